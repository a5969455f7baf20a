"""Units of time and energy in the heads of tables: how they are written, and their sizes."""

import argparse
import re

NANOSECONDS = {
    "fs": 1e-6,
    "ps": 1e-3,
    "ns": 1.0,
    "us": 1e3,
    "µs": 1e3,
    "ms": 1e6,
    "s": 1e9,
    "min": 6e10,
    "h": 3.6e12,
    "d": 8.64e13,
    "yr": 3.15576e16,
    "a.u.": 2.4188843265864e-8,
}
BOLTZMANN = {  # per kelvin, in the 2019 SI
    "ev": 8.617333262e-5,
    "mev": 8.617333262e-2,
    "kj/mol": 8.31446261815324e-3,
    "kcal/mol": 1.987204258640832e-3,
    "hartree": 3.166811563e-6,
    "ry": 6.333623126e-6,
    "j": 1.380649e-23,
    "kj": 1.380649e-26,
    "erg": 1.380649e-16,
    "cm-1": 0.695034800,
    "k": 1.0,
}
_OTHER_NAMES = {
    "time": {
        **dict.fromkeys(("femtosecond", "femtoseconds", "femto-seconds"), "fs"),
        **dict.fromkeys(("picosecond", "picoseconds", "pico-seconds"), "ps"),
        **dict.fromkeys(("nanosecond", "nanoseconds"), "ns"),
        **dict.fromkeys(("sec", "second", "seconds"), "s"),
        **dict.fromkeys(("year", "years"), "yr"),
        **dict.fromkeys(("au", "atomic_unit"), "a.u."),
    },
    "energy": {
        "electronvolt": "eV",
        **dict.fromkeys(("rydberg", "rydbergs"), "Ry"),
        **dict.fromkeys(("kj/mole", "kjmol", "kj.mol-1"), "kJ/mol"),
        **dict.fromkeys(("kcal/mole", "kcalmol"), "kcal/mol"),
        **dict.fromkeys(("a.u.", "au", "h", "ha", "eh", "hartrees", "atomic_unit"), "hartree"),
    },
}
_KNOWN = {"time": NANOSECONDS, "energy": BOLTZMANN}
_BRACKETS = re.compile(r"(.+?)[\s/]*[(\[{]\s*([^()\[\]{}]*?)\s*[)\]}]")
_SUFFIX = re.compile(r"(.+?)[\s_/]((?:kJ|kcal)/mol\w*|[^\s_/]+)", re.IGNORECASE)
_WORD = re.compile(
    r"kin|pot|tot|(?!.*(?:second|volt|hartree|rydberg))[a-z ]{4,}", re.IGNORECASE
)  # (const)
_TIME_NAME = re.compile(r"(?:.*[^a-z])?t|.*time", re.IGNORECASE)


def plain(kind: str, unit: str) -> str:
    """Return the key of a unit in NANOSECONDS or BOLTZMANN, "" if it is none of this kind."""
    lower = unit.casefold()
    name = _OTHER_NAMES[kind].get(lower, lower).casefold()
    return name if name in _KNOWN[kind] else ""


def shown(kind: str, unit: str) -> str:
    """Return the usual name of a unit; one that is not known as it is."""
    if kind == "time" and unit.casefold() in NANOSECONDS:
        return unit.casefold()
    return _OTHER_NAMES[kind].get(unit.casefold(), unit)


def split_unit(name: str) -> tuple[str, str]:
    """Return name and unit of `Time (ps)`, `E [eV]`, `time{picosecond}`, `t/ps` or `time_ps`."""
    name = name.strip()
    if (match := _BRACKETS.fullmatch(name)) and not _WORD.fullmatch(match[2]):
        return match[1], match[2]
    match = _SUFFIX.fullmatch(name)
    if match is None or match[2].casefold() in ("k", "h", "d"):
        return name, ""
    kind = "energy"
    if _TIME_NAME.fullmatch(match[1]):
        kind = "time"
    if not plain(kind, match[2]):
        return name, ""
    return match[1], match[2]


def quantity(text: str) -> tuple[float, str]:
    """Return a number above zero and its unit of time, for example of `0.5fs` or `2`."""
    match = re.fullmatch(r"([\d.eE+-]*[\d.])\s*([^\W\d]\S*)?", text.strip())
    try:
        value = float(match[1]) if match else 0.0
    except ValueError:
        value = 0.0
    if match is None or not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a step; use for example 2 or 0.5fs")
    return value, match[2] or ""


def assignments(text: str) -> dict[str, str]:
    """Return the units of `time=ps,energy=kJ/mol`."""
    pairs = [part.partition("=") for part in text.split(",") if part]
    found = {kind.strip(): unit.strip() for kind, _, unit in pairs}
    if not found or not set(found) <= {"time", "energy"} or not all(found.values()):
        raise argparse.ArgumentTypeError(f"{text!r} names no units; use time=ps,energy=kJ/mol")
    return found
