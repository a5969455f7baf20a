"""Tables of other programs: the rows under one head, and the series of times and energies in them.

The user says which columns are the time and the conserved energy, or they are guessed if they are
certain.  A series ends where time starts again.  A step back in time, but not to the start, is a
restart from a checkpoint: the same series.
"""

import math
from array import array
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.layouts import role
from pendu_tui.tui.cli.units import plain, shown, split_unit

LATEST = 1e300  # of times; squares and differences of later ones overflow
MAX_SERIES = 1000
MAX_NAMES = 500  # of values that are printed with their names
NOT_TIMES = "its time never increases; name the column of times with --time."
SAMPLE = 64  # rows, after which the columns are chosen and the others dropped
Group = tuple[int, ...]
"""Columns to add up."""

NO_ENERGIES = ("bar", "kbar", "atm", "gpa", "mpa", "g/cm^3", "a^3", "nm^3", "%")


def unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)


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
    def columns(self) -> Group:
        return tuple(sorted({*self.time, *self.energy, *self.kinetic}))


def choose(
    names: Sequence[str], units: Sequence[str], samples: Sequence[Any], wanted: Wanted
) -> Choice | None:
    """Return the columns to judge, None if one that the user names is missing.

    `samples` are the first values of each column; a column without a name is called "".
    """
    groups: list[Group] = []
    for name in (wanted.time, wanted.energy, wanted.kinetic):
        group = find(names, name) if name else ()
        if group is None:
            return None
        groups.append(group)
    time, energy, kinetic = groups
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
    for parts in ([text], text.split("+")):
        places = [_place(names, part.strip()) for part in parts]
        if -1 not in places:
            return tuple(places)
    return None


def _place(names: Sequence[str], text: str) -> int:
    """Return the column of a name or a number, -1 without it."""
    if text.isdecimal() and 0 < int(text) <= len(names):
        return int(text) - 1
    for way in (str.strip, str.casefold, _bare):
        for place, name in enumerate(names):
            if name and way(name.strip()) == way(text):
                return place
    return -1


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
        found = [
            place
            for place, name in enumerate(names)
            if role(name)[0] == known
            # T is a temperature, unless it increases
            and (_bare(name) != "t" or name[0] == "t" or place in rising)
        ]
        if found:
            return (min(found, key=lambda place: _bare(names[place]) not in ("t", "time")),)
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
    roles: dict[str, dict[int, list[int]]] = defaultdict(lambda: defaultdict(list))
    for place in places:
        unit = units[place]
        if plain("energy", unit) or not (plain("time", unit) or unit.casefold() in NO_ENERGIES):
            name, rank = role(names[place])
            roles[name][rank].append(place)
    for name in ("conserved", "total"):
        if name in roles:
            return _only(roles[name][min(roles[name])])
    parts = [
        place
        for name in ("kinetic", "potential")
        for found in roles[name].values()
        for place in found
    ]
    if len(roles["kinetic"]) == len(roles["potential"]) == 1 and len(parts) == 2:
        return tuple(parts) if units[parts[0]] == units[parts[1]] else ()
    return _only([place for place in places if role(names[place])[0] == "error"])


def _only(places: Sequence[int]) -> Group:
    """Return the only one of some columns, () if there are more."""
    return tuple(places) if len(places) == 1 else ()


def known_names(names: Sequence[str]) -> int:
    """Return how many of these are names of an energy, a step or the like, 0 without a time."""
    roles = [role(name)[0] for name in names]
    return len(roles) - roles.count("") if {"time", "step"} & set(roles) else 0


