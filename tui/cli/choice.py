"""Which columns are the time and the total energy: as the user says, or a guess by their names."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.tui.cli.layouts import (
    ENERGIES,
    ERRORS,
    KINETIC,
    OTHERS,
    POTENTIAL,
    STEPS,
    TIMES,
    key,
)
from pendu_tui.tui.cli.units import plain, split_unit

NO_ENERGIES = ("bar", "kbar", "atm", "gpa", "mpa", "g/cm^3", "a^3", "nm^3", "%")

Group = tuple[int, ...]
"""Columns to add up."""


@dataclass(frozen=True)
class Wanted:
    """What the user says about the columns; what is None is guessed."""

    time: str | None = None
    energy: str | None = None
    kinetic: str | None = None
    units: dict[str, str] = field(default_factory=dict)
    step: tuple[float, str] | None = None  # and its unit


class Choice(NamedTuple):
    """The columns of time, energy and kinetic energy.  Without a time, rows are counted."""

    time: Group = ()
    energy: Group = ()
    kinetic: Group = ()
    doubt: str = ""  # what is not certain

    @property
    def columns(self) -> list[int]:
        return sorted({*self.time, *self.energy, *self.kinetic})


def choose(
    names: Sequence[str], units: Sequence[str], samples: Sequence[Any], wanted: Wanted
) -> Choice | None:
    """Return the columns to judge, None if one that the user names is missing.

    `samples` are the first values of each column.
    """
    named = [wanted.time, wanted.energy, wanted.kinetic]
    groups = [name and find(names, name) for name in named]
    if any(name and not group for name, group in zip(named, groups, strict=True)):
        return None
    time, energy, kinetic = (group or () for group in groups)
    doubts = []
    if not time:
        guess = _time(names, samples, excluded=energy)
        if guess is None:
            doubts.append("the time")
        time = guess or ()
    if not energy:
        energy = _energy(names, units, excluded=time)
        if not energy:
            doubts.append("the total energy")
    return Choice(time, energy, kinetic, " and ".join(doubts))


def find(names: Sequence[str], text: str) -> Group | None:
    """Return the columns of a name, a number from 1, or several joined by +.

    Case and unit of a name do not count.  Without a name that fits, it is None.
    """
    last_first = [*enumerate(names)][::-1]
    known = {split_unit(name)[0].casefold(): place for place, name in last_first}
    known |= {name.strip().casefold(): place for place, name in last_first}
    known |= {name.strip(): place for place, name in last_first}
    known |= {str(place + 1): place for place, _ in last_first}
    known.pop("", None)
    for parts in ([text], text.split("+")):
        group = [_place(known, part.strip()) for part in parts]
        if None not in group:
            return tuple(place for place in group if place is not None)
    return None


def _place(known: dict[str, int], name: str) -> int | None:
    for each in (name, name.casefold(), split_unit(name)[0].casefold()):
        if each in known:
            return known[each]
    return None


def _time(names: Sequence[str], samples: Sequence[Any], excluded: Group) -> Group | None:
    """Return the column of times, () if there is none, None if it is not certain."""
    keys = [key(split_unit(name)[0]) for name in names]
    for known in (*TIMES, *STEPS):
        places = [place for place, each in enumerate(keys) if each == known]
        if known == "t":  # T is a temperature, unless it increases
            lower = [place for place in places if names[place].strip().startswith("t")]
            places = lower or [place for place in places if _increases(samples[place])]
        if places:
            return (places[0],)
    rising = [
        place
        for place, sample in enumerate(samples)
        if place not in excluded and _increases(sample)
    ]
    if not rising:
        return ()
    if len(rising) == 1 and (not names[rising[0]] or _is_even(samples[rising[0]])):
        return (rising[0],)
    return None


def _is_no_energy(unit: str) -> bool:
    return bool(plain("time", unit)) or unit.casefold() in NO_ENERGIES


def _increases(sample: Any) -> bool:
    differences = np.diff(sample)
    return len(differences) > 1 and bool(np.all(differences > 0))


def _is_even(sample: Any) -> bool:
    differences = np.diff(sample)
    return bool(np.ptp(differences) < 1e-3 * abs(differences).max())  # printed with few digits


def _energy(names: Sequence[str], units: Sequence[str], excluded: Group) -> Group:
    """Return the columns whose sum is the conserved energy, () if that is not certain."""
    places = [place for place in range(len(names)) if place not in excluded]
    if not any(names[place] for place in places):
        return tuple(places) if len(places) == 1 else ()
    keys = {
        place: key(split_unit(names[place])[0])
        for place in places
        if plain("energy", units[place]) or not _is_no_energy(units[place])
    }
    for known in ENERGIES:
        found = tuple(place for place, each in keys.items() if each in known)
        if found:
            return found if len(found) == 1 else ()
    parts = [
        [place for place, each in keys.items() if each in known] for known in (KINETIC, POTENTIAL)
    ]
    if all(len(part) == 1 for part in parts) and len({units[part[0]] for part in parts}) == 1:
        return (parts[0][0], parts[1][0])
    errors = tuple(place for place in places if is_error(names[place]))
    return errors if len(errors) == 1 else ()


def is_error(name: str) -> bool:
    """Return whether a column of this name holds relative errors of the energy."""
    return any(ERRORS.fullmatch(key(each)) for each in (name, split_unit(name)[0]))


def is_energy(name: str) -> bool:
    each = key(split_unit(name)[0])
    return any(each in known for known in (*ENERGIES, KINETIC, POTENTIAL))


def is_time(name: str) -> bool:
    return key(split_unit(name)[0]) in TIMES


def known_names(names: Sequence[str]) -> int:
    """Return how many of these are names of an energy, a step or the like, 0 without a time."""
    keys = [key(split_unit(name)[0]) for name in names]
    if not any(each in TIMES or each in STEPS for each in keys):
        return 0
    others = sum(each in OTHERS or each in STEPS for each in keys)
    return others + sum(is_time(name) or is_energy(name) or is_error(name) for name in names)
