"""Columns of another program's tables: text of any form, JSON lines, Amber's mdout, an .npz.

Lines are read one by one, so a table may stand between other text.  A table begins with a header
that has the wanted names, or where the time starts again; one of the tables is returned.
"""

import io
import json
import re
import zipfile
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, BinaryIO, NamedTuple

from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.options import did_you_mean

MAX_LINE = 1 << 20  # bytes
MAX_LINES_BEFORE = 100_000  # the first row
MAX_PAGE = 64  # rows below a header that comes again on each page, as NAMD's; fewer are no table
MAX_NAME = 200  # characters of a column's name
MAX_NAMES = 200  # columns of a header
MAX_ARRAY = 1 << 30  # bytes of an array in an .npz
LATEST = 1e300  # a time; squares and differences of later ones overflow

_LEGEND = re.compile(r'@\s*(?:s(\d{1,3})\s+legend|([xy])axis\s+label)\s+"([^"]*)"')
_PAIR = re.compile(r"([A-Za-z][\w()/-]*(?: [\w()/-]+)?)\s*=\s*([-+.\w*]+)")
_BINARY = {
    b"\x1f\x8b": "a gzip file; unpack it first",
    b"\xff\xfe": "text in UTF-16; save it as UTF-8",
    b"\xfe\xff": "text in UTF-16; save it as UTF-8",
    b"\x89MCAP": "a recording; pendu-tui export makes a table of it",
}


class Head(NamedTuple):
    """The wanted columns of a table: the fields that add up to each, and its unit."""

    places: tuple[tuple[int, ...], ...]
    units: tuple[str, ...]


Row = Sequence[float | None]  # a number for each wanted column; None: text or a gap
Records = Iterator[Head | Row]


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


def read_table(stream: BinaryIO, wanted: Sequence[str], number: int | None = None, start: float = -LATEST) -> Table:
    """Return a table of the wanted columns, times first: the last one, or that of this number.

    A column is a name, a number from 1, or several of them joined by +.  Rows before `start` are
    left out.  Raises UserError if there is no such table.
    """
    tables = _Tables(len(wanted), number)
    for record in _records(stream, wanted):
        if isinstance(record, Head):
            tables.add_head(record)
        elif None in record:
            tables.current.skipped["without_numbers"] += 1
        else:
            tables.add_row(record)  # type: ignore[arg-type]
    if tables.found is None and tables.count:
        raise _unreadable(f"there is no table {number}; the input has {tables.count}.")
    if tables.found is None:
        raise _unreadable("no row has a number in each column; columns count from 1.")
    tables.found.count = tables.count
    tables.found.finish(start)
    return tables.found


class _Tables:
    """Tables while they are read; the wanted one and the current one are kept."""

    def __init__(self, width: int, number: int | None) -> None:
        """`number` is that of the wanted table; None: the last one."""
        self.count = 0
        self.current = Table((), [])
        self.found: Table | None = None
        self._width = width
        self._number = number
        self._head: Head | None = None
        self._rows = 0  # since the head
        self._last = -LATEST  # time of the current table

    def add_head(self, head: Head) -> None:
        """Begin a table, unless it is the header of the next page."""
        if head != self._head or not 0 < self._rows < MAX_PAGE:
            self._begin(head.units)
        self._head = head
        self._rows = 0

    def _begin(self, units: tuple[str, ...]) -> None:
        self.current = Table(units, [array("d") for _ in range(self._width)])
        self._last = -LATEST

    def add_row(self, row: Sequence[float]) -> None:
        """Add a row; where its time starts again, to another table."""
        now = row[0]
        self._rows += 1
        if -LATEST < now < self._last or (now == self._last and self._rows == 1):
            self._begin(self.current.units)
        if abs(now) < LATEST:
            self._last = max(self._last, now)
            if not self.current.number:
                self.count += 1
                self.current.number = self.count
                if self._number in (None, self.count):
                    self.found = self.current
        for column, value in zip(self.current.columns, row, strict=True):
            column.append(value)


def _unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)


def _records(stream: BinaryIO, wanted: Sequence[str]) -> Records:
    """Return heads and rows of any input."""
    head = stream.peek(4096) if isinstance(stream, io.BufferedReader) else b""
    if head.startswith(b"PK\x03\x04"):
        return _of_arrays(stream, wanted)
    kind = next((text for start, text in _BINARY.items() if head.startswith(start)), None)
    if kind or b"\0" in head:
        raise _unreadable(f"this is {kind or 'no text'}.")
    if head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return _of_objects(_parsed(_lines(stream)), wanted)
    return _Text(wanted).records(_lines(stream))


