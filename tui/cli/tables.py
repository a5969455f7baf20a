"""Tables of other programs: the rows under one head, and the series of times and energies in them.

The user says which columns are the time and the conserved energy, or they are guessed if they are
certain.  A series ends where time starts again.  A step back in time, but not to the start, is a
restart from a checkpoint: the same series.
"""

import math
from array import array
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run.verdicts import TOO_LARGE
from pendu_tui.tui.cli.errors import UserError, unreadable
from pendu_tui.tui.cli.layouts import key, role
from pendu_tui.tui.cli.units import Moment, is_of_another_kind, plain, shown, size, split_unit

ROUNDING = 2e-15  # relative, of a converted time
LATEST = 1e300  # of times; squares and differences of later ones overflow
MAX_SERIES = 1000
MAX_NAMES = 500  # of values that are printed with their names
NOT_LATER = (
    "most of its rows are not later than those before; name the column of times with --time, or "
    "print numbers without thousands separators."
)
SAMPLE = 64  # rows, after which the columns are chosen and the others dropped
NO_UNIT = ("", "1", "-")  # of relative errors
CLEARLY = 2  # times smaller is the standard deviation of what is steadier
OTHER_E = {"e": {"a", "i", "inc", "n"}, "E": {"N", "B", "I", "nu", "strain", "loss"}}
"""Columns beside which it is an eccentricity, or East, a field, a modulus, a loss."""
WALL = (1e9, 2e9)  # seconds since 1970, in 2001 to 2033
COUNTS = ("N", "i", "n")  # if they are whole numbers
Group = tuple[int, ...]
"""Columns to add up."""


@dataclass(frozen=True)
class Wanted:
    """What the user says about the columns; what is None is guessed."""

    time: str | None = None
    energy: str | None = None
    kinetic: str | None = None
    units: dict[str, str] = field(default_factory=dict)
    step: Moment | None = None


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
    groups: Any = [find(names, text) for text in (wanted.time, wanted.energy, wanted.kinetic)]
    if None in groups:
        return None
    time, energy, kinetic = groups
    if not wanted.time:
        time = _time(names, units, samples, excluded=energy)
        if time is None and wanted.step:  # of rows
            time = ()
    if not wanted.energy:
        energy = _energy(names, units, samples, excluded=time or ())
    guessed = {"the time": time, "the total energy": energy}
    doubt = " and ".join(what for what, group in guessed.items() if group is None)
    return Choice(time or (), energy or (), kinetic, doubt)


def find(names: Sequence[str], text: str | None) -> Group | None:
    """Return the columns of a name, a number from 1, or several joined by +, None without them.

    Case and unit of a name do not count, if it is not there to the letter.
    """
    if not text:
        return ()
    text = text.replace("−", "-")  # as in what is read
    for parts in ([text], text.split("+")):
        places = [_place(names, part.strip()) for part in parts]
        if -1 not in places:
            return tuple(places)
    return None


def _place(names: Sequence[str], text: str) -> int:
    """Return the column of a name or a number, -1 without it."""
    if text.isdecimal() and int(text) <= len(names):
        return int(text) - 1
    for way in (str.strip, str.casefold, _bare):
        keys = [way(name.strip()) for name in names]
        if text and way(text) in keys:
            return keys.index(way(text))
    return -1


def _bare(name: str) -> str:
    return split_unit(name)[0].casefold()


def _by_role(names: Sequence[str], places: Iterable[int]) -> dict[str, Group]:
    """Return those of some columns that have the best name for each role."""
    found: dict[tuple[int, str], Group] = defaultdict(tuple)
    for place in places:
        kind, rank = role(names[place])
        found[rank, kind] += (place,)
    return {kind: group for (_, kind), group in sorted(found.items(), reverse=True)}


