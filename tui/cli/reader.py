"""Read the tables of any program: lines of text, JSON, NumPy arrays, compressed or not.

Documents and arrays become lines of text, a record each, so that there is one reader.
"""

import bz2
import csv
import gzip
import io
import json
import lzma
import re
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from itertools import accumulate, chain, compress
from statistics import mode
from typing import Any

import msgspec
import numpy as np

from pendu_tui.tui.cli.layouts import FAILED, LAYOUTS, NUMBER, Layout, is_energy, role
from pendu_tui.tui.cli.tables import Group, Sheet, Wanted, choose, known_names, unreadable
from pendu_tui.tui.cli.units import is_unit, plain, split_unit

MAX_LINE = 1 << 20  # characters
MAX_LINES_BEFORE = 100_000  # the first row
MAX_LINES = 5_000_000  # some seconds; the input may be endless
BLOCK = 1 << 16  # characters
MAX_DOCUMENT = 1 << 27  # characters of JSON
MAX_INNER = 9  # of an array in a record
MAX_COLUMNS = 5000
MAX_SHAPES = 10_000
MAX_HEADS = 20  # lines that may be the head of the next row
_UNPACK: dict[bytes, Callable[[Any], Any]] = {
    b"\x1f\x8b": gzip.open,
    b"BZh": bz2.open,
    b"\xfd7zXZ": lzma.open,
}
_NUMBERS = re.compile(r"([-+.\d](?<!\w.)[\d.]*(?<=\d)\.?(?:[eEdD][-+]?\d+)?)")
"""The numbers in a line that are not part of a word; twice as fast as NUMBER.  1.2.3 is one."""
_IS_FAILED = re.compile(FAILED, re.IGNORECASE)
_WITH_UNIT = re.compile(rf"({NUMBER})\s?([^\W\d]\S*)")
_GLUED = re.compile(r"(?<=\d)(?=[-+]\d)|(?<=\d)(?=\*\*)")  # numbers that Fortran ran together
_OBJECT = re.compile(r'\{(?:"|\w[^:=]*$)')  # that may be broken
_COMMENTS = "#@!%;"
_JSON_NUMBERS = msgspec.json.Decoder(list[float])
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
                raise unreadable("it cannot be unpacked; is it whole?") from None
    if start.startswith((b"PK\x03\x04", b"\x93NUMPY")):
        return _Text(wanted, file).read([_records(_arrays(stream))])
    encoding = "utf-8-sig"
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif b"\0" in start:
        raise unreadable("this is not text; save a table as CSV (a recording: pendu-tui export).")
    text = io.TextIOWrapper(stream, encoding=encoding, errors="replace")
    blocks = _blocks(text)
    if start.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"["):
        blocks = _json(text)
    return _Text(wanted, file).read(blocks)


def _blocks(text: io.TextIOBase) -> Iterator[list[str]]:
    """Yield some lines at a time.  Raises UserError where there is no end to them."""
    count = 0
    rest = ""
    while chunk := text.read(BLOCK):
        *lines, rest = (rest + chunk).split("\n")
        count += len(lines)
        if count > MAX_LINES:
            raise unreadable(f"more than {MAX_LINES:,} lines; leave some out.")
        if len(rest) > MAX_LINE:
            raise unreadable("a line is longer than 1 MB; is this a table?")
        yield lines
    yield [rest]


def _json(text: io.TextIOBase) -> Iterator[list[str]]:
    """Yield a line for each record of JSON, or other lines as they are, some at a time."""
    whole = text.read(MAX_DOCUMENT)
    if len(whole) == MAX_DOCUMENT:
        raise unreadable(f"more than {MAX_DOCUMENT:,} characters of JSON; leave some out.")
    document = _parsed(whole)
    if document is not whole:
        yield _records(document)
        return
    for lines in _blocks(io.StringIO(whole)):
        joined = "".join(lines)
        if joined.count("{") > len(lines) or "[" in joined:
            lines = _records([*map(_parsed, lines)])
        yield lines


def _parsed(text: str) -> Any:
    """Return what there is in JSON, or the text itself if it is none."""
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return text


def _is_broken(line: str) -> bool:
    """Return whether a line is no JSON, even with other numbers, and does not go on below."""
    bare = _NUMBERS.sub("0", _IS_FAILED.sub("0", line.rstrip(" ]\r")))
    return not bare.endswith(",") and _parsed(bare) is bare


