"""Read the tables of any program: text of any layout, JSON, NumPy arrays, compressed or not."""

import bz2
import csv
import gzip
import io
import json
import lzma
import re
from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import chain, groupby, islice
from typing import Any

import numpy as np

from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.choice import Wanted, choose, find, is_energy, is_time, known_names
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.layouts import FAILED, LAYOUTS, NUMBER, Layout
from pendu_tui.tui.cli.tables import MAX_ROWS, SAMPLE, Sheet
from pendu_tui.tui.cli.units import assignments, plain, split_unit

MAX_LINE = 1 << 20  # bytes
MAX_LINES_BEFORE = 100_000  # the first row
MAX_DOCUMENT = 1 << 28  # characters of JSON
MAX_NAMES = 500  # of values that are printed with their names
MAX_SHAPES = 10_000
BLOCK = 4096  # lines
_NOT_TEXT = {
    b"\x89MCAP": "a recording; pendu-tui export makes a table of it",
    b"PAR1": "Parquet; save it as CSV",
    b"\x89HDF": "HDF5; save its arrays with numpy.savez",
    b"MATLAB 5": "a MAT-file; save its arrays with numpy.savez",
    b"SQLite": "a database; export a table as CSV",
}
_UNPACK: dict[bytes, Callable[[Any], Any]] = {
    b"\x1f\x8b": gzip.open,
    b"BZh": bz2.open,
    b"\xfd7zXZ": lzma.open,
}
_IS_FAILED = re.compile(FAILED, re.IGNORECASE)
_FAILED_IN_TEXT = re.compile(rf"(?<![\w.#])(?:{FAILED})(?!\w)", re.IGNORECASE)
_NUMBER = re.compile(NUMBER)
_NO_NUMBERS = {ord(sign): None for sign in "0123456789.+- "}
_MEANINGS = frozenset(
    ("names", "row", "name", "value", "unit", "over", "place", "set", "label", "part", "end")
) | frozenset(("axis", "about"))
_IS_BRACKETED = re.compile(r"[(\[][^()\[\]]*[)\]]")  # a unit alone
_WITH_UNIT = re.compile(rf"({NUMBER})\s?([^\W\d]\S*)")
_FORTRAN_POWER = re.compile(r"(?<=[\d.])[dD](?=[-+]?\d)")
_GLUED = re.compile(r"(?<=\d)(?=[-+]\d)|(?<=\d)(?=\*\*)")  # numbers that Fortran ran together


def read_sheets(stream: io.BufferedReader, wanted: Wanted, file: str = "") -> list[Sheet]:
    """Return the tables of a file in its order.  Raises UserError, with a sentence without name."""
    start = stream.peek(MAX_LINE)
    for magic, unpack in _UNPACK.items():
        if start.startswith(magic):
            return _unpacked(unpack(stream), wanted, file)
    if not start:
        raise unreadable("the input is empty; nothing to judge.")
    if start.startswith((b"PK\x03\x04", b"\x93NUMPY")):
        return _of_arrays(stream, wanted)
    for magic, kind in _NOT_TEXT.items():
        if start.startswith(magic):
            raise unreadable(f"this is {kind}.")
    encoding = "utf-8-sig"
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif b"\0" in start[:BLOCK]:
        raise unreadable("this is not text.")
    text = io.TextIOWrapper(stream, encoding=encoding, errors="replace")
    if start.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"["):
        return _of_json(text, wanted, file)
    return _Text(wanted, file).read(_lines(text))


def unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)


def _unpacked(stream: Any, wanted: Wanted, file: str) -> list[Sheet]:
    try:
        return read_sheets(io.BufferedReader(stream), wanted, file.rpartition(".")[0])
    except (EOFError, OSError, lzma.LZMAError) as error:
        raise unreadable(f"it cannot be unpacked: {printable(str(error), 100)}.") from None


def _lines(text: io.TextIOBase) -> Iterator[str]:
    while line := text.readline(MAX_LINE):
        if len(line) == MAX_LINE:
            raise unreadable("a line is longer than 1 MB; is this a table?")
        yield line


def number(text: str) -> float | None:
    """Return the number in a field, nan if it ended, None if there is none.

    It may have a decimal comma, Fortran's D, a unit or brackets.
    """
    text = text.strip("()[] \t\"'")
    try:
        return float(text)
    except ValueError:
        if _IS_FAILED.fullmatch(text):
            return float("nan")
    match = _WITH_UNIT.fullmatch(text)
    if match and _is_unit(match[2]):
        text = match[1]
    try:
        return float(_FORTRAN_POWER.sub("e", text.replace(",", ".")))
    except ValueError:
        return None