def _time(
    names: Sequence[str], units: Sequence[str], samples: Sequence[Any], excluded: Group
) -> Group | None:
    """Return the column of times, () if there is none, None if it is not certain."""
    rising = [
        place
        for place, sample in enumerate(samples)
        if place not in excluded and len(sample) > 2 and (np.diff(sample) > 0).all()
    ]
    # T is a temperature, unless it increases
    is_hot = [_bare(name) == "t" and name[0] == "T" for name in names]
    best = _by_role(names, (n for n in range(len(names)) if n in rising or not is_hot[n]))
    if times := best.get("time", ()) + best.get("step", ()):
        return (min(times, key=lambda place: _is_on_the_wall(units[place], samples[place])),)
    if not rising:
        others = (some for name, some in zip(names, samples, strict=True) if not role(name)[0])
        return None if any(map(_is_in_turn, others)) else ()
    steps = np.diff(samples[rising[0]])
    is_even = np.ptp(steps) < 1e-3 * steps.max()  # printed with few digits
    return _only(rising) if is_even or not names[rising[0]] else None


def _are_numbered(names: Sequence[str], samples: Sequence[Any]) -> bool:
    """Return whether a first column without a name may hold the numbers of the rows."""
    if (samples[0] % 1).any():
        return False
    if len(names) < 2 or len(samples[1]) < 2 or role(names[1])[0] not in ("time", "step"):
        return True
    return not np.median(np.diff(samples[1])) < 0


def _is_on_the_wall(unit: str, sample: Any) -> bool:
    """Return whether a clock shows these times, in seconds since 1970."""
    low, high = WALL
    return unit in ("", "s") and len(sample) > 0 and low < sample[0] < high


def _is_in_turn(sample: Any) -> bool:
    """Return whether a column counts bodies, methods or processes again and again."""
    again = np.flatnonzero(np.asarray(sample[1:]) == sample[:1]) + 1
    if not len(again) or again[0] < 2 or len(sample) < 3 * again[0] or np.mod(sample, 1).any():
        return False
    is_periodic = np.array_equal(sample[again[0] :], sample[: -again[0]])
    return is_periodic and len({*sample[: again[0]]}) == again[0]


def _energy(
    names: Sequence[str], units: Sequence[str], samples: Sequence[Any], excluded: Group
) -> Group | None:
    """Return the columns whose sum is the conserved energy, None if that is not certain."""
    places = [place for place in range(len(names)) if place not in excluded]
    if not any(names[place] for place in places):
        return _only(places)
    best = _by_role(names, [place for place in places if not is_of_another_kind(units[place])])
    if certain := best.get("conserved") or best.get("total"):
        return _only(certain)
    kinetic = best.get("kinetic", ())
    parts = kinetic + best.get("potential", ())
    has_parts = len(kinetic) == 1 and len(parts) == 2
    further = best.get("", ())
    bare = [split_unit(name)[0] for name in names]
    has_more = any(key(bare[place]).endswith(("energy", "energie")) for place in further)
    if found := best.get("energy"):
        is_other = _is_other(bare, samples, found[0]) or (bare[found[0]] == "e" and "error" in best)
        name = key(bare[found[0]])
        is_total = name.startswith("tot")  # of what?
        if not units[found[0]]:
            has_more |= bool(further) and _is_field_or_count(_first(samples, found)[0])
            is_other |= name == "e" and has_more and not has_parts
            is_other |= is_total and bool(further) and not parts
        may_differ = bool(further) or not is_total
        is_sum = not has_parts or _is_sum(samples, found + parts, may_differ)
        is_certain = is_sum and not is_other and not _lacks(samples, found, kinetic)
        return _only(found) if is_certain else None
    if has_parts:
        is_whole = len({shown("energy", units[place]) for place in parts}) == 1 and not has_more
        return parts if is_whole and not _lacks(samples, parts, further) else None
    return _only([place for place in best.get("error", ()) if units[place] in NO_UNIT])


def _is_other(names: Sequence[str], samples: Sequence[Any], place: int) -> bool:
    """Return whether E is one of OTHER_E by the columns beside it."""
    values = zip(names, samples, strict=True)
    others = {each for each, some in values if each not in COUNTS or np.mod(some, 1).any()}
    return bool(others & OTHER_E.get(names[place], set()))


