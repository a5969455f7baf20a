"""Tables of other programs: the rows under one head, and the series of times and energies in them.

A series ends where time starts again.  A step back in time, but not to the start, is a restart from
a checkpoint: the same series.
"""

import math
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pendu_tui.tui.cli.choice import Choice, Wanted, choose, is_error, is_time
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.units import shown, split_unit

LATEST = 1e300  # of times; squares and differences of later ones overflow
MAX_ROWS = 20_000_000  # half a minute, 320 MB; the input may be endless
MAX_SERIES = 1000
NOT_TIMES = "its time never increases; name the column of times with --time."
SAMPLE = 64  # rows, after which the columns are chosen and the others dropped
REASONS = {
    "without_numbers": "without numbers",
    "time_not_later": "whose time is not later",
    "time_not_finite": "whose time is not finite",
    "out_of_range": "before --from or after --to",
    "energy_not_finite": "after the energy ended",
}
"""Why a row is not used, in JSON and in words."""


class Sheet:
    """The rows under one head.  Once the columns are chosen, only they are kept."""

    def __init__(self, names: Sequence[str], units: Sequence[str], wanted: Wanted, line: int = 0):
        self.names = list(names)
        self.units = list(units)
        self.line = line  # where it begins
        self.choice: Choice | None = None
        self.kept: list[int] = []
        self.columns: list[array[float]] = []
        self.rows = 0
        self.without_numbers = 0
        self._gaps = array("q")  # rows without an energy
        self._wanted = wanted
        self._sample: list[Sequence[float | None]] | None = []  # None: the columns are chosen

    @property
    def is_numbered(self) -> bool:
        """Whether the head is thought to have no name for the first column."""
        return len(self.names) > 1 and not self.names[0] and any(self.names)

    @property
    def is_chosen(self) -> bool:
        return self._sample is None

    def add(self, numbers: Sequence[float | None], is_cell: bool = True) -> None:
        """Add a row of numbers; where an energy is missing in a cell, it may have failed."""
        self._check_size(1)
        if self._sample is not None:
            self._sample.append(numbers)
            if len(self._sample) == SAMPLE:
                self.end()
            return
        time = [numbers[place] for place in (self.choice or Choice()).time]
        values = [numbers[place] for place in self.kept]
        if None in time or (None in values and not is_cell):
            self.without_numbers += 1
            return
        if None in values:
            self._gaps.append(self.rows)
        self.rows += 1
        for column, value in zip(self.columns, values, strict=True):
            column.append(math.nan if value is None else value)

    def extend(self, block: Any) -> None:
        """Add rows of the kept columns, (n, len(kept))."""
        self._check_size(len(block))
        self.rows += len(block)
        for column, values in zip(self.columns, block.T, strict=False):
            column.frombytes(values.tobytes())

    def fill(self, choice: Choice | None, block: Any) -> None:
        """Set the columns of the choice, (n, len(kept))."""
        self._sample = None
        self.choice = choice
        self.kept = choice.columns if choice else []
        self.columns = [array("d") for _ in self.kept]
        self.extend(block)

    def end(self) -> None:
        """Choose the columns, if that was not done yet."""
        if self._sample is None:
            return
        rows = self._sample
        self._sample = None
        values = np.array(rows, dtype=float).reshape(len(rows), len(self.names))
        if self.is_numbered and not _counts(values):
            self.names = [""] * len(self.names)
        self.choice = choose(self.names, self.units, list(values.T), self._wanted)
        if self.choice:
            self.kept = self.choice.columns
        self.columns = [array("d") for _ in self.kept]
        for numbers in rows:
            self.add(numbers)

    def _check_size(self, more: int) -> None:
        if self.rows + more > MAX_ROWS:
            raise UserError(f"more than {MAX_ROWS:,} rows; leave some out.", Exit.INPUT_UNREADABLE)

    def series(self) -> Iterator["Series"]:
        """Yield what lies between two starts of time.  Raises UserError if there are too many."""
        self.end()
        choice = self.choice or Choice()
        columns = dict(zip(self.kept, map(np.asarray, self.columns), strict=True))
        here = np.ones(self.rows, dtype=bool)
        gaps = np.asarray(self._gaps)
        whole = [place for place in (*choice.energy,) if len(gaps)]
        if whole:
            used = np.flatnonzero(np.isfinite(sum(columns[place] for place in whole)))
            last = used.max(initial=-1)
            here[gaps[gaps < last]] = False  # the energy went on later
            longest = np.diff(used, prepend=-1).max(initial=0) - 1
            if len(here) - 1 - last <= longest:  # the gap at the end is one like the others
                here[gaps] = False
        columns = {place: column[here] for place, column in columns.items()}
        rows = int(np.count_nonzero(here))
        times: Any = sum(columns[place] for place in choice.time)
        if not choice.time:
            times = np.arange(rows, dtype=float)
        skipped = self.without_numbers + self.rows - rows
        runs = list(_runs(times))
        if len(runs) == rows > 1:
            raise UserError(NOT_TIMES, Exit.INPUT_UNREADABLE)
        for first, last in runs:
            part = {place: column[first:last] for place, column in columns.items()}
            series = Series(self, choice, times[first:last], part)
            series.skipped["without_numbers"] = skipped
            skipped = 0
            yield series