def _is_unit(text: str) -> bool:
    text = text.strip("()[]")
    return bool(plain("time", text) or plain("energy", text))


class _Text:
    """Tables in lines of text."""

    def __init__(self, wanted: Wanted, file: str) -> None:
        self._wanted = wanted
        self._layouts = list(LAYOUTS)  # the one found last comes first
        self._units: dict[str, str] = {}  # of the layout, for columns without one
        self._heads: list[list[list[str]]] = []  # lines without numbers, each divided in ways
        self._places: dict[int, str] = {}  # names of columns by place
        self._passed = 0  # columns of earlier sets
        self._shared: list[str] = []  # units of xmgrace's y axis
        self._first = [names for names in (_columns_of(file),) if names]
        self._sheets: list[Sheet] = []
        self._sheet: Sheet | None = None
        self._delimiter: str | None = None
        self._opening = ""  # the word with which each row begins
        self._width = 0  # fields in a row
        self._printed = [_Pairs()]  # one for each run
        self._over: list[str] = []  # names above a line of numbers
        self._is_over = False  # the data have ended
        self._begins = False  # a new run
        self._line = 0
        self._shapes: dict[str, list[tuple[str, int]]] = {}  # of lines that need no other look

    def read(self, lines: Iterator[str]) -> list[Sheet]:
        """Return the sheets of these lines, in their order."""
        while block := list(islice(lines, BLOCK)):
            for is_alike, group in groupby(block, self._is_like_a_row):
                self._read(list(group), is_alike)
            if self._line > MAX_LINES_BEFORE and not self._sheets and not self._printed[-1].names:
                raise unreadable(f"{self._line:,} lines without a row; is this a table?")
        sheets = self._sheets
        named = [sheet for sheet in sheets if any(sheet.names)]
        for pairs in self._printed:
            printed = pairs.sheet(self._wanted)
            if printed and printed.choice and (not printed.choice.doubt or not named):
                named.append(printed)
        return sorted(named or sheets, key=lambda sheet: sheet.line)

    def _is_like_a_row(self, line: str) -> bool:
        return (
            line.startswith(self._opening)
            and len(line.split(self._delimiter)) == self._width
            and '"' not in line
        )

    def _read(self, lines: list[str], are_alike: bool) -> None:
        """Read rows like the last one at once, other lines one by one."""
        for at, line in enumerate(lines):
            sheet = self._sheet
            if are_alike and sheet and sheet.is_chosen and not self._heads and not self._over:
                block = self._block(sheet, lines[at:])
                if block is not None:
                    sheet.extend(block)
                    self._line += len(block)
                    return
            self._line += 1
            self._take(line)

    def _block(self, sheet: Sheet, lines: list[str]) -> Any:
        """Return the kept columns of rows, (n, len(kept)), None if one has no number there."""
        if self._is_over or self._begins or not sheet.kept:
            return None
        text = "".join(lines)
        for is_clean in (False, True):
            if is_clean:
                text = _FORTRAN_POWER.sub("e", _FAILED_IN_TEXT.sub("nan", text))
                if self._delimiter != ",":
                    text = text.replace(",", ".")
                text = re.sub(r"[()\[\]]", "", text)
            with suppress(ValueError):
                return np.loadtxt(
                    text.splitlines(),
                    delimiter=self._delimiter,
                    comments=None,
                    usecols=sheet.kept,
                    ndmin=2,
                )
        return None

    def _take(self, line: str) -> None:
        """Read one line: what a layout finds in it, or else words or a row."""
        if self._over:
            names = self._over
            self._over = []
            values = [number(field) for field in line.split()]
            if len(values) == len(names) and None not in values:
                for name, value in zip(names, values, strict=True):
                    self._pair(name, value)
                return
        shape = line.translate(_NO_NUMBERS)
        prints = self._shapes.get(shape)
        if prints is None:
            prints = self._by_layout(line)
            if prints is not None and len(self._shapes) < MAX_SHAPES:
                self._shapes[shape] = prints
            return
        numbers = _NUMBER.findall(line)
        if prints and len(numbers) == prints[0][1] and not self._is_over:
            for name, at in prints[1:]:
                self._pair(name, float(_FORTRAN_POWER.sub("e", numbers[at])))
        elif prints:
            self._by_layout(line)

    def _by_layout(self, line: str) -> list[tuple[str, int]] | None:
        """Read a line by the layouts.

        Return what lines of this shape hold, if it is nothing, or numbers with their names: the
        names with the places of their numbers, behind the count of all numbers in the line.
        """
        prints: dict[str, int] = {}  # where the numbers begin
        is_known = False
        for layout in self._layouts:
            found = list(layout.pattern.finditer(line))
            if found:
                self._units |= assignments(layout.units) if layout.units else {}
            is_data = False
            for match in found:
                groups = {
                    name: text for name, text in match.groupdict().items() if text is not None
                }
                for name in groups.keys() - _MEANINGS:
                    prints[name] = match.start(name)
                    self._pair(name, number(groups[name]))
                if "value" in groups:
                    prints[groups["name"]] = match.start("value")
                is_data |= self._found(layout, groups)
            is_known |= is_data
            if is_data:
                break
        if not is_known:
            is_noise = not self._is_over and self._words_or_row(line)
            return [] if is_noise else None
        places = [match.start() for match in _NUMBER.finditer(line)]
        if prints and set(prints.values()) <= set(places):
            return [("", len(places)), *((name, places.index(at)) for name, at in prints.items())]
        return None

    def _found(self, layout: Layout, groups: dict[str, str]) -> bool:
        """Take what a layout found.  Return whether that is all there is in the line."""
        match groups:
            case {"part": _}:
                self._begins = True
                self._is_over = False
                self._passed += max(self._width - 1, 0)
                self._printed.append(_Pairs())
            case {"end": _}:
                self._is_over = True
            case _ if self._is_over:
                pass
            case {"name": name, "value": value, **more}:
                self._pair(name, number(value), more.get("unit", ""))
            case {"names": text}:
                self._heads = [_ways(text, layout.cells)]
            case {"over": text}:
                self._over = [name.strip() for name in re.findall(layout.cells, text)]
            case {"row": text}:
                fields, delimiter = _fields(text, glued=True)
                self._row(fields, delimiter, opening=fields[0] if number(fields[0]) is None else "")
            case {"label": label, **places}:
                first = int(places.get("place", 0)) - 1
                if "set" in places:
                    first = int(places["set"]) + 1
                self._places[first] = label
            case {"axis": "x", "about": label}:
                self._places[0] = label
            case {"about": label}:
                self._shared = re.findall(r"\(([^()]*)\)", label)
            case _:
                return False
        return True

    def _pair(self, name: str, value: float | None, unit: str = "") -> None:
        pairs = self._printed[-1]
        if name not in pairs.names:
            unit = unit or split_unit(name)[1] or self._default_unit(name)
        pairs.add(name, value, unit, self._line)

    def _default_unit(self, name: str) -> str:
        if is_time(name):
            return self._units.get("time", "")
        return self._units.get("energy", "") if is_energy(name) else ""

    def _words_or_row(self, line: str) -> bool:
        """Read a row, or words that may be a head.  Return whether it is neither."""
        text = line.strip()
        bare = text.lstrip("#@!%; \t")
        is_comment = bare != text and number(text.split()[0]) is None
        if text.startswith("@") or not re.search(r"[\w*]", text):
            return False  # what else xmgrace is told, or a rule
        fields, delimiter = _fields(bare)
        if delimiter is None and len(fields) != self._width:
            divided = _fields(bare, glued=True)[0]
            fields = divided if len(divided) == self._width else fields
        numbers = [number(each) for each in fields]
        some = len(numbers) > numbers.count(None)
        if some and not is_comment and self._row(fields, delimiter):
            return False
        if not some:
            self._heads = [*self._heads[-20:], _ways(bare)]
        return some and (is_comment or numbers[0] is None)

    def _row(self, fields: list[str], delimiter: str | None, opening: str = "") -> bool:
        """Add a row to its table, which may begin here.  Return whether it is a row."""
        numbers = [number(each) for each in fields]
        is_like = len(fields) == self._width and opening == self._opening
        is_new = self._heads or self._begins or not is_like
        if is_new and self._begin(fields, numbers, opening):
            self._delimiter = delimiter
            self._width = len(fields)
            self._opening = opening
        sheet = self._sheet
        if sheet is None or len(fields) != self._width or self._opening != opening:
            is_broken = opening == self._opening and (opening or numbers[0] is not None)
            if sheet is not None and is_broken:
                sheet.without_numbers += 1
            return False
        sheet.add(numbers, is_cell=delimiter is not None or not _has_words(fields, numbers))
        return True

    def _begin(self, fields: list[str], numbers: list[float | None], opening: str) -> bool:
        """Look for the head of this row; begin a table, unless it is the head of the present."""
        width = len(fields)
        names = self._head(fields, numbers)
        before = self._sheet
        is_same = width == self._width and opening == self._opening
        if names is None and before is not None and not self._begins and is_same:
            self._heads = []
            return False
        if names is None:
            names = self._placed(width)
            is_data = None not in numbers or (opening and None not in numbers[1:])
            if not is_data or (before is not None and not self._begins and any(before.names)):
                return False
        units = self._units_of(names, fields)
        text_between = len(self._heads) > 1
        self._heads = []
        is_page = before is not None and before.names == names and not self._begins
        if is_page and not (text_between and _repeats(before, numbers)):
            return True
        self._begins = False
        self._sheet = Sheet(names, units, self._wanted, self._line)
        self._sheets.append(self._sheet)
        return True

    def _head(self, fields: list[str], numbers: list[float | None]) -> list[str] | None:
        """Return the best names above that fit a row, None without any."""
        best: list[str] | None = None
        most = 0
        width = len(fields)
        for names in (names for ways in reversed([*self._heads, self._first]) for names in ways):
            if len(names) == width - 1 and fields[-1] == "":
                names = [*names, ""]
            if len(names) == width - 1 and numbers[0] is not None and known_names(names) > 1:
                names = ["", *names]  # the rows are numbered
            if names in self._first:
                names = [*names, *[""] * (width - len(names))]
            if len(names) != width:
                continue
            worth = self._worth(names, numbers)
            if worth > most:
                best = names
                most = worth
        return best

    def _worth(self, names: list[str], numbers: list[float | None]) -> int:
        """Return how sure it is that these are the names of a row, 0 if they are not."""
        wanted = (self._wanted.time, self._wanted.energy)
        groups = [find(names, text) for text in wanted if text and not text.isdecimal()]
        places = [place for group in groups if group for place in group]
        if None in [numbers[place] for place in places]:
            return 0
        if groups and None not in groups:
            return 100
        if any(self._places.values()) or any(map(_IS_BRACKETED.fullmatch, names)):
            return 0
        known = known_names(names)
        if known > 1:
            choice = choose(names, [""] * len(names), [()] * len(names), self._wanted)
            if choice and None in [numbers[place] for place in choice.columns]:
                return 0
        if known < 2 and (None in numbers or any(number(name) is not None for name in names)):
            return 0
        return max(known, int(self._sheet is None or self._begins))

    def _placed(self, width: int) -> list[str]:
        names = [self._places.get(0, ""), *[""] * (width - 1)]
        for place in range(1, width):
            names[place] = self._places.get(place + self._passed, "")
        return names

    def _units_of(self, names: list[str], fields: list[str]) -> list[str]:
        """Return the unit of each column, as far as it is certain to be its own."""
        units = [split_unit(name)[1] for name in names]
        for row in (row for ways in self._heads for row in ways):
            if len(row) == len(names) and not any(units) and any(map(_is_unit, row)):
                units = [each.strip("()[]") for each in row]
        energies = [unit for unit in self._shared if plain("energy", unit) and unit != "K"]
        for place, name in enumerate(names):
            if units[place]:
                continue
            if len(self._shared) == 1 and place and self._places:
                units[place] = self._shared[0]
            elif len(energies) == 1 and is_energy(name):
                units[place] = energies[0]
            elif (match := _WITH_UNIT.fullmatch(fields[place])) and _is_unit(match[2]):
                units[place] = match[2]
            else:
                units[place] = self._default_unit(name)
        return units


