"""Read the tables of any program: lines of text, JSON, NumPy arrays, compressed or not.

1. A file becomes lines: packed files are unpacked, documents and arrays have a line a record.
2. A line is a row like the last one; or else what a layout finds in it, such as printed values,
   which is remembered for other lines of its shape; or else words that may be a head, or a row.
3. Rows go to the table of the last head above them, printed values to the sheet of their run.
4. `tables` chooses the columns of time and energy of each, and parts the series in them.
"""

import bz2
import csv
import gzip
import io
import json
import lzma
import re
import zlib
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from functools import partial
from itertools import chain
from statistics import mode
from typing import Any

import msgspec
import numpy as np

from pendu_tui.tui.cli.errors import unreadable
from pendu_tui.tui.cli.layouts import FAILED, LAYOUTS, NUMBER, Layout, is_energy, role
from pendu_tui.tui.cli.tables import Sheet, Wanted, choose, known_names
from pendu_tui.tui.cli.units import UNIT, is_unit, plain, split_unit

MAX_LINE = 1 << 20  # characters
MAX_LINES_BEFORE = 100_000  # the first row
MAX_LINES = 5_000_000  # some seconds; the input may be endless
MAX_DOCUMENT = 1 << 27  # characters of JSON
MAX_INNER = 9  # of an array in a record
MAX_COLUMNS = 5000
MAX_TABLES = 10_000
MAX_SHAPES = 10_000
MIN_ABOVE = 8  # lines that tell whether the last one was cut
MAX_ABOVE = 64
MAX_HEADS = 20  # lines that may be the head of the next row
_UNPACK: dict[bytes, Callable[[Any], Any]] = {
    b"\x1f\x8b": gzip.open,
    b"BZh": bz2.open,
    b"\xfd7zXZ": lzma.open,
}
_NUMBERS = re.compile(
    r"([-+.\d](?<!\w.)[\d.]*(?<=\d)(?:\.|,\d+(?![\d.]|,\d))?(?:[eEdD][-+]?\d+|[-+]\d{3}(?!\d))?)"
)
"""The numbers in a line that are not part of a word; twice as fast as NUMBER.  1.2.3 is one."""
_MAY_BE_MARKED = re.compile(r",\d{3}(?![\d,])")
_MARKED = re.compile(
    r"(?:(?<=[=:\";|])|(?<=[=:] ))[-+]?[1-9]\d{0,2}(?:,\d{3})+(?=[\s\";|.]|,\s|$)"
    r"|(?<!\S)[-+]?[1-9]\d{0,2}(?:,\d{3})+(?=[\s;|]|$)"
)
_HAS_POINT = re.compile(r"(?<![\w.])[-+]?\d*\.(?:\d{1,2}|\d{4,})(?![\d.])")
_IS_FAILED = re.compile(FAILED, re.IGNORECASE)
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s?({UNIT})\s*", re.IGNORECASE)
_DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
_BRACKETED = re.compile(r"\s*\(\s*[-+]?[.\d][^()]*\)\s*")
_GLUED = re.compile(r"[-+*](?<=\d.)(?:(?<!\*)(?=\d)|(?<=\*)(?=\*))")  # to the number before
_OBJECT = re.compile(r'\{(?:"|\w[^:=]*$)')  # that may be broken
_MARKS = "#@!%;"  # of comments
_DELIMITERS = "\t;,|"
_BETWEEN = (
    r"\s{2,}",  # names may contain single blanks
    r"\s+(?![\s(\[])",  # or a blank before the unit
    r"(?<=[)\]])\s+",  # or end with the unit
)


def read_sheets(stream: io.BufferedReader, wanted: Wanted, file: str = "") -> list[Sheet]:
    """Return the tables of a file in its order.  Raises UserError, with a sentence without name."""
    start = stream.peek(MAX_LINE)
    for magic, unpack in _UNPACK.items():
        if start.startswith(magic):
            try:
                unpacked = io.BufferedReader(unpack(stream))
                return read_sheets(unpacked, wanted, file.rpartition(".")[0])
            except (EOFError, OSError, lzma.LZMAError, zlib.error):
                raise unreadable("it cannot be unpacked; is it complete?") from None
    if start.startswith((b"PK\x03\x04", b"\x93NUMPY")):
        return _Text(wanted, file).read(_document(_arrays(stream)))
    encoding = "utf-8-sig"
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif b"\0" in start:
        raise unreadable("this is not text; save a table as CSV (a recording: pendu-tui export).")
    text = io.TextIOWrapper(stream, encoding=encoding, errors="replace")
    is_json = start.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"[")
    return _Text(wanted, file).read(_json(text) if is_json else _lines(text))


