"""Columns of another program's tables: text of any form, JSON lines, Amber's mdout, an .npz.

Lines are read one by one, so a table may stand between other text.  A table begins with a header
that has the wanted names, or where the time starts again; one of the tables is returned.
"""

import io
import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, BinaryIO, cast

from tui.cli.heads import (
    MAX_LINES_BEFORE,
    MAX_NAME,
    MAX_NAMES,
    Head,
    Records,
    Row,
    delimiter_of,
    fields_of,
    missing,
    number_of,
    places_of,
    row_of,
    unit_of,
    unreadable,
)
from tui.cli.objects import is_mdout, of_arrays, of_objects, pairs, parsed

MAX_LINE = 1 << 20  # bytes
MAX_RECORDS = 20_000_000  # of the input, which may never end; half a minute, 320 MB
MAX_PAGE = 64  # rows below a header that comes again on each page, as NAMD's; fewer are no table
LATEST = 1e300  # a time; squares and differences of later ones overflow

_LEGEND = re.compile(r'@\s*(?:s(\d{1,3})\s+legend|([xy])axis\s+label)\s+"([^"]*)"')
_BINARY = {
    b"\x1f\x8b": "a gzip file; unpack it first",
    b"\xff\xfe": "text in UTF-16; save it as UTF-8",
    b"\xfe\xff": "text in UTF-16; save it as UTF-8",
    b"\x89MCAP": "a recording; pendu-tui export makes a table of it",
}
REASONS = {
    "without_numbers": "without numbers",
    "time_not_later": "whose time is not later",
    "time_not_finite": "whose time is not finite",
    "energy_not_finite": "whose energy is not finite",
    "before_start": "before --from",
}
"""Why a row is not used: in JSON, and for people."""


@dataclass
class Table:
    """One table: columns of finite numbers, of which the first increases."""

    units: tuple[str, ...]
    columns: Sequence[Any]  # array.array while it is read, then NumPy's
    number: int = 0
    count: int = 0  # tables in the input
    skipped: dict[str, int] = field(default_factory=lambda: dict.fromkeys(REASONS, 0))
    failed_at: float | None = None  # the time from which on numbers are nan or inf, to the end
    first: float | None = None  # usable time

    @classmethod
    def of(cls, head: Head) -> "Table":
        """Return an empty table."""
        return cls(head.units, [array("d") for _ in head.places])

    def is_over(self, time: float) -> bool:
        """Return whether a row of this time begins another table.

        A step back to a later time than the first is a restart from a checkpoint: the same table.
        """
        return self.first is not None and -LATEST < time <= self.first

    def add(self, row: Sequence[float]) -> None:
        if self.first is None and abs(row[0]) < LATEST:
            self.first = row[0]
        for column, value in zip(self.columns, row, strict=True):
            column.append(value)

    def finish(self, start: float) -> None:
        """Leave out what cannot be used, and count it."""
        import numpy as np

        columns = [np.asarray(column) for column in self.columns]
        times = np.where(np.abs(columns[0]) < LATEST, columns[0], -np.inf)
        before = np.maximum.accumulate(np.concatenate([[-np.inf], times[:-1]]))
        finite = np.all([np.isfinite(column) for column in columns[1:]], axis=0)
        left = np.ones(len(times), dtype=bool)
        for why, bad in (
            ("time_not_finite", np.isinf(times)),
            ("time_not_later", times <= before),
            ("before_start", times < start),
        ):
            self.skipped[why] = int(np.count_nonzero(bad & left))
            left &= ~bad
        good = np.flatnonzero(finite & left)
        lost = np.flatnonzero(~finite & left)
        self.skipped["energy_not_finite"] = len(lost)
        lost = lost[lost > good[-1]] if len(good) else lost
        self.failed_at = float(times[lost[0]]) if len(lost) else None
        self.columns = [column[good] for column in columns]


def read_table(
    stream: BinaryIO, wanted: Sequence[str], number: int | None = None, start: float = -LATEST
) -> Table:
    """Return a table of the wanted columns, times first: the last one, or that of this number.

    A column is a name, a number from 1, or several of them joined by +.  Rows before `start` are
    left out.  Raises UserError if there is no such table.
    """
    found: Table | None = None
    count = 0
    rows = 0
    for count, table in enumerate(_tables(_records(stream, wanted)), 1):
        rows += len(table.columns[0])
        if number in (None, count):
            found = table
            found.number = count
    if found is None and count:
        raise unreadable(f"there is no table {number}; the input has {count}.")
    if found is None:
        raise unreadable("no row has a number in each column; columns count from 1.")
    if rows == count > 1:
        raise unreadable("its time goes back in every row; name the column of times with --time.")
    found.count = count
    found.finish(start)
    return found


def _tables(records: Records) -> Iterator[Table]:
    """Yield each table once it is read, if it has a usable time."""
    table = Table((), [])
    head = Head((), ())
    on_page = 0  # rows since the head
    for number, record in enumerate(records):
        if number >= MAX_RECORDS:
            raise unreadable(f"more than {MAX_RECORDS:,} rows; leave some out.")
        if isinstance(record, Head):
            if record != head or not 0 < on_page < MAX_PAGE:
                if table.first is not None:
                    yield table
                table = Table.of(record)
            head = record
            on_page = 0
        elif None in record:
            table.skipped["without_numbers"] += 1
        else:
            on_page += 1
            row = cast(Sequence[float], record)
            if table.is_over(row[0]):
                yield table
                table = Table.of(head)
            table.add(row)
    if table.first is not None:
        yield table