def _columns_of(file: str) -> list[str]:
    fitting = (each.columns for each in LAYOUTS if re.search(f"{each.file}$", file))
    return list(next(fitting, ()))


def _has_words(fields: Sequence[str], numbers: Sequence[float | None]) -> bool:
    pairs = zip(fields, numbers, strict=True)
    return any(value is None and field for field, value in pairs)


def _repeats(sheet: Sheet | None, numbers: Sequence[float | None]) -> bool:
    """Return whether a row has the time of the last one, as at the beginning of a new run."""
    if sheet is None:
        return False
    sheet.end()
    time = (sheet.choice and sheet.choice.time) or ()
    if len(time) != 1 or not sheet.rows:
        return False
    return sheet.columns[sheet.kept.index(time[0])][-1] == numbers[time[0]]


def _ways(text: str, cells: str = "") -> list[list[str]]:
    """Return the names in a head, divided in each way that there may be."""
    text = _without_bars(text.strip().rstrip(",; "))
    if cells:
        return [[name.strip() for name in re.findall(cells, text)]]
    ways = [_split(text, sign) for sign in "\t;,|" if sign in text]
    ways.append(_split(text, " "))
    ways.append(re.split(r"\s{2,}", text))  # names may contain single blanks
    ways.append(re.sub(r"\s+(?=[(\[])", "\0", text).split())  # or a blank before the unit
    ways.append(re.findall(r"[^)\]]+[)\]]", text))  # or end with the unit
    clean = [[name.replace("\0", " ").strip(" '\"#") for name in names] for names in ways]
    return [names for names in clean if names]