def _lines(text: io.TextIOBase) -> Iterator[str]:
    """Yield the lines.  Raises UserError where there is no end to them."""
    above: deque[str] = deque(maxlen=MAX_ABOVE)
    for count, line in enumerate(iter(partial(text.readline, MAX_LINE), "")):
        if count == MAX_LINES:
            raise unreadable(f"more than {MAX_LINES:,} lines; leave some out.")
        if len(line) == MAX_LINE:
            raise unreadable("a line is longer than 1 MB; is this a table?")
        line = line.replace("−", "-")
        yield line[:-1] if line.endswith("\n") else _uncut(line, above)
        above.append(line)


def _uncut(line: str, above: Iterable[str]) -> str:
    """Return the last line, with a word for its last number if the file was cut in that.

    It is then shorter than in all lines above that look the same.
    """
    *_, number, end = ["", *_NUMBERS.split(line)]
    if end or not number:
        return line
    shape = _NUMBERS.sub("0", line).split()
    like = [each for each in above if _NUMBERS.sub("0", each).split() == shape]
    numbers = [_NUMBERS.findall(each)[-1] for each in like]
    has_grown = "e" in number.lower() and "e" not in "".join(numbers).lower()  # to 1e+300
    if has_grown or len(like) < MIN_ABOVE or len(number) >= min(map(len, numbers)):
        return line
    return f"{line.removesuffix(number)}cut"


def _unmarked(line: str) -> str:
    """Return a line without commas between thousands if it has decimal points, too."""
    if not _MAY_BE_MARKED.search(line) or not _HAS_POINT.search(line):
        return line
    return _MARKED.sub(lambda found: found[0].replace(",", ""), line)


def _json(text: io.TextIOBase) -> Iterator[str]:
    """Yield a line for each record of JSON, or other lines as they are."""
    whole = text.read(MAX_DOCUMENT).replace("−", "-")
    if len(whole) == MAX_DOCUMENT:
        raise unreadable(f"more than {MAX_DOCUMENT:,} characters of JSON; leave some out.")
    document = _parsed(whole)
    if document is not whole:
        yield from _document(document)
        return
    for line in _lines(io.StringIO(whole)):
        is_nested = line.count("{") > 1 or "[" in line
        yield _record(_parsed(line)) if is_nested else line


def _document(document: Any) -> Iterator[str]:
    """Yield a line for each record of a document, the longest list last, as it is judged."""
    for items in sorted(_lists(document), key=len):
        yield from map(_record, items)
        yield "&"  # a new run


def _parsed(text: str) -> Any:
    """Return what there is in JSON, or the text itself if it is none."""
    for decode in (msgspec.json.decode, json.loads):  # msgspec is fast, but knows no NaN
        with suppress(ValueError, RecursionError):
            return decode(text)
    return text


def _is_broken(line: str) -> bool:
    """Return whether a line is no JSON, even with other numbers, and does not go on below."""
    bare = _NUMBERS.sub("0", _IS_FAILED.sub("0", line.rstrip(" ]\r")))
    return not bare.endswith((",", "{", "[")) and _parsed(bare) is bare


def _record(item: Any) -> str:
    """Return the line of an object or a row."""
    if isinstance(item, dict):
        return _encoded(_flat(item))
    return " ".join(map(str, item if isinstance(item, list) else [item]))


def _encoded(record: dict[str, Any]) -> str:
    """Return an object in JSON."""
    with suppress(TypeError, UnicodeEncodeError):
        line = msgspec.json.encode(record).decode()  # ten times as fast
        if "null" not in line:  # which may stand for nan
            return line
    return json.dumps(record, ensure_ascii=False, default=str)


