"""Units of time and energy: how heads of tables write them, and their sizes."""

import math
import re
from functools import lru_cache

from pendu_tui.tui.cli.errors import UserError

NANOSECONDS = {
    "fs": 1e-6,
    "ps": 1e-3,
    "ns": 1.0,
    "us": 1e3,
    "ms": 1e6,
    "s": 1e9,
    "yr": 3.15576e16,
    "a.u.": 2.4188843265864e-8,
}
BOLTZMANN = {  # per kelvin, in the 2019 SI
    "ev": 8.617333262e-5,
    "mev": 8.617333262e-2,
    "hartree": 3.166811563e-6,
    "ry": 6.333623126e-6,
    "kj/mol": 8.31446261815324e-3,
    "kcal/mol": 1.987204258640832e-3,
    "j": 1.380649e-23,
    "erg": 1.380649e-16,
    "k": 1.0,
}
_NO_ENERGIES = (
    *("bar", "kbar", "atm", "gpa", "mpa", "g/cm^3", "a^3", "nm^3", "%"),
    *("m", "m/s", "rad", "rad/s", "deg", "n", "v", "v/m"),
)
MAX_NAME = 100  # characters
_KNOWN = {"time": NANOSECONDS, "energy": BOLTZMANN}
_PER_MOLE = r"(/?mole?|[\s.·]mol\^?(-1|⁻¹))"
_OTHER_NAMES = {
    "time": (
        (r"femto-?seconds?", "fs"),
        (r"pico-?seconds?", "ps"),
        (r"nano-?seconds?", "ns"),
        (r"micro-?seconds?|µs", "us"),  # in any case, which makes a mu of the micro sign
        (r"sec(onds?)?", "s"),
        (r"years?", "yr"),
        (r"au|atomic_unit", "a.u."),
    ),
    "energy": (
        (r"a\.?u\.?|h|ha|eh|hartrees|atomic_unit", "hartree"),
        (r"electronvolt", "eV"),
        (r"rydbergs?", "Ry"),
        (rf"kj{_PER_MOLE}", "kJ/mol"),
        (rf"kcal{_PER_MOLE}", "kcal/mol"),
    ),
}
UNIT = "|".join(
    [*map(re.escape, NANOSECONDS | BOLTZMANN)]
    + [pattern for names in _OTHER_NAMES.values() for pattern, _ in names]
    + ["[kmnuµμ]J"]
)
"""The known units, as they are written in any case."""
_NO_UNITS = re.compile(r"kin(etic)?|pot(ential)?|tot(al)?|const", re.IGNORECASE)
_BRACKETS = re.compile(r"(.+?)[\s/]*[(\[{]\s*([^()\[\]{}>]*?)\s*[)\]}]")
_SUFFIX = re.compile(r"(.+?)(?:, |[\s_/])((?:kJ|kcal)/mol\w*|[^\s_/]{2,}|[sJ])", re.IGNORECASE)
_TIME_NAME = re.compile(r"(?:.*[^a-z])?t|.*time", re.IGNORECASE)


@lru_cache(4096)
def shown(kind: str, unit: str) -> str:
    """Return the usual name of a unit of this kind; one that is not known as it is."""
    for pattern, name in _OTHER_NAMES[kind]:
        if re.fullmatch(pattern, unit, re.IGNORECASE):
            return name
    return unit.lower() if kind == "time" and unit.lower() in NANOSECONDS else unit


def plain(kind: str, unit: str) -> str:
    """Return the key of a unit in NANOSECONDS or BOLTZMANN, "" if it is none of this kind."""
    name = shown(kind, unit).casefold()
    return name if name in _KNOWN[kind] else ""


def size(kind: str, unit: str) -> float:
    """Return a unit of time in ns, or kT at 1 K in a unit of energy.  Raises UserError."""
    name = plain(kind, unit)
    if not name:
        raise UserError(
            f"the unit of {kind} is not known; give one of {', '.join(_KNOWN[kind])}, "
            "for example --units time=ps,energy=eV or --step 0.5fs."
        )
    return _KNOWN[kind][name]


def is_of_another_kind(unit: str) -> bool:
    """Return whether this is a known unit, but none of energy."""
    is_known = bool(plain("time", unit)) or unit.casefold() in _NO_ENERGIES
    return is_known and not plain("energy", unit)


def is_unit(text: str) -> bool:
    return bool(plain("time", text) or plain("energy", text))


def split_unit(name: str) -> tuple[str, str]:
    """Return name and unit of `Time (ps)`, `E [eV]`, `time{picosecond}`, `t/ps` or `time_ps`."""
    name = name.strip()[:MAX_NAME]
    match = _BRACKETS.fullmatch(name)
    if match and not _NO_UNITS.fullmatch(match[2]):
        is_argument = match[2] == "t"  # of E(t)
        return match[1], "" if is_argument else match[2]
    match = _SUFFIX.fullmatch(name)
    kind = "time" if match and _TIME_NAME.fullmatch(match[1]) else "energy"
    if match and plain(kind, match[2]):
        return match[1], match[2]
    return name, ""


Moment = tuple[float, str]
"""A time and its unit, "" for that of the table."""


def moment(text: str) -> Moment:
    """Return a number and its unit of time, for example of `50ps` or `-2`."""
    number = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
    match = re.fullmatch(rf"{number}\s*([^\W\d]\S*)?", text.strip())
    if match is None or math.isinf(float(match[1])):
        raise ValueError(f"{text!r} is not a time; use, for example, 2 or 0.5fs")
    return float(match[1]), _unit_of_time(match[2]) if match[2] else ""


def quantity(text: str) -> Moment:
    """Return a time above zero, and its unit."""
    value, unit = moment(text)
    if value <= 0:
        raise ValueError(f"{text!r} is not a step; use, for example, 2 or 0.5fs")
    return value, unit


def _unit_of_time(unit: str) -> str:
    """Return a unit of time.  Raises ValueError if it is not known."""
    if not plain("time", unit):
        raise ValueError(f"{unit!r} is not a known unit of time; use, for example, fs, ps or ns")
    return unit


def assignments(text: str) -> dict[str, str]:
    """Return the units of `time=ps,energy=kJ/mol`."""
    pairs = [part.partition("=") for part in text.split(",") if part]
    found = {kind.strip(): unit.strip() for kind, _, unit in pairs}
    if not found or not set(found) <= {"time", "energy"} or not all(found.values()):
        raise ValueError(f"{text!r} names no units; use time=ps,energy=kJ/mol")
    if "time" in found:
        _unit_of_time(found["time"])
    if is_of_another_kind(found.get("energy", "")):
        raise ValueError(
            f"{found['energy']!r} is not a unit of energy; use, for example, eV or kJ/mol"
        )
    return found