class Sheet:
    """The columns under one head, or of values printed with their names.

    Each value has the line where it was found.  A column without a name is called "".
    """

    def __init__(self, wanted: Wanted, line: int = 0, is_printed: bool = False):
        self.names: list[str] = []
        self.units: list[str] = []
        self.line = line  # where it begins
        self.kept: Group = ()  # the columns that are still read
        self.choice: Choice | None = None
        self.skipped = 0  # rows of another width
        self.puts = 0
        self.last: dict[int, float] = {}  # values
        self.last_line = line
        self.places: dict[str, int] = {}  # of columns by name
        self.wanted = wanted
        self._is_printed = is_printed
        self._once: dict[str, tuple[int, float]] = {}  # what was printed only once
        self._values: dict[Group, array[float]] = defaultdict(lambda: array("d"))
        """By columns: the line where they were found and their values, in turn."""

    def add_column(self, name: str, unit: str = "") -> None:
        self.kept += (len(self.names),)
        self.names.append(name)
        self.units.append(unit)

    def put(
        self, lines: Sequence[int], places: Group, columns: Sequence[Sequence[float | None]]
    ) -> None:
        """Add the values of some columns at these lines, at a single one only the numbers."""
        pairs = zip(places, columns, strict=True)
        some: dict[int, Any] = {place: column for place, column in pairs if column[0] is not None}
        self._values[tuple(some)].extend(
            chain.from_iterable(zip(lines, *some.values(), strict=True))
        )
        self.last = {place: column[-1] for place, column in some.items()}
        self.last_line = lines[-1]
        is_sampled = self.puts >= SAMPLE
        self.puts += len(lines)
        if self.puts >= SAMPLE and not is_sampled:
            self.choose()

    def print(self, name: str, unit: str, line: int, value: float) -> None:
        """Add a value that is printed with its name.  Once is not repeatedly."""
        if name not in self.places and name in self._once:
            self.places[name] = len(self.names)
            self.add_column(name, unit)
            first, before = self._once[name]
            self.put([first], (self.places[name],), [[before]])
        if name in self.places:
            self.put([line], (self.places[name],), [[value]])
        elif len(self._once) < MAX_NAMES:
            self._once[name] = (line, value)

    def _column(self, place: int) -> tuple[Any, Any]:
        """Return the lines and values of a column, in the order of the lines."""
        tables = [
            np.frombuffer(values).reshape(-1, 1 + len(places)).T[[0, 1 + places.index(place)]]
            for places, values in self._values.items()
            if place in places
        ]
        if len(tables) == 1:
            return tables[0][0], tables[0][1]
        lines, values = np.concatenate([np.empty((2, 0)), *tables], axis=1)
        order = np.argsort(lines, kind="stable")
        return lines[order], values[order]

    def choose(self) -> None:
        """Choose the columns of time and energy.  The others are no longer read."""
        samples = [self._column(place)[1][:SAMPLE] for place in range(len(self.names))]
        if len(self.names) > 1 and not self.names[0] and any(self.names) and not _counts(samples):
            self.names = [""] * len(self.names)  # the head does not belong to these rows
        self.choice = choose(self.names, self.units, samples, self.wanted)
        if not self._is_printed and self.puts >= SAMPLE:
            self.kept = (self.choice or Choice()).columns or (0,)  # to count rows

    def ends_at(self, row: Sequence[float | None]) -> bool:
        """Return whether the last row has the time of this one, which begins a run."""
        if self.choice is None:
            self.choose()
        time = (self.choice or Choice()).time
        return len(time) == 1 and self.last.get(time[0]) == row[time[0]]

    def series(self) -> Iterator["Series"]:
        """Yield what lies between two starts of time.  Raises UserError if there are too many."""
        self.choose()
        choice = self.choice or Choice()
        leading = [*choice.time, *choice.energy, 0]
        lines, _ = self._column(leading[0])
        if not len(lines):
            return
        here, sums = self._sums((choice.time, choice.energy, choice.kinetic), lines)
        last = np.flatnonzero(here).max(initial=-1)
        inner = np.diff(np.flatnonzero(here), prepend=-1).max(initial=0) - 1
        missing = len(here) - 1 - last  # rows after the last energy
        if last >= 0 and missing > max(inner, 1):  # it ended, it is not only rarer
            here[last + 1 :] = True
        times, energies, kinetic = (total[here] for total in sums)
        rows = len(times)
        if not choice.time:
            times = np.arange(rows, dtype=float)
        if self.skipped > rows:
            raise unreadable(
                f"{self.skipped} rows have another number of columns than the {rows} that fit the "
                "head; cut the file there."
            )
        runs = list(_runs(times))
        if len(runs) == rows > 1:
            raise unreadable(NOT_TIMES)
        seen = len(here) if self._is_printed else self.puts
        skipped = self.skipped + seen - rows
        for run in runs:
            series = Series(self, choice, times[run], energies[run], kinetic[run])
            series.skipped = skipped
            skipped = 0
            yield series

    def _sums(self, groups: Sequence[Group], lines: Any) -> tuple[Any, list[Any]]:
        """Return the leading lines where all columns have a value, and the sum of each group."""
        here = np.ones(len(lines), dtype=bool)
        sums = []
        for group in groups:
            sums.append(np.zeros(len(lines)))
            for place in group:
                column, has_value = self._joined(place, lines)
                here &= has_value
                sums[-1] += column
        return here, sums

    def _joined(self, place: int, lines: Any) -> tuple[Any, Any]:
        """Return a column at the lines of the leading one, nan where it has no value, and where.

        What is printed belongs to the time before it, or to that after it if all come before.
        """
        own, values = self._column(place)
        record = np.searchsorted(lines, own, side="right") - 1
        if self._is_printed and np.array_equal(record + 1, np.arange(len(lines))):
            record += 1
        fits = record >= 0
        if not self._is_printed:
            fits &= lines[record] == own
        record = record[fits]
        column = np.full(len(lines), np.nan)
        column[record] = values[fits]
        has_value = np.zeros(len(lines), dtype=bool)
        has_value[record] = True
        return column, has_value


