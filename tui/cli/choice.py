"""Which columns are the time and the conserved energy: as the user says, or a certain guess."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.tui.cli.layouts import role
from pendu_tui.tui.cli.units import plain, split_unit

Group = tuple[int, ...]
"""Columns to add up."""

NO_ENERGIES = ("bar", "kbar", "atm", "gpa", "mpa", "g/cm^3", "a^3", "nm^3", "%")


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

    `samples` are the first values of each column; a column without a name is called "".
    """
    asked = (wanted.time, wanted.energy, wanted.kinetic)
    groups = [name and find(names, name) for name in asked]
    if any(name and not group for name, group in zip(asked, groups, strict=True)):
        return None
    time, energy, kinetic = (group or () for group in groups)
    doubts = []
    if not wanted.time:
        guess = _time(names, samples, excluded=energy)
        time = guess or ()
        if guess is None:
            doubts.append("the time")
    if not energy:
        energy = _energy(names, units, excluded=time)
        if not energy:
            doubts.append("the total energy")
    return Choice(time, energy, kinetic, " and ".join(doubts))


def find(names: Sequence[str], text: str) -> Group | None:
    """Return the columns of a name, a number from 1, or several joined by +, None without them.

    Case and unit of a name do not count, if it is not there to the letter.
    """
    known: dict[str, int] = {}
    for ways in (str.strip, _bare, lambda name: name.strip().casefold()):
        for place, name in enumerate(names):
            known.setdefault(ways(name), place)
    known |= {str(place + 1): place for place in range(len(names))}
    known.pop("", None)
    for parts in ([text.strip()], text.split("+")):
        keys = [
            next(
                (
                    way
                    for way in (part.strip(), part.strip().casefold(), _bare(part))
                    if way in known
                ),
                None,
            )
            for part in parts
        ]
        if None not in keys:
            return tuple(known[key] for key in keys if key is not None)
    return None


def _bare(name: str) -> str:
    return split_unit(name)[0].casefold()


def _time(names: Sequence[str], samples: Sequence[Any], excluded: Group) -> Group | None:
    """Return the column of times, () if there is none, None if it is not certain."""
    rising = [
        place
        for place, sample in enumerate(samples)
        if place not in excluded and len(sample) > 2 and (np.diff(sample) > 0).all()
    ]
    for known in ("time", "step"):
        places = [place for place, name in enumerate(names) if role(name)[0] == known]
        # T is a temperature, unless it increases
        places = [
            place
            for place in places
            if _bare(names[place]) != "t" or names[place][0] == "t" or place in rising
        ]
        if places:
            return (
                min(places, key=lambda place: (_bare(names[place]) not in ("t", "time"), place)),
            )
    if not rising:
        return ()
    steps = np.diff(samples[rising[0]])
    is_even = np.ptp(steps) < 1e-3 * steps.max()  # printed with few digits
    if len(rising) == 1 and (is_even or not names[rising[0]]):
        return (rising[0],)
    return None


def _energy(names: Sequence[str], units: Sequence[str], excluded: Group) -> Group:
    """Return the columns whose sum is the conserved energy, () if that is not certain."""
    places = [place for place in range(len(names)) if place not in excluded]
    if not any(names[place] for place in places):
        return _only(places)
    roles: dict[tuple[str, int], list[int]] = {}
    for place in places:
        unit = units[place]
        is_energy = plain("energy", unit) or not (
            plain("time", unit) or unit.casefold() in NO_ENERGIES
        )
        if is_energy:
            roles.setdefault(role(names[place]), []).append(place)
    ranked = [roles[each] for each in sorted(roles, key=lambda each: each[1])]
    best = [found for found in ranked if role(names[found[0]])[0] in ("conserved", "total")]
    if best:
        return _only(best[0])
    parts = [
        place
        for (name, _), found in sorted(roles.items())
        for place in found
        if name in ("kinetic", "potential")
    ]
    if [role(names[place])[0] for place in parts] == ["kinetic", "potential"]:
        if units[parts[0]] != units[parts[1]]:
            return ()
        return tuple(parts)
    errors = [place for place in places if role(names[place])[0] == "error"]
    return _only(errors)


def _only(places: Sequence[int]) -> Group:
    """Return the only one of some columns, () if there are more."""
    if len(places) > 1:
        return ()
    return tuple(places)


def known_names(names: Sequence[str]) -> int:
    """Return how many of these are names of an energy, a step or the like, 0 without a time."""
    roles = [role(name)[0] for name in names]
    return len(roles) - roles.count("") if {"time", "step"} & set(roles) else 0