def _lines(stream: BinaryIO) -> Iterator[str]:
    """Yield the lines of a stream."""
    encoding = "utf-8-sig"
    while line := stream.readline(MAX_LINE + 1):
        if len(line) > MAX_LINE:
            raise _unreadable("a line is longer than 1 MB; is this a table?")
        yield line.decode(encoding, errors="replace")
        encoding = "utf-8"
    if encoding == "utf-8-sig":
        raise _unreadable("the input is empty; nothing to judge.")


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
        self._above: list[str] = []  # the first row: where it comes again, a table begins

    def records(self, lines: Iterator[str]) -> Records:
        """Yield heads and rows."""
        for number, line in enumerate(lines):
            row = self._plain_row(line) if self._has_rows else None
            if row:
                yield row
            elif line.lstrip().startswith("NSTEP") and len(_PAIR.findall(line[:MAX_NAME])) > 1:
                yield from _of_objects(_pairs(chain([line], lines)), self._wanted, "kcal/mol")
                return
            else:
                yield from self._other(line)
            if number > MAX_LINES_BEFORE and not self._has_rows:
                raise _unreadable(f"{number:,} lines without a row of these columns; is this a table?")
        if self._head is None:
            raise _missing(self._wanted, list(self._legend.values()) or self._names)

    def _plain_row(self, line: str) -> Row | None:
        """Return a row like the one before it."""
        assert self._head is not None
        fields = line.split(self._delimiter) if '"' not in line else _fields(line, self._delimiter)
        if len(fields) != self._width:
            return None
        try:
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
        delimiter = _delimiter(text)
        fields = _fields(text, delimiter)
        if sum(_number(each) is not None for each in fields) < 2:
            self._read_header(text, fields, is_comment)
        elif not is_comment:
            yield from self._begin(fields, delimiter)
        if self._has_rows and self._head and text.strip() and not is_comment:
            yield _row(fields if len(fields) == self._width else [], self._head.places)

    def _begin(self, fields: list[str], delimiter: str | None) -> Records:
        """Yield the head of the table whose first row this is, if it is one."""
        if self._is_numbered:
            is_other = len(fields) != self._width and None not in map(_number, fields)
            head = None
            if is_other or not self._has_rows:
                head = self._head_of_legend(len(fields))
            begins = head is not None and None not in _row(fields, head.places)
        else:
            head = self._head
            begins = head is not None and not self._has_rows
        if begins and head:
            self._head = head
            self._delimiter = delimiter
            self._width = len(fields)
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
            if places := _places(names[:MAX_NAMES], self._wanted, named=True):
                self._head = Head(places, tuple(_unit(names[group[0]]) for group in places))
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
        places = _places(names, self._wanted)
        if places is None:
            return None
        units = [_unit(names[group[0]]) for group in places]
        shared = _unit(self._legend.get(-1, ""))
        return Head(places, (units[0], *(unit or shared for unit in units[1:])))


def _row(fields: Sequence[str], places: Iterable[Iterable[int]]) -> Row:
    """Return the numbers of a row, also with decimal commas or with Fortran's D."""
    row: list[float | None] = []
    for group in places:
        numbers = [_number(fields[place]) if place < len(fields) else None for place in group]
        present = [number for number in numbers if number is not None]
        row.append(sum(present) if len(present) == len(numbers) else None)
    return row


def _number(text: str) -> float | None:
    try:
        return float(text.replace(",", ".").replace("D", "e").replace("d", "e"))
    except ValueError:
        return None


def _fields(line: str, delimiter: str | None) -> list[str]:
    """Return the fields of a line, without quotes."""
    if '"' not in line:
        return [text.strip() for text in line.split(delimiter)]
    if delimiter is None:
        return [quoted or bare for quoted, bare in re.findall(r'"([^"]*)"|(\S+)', line)]
    parts = re.findall(r'((?:"[^"]*"|[^"' + delimiter + r"])*)(?:" + delimiter + r"|$)", line.strip())
    return [text.strip().strip('#" ') for text in parts]


def _delimiter(line: str) -> str | None:
    """Return a tab, a semicolon or a comma outside quotes; None for blanks."""
    bare = re.sub(r'"[^"]*"', "", line)
    return next((sign for sign in "\t;," if sign in bare), None)


def _places(fields: Sequence[str], wanted: Sequence[str], named: bool = False) -> tuple[tuple[int, ...], ...] | None:
    """Return the fields that make up each wanted column, if all are there.

    `named`: only if one of them is asked for by name.
    """
    if named and all(part.isdecimal() for name in wanted for part in name.split("+")):
        return None
    found: list[tuple[int, ...]] = []
    for name in wanted:
        whole = _place(fields, name)
        parts = [whole] if whole is not None else [_place(fields, part) for part in name.split("+")]
        places = tuple(place for place in parts if place is not None)
        if len(places) < len(parts):
            return None
        found.append(places)
    return tuple(found)