def _is_field_or_count(values: Any) -> bool:
    """Return whether a bare E is a field, which often changes sign, or counts from 0."""
    changes = np.diff(values > 0)
    is_field = np.count_nonzero(changes[1:] > changes[:-1]) > 2
    is_count = values.min(initial=1) == 0 and values.max() > 1 and not np.mod(values, 1).any()
    return bool(is_field or is_count)


def _is_sum(samples: Sequence[Any], places: Group, may_differ: bool) -> bool:
    """Return whether a total is the sum of two columns, or perhaps steadier, but no constant."""
    total, *parts = _first(samples, places)
    error = np.abs(total - sum(parts)).max(initial=0)
    is_near = error <= 0.01 * np.abs(parts).max(initial=0)
    return bool(is_near or (may_differ and 0 < np.ptp(total) < np.ptp(sum(parts))))


def _lacks(samples: Sequence[Any], places: Group, others: Group) -> bool:
    """Return whether one of the other columns makes the sum of these clearly steadier."""
    for other in others:
        *_, before, after = _first(samples, (*places, other)).cumsum(axis=0)
        if len(after) > 2 and CLEARLY * np.std(after) < np.std(before):
            return True
    return False


def _first(samples: Sequence[Any], places: Group) -> Any:
    """Return the first finite values of some columns."""
    rows = min(len(samples[place]) for place in places)
    values = np.array([samples[place][:rows] for place in places])
    return values[:, np.isfinite(values).all(axis=0)]