def _records(document: Any) -> list[str]:
    """Return a line for each object or row in a document."""
    return [*map(_record, _items(document))]


def _items(document: Any) -> list[Any]:
    """Return the objects or rows in a document: those of a list, or of lists in an object."""
    if isinstance(document, list):
        return document
    if not isinstance(document, dict):
        return []
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
        return [dict(zip(arrays, row, strict=True)) for row in zip(*arrays.values(), strict=True)]
    return next(filter(None, map(_items, document.values())), [])


def _record(item: Any) -> str:
    """Return an object or a row in one line; the names of inner values have those around them."""
    if isinstance(item, dict):
        return json.dumps(dict(_flat(item)), ensure_ascii=False)
    return " ".join(map(str, item if isinstance(item, list) else [item]))


def _flat(item: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(item, dict):
        for inner, value in item.items():
            yield from _flat(value, f"{name}.{inner}".lstrip("."))
    elif isinstance(item, list):
        for place, value in enumerate(item[:MAX_INNER], 1):
            if not isinstance(value, (dict, list)):
                yield f"{name}_{place}", value
    else:
        yield name, item


def _arrays(stream: io.BufferedReader) -> Any:
    """Return the arrays of an .npz or .npy as lists, by name if they have names."""
    try:
        loaded: Any = np.load(io.BytesIO(stream.read()), allow_pickle=False)
        names = getattr(loaded, "files", None) or loaded.dtype.names
        if names:
            return {name: loaded[name].squeeze().tolist() for name in names}
        return loaded.reshape(len(loaded), -1).tolist()
    except Exception:  # a broken archive may raise anything
        raise unreadable("its arrays cannot be read; save arrays of numbers, or CSV.") from None


def number(text: str) -> float | None:
    """Return the number in a field, nan if it ended, None if there is none.

    It may have a decimal comma, Fortran's D, a unit or brackets.
    """
    text = text.strip("()[] \t\r\n\"'")
    with suppress(ValueError):
        return float(text)
    if _IS_FAILED.fullmatch(text):
        return float("nan")
    match = _WITH_UNIT.fullmatch(text)
    if match and is_unit(match[2]):
        text = match[1]
    if "." in text and "," in text:
        text = text.replace(min(".,", key=text.find), "")  # it parts thousands
    with suppress(ValueError):
        return float(text.replace(",", ".").translate(str.maketrans("dD", "ee")))
    return None


def _floats(column: list[str]) -> list[float]:
    """Return the numbers in these fields.  Raises ValueError."""
    with suppress(msgspec.DecodeError):  # three times as fast
        values = _JSON_NUMBERS.decode(f"[{','.join(column)}]")
        if len(values) == len(column):  # no field has a comma
            return values
    return [*map(float, column)]


def _values(columns: list[list[str]], is_certain: bool) -> list[list[Any]]:
    """Return the numbers in columns; nothing if they are not certain to be some.

    Those of a single row may be None, but not the first.
    """
    with suppress(ValueError):
        return [*map(_floats, columns)]
    if not is_certain:
        return []
    values = [[*map(number, column)] for column in columns]
    is_single = len(columns[0]) == 1
    needed = values[:1] if is_single else values
    return [] if any(None in column for column in needed) else values


Form = tuple[str | None, int, str]
"""The delimiter of a row, None for blanks; its fields; the word with which it begins, or ""."""


class _Text:
    """Tables in lines of text."""

    def __init__(self, wanted: Wanted, file: str) -> None:
        self._wanted = wanted
        self._line = 0
        self._sheets: list[Sheet] = []
        self._prints = [Sheet(wanted, is_printed=True)]  # of each run
        self._shapes: dict[str, tuple[Group, Group]] = {}
        """What a line holds, by its text with \\0 for each number: some columns, and the place of
        each where `_NUMBERS` divides the line, -1 for a number that ended.
        """
        self._form: Form = (None, -1, "")
        self._heads: dict[str, list[list[str]]] = {}  # lines of words, divided in ways
        self._units = ("", "")  # of times and energies, if the layout has only these
        named = (each.columns for each in LAYOUTS if re.search(f"{each.file}$", file))
        self._labels = dict(enumerate(next(named, ())))  # names of columns by place
        self._passed = 0  # columns of earlier sets
        self._shared: list[str] = []  # units of xmgrace's y axis
        self._over: list[str] = []  # names above a line of numbers
        self._is_over = False  # the data have ended
        self._begins = False  # a new run

    def read(self, blocks: Iterable[list[str]]) -> list[Sheet]:
        """Return the sheets of these lines, in their order."""
        for lines in blocks:
            first = 0
            size = len(lines)
            while first < len(lines):
                some = lines[first : first + size]
                if self._read_known(some):
                    first += size
                    size *= 2
                elif size > 1:
                    size = max(size // 4, 1)
                else:
                    self._line += 1
                    self._read_new(*some)
                    first += 1
            if self._line > MAX_LINES_BEFORE and not self._sheets and not self._prints[0].puts:
                raise unreadable(f"{MAX_LINES_BEFORE:,} lines without a row; is this a table?")
        named = [sheet for sheet in self._sheets if any(sheet.names)]
        for sheet in self._prints:
            sheet.choose()
            if sheet.choice and sheet.choice.energy and not (named and sheet.choice.doubt):
                named.append(sheet)
        return sorted(named or self._sheets or self._prints, key=lambda sheet: sheet.line)

    def _read_known(self, lines: list[str]) -> bool:
        """Read lines that are all like earlier ones.  Return whether they are."""
        if self._heads or self._over or self._is_over or self._begins:
            return False
        others = dict(enumerate(lines, self._line + 1))
        puts: list[Any] = []
        if self._sheets:
            sheet = self._sheets[-1]
            delimiter, width, opening = self._form
            rows = {
                number: line
                for number, line in others.items()
                if len(_split(line, delimiter)) == width
                and line.startswith(opening)
                and line.lstrip()[:1] not in _COMMENTS
            }
            fields = _split((delimiter or " ").join(rows.values()), delimiter)
            columns = [fields[place::width] for place in sheet.kept]
            is_whole = len(fields) == len(rows) * width
            values = is_whole and _values(columns, delimiter is not None)
            if rows and values:
                puts.append((sheet, [*rows], sheet.kept, values))
                others = {number: line for number, line in others.items() if number not in rows}
        if others:
            found = self._prints_in(others)
            if found is None:
                return False
            puts += found
        for sheet, *put in puts:
            sheet.put(*put)
        self._line += len(lines)
        return True

    def _prints_in(self, lines: dict[int, str]) -> list[Any] | None:
        """Return what lines of known shapes hold, None if a shape is new."""
        fields = _NUMBERS.split("\n".join(lines.values()))
        shapes = "\0".join(fields[::2]).split("\n")
        starts = [0, *accumulate(shape.count("\0") for shape in shapes)]
        puts: list[Any] = []
        for shape in {*shapes}:
            known = self._shapes.get(shape)
            if known is None:
                return None
            places, found = known
            if not places:
                continue
            here = [each == shape for each in shapes]
            at = [*compress(starts, here)]
            columns = [
                [fields[2 * start + index] for start in at] if index > 0 else ["nan"] * len(at)
                for index in found
            ]
            if not (values := _values(columns, is_certain=True)):
                return None
            puts.append((self._prints[-1], [*compress(lines, here)], places, values))
        return puts

    def _read_new(self, line: str) -> None:
        """Read a line of a new form: what a layout finds in it, or else words or a row."""
        if _OBJECT.match(line) and self._prints[-1].puts and _is_broken(line):
            self._prints[-1].skipped += 1
            return
        names = self._over
        self._over = []
        if names and len(fields := line.split()) == len(names):
            for name, field in zip(names, fields, strict=True):
                self._print(name, field)
            return
        prints: dict[str, tuple[int, str]] = {}
        is_data = False
        for layout in LAYOUTS:
            for match in layout.pattern.finditer(line):
                if any(layout.units):
                    self._units = layout.units
                groups = {name: text for name, text in match.groupdict().items() if text}
                is_data |= self._found(layout, line, groups)
                for value, name in (("value", groups.get("name", "")), ("step", "Step")):
                    if value in groups and not self._is_over:
                        self._print(name, groups[value], groups.get("unit", ""))
                        prints[name] = (match.start(value), groups[value])
            if is_data:
                break
        is_nothing = not is_data and not self._is_over and self._words_or_row(line)
        if is_nothing or prints:
            self._remember(line, prints)

    def _remember(self, line: str, prints: Mapping[str, tuple[int, str]]) -> None:
        """Remember what lines of this shape hold: these prints, at their places in the line."""
        starts = [match.start() for match in _NUMBERS.finditer(line)]
        if None in map(number, _NUMBERS.findall(line)):  # as in a version, 1.2.3
            return
        holds = {}
        for name, (start, text) in prints.items():
            place = self._prints[-1].places.get(name)
            if place is None or _NUMBERS.search(name):  # another name may have this shape
                return
            if _IS_FAILED.fullmatch(text):
                holds[place] = -1
            elif start in starts:
                holds[place] = 2 * starts.index(start) + 1
            else:
                return
        shape = _NUMBERS.sub("\0", line)
        is_text = re.search(r"[^\W\d_]", shape) or not starts
        if is_text and len(self._shapes) < MAX_SHAPES:
            self._shapes[shape] = (tuple(holds), tuple(holds.values()))

    def _found(self, layout: Layout, line: str, groups: dict[str, str]) -> bool:
        """Take what a layout found.  Return whether that is all there is in the line."""
        match groups:
            case {"part": _}:
                self._begins = True
                self._is_over = False
                self._passed += max(self._form[1] - 1, 0)
                self._prints.append(Sheet(self._wanted, self._line, is_printed=True))
                self._shapes.clear()
            case {"end": _} | {"again": _}:
                self._is_over = "end" in groups
            case _ if self._is_over:
                pass
            case {"value": _}:
                pass
            case {"names": text}:
                self._heads = {line: _ways(text, layout.cells)}
            case {"over": text}:
                self._over = [name.strip() for name in re.findall(layout.cells, text)]
            case {"row": text}:
                fields, delimiter = self._fields(text, is_row=True)
                opening = fields[0]
                if number(opening) is not None:
                    opening = ""
                self._row(fields, delimiter, opening)
            case {"label": label}:
                place = int(groups.get("place", 1)) - 1
                if "set" in groups:
                    place = int(groups["set"]) + 1
                self._labels[place] = label
            case {"units": units}:
                self._shared = re.findall(r"\(([^()]*)\)", units)
                energies = [unit for unit in self._shared if plain("energy", unit) and unit != "K"]
                self._units = ("", energies[0] if len(energies) == 1 else "")
            case _:
                return False
        return True

    def _print(self, name: str, text: str, unit: str = "") -> None:
        value = number(text)
        if value is not None:
            self._prints[-1].print(name, unit or self._unit(name), self._line, value)

    def _unit(self, name: str) -> str:
        """Return the unit of a column by its name, or that of its layout's times or energies."""
        default = ""
        if role(name)[0] == "time":
            default = self._units[0]
        elif is_energy(name):
            default = self._units[1]
        return split_unit(name)[1] or default

    def _words_or_row(self, line: str) -> bool:
        """Read a row, or words that may be a head.  Return whether it is neither."""
        text = line.strip()
        if not re.search(r"[\w*]", text):
            return True  # a rule
        bare = text.lstrip(_COMMENTS + " \t")
        is_comment = bare != text and number(text.split()[0]) is None
        fields, delimiter = self._fields(bare)
        numbers = [*map(number, fields)]
        if not any(each is not None for each in numbers):
            ways = _ways(bare)
            heads = chain(ways, *self._heads.values())
            is_row = delimiter and len(fields) == self._form[1] and not self._begins
            if is_row and not is_comment and not any(map(self._worth, heads)):
                self._sheets[-1].skipped += 1
                return False
            self._heads[line] = ways
            if len(self._heads) > MAX_HEADS:
                del self._heads[next(iter(self._heads))]
            return False
        if not is_comment and len(fields) <= MAX_COLUMNS and self._row(fields, delimiter):
            return False
        return len(fields) != self._form[1] and (is_comment or numbers[0] is None)

    def _fields(self, text: str, is_row: bool = False) -> tuple[list[str], str | None]:
        """Return the fields of a row and what separates them, None for blanks."""
        text = text.strip()
        delimiter, width, _ = self._form
        if delimiter and len(fields := _split(text, delimiter)) == width:
            return fields, delimiter
        bare = re.sub(r'"[^"]*"', "", text)
        for sign in filter(bare.__contains__, _DELIMITERS):
            fields = _split(text, sign)
            if fields and not any(re.search(r"\d\s+[-+.\d]", field) for field in fields):
                return fields, sign
        divided = _GLUED.sub(" ", text).split()
        if is_row or len(divided) == width:
            return divided, None
        return _split(text, None) or [""], None

    def _row(self, fields: list[str], delimiter: str | None, opening: str = "") -> bool:
        """Add a row to its table, which may begin here.  Return whether it is a row."""
        numbers = [number(each) for each in fields]
        form = (delimiter, len(fields), opening)
        is_like = form[1:] == self._form[1:]
        is_sure = None not in numbers[bool(opening) :]
        is_new = self._heads or self._begins or not is_like
        if is_new and self._begin(fields, numbers, is_like, is_sure):
            self._form = form
            is_like = True
        if is_like:
            sheet = self._sheets[-1]
            sheet.put([self._line], sheet.kept, [[numbers[place]] for place in sheet.kept])
        elif self._sheets and opening == self._form[2] and (opening or numbers[0] is not None):
            self._sheets[-1].skipped += 1
        return is_like

    def _begin(
        self, fields: list[str], numbers: list[float | None], is_like: bool, is_sure: bool
    ) -> bool:
        """Look for the head of this row.  Return whether a table begins, or goes on below it."""
        before = self._sheets[-1] if self._sheets else None
        names = self._head(fields, numbers)
        if names is None:
            names = self._labelled(len(fields))
            is_sure = is_sure or self._worth([""] * len(fields), numbers) > 0
            is_below = before and not self._begins and (is_like or any(before.names))
            if is_below or not is_sure:
                for line, ways in self._heads.items():
                    if is_like and not self._begins and not any(map(self._worth, ways)):
                        self._remember(line, {})  # it never will be a head
                if is_like:
                    self._heads.clear()
                return False
        units = self._units_of(names, fields)
        self._heads.clear()
        if before and before.names == names and not self._begins:
            has_remarks = self._line - before.last_line > 2
            if not (has_remarks and before.ends_at(numbers)):
                return True  # a page of the same table, or a restart
        self._begins = False
        self._sheets.append(Sheet(self._wanted, self._line))
        for name, unit in zip(names, units, strict=True):
            self._sheets[-1].add_column(name, unit)
        return True

    def _head(self, fields: list[str], numbers: list[float | None]) -> list[str] | None:
        """Return the best names above that fit a row, None without any."""
        found: list[str] | None = None
        most = 0
        width = len(fields)
        above = (names for ways in [*self._heads.values()][::-1] for names in ways)
        labels = [names for names in (self._labelled(width),) if any(names)]
        for names in chain(labels, above):
            if len(names) == width - 1 and fields[-1] == "":
                names = [*names, ""]
            elif len(names) == width - 1 and numbers[0] is not None and known_names(names) > 1:
                names = ["", *names]  # the rows are numbered
            if len(names) == width and (worth := self._worth(names, numbers)) > most:
                found = names
                most = worth
        return found

    def _worth(self, names: list[str], numbers: list[float | None] | None = None) -> int:
        """Return how sure it is that these are the names of a row, 0 if they are not.

        Without numbers they are those of any row.
        """
        if any(re.fullmatch(r"[(\[][^()\[\]]*[)\]]", name) for name in names):  # a unit
            return 0
        choice = choose(names, [""] * len(names), [()] * len(names), self._wanted)
        if choice and numbers and None in [numbers[place] for place in choice.columns]:
            return 0
        asked = [text for text in (self._wanted.time, self._wanted.energy) if choice and text]
        if not all(map(str.isdecimal, asked)):
            return len(names) + 1
        known = known_names(names)
        if known > 1:
            return known
        is_data = numbers is None or any(number(name) is not None for name in names)
        is_first = not self._sheets or self._begins
        return int(is_first and not is_data and (bool(asked) or None not in (numbers or ())))

    def _labelled(self, width: int) -> list[str]:
        """Return the names that lines above gave to single columns."""
        places = [0, *range(1 + self._passed, width + self._passed)]
        return [self._labels.get(place, "") for place in places]

    def _units_of(self, names: list[str], fields: list[str]) -> list[str]:
        """Return the unit of each column, as far as it is certain to be its own."""
        units = [self._unit(name) for name in names]
        rows = (row for ways in self._heads.values() if names not in ways for row in ways)
        for row in ([each.strip("()[]") for each in row] for row in rows):
            if len(row) == len(names) and any(map(is_unit, row)) and not any(units):
                units = row
        for place, unit in enumerate(units):
            match = _WITH_UNIT.fullmatch(fields[place])
            if unit:
                continue
            if place and len(self._shared) == 1:
                units[place] = self._shared[0]
            elif match and is_unit(match[2]):
                units[place] = match[2]
        return units


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
