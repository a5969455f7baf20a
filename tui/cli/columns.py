"""Columns of another program's tables: text of any form, JSON lines, Amber's mdout, an .npz.

A table may stand between other text.  It begins below a header with the wanted names, or where time
starts again; one of the tables is returned.
"""

import csv
import io
import json
import math
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain, islice, takewhile
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import did_you_mean

LATEST = 1e300  # of times; squares and differences of later ones overflow
MAX_LINE = 1 << 20  # bytes
MAX_LINES_BEFORE = 100_000  # the first row
MAX_RECORDS = 20_000_000  # half a minute, 320 MB; the input may be endless
REASONS = {
    "without_numbers": "without numbers",
    "time_not_later": "whose time is not later",
    "time_not_finite": "whose time is not finite",
    "before_start": "before --from",
    "energy_not_finite": "from the first energy on that is nan or inf",
}
"""Why a row is not used, in JSON and in words."""

_BINARY = {
    b"\x1f\x8b": "a gzip file; unpack it first",
    b"\xff\xfe": "text in UTF-16; save it as UTF-8",
    b"\xfe\xff": "text in UTF-16; save it as UTF-8",
    b"\x89MCAP": "a recording; pendu-tui export makes a table of it",
}
_LEGEND = re.compile(r'@\s*(?:s(\d{1,3})\s+legend|([xy])axis\s+label)\s+"([^"]*)"')
_PAIR = re.compile(r"([A-Za-z][\w()/-]{,20}(?: [\w()/-]{1,20})?)\s*=\s*([-+.\w*]+)")
_NO_ROW = "no row has a number in each column; columns count from 1."
_UNIT = re.compile(r"(?:[(\[]([^()\[\]]*)[)\]]|/([^\W\d_]+))$")


class Head(NamedTuple):
    """The wanted columns of a table: the fields to add up for each, and their units."""

    places: tuple[tuple[int, ...], ...]
    units: tuple[str, ...]

    @classmethod
    def of(cls, names: Sequence[str], wanted: Sequence[str]) -> "Head | None":
        """Return the head of columns with these names, or None if a wanted one is missing.

        A column is found by its number or its name, in which case and unit do not count.
        """
        last_first = [*enumerate(names)][::-1]
        known = {_plain(name): place for place, name in last_first}
        known |= {name.strip(): place for place, name in last_first}
        known |= {str(place + 1): place for place, _ in last_first}
        known.pop("", None)
        groups: list[tuple[int, ...]] = []
        for name in wanted:
            for parts in ([name], name.split("+")):
                keys = [key.strip() if key.strip() in known else _plain(key) for key in parts]
                if all(key in known for key in keys):
                    groups.append(tuple(known[key] for key in keys))
                    break
            else:
                return None
        return cls(tuple(groups), tuple(_split(names[group[0]])[1] for group in groups))


Record = Head | list[Any] | Any
"""A head, a row (a number for each place, None for text or a gap), or an array of rows."""


@dataclass
class Table:
    """One table: columns of finite numbers, of which the first increases."""

    head: Head
    columns: list[Any]  # an array for each place; when finished, for each column
    number: int = 0
    count: int = 0  # tables in the input
    skipped: dict[str, int] = field(default_factory=lambda: dict.fromkeys(REASONS, 0))
    failed_at: float | None = None  # the time of the first energy that is nan or inf

    @property
    def units(self) -> tuple[str, ...]:
        return self.head.units

    def finish(self, start: float) -> None:
        """Add up columns, and leave out and count the rows that cannot be used."""
        parts = map(np.asarray, self.columns)
        columns: list[Any] = [sum(islice(parts, len(group))) for group in self.head.places]
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
        used = np.flatnonzero(left)
        lost = np.flatnonzero(~finite[used])
        if len(lost):
            self.failed_at = float(times[used[lost[0]]])
            self.skipped["energy_not_finite"] = len(used) - int(lost[0])
            used = used[: lost[0]]
        self.columns = [column[used] for column in columns]