def _only(places: Sequence[int]) -> Group | None:
    """Return the only one of some columns, None if there are more or none."""
    return tuple(places) if len(places) == 1 else None


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
        self.marks: Group = ()  # methods, seeds
        self.choice: Choice | None = None
        self.skipped = 0  # rows of another width
        self.puts = 0
        self.last = 0  # the line of the last row
        self.error = ""  # the line of an error below it
        self.heads: list[int] = []  # lines of its head, where it is repeated
        self.places: dict[str, int] = {}  # of columns by name
        self.wanted = wanted
        self.mixed: dict[int, str] = {}  # columns in two units, and where
        self.bracketed: dict[int, str] = {}  # columns with (42), and that
        self._is_printed = is_printed
        self._once: dict[str, tuple[str, int, float]] = {}  # what was printed only once
        self._lines: list[array[int]] = []  # of the values of each column
        self._values: list[array[float]] = []

    def add_column(self, name: str, unit: str = "") -> None:
        self.kept += (len(self.names),)
        if role(name)[0] == "mark":
            self.marks += (len(self.names),)
        self.names.append(name)
        self.units.append(unit)
        self._lines.append(array("q"))
        self._values.append(array("d"))

    def put(self, line: int, places: Group, values: Sequence[float | None]) -> None:
        """Add the values of some columns at this line; None is a blank."""
        for place, value in zip(places, values, strict=True):
            if value is not None:
                self._lines[place].append(line)
                self._values[place].append(value)
        self.last = line
        self.error = ""
        self.puts += 1
        if self.puts == SAMPLE:
            self.choose()

    def put_cut(self, line: int, numbers: Sequence[Any]) -> None:
        """Add a row that ends early.  Only its time is certainly a number of its column.

        What is far from the next time belongs to a remark below the table.
        """
        if self.choice is None:
            self.choose()
        choice = self.choice or Choice()
        if not choice.time:
            self.skipped += 1
            return
        place = choice.time[0]
        ended = [value for value in numbers if value != value]  # perhaps all there is
        times = [*numbers[place:], *ended]
        if times and self._may_follow(place, times[0]):
            self.put(line, (place,), times[:1])
        else:
            self.skipped += 1

    def _may_follow(self, place: int, time: float) -> bool:
        """Return whether a time may be the next one in a column, or nan."""
        known = self._values[place][-2:]
        if len(known) < 2 or math.isnan(time):
            return True
        return 0 < time - known[1] <= 10 * (known[1] - known[0])

    def print(self, name: str, unit: str, line: int, value: float) -> None:
        """Add a value that is printed with its name.  Once is not repeatedly."""
        if name not in self.places and name in self._once:
            self.places[name] = len(self.names)
            first = self._once[name]
            self.add_column(name, first[0] or unit)
            self.print(name, *first)
        if name in self.places:
            place = self.places[name]
            self.put(line, (place,), (value,))
            if unit != self.units[place]:
                self.check_unit(place, unit, line)
        elif len(self._once) < MAX_NAMES:
            self._once[name] = (unit, line, value)

    def check_unit(self, place: int, unit: str, line: int) -> None:
        """Note that a value has another unit than those above."""
        name = self.names[place]
        own = self.units[place]
        kind = "time" if role(name)[0] == "time" else "energy"
        if unit and shown(kind, unit) != shown(kind, own or unit):
            why = f"{name} is in {own}, but in {unit} in line {line}; print it in one unit."
            self.mixed.setdefault(place, why)

    def choose(self) -> None:
        """Choose the columns of time and energy.  The others are no longer read."""
        samples = [np.array(values[:SAMPLE]) for values in self._values]
        if self.names[:1] == [""] and not _are_numbered(self.names, samples):
            self.names = [""] * len(self.names)  # the head does not belong to these rows
        self.choice = choose(self.names, self.units, samples, self.wanted)
        if self.puts >= SAMPLE:
            self.kept = (self.choice or Choice()).columns + self.marks or (0,)  # to count rows

    def series(self) -> Iterator["Series"]:
        """Yield what lies between two starts of time.  Raises UserError if there are too many."""
        self.choose()
        choice = self.choice or Choice()
        leading = [*choice.time, *choice.energy, 0][0]
        if not self.names or not self._lines[leading]:
            return
        lines = np.array(self._lines[leading])
        sums = [self._sum(group, lines) for group in choice[:3]]
        here = ~np.ma.getmaskarray(sum(sums))
        found = np.flatnonzero(here)
        *inner, missing = np.diff(found, prepend=-1, append=len(here)) - 1
        if len(found) and missing > 1 + max(inner):  # it ended, it is not only rarer
            here[found[-1] :] = True
        times, energies, kinetic = (total.filled(np.nan)[here] for total in sums)
        rows = len(times)
        if not choice.time:
            times = np.arange(rows, dtype=float)
        seen = len(here) if self._is_printed else self.puts
        skipped = self.skipped + seen - rows
        times[~(np.abs(times) < LATEST)] = np.nan
        begins = self._again(lines[here], times)
        begins[_blocks(self._sum(self.marks, lines).filled(0)[here])] = True
        runs = list(islice(_runs(times, begins), MAX_SERIES))
        if self.skipped > rows:
            why = "most rows differ from the header in the number of columns; keep one table."
            raise unreadable(why)
        if rows > 1 and len(runs) in (rows, MAX_SERIES):
            raise unreadable(NOT_LATER)
        for run in runs:
            found = np.flatnonzero(np.isfinite(times[run]))
            lost = (~(np.abs(energies[run][found[-1] + 1 :]) < TOO_LARGE)).sum()
            may_divide = len(runs) > 1 or found[-1] - found[0] >= len(found)  # one row of nan
            series = Series(self, choice, times[run], energies[run], kinetic[run], skipped=skipped)
            series.has_ended = lost > may_divide
            yield series
            skipped = 0

    def _again(self, lines: Any, times: Any) -> Any:
        """Return whether rows have the time of the row above their head and a remark."""
        below = np.searchsorted(lines, self.heads)
        below = below[(below > 0) & (below < len(lines))]
        is_again = np.zeros(len(times), dtype=bool)
        has_remark = lines[below] - lines[below - 1] > 2
        is_again[below] = has_remark & (times[below] == times[below - 1])
        return is_again

    def _sum(self, group: Group, lines: Any) -> Any:
        """Return the sum of some columns at the lines of the leading one, masked where one is not.

        What is printed belongs to the time before it, or to that after it if all come before.
        Raises UserError if several bodies, or steps of an iteration, print the same.
        """
        total = np.ma.zeros(len(lines))
        for place in group:
            own = np.array(self._lines[place])
            record = np.searchsorted(lines, own, side="right") - 1
            if np.array_equal(record + 1, np.arange(len(lines))):
                record += 1
            fits = record >= 0
            if not self._is_printed:
                fits &= lines[record] == own
            column = np.ma.array(np.zeros(len(lines)), mask=True)
            values = np.array(self._values[place])
            column[record[fits]] = values[fits]
            if _alternate(values[fits], record[fits]):
                name = self.names[place]
                raise unreadable(f"{name} has several values at each time; keep one of them.")
            total = total + column
        return total