def _place(fields: Sequence[str], name: str) -> int | None:
    """Return the place of a column: by number, name, name but for case, or but for its unit."""
    if not name.strip():
        return None
    if name.strip().isdecimal():
        place = int(name[:9]) - 1
        return place if 0 <= place < len(fields) else None
    ways: tuple[Callable[[str], str], ...] = (str.strip, lambda text: text.strip().casefold(), _plain)
    for like in ways:
        asked = like(name)
        for place, text in enumerate(fields):
            if len(text) <= MAX_NAME and like(text) == asked:
                return place
    return None


def _unit(name: str) -> str:
    """Return the unit in a name, such as ps in `Time (ps)`, `time [ps]` or `t/ps`."""
    return _split(name)[1]


def _plain(name: str) -> str:
    """Return a name without its unit, in lower case."""
    return _split(name)[0].casefold()


def _split(name: str) -> tuple[str, str]:
    """Split a name and its unit."""
    name = name.strip()[:MAX_NAME]
    for opening, closing in ("()", "[]"):
        bare, found, unit = name.rpartition(opening)
        if found and name.endswith(closing):
            return bare.rstrip(), unit[:-1].strip()
    bare, _, unit = name.rpartition("/")
    return (bare, unit) if bare and unit.isalpha() else (name, "")


def _missing(wanted: Sequence[str], names: Sequence[str]) -> UserError:
    lost = next((name for name in wanted if not name.isdecimal() and not _places(names, [name])), None)
    if lost is None:
        return _unreadable("no row has a number in each column; columns count from 1.")
    present = [printable(name, 40) for name in names[:20] if name]
    others = f"; choose from {', '.join(present)}." if present else "; give columns by number, from 1."
    hint = did_you_mean(lost, present) if len(lost) <= MAX_NAME else None
    return UserError(f"there is no column {printable(lost, 40)!r}{hint or others}")


def _of_objects(objects: Iterable[dict[str, Any]], wanted: Sequence[str], unit: str = "") -> Records:
    """Yield a head and the rows of objects with names; `unit` is that of energies without one."""
    names: list[str] = []
    places: tuple[tuple[int, ...], ...] | None = None
    for number, item in enumerate(objects):
        if list(item) != names:
            names = list(item)
            now = _places(names[:MAX_NAMES], wanted)
            if now and not places:
                yield Head(now, tuple(_unit(names[group[0]]) or unit for group in now))
            places = now or places
        if places:
            yield _row([str(value) for value in item.values()], places)
        elif number > MAX_LINES_BEFORE:
            break
    if not places:
        raise _missing(wanted, names)


def _parsed(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield the objects of JSON lines; an empty one for a line that is none."""
    for line in lines:
        try:
            item = json.loads(line)
        except (ValueError, RecursionError):
            item = None
        if line.strip():
            yield item if isinstance(item, dict) else {}


def _pairs(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield the records of Amber's mdout, `NSTEP = 10  TIME(PS) = 0.02 …`, up to its averages."""
    record: dict[str, Any] = {}
    for line in lines:
        ends = line.lstrip().startswith("A V E R A G E S")
        if record and (ends or line.lstrip().startswith("NSTEP")):
            yield record
            record = {}
        if ends:
            return
        record |= dict(_PAIR.findall(line[:MAX_NAME]))
    if record:
        yield record


def _of_arrays(stream: BinaryIO, wanted: Sequence[str]) -> Records:
    """Yield the head and the rows of the arrays in an .npz."""
    import numpy as np

    try:
        source = stream if stream.seekable() else io.BytesIO(stream.read(MAX_ARRAY))
        with np.load(source, allow_pickle=False) as arrays:
            names = list(arrays)
            places = _places(names[:MAX_NAMES], wanted)
            if places is None:
                raise _missing(wanted, names)
            sizes = {item.filename.removesuffix(".npy"): item.file_size for item in arrays.zip.infolist()}
            if any(sizes[names[place]] > MAX_ARRAY for place in chain(*places)):
                raise _unreadable("an array is larger than 1 GB.")
            columns = [
                np.sum([np.ravel(arrays[names[place]]).astype(float) for place in group], axis=0) for group in places
            ]
    except (OSError, ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise _unreadable(f"this .npz cannot be read: {printable(str(error), 100)}.") from None
    yield Head(places, tuple(_unit(names[group[0]]) for group in places))
    yield from zip(*(column.tolist() for column in columns), strict=False)