def _records(stream: BinaryIO, wanted: Sequence[str]) -> Records:
    """Return heads and rows of any input."""
    head = stream.peek(4096) if isinstance(stream, io.BufferedReader) else b""
    if head.startswith(b"PK\x03\x04"):
        return of_arrays(stream, wanted)
    kind = next((text for start, text in _BINARY.items() if head.startswith(start)), None)
    if kind or b"\0" in head:
        raise unreadable(f"this is {kind or 'no text'}.")
    if head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return of_objects(parsed(_lines(stream)), wanted)
    return _Text(wanted).records(_lines(stream))


def _lines(stream: BinaryIO) -> Iterator[str]:
    """Yield the lines of a stream."""
    encoding = "utf-8-sig"
    while line := stream.readline(MAX_LINE + 1):
        if len(line) > MAX_LINE:
            raise unreadable("a line is longer than 1 MB; is this a table?")
        yield line.decode(encoding, errors="replace")
        encoding = "utf-8"
    if encoding == "utf-8-sig":
        raise unreadable("the input is empty; nothing to judge.")


class _Text:
    """The table in lines of text: a header may have a # in front, units may follow it."""

    def __init__(self, wanted: Sequence[str]) -> None:
        self._wanted = wanted
        self._legend: dict[int, str] = {}  # names of columns as GROMACS writes them
        self._names: list[str] = []  # of the header, or of the longest line before it
        self._head: Head | None = None
        self._has_rows = False
        self._delimiter: str | None = None
        self._is_numbered = True  # no header has the names
        self._width = 0  # fields of a row
        self._singles: list[int] = []  # the places, if no columns are to be added
        self._above: list[str] = []  # the first row: where it comes again, a table begins

    def records(self, lines: Iterator[str]) -> Records:
        """Yield heads and rows."""
        for number, line in enumerate(lines):
            row = self._plain_row(line) if self._has_rows else None
            if row:
                yield row
            elif is_mdout(line):
                yield from of_objects(pairs(chain([line], lines)), self._wanted, "kcal/mol")
                return
            else:
                yield from self._other(line)
            if number > MAX_LINES_BEFORE and not self._has_rows:
                raise unreadable(
                    f"{number:,} lines without a row of these columns; is this a table?"
                )
        if self._head is None:
            raise missing(self._wanted, list(self._legend.values()) or self._names)

    def _plain_row(self, line: str) -> Row | None:
        """Return a row like the one before it."""
        assert self._head is not None
        fields = (
            line.split(self._delimiter) if '"' not in line else fields_of(line, self._delimiter)
        )
        if len(fields) != self._width:
            return None
        try:
            if self._singles:
                return [float(fields[place]) for place in self._singles]
            return [sum([float(fields[place]) for place in group]) for group in self._head.places]
        except ValueError:
            return None

    def _other(self, line: str) -> Records:
        """Yield what any other line means."""
        if match := _LEGEND.match(line[: 2 * MAX_NAME]):
            number, axis, name = match.groups()
            self._legend[{"x": 0, "y": -1}[axis] if axis else int(number) + 1] = name
            return
        is_comment = line.lstrip()[:1] in ("#", "@")
        text = line.lstrip("#@ \t") if is_comment else line
        delimiter = delimiter_of(text)
        fields = fields_of(text, delimiter)
        if sum(number_of(each) is not None for each in fields) < 2:
            self._read_header(text, fields, is_comment)
        elif not is_comment:
            yield from self._begin(fields, delimiter)
        if self._has_rows and self._head and text.strip() and not is_comment:
            yield row_of(fields if len(fields) == self._width else [], self._head.places)

    def _begin(self, fields: list[str], delimiter: str | None) -> Records:
        """Yield the head of the table whose first row this is, if it is one."""
        if self._is_numbered:
            is_other = len(fields) != self._width and None not in map(number_of, fields)
            head = None
            if is_other or not self._has_rows:
                head = self._head_of_legend(len(fields))
            begins = head is not None and None not in row_of(fields, head.places)
        else:
            head = self._head
            begins = head is not None and not self._has_rows
        if begins and head:
            self._head = head
            self._delimiter = delimiter
            self._width = len(fields)
            is_sum = any(len(group) > 1 for group in head.places)
            self._singles = [] if is_sum else [group[0] for group in head.places]
            self._has_rows = True
            yield head
        elif self._head is None and len(fields) == len(self._above):
            self._names = self._above

    def _read_header(self, text: str, fields: list[str], is_comment: bool) -> None:
        """Look for the names of columns in a line, or for the units below them."""
        if len(fields) > 1 and not is_comment:
            if self._has_rows and fields == self._above:
                self._has_rows = False
            elif not self._has_rows:
                self._above = fields
        ways = [fields, re.split(r"\s{2,}", text.strip())]  # names may hold single blanks
        for names in ways:
            if places := places_of(names[:MAX_NAMES], self._wanted, named=True):
                self._head = Head(places, tuple(unit_of(names[group[0]]) for group in places))
                self._is_numbered = False
                self._names = names
                self._has_rows = False
                return
        if self._head is None:
            if not self._names and not is_comment:
                self._names = fields[:MAX_NAMES]
        elif len(fields) == len(self._names) and not self._has_rows and not any(self._head.units):
            units = tuple(fields[group[0]].strip("()[]")[:20] for group in self._head.places)
            self._head = self._head._replace(units=units)

    def _head_of_legend(self, width: int) -> Head | None:
        """Return the head of a table without a header, by legend or by numbers."""
        names = [self._legend.get(place, "") for place in range(width)]
        places = places_of(names, self._wanted)
        if places is None:
            return None
        units = [unit_of(names[group[0]]) for group in places]
        shared = unit_of(self._legend.get(-1, ""))
        return Head(places, (units[0], *(unit or shared for unit in units[1:])))