def _alternate(values: Any, records: Any) -> bool:
    """Return whether values take turns: as many at each time, each most like its own before."""
    counts = np.bincount(records)[1:-1]
    if not 1 < counts.max(initial=1) == counts.min():
        return False
    own, other = (np.nansum(abs(values[lag:] - values[:-lag])) for lag in (counts[0], 1))
    return bool(CLEARLY * own < other)


def _blocks(marks: Any) -> Any:
    """Return where the next mark begins, nowhere if one comes back or marks a single row."""
    begins = np.flatnonzero(np.diff(marks, prepend=np.nan))
    sizes = np.diff(begins, append=len(marks))
    are_blocks = len(begins) == len({*marks}) and sizes.min(initial=2) > 1
    return begins[1:] if are_blocks else []


def _runs(times: Any, is_again: Any) -> Iterator[slice]:
    """Yield each part of the times that ends where time starts again; nan is no time."""
    first = 0
    while len(usable := times[first:][np.isfinite(times[first:])]):
        starts = first + np.flatnonzero((times[first:] <= usable[0]) | is_again[first:])
        last = int(starts[1]) if len(starts) > 1 else len(times)
        yield slice(first, last)
        first = last


@dataclass(eq=False)
class Series:
    """Times that increase, and their energies; before `finish`, as they are in the sheet."""

    sheet: Sheet
    choice: Choice
    times: Any  # nan where there is none
    energies: Any
    kinetic: Any
    skipped: int = 0  # rows without numbers, or not later than one before
    has_ended: bool = False  # neither time nor energy is a number after the last time
    diverged_at: float | None = None  # the time of the first energy that has failed
    units: tuple[str, str] = ("", "")  # of time and energy

    @property
    def holds_errors(self) -> bool:
        """Whether the energies are relative errors already."""
        roles = [role(self.sheet.names[place])[0] for place in self.choice.energy]
        return roles == ["error"] and self.units[1] in NO_UNIT

    def named(self, group: Sequence[int]) -> str:
        """Return the names of columns that are added up, "row" if there is none."""
        names = (split_unit(self.sheet.names[place])[0] or f"column {place + 1}" for place in group)
        return "+".join(names) or "row"

    def finish(self, start: Moment = (-math.inf, ""), end: Moment = (math.inf, "")) -> None:
        """Apply step and units; leave out rows that cannot be used or are not in this range.

        Raises UserError if none is left.
        """
        self.units = self._units()
        begin, last = (self._moment(each) for each in (start, end))
        begin -= ROUNDING * abs(begin)
        last += ROUNDING * abs(last)
        if not begin <= last:
            raise UserError(f"there are no times from {begin:g} to {last:g}.")
        step, _ = self.sheet.wanted.step or (1.0, "")
        times = self.times * step
        is_later = times > np.fmax.accumulate(np.append(-np.inf, times[:-1]))
        skipped = len(times) - int(is_later.sum())
        self._check_order(times, is_later)
        self.skipped += skipped
        used = np.flatnonzero(is_later & (times >= begin) & (times <= last))
        sizes = np.abs(self.energies) + np.abs(self.kinetic)
        lost = np.flatnonzero(~(sizes[used] < TOO_LARGE))
        if len(lost):
            self.diverged_at = float(times[used[lost[0]]])
            used = used[: lost[0]]
        elif self.has_ended and len(used) and used[-1] == np.flatnonzero(is_later)[-1]:
            self.diverged_at = float(np.nextafter(times[used[-1]], np.inf))  # later than all
        if not len(used):
            whole = times[is_later]
            why = f"it has times from {whole[0]:g} to {whole[-1]:g} {self.units[0]}".rstrip()
            why += f", none from {begin:g} to {last:g}."
            if self.diverged_at is not None:
                why = f"at {self.diverged_at:g} its energy is already nan, infinite or too large; "
                why += "begin later with --from, or repeat it with smaller steps."
            raise unreadable(why)
        self.times = times[used]
        self.energies = self.energies[used]
        self.kinetic = self.kinetic[used]

    def _check_order(self, times: Any, is_later: Any) -> None:
        """Raise UserError where rows of several bodies or runs are mixed."""
        with np.errstate(invalid="ignore"):  # inf - inf
            has_changed = np.abs(np.diff(self.energies)) > 0
        in_turn = ((np.diff(times) == 0) & has_changed).sum()
        if in_turn > len(times) / 3:
            raise unreadable(
                f"{in_turn} of {len(times)} rows repeat the time of the row before, with another "
                "energy; keep one body or method, for example with grep, or print more digits."
            )
        if (~is_later).sum() > len(times) / 2 and not self.has_ended:
            raise unreadable(NOT_LATER)
        behind = np.isfinite(times[np.flatnonzero(is_later)[-1] + 1 :]).sum()
        if behind > len(times) / 10:
            raise unreadable(
                f"its last {behind} rows are not later than {np.nanmax(times):g}; keep one run, "
                "without thousands separators."
            )

    def _units(self) -> tuple[str, str]:
        """Return the units of time and energy.

        Raises UserError if those of energies differ, or an option contradicts the file.
        """
        wanted = self.sheet.wanted
        time, energy, kinetic, _ = self.choice
        for place in self.choice.columns:
            if place in self.sheet.mixed:
                raise unreadable(self.sheet.mixed[place])
            if place in self.sheet.bracketed and place not in time:
                cell = self.sheet.bracketed[place]
                raise unreadable(f"{cell} may be negative or an uncertainty; leave out brackets.")
        if {*time} & {*energy}:
            raise UserError(
                f"{self.named(time)} is both the time and an energy; name another column."
            )
        groups = {"time": time, "energy": energy}
        found = {kind: self._unit(kind, group) for kind, group in groups.items()}
        is_time = any(role(self.sheet.names[place])[0] == "time" for place in time)
        if wanted.step and (found["time"] or is_time):
            raise UserError(
                f"--step is for steps, but {self.named(time)} is a time already; "
                "name the column of steps with --time, or leave out --step."
            )
        for kind, unit in wanted.units.items():
            own = plain(kind, found[kind])
            if own and own != plain(kind, unit):
                raise UserError(
                    f"{self.named(groups[kind])} is in {found[kind]}, not in {unit}; "
                    f"leave {kind}= out of --units."
                )
        if wanted.step:
            found["time"] = wanted.step[1]
        time_unit, energy_unit = (shown(*each) for each in (found | wanted.units).items())
        self._unit("energy", kinetic, energy_unit)
        return time_unit, energy_unit

    def _unit(self, kind: str, group: Group, *energies: str) -> str:
        """Return the unit of all these columns, "" if it is not certain.

        Raises UserError if they have different ones, or another than that of `energies`.
        """
        units = {*energies, *(shown(kind, self.sheet.units[place]) for place in group)}
        known = sorted(units - {""})
        if len(known) > 1:
            raise UserError(
                f"the units of {self.named(group)}{' and the energy' * len(energies)} differ "
                f"({', '.join(known)}); use columns of one unit, or convert them first."
            )
        return units.pop() if len(units) == 1 else ""

    def _moment(self, moment: Moment) -> float:
        """Return a moment in the unit of the times.  Raises UserError if that is not known."""
        value, unit = moment
        if unit:
            value *= size("time", unit) / size("time", self.units[0])
        return value