def _without_bars(text: str) -> str:
    """Return a row without the bars at its ends, as Markdown has them."""
    if len(text) > 1 and text[0] == text[-1] == "|":
        return text[1:-1]
    return text


def _split(text: str, delimiter: str) -> list[str]:
    try:
        (fields,) = csv.reader([text.strip(" \r\n")], delimiter=delimiter, skipinitialspace=True)
    except (csv.Error, ValueError):
        return []
    return [field.strip() for field in fields]


def _fields(text: str, glued: bool = False) -> tuple[list[str], str | None]:
    """Return the fields of a row and what separates them, None for blanks."""
    text = _without_bars(text.strip())
    bare = re.sub(r'"[^"]*"', "", text)
    for sign in "\t;,|":
        if sign in bare:
            fields = _split(text, sign)
            if not any(re.search(r"\d\s+[-+.\d]", field) for field in fields):
                return fields, sign
    if glued:
        text = _GLUED.sub(" ", text)
    return _split(text, " "), None


class _Pairs:
    """Values that a program prints with their names."""

    def __init__(self) -> None:
        self.names: dict[str, tuple[array[int], array[float], str]] = {}  # lines, values, unit

    def add(self, name: str, value: float | None, unit: str, line: int) -> None:
        if value is None or (name not in self.names and len(self.names) == MAX_NAMES):
            return
        lines, values, _ = self.names.setdefault(name, (array("q"), array("d"), unit))
        if len(lines) == MAX_ROWS:
            raise unreadable(f"more than {MAX_ROWS:,} rows; leave some out.")
        lines.append(line)
        values.append(value)

    def sheet(self, wanted: Wanted) -> Sheet | None:
        """Return a table of what is printed repeatedly, a row for each time, None without any."""
        names = [name for name, (lines, _, _) in self.names.items() if len(lines) > 1]
        found = [self.names[name] for name in names]
        units = [unit for _, _, unit in found]
        samples = [np.asarray(values[:SAMPLE]) for _, values, _ in found]
        choice = choose(names, units, samples, wanted)
        if not names or choice is None or not choice.energy:
            return None
        leader = np.asarray(found[(choice.time or choice.energy)[0]][0])
        columns = np.zeros((len(leader), len(choice.columns)))
        is_whole = np.ones(len(leader), dtype=bool)
        for column, place in enumerate(choice.columns):
            lines = np.asarray(found[place][0])
            record = np.searchsorted(leader, lines, side="right") - 1
            if np.array_equal(record + 1, np.arange(len(leader))):
                record += 1  # each is printed before the leader
            inside = record >= 0
            columns[record[inside], column] = np.asarray(found[place][1])[inside]
            is_whole &= np.isin(np.arange(len(leader)), record)
        sheet = Sheet(names, units, wanted, int(leader[0]))
        sheet.fill(choice, columns[is_whole])
        sheet.without_numbers = int(np.count_nonzero(~is_whole))
        return sheet