def read_table(
    stream: io.BufferedReader,
    wanted: Sequence[str],
    number: int | None = None,
    start: float = -math.inf,
) -> Table:
    """Return the last table of the wanted columns, times first, or that of this number.

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
    if found is None:
        why = f"there is no table {number}; the input has {count}."
        raise _unreadable(why if count else _NO_ROW)
    if rows == count > 1:
        raise _unreadable("its time never increases; name the column of times with --time.")
    found.count = count
    found.finish(start)
    return found


def _tables(records: Iterable[Record]) -> Iterator[Table]:
    """Yield each table that has a usable time.

    A step back in time, but not to the start, is a restart from a checkpoint, in the same table.  A
    header repeated on each page, as in NAMD's logs, does not begin a table either.
    """
    table = Table(Head((), ()), [])
    head = table.head
    first: float | None = None  # the first usable time
    on_page = 0  # rows since the last head
    count = 0
    for record in _blocks(records):
        count += len(record) if isinstance(record, np.ndarray) else 1
        if count > MAX_RECORDS:
            raise _unreadable(f"more than {MAX_RECORDS:,} rows; leave some out.")
        if count > MAX_LINES_BEFORE and not table.columns:
            raise _unreadable(f"{count:,} lines without a row of these columns; is this a table?")
        if record is None:
            table.skipped["without_numbers"] += 1
            continue
        if isinstance(record, Head):
            head = record
            begins = head != table.head or on_page >= 64
            on_page = 0
        else:
            begins = first is not None and -LATEST < record[0, 0] <= first
            on_page += len(record)
        if begins:
            if first is not None:
                yield table
            first = None
            table = Table(head, [array("d") for group in head.places for _ in group])
        if isinstance(record, Head):
            continue
        if first is None and abs(record[0, 0]) < LATEST:
            first = record[0, 0]
        for column, values in zip(table.columns, record.T, strict=True):
            column.frombytes(values.tobytes())
    if first is not None:
        yield table


def _blocks(records: Iterable[Record]) -> Iterator[Any]:
    """Yield heads, arrays of rows whose times increase, and None for a row with a gap."""
    for record in records:
        if isinstance(record, Head):
            yield record
            continue
        if isinstance(record, list):
            yield None if None in record else np.array([record])
            continue
        times = record[:, 0]
        increasing = (times[:-1] < times[1:]).all()
        if increasing and times[0] > -LATEST and times[-1] < LATEST:
            yield record
        else:
            yield from record[:, None]


def _records(stream: io.BufferedReader, wanted: Sequence[str]) -> Iterator[Record]:
    start = stream.peek(4096)
    if not start:
        raise _unreadable("the input is empty; nothing to judge.")
    if start.startswith(b"PK\x03\x04"):
        return _of_arrays(stream, wanted)
    for magic, kind in _BINARY.items():
        if start.startswith(magic):
            raise _unreadable(f"this is {kind}.")
    if b"\0" in start:
        raise _unreadable("this is not text.")
    lines = _lines(stream)
    if start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return _of_objects(map(_parsed, filter(str.strip, lines)), wanted)
    return _Text(wanted).records(lines)


def _lines(stream: io.BufferedReader) -> Iterator[str]:
    text = io.TextIOWrapper(stream, encoding="utf-8-sig", errors="replace")
    while line := text.readline(MAX_LINE):
        if len(line) == MAX_LINE:
            raise _unreadable("a line is longer than 1 MB; is this a table?")
        yield line


class _Text:
    """A table in lines of text; the header may begin with #, and a row of units may follow it."""

    def __init__(self, wanted: Sequence[str]) -> None:
        self._wanted = wanted
        self._is_named = not all(part.isdecimal() for each in wanted for part in each.split("+"))
        self._legend: dict[int, str] = {}  # GROMACS' names of columns
        self._headers: list[list[str]] = []  # the names in a header, split in two ways
        self._units: list[str] = []  # from the row below the header
        self._above: list[str] = []  # words above the rows; where they return, a table begins
        self._names: list[str] = []  # for the error message
        self._places: list[int] = []  # of the wanted fields; empty before the first row
        self._delimiter: str | None = None
        self._width = 0  # fields in a row

    def records(self, lines: Iterator[str]) -> Iterator[Record]:
        while block := list(islice(lines, 4096)):
            if any(line.lstrip().startswith("NSTEP =") for line in block):
                yield from _of_objects(_mdout(chain(block, lines)), self._wanted, "kcal/mol")
                return
            yield from self._read(block)
        if not self._width:
            raise _missing(self._wanted, [*self._legend.values()] or self._names or self._above)

    def _read(self, lines: list[str]) -> Iterator[Record]:
        """Read blocks of rows like the last one at once, and other lines one by one."""
        rows = self._plain_rows(lines)
        if rows is not None:
            yield rows
        elif len(lines) > 1:
            middle = len(lines) // 2
            yield from self._read(lines[:middle])
            yield from self._read(lines[middle:])
        elif match := _LEGEND.match(lines[0]):
            number, axis, name = match.groups()
            self._legend[{"x": 0, "y": -1}[axis] if axis else int(number) + 1] = name
        else:
            yield from self._other(lines[0])

    def _plain_rows(self, lines: list[str]) -> Any:
        """Return an array of the rows, or None if not all lines are rows like the last one."""
        widths = {len(line.split(self._delimiter)) for line in lines}
        if not self._places or widths != {self._width} or '"' in "".join(lines):
            return None
        try:
            return np.loadtxt(
                lines, delimiter=self._delimiter, comments=None, usecols=self._places, ndmin=2
            )
        except ValueError:
            return None

    def _other(self, line: str) -> Iterator[Record]:
        is_comment = line.lstrip().startswith(("#", "@"))
        text = line.lstrip("#@ \t") if is_comment else line
        bare = re.sub(r'"[^"]*"', "", text)
        delimiter = next((sign for sign in "\t;," if sign in bare), None)
        fields = _fields(text, delimiter or " ")
        numbers = [_number(each) for each in fields]
        if len(numbers) - numbers.count(None) < 2:
            self._read_words(text, fields, is_comment)
        elif not is_comment and (head := self._head_at(numbers)):
            self._places = list(chain(*head.places))
            self._delimiter = delimiter
            self._width = len(fields)
            yield head
        if not self._width:
            yield [None]
        elif self._places and text.strip() and not is_comment:
            is_row = len(numbers) == self._width
            yield [numbers[place] for place in self._places] if is_row else [None]

    def _read_words(self, text: str, fields: list[str], is_comment: bool) -> None:
        """Look for a header in a line without numbers."""
        ways = [fields, re.split(r"\s{2,}", text.strip())]  # names may contain single blanks
        headers = [names for names in ways if self._is_named and Head.of(names, self._wanted)]
        if headers:
            self._headers = headers
            self._names = headers[0]
            self._units = []
        elif not self._places and len(fields) == len(self._names):
            self._units = [name.strip("()[]") for name in fields]
        if headers or fields == self._above != []:
            self._places = []
        elif not self._places and not is_comment and len(fields) > 1:
            self._above = fields

    def _head_at(self, numbers: Sequence[float | None]) -> Head | None:
        """Return the head of the table that begins with this row, None if none does."""
        width = len(numbers)
        if self._places and (self._headers or None in numbers or width == self._width):
            return None
        if self._headers:
            fitting = (names for names in self._headers if len(names) == width)
            head = Head.of(next(fitting, self._headers[0]), self._wanted)
            if head is None or max(chain(*head.places)) >= width:
                return None
            if len(self._units) == width and not any(head.units):
                head = Head(head.places, tuple(self._units[group[0]] for group in head.places))
            return head
        if not self._names and width == len(self._above):
            self._names = self._above
        head = Head.of([self._legend.get(place, "") for place in range(width)], self._wanted)
        if head is None or None in [numbers[place] for place in chain(*head.places)]:
            return None
        shared = _split(f"energy {self._legend.get(-1, '')}")[1]
        return Head(head.places, (head.units[0], *(unit or shared for unit in head.units[1:])))