def _counts(samples: Sequence[Any]) -> bool:
    """Return whether the first column counts rows or steps, and the second does not fall."""
    steps = np.diff(samples[0])
    return bool(
        (samples[0] % 1 == 0).all()
        and (len(steps) == 0 or np.median(steps) > 0)
        and (len(samples[1]) < 2 or np.median(np.diff(samples[1])) >= 0)
    )


def _runs(times: Any) -> Iterator[slice]:
    """Yield each part of the times that ends where time starts again."""
    first = 0
    for _ in range(MAX_SERIES):
        usable = np.abs(times[first:]) < LATEST
        if not usable.any():
            return
        start = first + int(np.argmax(usable))
        again = np.flatnonzero(usable[start - first + 1 :] & (times[start + 1 :] <= times[start]))
        last = start + 1 + int(again[0]) if len(again) else len(times)
        yield slice(first, last)
        first = last
    raise unreadable(NOT_TIMES)


@dataclass
class Series:
    """Times that increase, and their energies; before `finish`, as they are in the sheet."""

    sheet: Sheet
    choice: Choice
    times: Any
    energies: Any
    kinetic: Any
    number: int = 0  # from 1
    skipped: int = 0  # rows without numbers, or not later than one before
    diverged_at: float | None = None  # the time of the first energy that is no finite number
    units: tuple[str, str] = ("", "")  # of time and energy

    @property
    def rows(self) -> int:
        return len(self.times)

    @property
    def holds_errors(self) -> bool:
        """Whether the energies are relative errors already."""
        energy = self.choice.energy
        return len(energy) == 1 and role(self.sheet.names[energy[0]])[0] == "error"

    def named(self, group: Sequence[int]) -> str:
        """Return the names of columns that are added up, "row" if there is none."""
        names = (self.sheet.names[place] for place in group)
        bare = (split_unit(name)[0] for name in names)
        parts = zip(bare, group, strict=True)
        return "+".join(name or f"column {place + 1}" for name, place in parts) or "row"

    def finish(self, start: float = -math.inf, end: float = math.inf) -> None:
        """Apply step and units; leave out rows that cannot be used or are not in this range.

        Raises UserError if none is left.
        """
        self.units = self._units()
        size, _ = self.sheet.wanted.step or (1.0, "")
        is_time = np.abs(self.times) < LATEST
        times = np.where(is_time, self.times * size, -np.inf)
        before = np.maximum.accumulate(np.concatenate([[-np.inf], times[:-1]]))
        is_later = is_time & (times > before)
        skipped = int(np.count_nonzero(~is_later))
        self.skipped += skipped
        used = np.flatnonzero(is_later & (times >= start) & (times <= end))
        lost = np.flatnonzero(~np.isfinite(self.energies[used] + self.kinetic[used]))
        is_lost = 0 < len(lost) == len(used)
        if len(lost):
            self.diverged_at = float(times[used[lost[0]]])
            used = used[: lost[0]]
        if skipped > len(times) - skipped:
            raise unreadable(
                "most rows are not later than the row before, so this table seems to hold several "
                "methods; judge one of them, for example filtered with grep."
            )
        if not len(used):
            why = "no row has a usable time and energy in this range."
            if is_lost:
                why = "each energy in this range is nan or infinite; repeat it with a smaller step."
            elif self.diverged_at is not None:
                why += f" Use --from with a later time than {self.diverged_at:g}."
            raise unreadable(why)
        self.times = times[used]
        self.energies = self.energies[used]
        self.kinetic = self.kinetic[used]

    def _units(self) -> tuple[str, str]:
        """Return the units of time and energy.

        Raises UserError if columns to be added have different ones, or --step contradicts one.
        """
        wanted = self.sheet.wanted
        found = {}
        for kind, group in (("time", self.choice.time), ("energy", self.choice.energy)):
            units = {shown(kind, self.sheet.units[place]) for place in group}
            if len(units - {""}) > 1:
                raise UserError(
                    f"the units of {self.named(group)} differ ({', '.join(sorted(units))}); "
                    "add columns of one unit, or convert them first."
                )
            found[kind] = units.pop() if len(units) == 1 else ""
        is_time = any(role(self.sheet.names[place])[0] == "time" for place in self.choice.time)
        if wanted.step and (found["time"] or is_time):
            raise UserError(
                f"--step is for steps, but {self.named(self.choice.time)} is a time already; "
                "name the column of steps with --time, or leave out --step."
            )
        if wanted.step:
            found["time"] = wanted.step[1]
        time, energy = (shown(kind, unit) for kind, unit in (found | wanted.units).items())
        return time, energy