def _of_json(text: io.TextIOBase, wanted: Wanted, file: str) -> list[Sheet]:
    """Read JSON: an object a line, or one document."""
    first = text.readline(MAX_DOCUMENT)
    while first.isspace():
        first = text.readline(MAX_DOCUMENT)
    item = _parsed(first)
    second = text.readline(MAX_DOCUMENT)
    if item is not None and second.strip():
        lines = (_parsed(line) for line in chain([second], _lines(text)))
        return _documents(chain([item], lines), wanted)
    if item is None:
        whole = first + second + text.read(MAX_DOCUMENT)
        item = _parsed(whole)
        if item is None:
            return _Text(wanted, file).read(iter(whole.splitlines(keepends=True)))
    return _documents(item, wanted)


def _parsed(text: str) -> Any:
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return None


def _documents(item: Any, wanted: Wanted) -> list[Sheet]:
    sheets: list[Sheet] = []
    for names, rows in _in_document(item):
        sheet = Sheet(names, [split_unit(name)[1] for name in names], wanted, len(sheets))
        for row in rows:
            sheet.add([_value(each) for each in row])
        sheets.append(sheet)
    return sheets


def _in_document(item: Any) -> Iterator[tuple[list[str], Iterable[Sequence[Any]]]]:
    """Yield names and rows of each table: lists of objects or of rows, objects of lists."""
    match item:
        case {"columns": [str(), *_] as names, "data": [[*_], *_] as rows}:
            yield names, rows
        case [int() | float(), *_]:
            yield [""], zip(item)
        case dict():
            lists = {name: [*each.values()] for name, each in item.items() if _is_numbered(each)}
            lists |= {name: each for name, each in item.items() if isinstance(each, list)}
            flat = {name: each for name, each in lists.items() if not _is_nested(each)}
            sizes = Counter(map(len, flat.values()))
            most = max(sizes, key=lambda size: (sizes[size], size), default=0)
            names = [name for name, each in flat.items() if len(each) == most > 1]
            if names:
                yield names, zip(*(flat[name] for name in names), strict=True)
            for name, each in item.items():
                if name not in flat and isinstance(each, (dict, list)):
                    yield from _in_document(each)
        case str() | None | int() | float() | []:
            pass
        case _:
            yield _of_records(iter(item))