def _fields(line: str, delimiter: str) -> list[str]:
    try:
        (fields,) = csv.reader([line.strip(" \r\n")], delimiter=delimiter, skipinitialspace=True)
    except csv.Error:
        return []
    return [text.strip() for text in fields]


def _number(text: str) -> float | None:
    """Return the number in a field, which may have a decimal comma or Fortran's D."""
    try:
        return float(text.replace(",", ".").replace("D", "e").replace("d", "e"))
    except ValueError:
        return None


def _of_objects(
    objects: Iterable[dict[str, Any]], wanted: Sequence[str], unit: str = ""
) -> Iterator[Record]:
    """Yield the head and the rows of named values; `unit` is for columns without one."""
    names: list[str] = []
    rest = iter(objects)
    for first in rest:
        if head := Head.of(list(first), wanted):
            keys = [list(first)[place] for place in chain(*head.places)]
            yield Head(head.places, tuple(each or unit for each in head.units))
            for item in chain([first], rest):
                yield [_number(str(item.get(key))) for key in keys]
            return
        names = list(first) or names
        yield [None]
    raise _missing(wanted, names)


def _parsed(line: str) -> dict[str, Any]:
    """Return the object in a line of JSON; an empty one if there is none."""
    with suppress(ValueError, RecursionError):
        item = json.loads(line)
        return item if isinstance(item, dict) else {}
    return {}