def _lists(document: Any) -> Iterator[list[Any]]:
    """Yield the objects or rows in a document: those of a list, or of lists in an object."""
    if isinstance(document, list):
        yield document
    if not isinstance(document, dict):
        return
    arrays = {}
    for name, each in document.items():
        if isinstance(each, dict) and all(map(str.isdecimal, each)):  # pandas
            each = [*each.values()]
        if isinstance(each, list) and len(each) > 1 and not isinstance(each[0], dict):
            arrays[name] = each
    if arrays:
        rows = [each for each in arrays.values() if not isinstance(each[0], list)]
        size = mode(map(len, rows or arrays.values()))  # positions, for example, are more
        arrays = {name: each for name, each in arrays.items() if len(each) == size}
        yield [dict(zip(arrays, row, strict=True)) for row in zip(*arrays.values(), strict=True)]
        return
    for each in document.values():
        yield from _lists(each)


def _flat(item: dict[str, Any], above: str = "") -> dict[str, Any]:
    """Return the values in an object; the names of inner ones have those around them."""
    found: dict[str, Any] = {}
    for key, value in item.items():
        name = f"{above}{key}"
        if isinstance(value, dict):
            found |= _flat(value, f"{name}.")
        elif isinstance(value, list):
            for place, inner in enumerate(value[:MAX_INNER], 1):
                if not isinstance(inner, (dict, list)):
                    found[f"{name}_{place}"] = inner
        else:
            found[name] = value
    return found


def _arrays(stream: io.BufferedReader) -> Any:
    """Return the arrays of an .npz or .npy as lists, by name if they have names."""
    try:
        loaded: Any = np.load(io.BytesIO(stream.read()))
        names = getattr(loaded, "files", None) or loaded.dtype.names
        if names:
            return {name: loaded[name].squeeze().tolist() for name in names}
        return loaded.reshape(len(loaded), -1).tolist()
    except Exception:  # a broken archive may raise anything
        raise unreadable("its arrays cannot be read; save arrays of numbers, or CSV.") from None


def number(text: str) -> float | None:
    """Return the number in a field, nan if it ended, None if there is none.

    It may have a decimal comma, Fortran's D, a unit or brackets.  A date counts in seconds since
    1970, in UTC if it has no zone.
    """
    try:
        return float(text.replace(",", "."))
    except ValueError:
        text = text.strip("()[] \t\r\n\"'")
    with suppress(ValueError):
        return float(text.replace(",", "."))
    if _IS_FAILED.fullmatch(text):
        return float("nan")
    if _DATE.match(text):
        with suppress(ValueError):
            moment = datetime.fromisoformat(text)
            return moment.replace(tzinfo=moment.tzinfo or UTC).timestamp()
    if match := _WITH_UNIT.fullmatch(text):
        text = match[1]
    text = re.sub(r"[.,](?=\d{3}[.,])", "", text)  # between thousands
    # Fortran's exponents from 100 on
    text = re.sub(r"(\.\d+)([-+](?:[12]\d\d|3[0-2]\d))$", r"\1e\2", text)
    with suppress(ValueError):
        return float(text.replace(",", ".").translate(str.maketrans("dD", "ee")))
    return None


def _units_in(fields: list[str]) -> dict[int, str]:
    """Return the units behind the numbers in some fields, by their places."""
    found = map(_WITH_UNIT.fullmatch, fields)
    return {place: match[2] for place, match in enumerate(found) if match}


Form = tuple[str | None, int, str]
"""The delimiter of a row, None for blanks; its fields; the word with which it begins, or ""."""
Prints = dict[str, tuple[str, int]]
"""The unit of each name that is printed in a line, and where its value begins."""