def _of_records(items: Iterator[Any]) -> tuple[list[str], Iterable[Sequence[Any]]]:
    """Return names and rows of objects, or of lists without names."""
    sample = list(islice(items, SAMPLE))
    everything = chain(sample, items)
    keys = dict.fromkeys(name for each in sample if isinstance(each, dict) for name in _flat(each))
    if keys:
        objects = (_flat(each) for each in everything if isinstance(each, dict))
        return list(keys), ([each.get(name) for name in keys] for each in objects)
    rows = (each for each in everything if isinstance(each, list))
    width = max((len(each) for each in sample if isinstance(each, list)), default=0)
    return [""] * width, (each for each in rows if len(each) == width)


def _flat(item: dict[str, Any], above: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in item.items():
        if isinstance(value, dict) and above.count(".") < 3:
            found |= _flat(value, f"{above}{name}.")
        else:
            found[above + name] = value
    return found


def _is_numbered(item: Any) -> bool:
    """Return whether this is a column as pandas writes it, {"0": 1.5, "1": 1.6}."""
    return isinstance(item, dict) and len(item) > 1 and all(name.isdecimal() for name in item)


def _is_nested(items: list[Any]) -> bool:
    return any(isinstance(each, (dict, list)) for each in items)


def _value(item: Any) -> float | None:
    if isinstance(item, (int, float, str)):
        return number(str(item))
    return None


def _of_arrays(stream: io.BufferedReader, wanted: Wanted) -> list[Sheet]:
    """Read an .npz of columns, or an .npy of a column, of columns or of records."""
    try:
        loaded: Any = np.load(io.BytesIO(stream.read()), allow_pickle=False)
        if not isinstance(loaded, np.ndarray):
            members = loaded.zip.namelist()
            if not all(name.endswith(".npy") for name in members):
                raise unreadable("this is a workbook or another archive; save the table as CSV.")
            arrays = {name: loaded[name] for name in loaded}
        elif loaded.dtype.names:
            arrays = {name: loaded[name] for name in loaded.dtype.names}
        else:
            arrays = {"": loaded}
        columns = [
            (name, column.astype(float))
            for name, each in arrays.items()
            if each.ndim in (1, 2) and each.size
            for column in np.reshape(each, (len(each), -1)).T
        ]
    except UserError:
        raise
    except Exception as error:  # a broken archive may raise anything
        raise unreadable(f"its arrays cannot be read: {printable(str(error), 100)}.") from None
    rows = Counter(len(column) for _, column in columns).most_common(1)
    names = [name for name, column in columns if len(column) == rows[0][0]]
    table = np.stack([column for _, column in columns if len(column) == rows[0][0]])
    choice = choose(names, [split_unit(name)[1] for name in names], list(table), wanted)
    sheet = Sheet(names, [split_unit(name)[1] for name in names], wanted)
    sheet.fill(choice, table[choice.columns].T if choice else table.T)
    return [sheet]