def _mdout(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield the records of Amber's mdout, `NSTEP = 10  TIME(PS) = 0.02 …`, up to its averages."""
    text = "".join(takewhile(lambda line: "A V E R A G E S" not in line, lines))
    for record in text.split("NSTEP")[1:]:
        yield dict(_PAIR.findall(f"NSTEP{record}"))


def _of_arrays(stream: io.BufferedReader, wanted: Sequence[str]) -> Iterator[Record]:
    try:
        arrays = np.load(io.BytesIO(stream.read()), allow_pickle=False)
        names = list(arrays)
        if head := Head.of(names, wanted):
            found = [np.ravel(arrays[names[place]]) for place in chain(*head.places)]
            rows = min(map(len, found))
            table = np.column_stack([column[:rows].astype(float) for column in found])
    except Exception as error:  # a broken archive may raise anything
        raise _unreadable(f"this .npz cannot be read: {printable(str(error), 100)}.") from None
    if head is None:
        raise _missing(wanted, names)
    yield head
    yield table


def _plain(name: str) -> str:
    return _split(name)[0].casefold()


def _split(name: str) -> tuple[str, str]:
    """Return name and unit of `Time (ps)`, `time [ps]` or `t/ps`."""
    name = name.strip()
    match = _UNIT.search(name, 1)
    if match is None:
        return name, ""
    return name[: match.start()].rstrip(), (match[1] or match[2] or "").strip()


def _missing(wanted: Sequence[str], names: Sequence[str]) -> UserError:
    """Return the error that a wanted column is missing."""
    parts = [part for each in wanted if Head.of(names, [each]) is None for part in each.split("+")]
    lost = [each for each in parts if not each.isdecimal() and Head.of(names, [each]) is None]
    if not lost:
        return _unreadable(_NO_ROW)
    present = [printable(name, 40) for name in names[:20] if name]
    advice = did_you_mean(lost[0], present) or f"; choose from {', '.join(present)}."
    if not present:
        advice = "; give columns by number, from 1."
    return UserError(f"there is no column {printable(lost[0], 40)!r}{advice}")


def _unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)