class _Table(Sheet):
    """The rows below one head, and how the next row may look."""

    def __init__(self, wanted: Wanted) -> None:
        super().__init__(wanted)
        self.form: Form = (None, -1, "")
        self.cells: dict[int, str] = {}  # the units in its fields
        self.page: dict[str, list[list[str]]] = {}  # its head, which may be repeated on each page

    def like_last(self, line: str) -> list[str]:
        """Return the fields of a line that looks like the last row, none of another."""
        delimiter, width, opening = self.form
        fields = _split(line, delimiter)
        if opening and len(fields) != width:
            fields = _split(_GLUED.sub(r" \g<0>", line), delimiter)
        is_like = len(fields) == width and line.startswith(opening)
        if not is_like or line.lstrip()[:1] in _MARKS:
            return []
        if self.cells and _units_in(fields) != self.cells:
            return []
        return fields

    def values(self, fields: list[str]) -> list[float | None]:
        """Return the number, or that of its mark, in each field that is kept."""
        values = [number(fields[place]) for place in self.kept]
        for place in self.marks:
            values[self.kept.index(place)] = zlib.crc32(fields[place].encode())
        return values

    def note_brackets(self, fields: list[str]) -> None:
        for place in self.kept:
            if _BRACKETED.fullmatch(fields[place]):
                self.bracketed[place] = fields[place].strip()

    def put_odd(self, line: int, numbers: Sequence[float | None], opening: str) -> None:
        """Add what is certain of a row that is not quite like the others, or count it."""
        if not self.names or opening != self.form[2] or (numbers[0] is None and not opening):
            return
        if any(value != value for value in numbers[1:]):  # some of what ended are missing
            self.put(line, self.kept, [float("nan")] * len(self.kept))
        elif self.last == line - 1 and len(numbers) < self.form[1] and None not in numbers:
            self.put_cut(line, numbers)
        else:
            self.skipped += 1