def _counts(values: Any) -> bool:
    """Return whether the first column counts rows or steps, and the second does not fall."""
    steps = np.diff(values[:, 0])
    return bool(
        (values[:, 0] % 1 == 0).all()
        and np.median(steps, axis=0) > 0
        and np.median(np.diff(values[:, 1])) >= 0
    )


def _runs(times: Any) -> Iterator[tuple[int, int]]:
    """Yield first and last index (exclusive) of each part that ends where time starts again."""
    first = 0
    for _ in range(MAX_SERIES):
        if first == len(times):
            return
        usable = np.abs(times[first:]) < LATEST
        start = first + int(np.argmax(usable))
        if not usable.any():
            return
        again = np.flatnonzero(usable[start - first + 1 :] & (times[start + 1 :] <= times[start]))
        last = start + 1 + int(again[0]) if len(again) else len(times)
        yield first, last
        first = last
    raise UserError(NOT_TIMES, Exit.INPUT_UNREADABLE)


@dataclass
class Series:
    """Times that increase, and their energies; before `finish`, as they are in the sheet."""

    sheet: Sheet
    choice: Choice
    times: Any
    parts: dict[int, Any]  # a column for each place
    number: int = 0
    count: int = 0  # series in the input
    skipped: dict[str, int] = field(default_factory=lambda: dict.fromkeys(REASONS, 0))
    failed_at: float | None = None  # the time of the first energy that is no finite number
    energies: Any = ()
    kinetic: Any = ()
    units: tuple[str, str] = ("", "")  # of time and energy

    @property
    def rows(self) -> int:
        return len(self.times) if self.sheet.kept else self.sheet.rows

    @property
    def holds_errors(self) -> bool:
        """Whether the energies are relative errors already."""
        energy = self.choice.energy
        return len(energy) == 1 and is_error(self.sheet.names[energy[0]])

    def named(self, group: Sequence[int]) -> str:
        """Return the names of columns that are added up, "row" if there is none."""
        names = (self.sheet.names[place] for place in group)
        bare = (split_unit(name)[0] for name in names)
        parts = zip(bare, group, strict=True)
        return "+".join(name or f"column {place + 1}" for name, place in parts) or "row"

    def finish(self, wanted: Wanted, start: float = -math.inf, end: float = math.inf) -> None:
        """Apply step and units, add up columns, leave out and count rows that cannot be used."""
        choice = self.choice
        self.units = self._units(wanted)
        times = np.where(np.abs(self.times) < LATEST, self.times, -np.inf)
        if wanted.step:
            times = times * wanted.step[0]
        before = np.maximum.accumulate(np.concatenate([[-np.inf], times[:-1]]))
        energies = sum((self.parts[place] for place in choice.energy), np.zeros(len(times)))
        kinetic = sum((self.parts[place] for place in choice.kinetic), np.zeros(len(times)))
        left = np.ones(len(times), dtype=bool)
        for why, bad in (
            ("time_not_finite", np.isinf(times)),
            ("time_not_later", times <= before),
            ("out_of_range", (times < start) | (times > end)),
        ):
            self.skipped[why] = int(np.count_nonzero(bad & left))
            left &= ~bad
        used = np.flatnonzero(left)
        lost = np.flatnonzero(~np.isfinite(energies[used] + kinetic[used]))
        if len(lost):
            self.failed_at = float(times[used[lost[0]]])
            self.skipped["energy_not_finite"] = len(used) - int(lost[0])
            used = used[: lost[0]]
        self.times = times[used]
        self.energies = energies[used]
        self.kinetic = kinetic[used]

    def _units(self, wanted: Wanted) -> tuple[str, str]:
        """Return the units of time and energy.  Raises UserError if --step contradicts one."""
        names = self.sheet.names
        units = [self.sheet.units[place] for place in (*self.choice.time[:1],)] or [""]
        time = units[0]
        if wanted.step and (time or any(is_time(names[place]) for place in self.choice.time)):
            raise UserError(
                f"--step is for steps, but {self.named(self.choice.time)} is a time already; "
                "name the column of steps with --time, or leave out --step."
            )
        if wanted.step:
            time = wanted.step[1]
        energies = {self.sheet.units[place] for place in self.choice.energy}
        energy = energies.pop() if len(energies) == 1 else ""
        return (
            shown("time", wanted.units.get("time", time)),
            shown("energy", wanted.units.get("energy", energy)),
        )