class _Text:
    """Tables in lines of text."""

    def __init__(self, wanted: Wanted, file: str) -> None:
        self._wanted = wanted
        self._line = 0
        self._tables = [_Table(wanted)]  # the last has no columns before its first row
        self._prints = [Sheet(wanted, is_printed=True)]  # of each run
        self._shapes: dict[str, list[tuple[str, str, int]]] = {}
        """What a line holds, by its text with \\0 for each number: names, their units, and where
        their values are if `_NUMBERS` divides the line, 0 for a number that ended.
        """
        self._heads: dict[str, list[list[str]]] = {}  # lines of words, divided in ways
        self._units = ("", "")  # of times and energies, if the layout has only these
        named = (each.columns for each in LAYOUTS if each.file and file.endswith(each.file))
        self._labels = dict(enumerate(next(named, ())))  # names of columns by place
        self._passed = 0  # columns of earlier sets
        self._shared = ""  # the only unit of xmgrace's y axis
        self._above: dict[str, list[str]] = {}  # the names in lines above one line of numbers
        self._over: list[str] = []  # those in the line before
        self._is_over = False  # the data have ended

    def read(self, lines: Iterable[str]) -> list[Sheet]:
        """Return the sheets of these lines, in their order."""
        for line in lines:
            self._line += 1
            self._read(_unmarked(line))
            is_late = self._line == MAX_LINES_BEFORE
            if is_late and not any(sheet.puts for sheet in (*self._tables, *self._prints)):
                raise unreadable(f"{MAX_LINES_BEFORE:,} lines without a row; is this a table?")
            if len(self._tables) + len(self._prints) > MAX_TABLES:
                raise unreadable(f"more than {MAX_TABLES:,} tables; leave some out.")
        named: list[Sheet] = [sheet for sheet in self._tables if any(sheet.names)]
        for sheet in self._prints:
            sheet.choose()
            if sheet.choice and sheet.choice.energy and not (named and sheet.choice.doubt):
                named.append(sheet)
        bare = [sheet for sheet in self._tables if sheet.names]
        return sorted(named or bare or self._prints, key=lambda sheet: sheet.line)

    @property
    def _table(self) -> _Table:
        return self._tables[-1]

    def _read(self, line: str) -> None:
        """Read a row like the last one, printed values, or a line of a new form."""
        over = self._over
        self._over = []
        if self._is_over:
            self._read_new(line)
        elif over and len(line.split()) == len(over):
            for name, value in zip(over, line.split(), strict=True):
                self._print(name, value, self._unit(name))
        elif self._is_next_row(line) or line in self._heads:
            pass
        elif line in self._above:
            self._over = self._above[line]
        elif line in self._table.page:
            self._heads[line] = self._table.page[line]
        else:
            fields = _NUMBERS.split(line)
            prints = self._shapes.get("\0".join(fields[::2]))
            if prints is None:
                self._read_new(line)
                return
            for name, unit, place in prints:
                self._print(name, fields[place] if place else "nan", unit)

    def _is_next_row(self, line: str) -> bool:
        """Add a row like the last one to its table.  Return whether it is one."""
        table = self._table
        if self._heads and not self._heads.keys() <= table.page.keys():
            return False
        fields = table.like_last(line)
        values = table.values(fields) if fields else [None]
        if values[0] is None:
            return False
        if self._heads:
            table.heads.append(self._line)
            self._heads.clear()
        if "(" in line:
            table.note_brackets(fields)
        table.put(self._line, table.kept, values)
        return True

    def _read_new(self, line: str) -> None:
        """Read a line of a new form: what a layout finds in it, or else words or a row."""
        if _OBJECT.match(line) and _is_broken(line):
            self._prints[-1].skipped += 1
            return
        prints: Prints = {}
        is_read = False
        for layout in LAYOUTS:
            for match in layout.pattern.finditer(line):
                if any(layout.units):
                    self._units = layout.units
                is_read |= self._take(layout, match, prints)
            if is_read:
                break
        is_nothing = not is_read and not self._is_over and self._words_or_row(line)
        if is_nothing or prints:
            self._remember(line, prints)

    def _remember(self, line: str, prints: Prints) -> None:
        """Remember what lines of this shape hold: these prints, where their values begin."""
        starts = {match.start(): 2 * n + 1 for n, match in enumerate(_NUMBERS.finditer(line))}
        holds = []
        for name, (unit, start) in prints.items():
            place = 0 if _IS_FAILED.match(line, start) else starts.get(start)
            if place is None or _NUMBERS.search(name):
                return  # another name may have this shape
            holds.append((name, unit, place))
        shape = _NUMBERS.sub("\0", line)
        is_text = not starts or re.search(r"[^\W\d_]", shape)
        is_odd = None in map(number, _NUMBERS.findall(line))  # as in a version, 1.2.3
        if is_text and not is_odd and len(self._shapes) < MAX_SHAPES:
            self._shapes[shape] = holds

    def _take(self, layout: Layout, match: re.Match[str], prints: Prints) -> bool:
        """Take what a layout found.  Return whether that is all there is in the line."""
        line = match.string
        groups = {name: text for name, text in match.groupdict().items() if text}
        match groups:
            case {"part": _}:
                self._begin_run()
            case {"end": _} | {"again": _}:
                self._is_over = "end" in groups
            case {"error": text}:
                for sheet in (self._last_rows(), self._prints[-1]):
                    sheet.error = sheet.error or text  # later ones follow from the first
            case _ if self._is_over:
                pass
            case {"value": value}:
                name = groups.get("name", "Step")
                if name in prints:
                    name += "'"  # so that no energy is certain
                unit = groups.get("unit") or self._unit(name)
                self._print(name, value, unit)
                prints[name] = (unit, match.start("value"))
                return "name" in groups
            case {"names": text}:
                self._heads = {line: _ways(text, layout.cells)}
            case {"over": text}:
                self._over = [*map(str.strip, re.findall(layout.cells, text))]
                self._above[line] = self._over
            case {"row": text}:
                fields, delimiter = self._fields(text, is_row=True)
                is_word = number(fields[0]) is None
                self._row(fields, delimiter, fields[0] if is_word else "")
            case {"set": place, "label": label}:
                self._labels[int(place) + 1] = label
            case {"label": label}:
                self._labels[int(groups.get("place", 1)) - 1] = label
            case {"units": units}:
                self._share(re.findall(r"\(([^()]*)\)", units))
            case _:
                return False
        return True

    def _share(self, units: list[str]) -> None:
        """Note the units of an axis: that of energies, and the only one, if it is certain."""
        energies = [unit for unit in units if plain("energy", unit) and unit != "K"]
        self._units = ("", energies[0] if len(energies) == 1 else "")
        self._shared = units[0] if len(units) == 1 else ""

    def _last_rows(self) -> _Table:
        """Return the last table that has rows, also if a new run began below it."""
        return next((each for each in reversed(self._tables) if each.puts), self._table)

    def _begin_run(self) -> None:
        """Begin a run, whose lines may look like earlier ones, but hold something else."""
        if self._table.names:
            self._passed += self._table.form[1] - 1
            self._tables.append(_Table(self._wanted))
        self._shapes.clear()  # what held nothing may be a head
        self._prints.append(Sheet(self._wanted, self._line, is_printed=True))

    def _print(self, name: str, text: str, unit: str) -> None:
        value = number(text)
        if value is not None:
            self._prints[-1].print(name, unit, self._line, value)

    def _unit(self, name: str) -> str:
        """Return the unit of a column by its name, or that of its layout's times or energies."""
        time, energy = self._units
        default = time if role(name)[0] == "time" else energy * is_energy(name)
        return split_unit(name)[1] or default

    def _words_or_row(self, line: str) -> bool:
        """Read a row, or words that may be a head.  Return whether it is neither."""
        text = line.lstrip().rstrip(" \r")  # a tab may stand before a blank field
        if not re.search(r"[\w*]", text):
            return True  # a rule
        if re.fullmatch(r"1\.0e[-+]\d\d +\*", text):  # MATLAB
            raise unreadable(f"its numbers lack a factor, {text[:7]}; print them in full.")
        is_comment = text[0] in _MARKS and not _IS_FAILED.match(text)
        bare = text.lstrip(_MARKS + " \t") if is_comment else text
        fields, delimiter = self._fields(bare)
        is_like = (len(fields), "") == self._table.form[1:]
        numbers = [*map(number, fields)]
        if numbers.count(None) < len(fields):
            if not is_comment and len(fields) <= MAX_COLUMNS and self._row(fields, delimiter):
                return False
            return is_comment or numbers[0] is None or not self._last_rows().names
        ways = _ways(bare)
        is_row = is_like and delimiter and not is_comment
        if is_row and not any(map(self._worth, chain(ways, *self._heads.values()))):
            self._table.skipped += 1
            return False
        self._heads[line] = ways
        if len(self._heads) > MAX_HEADS:
            del self._heads[next(iter(self._heads))]
        return False

    def _fields(self, text: str, is_row: bool = False) -> tuple[list[str], str | None]:
        """Return the fields of a row and what separates them, None for blanks."""
        delimiter, width, _ = self._table.form
        if delimiter and len(fields := _split(text, delimiter)) == width:
            return fields, delimiter
        text = text.strip()
        for sign in filter(text.__contains__, _DELIMITERS):
            fields = _split(text, sign)
            undated = [_DATE.sub("", field) for field in fields]
            if fields and not any(re.search(r"\d\s+(?:[-+.\d]|\(nan)", each) for each in undated):
                return fields, sign
        divided = _GLUED.sub(r" \g<0>", text).split()
        if is_row or len(divided) == width or re.search(r"\d\*{2,}$", text):
            return divided, None
        return _split(text, None), None

    def _row(self, fields: list[str], delimiter: str | None, opening: str = "") -> bool:
        """Add a row to the last table, or to one that begins here.  Return whether it is a row."""
        numbers = [*map(number, fields)]
        is_row = self._has_table(fields, numbers, (delimiter, len(fields), opening))
        table = self._table
        if not is_row:
            self._last_rows().put_odd(self._line, numbers, opening)
            return False
        table.note_brackets(fields)
        table.put(self._line, table.kept, table.values(fields))
        for place, unit in _units_in(fields).items():
            table.check_unit(place, unit, self._line)
        return True

    def _has_table(self, fields: list[str], numbers: Sequence[float | None], form: Form) -> bool:
        """Return whether a row belongs to the last table, or to one that begins here."""
        last = self._table
        names = self._head(fields, numbers)
        goes_on = names == last.names
        if names is None:
            goes_on = form[1:] == last.form[1:]
            bare = [""] * len(fields)
            is_sure = None not in numbers[bool(form[2]) :] or self._worth(bare, numbers)
            if not goes_on and (any(last.names) or not is_sure):
                return False
        elif goes_on:
            last.heads.append(self._line)
        if not goes_on:
            self._begin_table(names or self._labelled(len(fields)), fields)
        if names or not goes_on:
            self._table.form = form
        for line, ways in self._heads.items():
            if names in ways:
                self._table.page[line] = ways
            elif not any(map(self._worth, ways)):  # it never will be a head
                self._remember(line, {})
        self._heads.clear()
        return True

    def _begin_table(self, names: list[str], fields: list[str]) -> None:
        """Begin a table of columns of these names above a row."""
        if self._table.names:
            self._tables.append(_Table(self._wanted))
        self._shapes.clear()  # what held nothing may be a row
        self._table.line = self._line
        self._table.cells = _units_in(fields)
        for name, unit in zip(names, self._units_of(names, fields), strict=True):
            self._table.add_column(name, unit)

    def _head(self, fields: list[str], numbers: Sequence[float | None]) -> list[str] | None:
        """Return the best names above that fit a row, None without any."""
        found: list[str] | None = None
        most = 0
        width = len(fields)
        labels = [] if any(self._table.names) else [self._labelled(width)]
        for names in chain(labels, *reversed(self._heads.values())):
            blanks = width - len(names)
            if blanks > 0 and not any(fields[-blanks:]):
                names = [*names, *[""] * blanks]
            elif blanks == 1 and numbers[0] is not None and known_names(names) > 1:
                names = ["", *names]  # the rows are numbered
            fits = any(names) and len(names) == width
            if fits and (worth := self._worth(names, numbers)) > most:
                found = names
                most = worth
        return found

    def _worth(self, names: list[str], numbers: Sequence[float | None] | None = None) -> int:
        """Return how sure it is that these are the names of a row, 0 if they are not.

        Without numbers they are those of any row.
        """
        is_first = not self._table.names
        wanted = [text for text in (self._wanted.time, self._wanted.energy) if text]
        known = known_names(names)
        if known < 2 and not (is_first or wanted):
            return 0  # at once, or prose would be slow
        if any(re.fullmatch(r"[(\[][^()\[\]]*[)\]]", name) for name in names):  # a unit
            return 0
        choice = choose(names, [""] * len(names), [()] * len(names), self._wanted)
        if choice and numbers and None in [numbers[place] for place in choice.columns]:
            return 0
        asked = wanted if choice else []
        if not all(map(str.isdecimal, asked)):
            return len(names)
        if known > 1:
            return known
        is_data = any(number(name) is not None for name in names)
        return int(is_first and not is_data and (bool(asked) or None not in (numbers or ())))

    def _labelled(self, width: int) -> list[str]:
        """Return the names that lines above gave to single columns."""
        places = [0, *range(1 + self._passed, width + self._passed)]
        return [self._labels.get(place, "") for place in places]

    def _units_of(self, names: list[str], fields: list[str]) -> list[str]:
        """Return the unit of each column, as far as it is certain to be its own."""
        units = [self._unit(name) for name in names]
        others = (ways for ways in self._heads.values() if names not in ways)
        for row in chain.from_iterable(others):
            bare = [each.strip("()[]") for each in row]
            if len(row) == len(names) and any(map(is_unit, bare)) and not any(units):
                units = bare
        for place, field in enumerate(fields):
            if _DATE.match(field.strip("\"' ")):
                units[place] = "s"
            units[place] = self._table.cells.get(place) or units[place]
        return [units[0], *(each or self._shared for each in units[1:])]


def _ways(text: str, cells: str = "") -> list[list[str]]:
    """Return the names in a head, divided in each way that there may be."""
    text = text.strip().rstrip(",; ")
    ways = [_split(text, sign) for sign in (*_DELIMITERS, None)]
    ways += [re.split(between, text) for between in _BETWEEN]
    if cells:
        ways = [re.findall(cells, text)]
    return [[name.strip(" '\"#") for name in names] for names in ways]


def _split(text: str, delimiter: str | None) -> list[str]:
    """Return the fields between delimiters, None for blanks; what is in quotes is one field."""
    if '"' not in text:
        return text.split(delimiter)
    with suppress(csv.Error, ValueError):
        (fields,) = csv.reader(
            [text.strip(" \r\n")], delimiter=delimiter or " ", skipinitialspace=True
        )
        return fields
    return []
