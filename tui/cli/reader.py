"""Read the tables of any program: text of any layout, JSON, NumPy arrays, compressed or not."""

import bz2
import csv
import gzip
import io
import json
import lzma
import re
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from itertools import chain, groupby, islice
from typing import Any

import numpy as np

from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.layouts import FAILED, LAYOUTS, NUMBER, Layout, role
from pendu_tui.tui.cli.tables import SAMPLE, Sheet, Wanted, choose, known_names
from pendu_tui.tui.cli.units import is_unit, plain, split_unit

MAX_LINE = 1 << 20  # bytes
MAX_LINES_BEFORE = 100_000  # the first row
MAX_LINES = 10_000_000  # half a minute, 320 MB; the input may be endless
MAX_DOCUMENT = 1 << 28  # characters of JSON
MAX_COLUMNS = 5000
MAX_NAMES = 500  # of values that are printed with their names
MAX_SHAPES = 10_000
MAX_DEPTH = 8  # of objects in objects
BLOCK = 4096  # lines
_NOT_TEXT = {
    b"\x89MCAP": "a recording; pendu-tui export makes a table of it",
    b"PAR1": "Parquet; save it as CSV",
    b"\x89HDF": "HDF5; save its arrays with numpy.savez",
    b"MATLAB 5": "a MAT-file; save its arrays with numpy.savez",
}
_UNPACK: dict[bytes, Callable[[Any], Any]] = {
    b"\x1f\x8b": gzip.open,
    b"BZh": bz2.open,
    b"\xfd7zXZ": lzma.open,
}
_NUMBER = re.compile(NUMBER)
_IS_FAILED = re.compile(FAILED, re.IGNORECASE)
_FAILED_IN_TEXT = re.compile(rf"(?<![\w.#])(?:{FAILED})(?!\w)", re.IGNORECASE)
_WITH_UNIT = re.compile(rf"({NUMBER})\s?([^\W\d]\S*)")
_FORTRAN_POWER = re.compile(r"(?<=[\d.])[dD](?=[-+]?\d)")
_GLUED = re.compile(r"(?<=\d)(?=[-+]\d)|(?<=\d)(?=\*\*)")  # numbers that Fortran ran together
_IS_UNIT_ALONE = re.compile(r"[(\[][^()\[\]]*[)\]]")
_NO_NUMBERS = {ord(sign): None for sign in "0123456789.+- "}
_PARTS = {"names", "row", "name", "value", "unit", "over", "place", "set", "label"} | {
    *("first", "units", "part", "end", "again", "columns")
}


def read_sheets(stream: io.BufferedReader, wanted: Wanted, file: str = "") -> list[Sheet]:
    """Return the tables of a file in its order.  Raises UserError, with a sentence without name."""
    start = stream.peek(MAX_LINE)
    for magic, unpack in _UNPACK.items():
        if start.startswith(magic):
            try:
                unpacked = io.BufferedReader(unpack(stream))
                return read_sheets(unpacked, wanted, file.rpartition(".")[0])
            except (EOFError, OSError, lzma.LZMAError, zlib.error) as error:
                why = printable(str(error), 100)
                raise unreadable(f"it cannot be unpacked: {why}.") from None
    if not start:
        raise unreadable("the input is empty; nothing to judge.")
    if start.startswith((b"PK\x03\x04", b"\x93NUMPY")):
        return [_of_arrays(stream, wanted)]
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


def check_lines(count: int) -> None:
    """Raise UserError if there are too many lines; the input may be endless."""
    if count > MAX_LINES:
        raise unreadable(f"more than {MAX_LINES:,} lines; leave some out.")


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
        return float(_FORTRAN_POWER.sub("e", text.replace(",", ".")))
    return None


class _Text:
    """Tables in lines of text."""

    def __init__(self, wanted: Wanted, file: str) -> None:
        self._wanted = wanted
        self._units = ("", "")  # of times and energies, if the layout has only these
        self._heads: list[list[list[str]]] = []  # lines without numbers, each divided in ways
        self._labels: dict[int, str] = {}  # names of columns by place
        self._passed = 0  # columns of earlier sets
        self._shared: list[str] = []  # units of xmgrace's y axis
        named = (each.columns for each in LAYOUTS if re.search(f"{each.file}$", file))
        self._columns = list(next(named, ()))
        self._sheets: list[Sheet] = []
        self._sheet: Sheet | None = None
        self._delimiter: str | None = None
        self._opening = ""  # the word with which each row begins
        self._width = 0  # fields in a row
        self._prints = [Sheet(wanted, is_printed=True)]  # of each run
        self._over: list[str] = []  # names above a line of numbers
        self._is_over = False  # the data have ended
        self._begins = False  # a new run
        self._line = 0
        self._shapes: dict[str, list[tuple[str, int]]] = {}  # lines that need no other look

    def read(self, lines: Iterator[str]) -> list[Sheet]:
        """Return the sheets of these lines, in their order."""
        while block := list(islice(lines, BLOCK)):
            for is_alike, group in groupby(block, self._is_like_a_row):
                self._read(list(group), is_alike)
            check_lines(self._line)
            if self._line > MAX_LINES_BEFORE and not self._sheets and not self._prints[0]:
                raise unreadable(f"{self._line:,} lines without a row; is this a table?")
        named = [sheet for sheet in self._sheets if any(sheet.names)]
        for sheet in self._prints:
            sheet.choose()
            if sheet.choice and sheet.choice.energy and not (named and sheet.choice.doubt):
                named.append(sheet)
        return sorted(named or self._sheets, key=lambda sheet: sheet.line)

    def _is_like_a_row(self, line: str) -> bool:
        is_wide = len(line.split(self._delimiter)) == self._width
        is_text = line.startswith(self._opening) and not line.isspace()
        return is_wide and is_text and '"' not in line

    def _read(self, lines: list[str], are_alike: bool) -> None:
        """Read rows like the last one at once, other lines by their shapes."""
        if not are_alike:
            for shape, group in groupby(lines, _shape):
                self._read_shape(shape, list(group))
            return
        for at, line in enumerate(lines):
            sheet = self._sheet
            is_row = not (self._heads or self._over or self._is_over or self._begins)
            if is_row and sheet and len(sheet) >= SAMPLE:
                if sheet.choice is None:
                    sheet.choose()
                block = self._block(sheet, lines[at:])
                if block is not None:
                    sheet.extend(self._line + 1, block, sheet.kept)
                    self._line += len(block)
                    return
            self._take(line)

    def _read_shape(self, shape: str, lines: list[str]) -> None:
        """Read lines of one shape, which the layouts need to see only once."""
        for at, line in enumerate(lines):
            holds = self._shapes.get(shape)
            is_known = holds is not None and not self._over and not self._is_over
            if is_known and self._extend(holds or [], lines[at:]):
                return
            found = self._take(line)
            if found is not None and len(self._shapes) < MAX_SHAPES:
                self._shapes[shape] = found

    def _extend(self, holds: list[tuple[str, int]], lines: list[str]) -> bool:
        """Read lines of a shape that is known.  Return whether all hold the same."""
        if holds:
            numbers = _NUMBER.findall("".join(lines))
            if len(numbers) != holds[0][1] * len(lines):
                return False
            try:
                block = np.array(numbers, dtype=float).reshape(len(lines), -1)
            except ValueError:  # Fortran's D
                return False
            places = [self._prints[-1].place(name, self._unit(name)) for name, _ in holds[1:]]
            block = block[:, [at for _, at in holds[1:]]]
            self._prints[-1].extend(self._line + 1, block, places)
        self._line += len(lines)
        return True

    def _block(self, sheet: Sheet, lines: list[str]) -> Any:
        """Return the kept columns of rows, (n, len(kept)), None if one has no number there."""
        text = "".join(lines)
        for is_clean in (False, True):
            if is_clean:
                text = _FORTRAN_POWER.sub("e", _FAILED_IN_TEXT.sub("nan", text))
                text = re.sub(r"[()\[\]]", "", text)
                if self._delimiter != ",":
                    text = text.replace(",", ".")
            with suppress(ValueError):
                return np.loadtxt(
                    text.splitlines(),
                    delimiter=self._delimiter,
                    comments=None,
                    usecols=sheet.kept,
                    ndmin=2,
                )
        return None

    def _take(self, line: str) -> list[tuple[str, int]] | None:
        """Read one line: what a layout finds in it, or else words or a row.

        Return what lines of this shape hold, if it is nothing, or numbers with their names: the
        names with the places of their numbers, behind the count of all numbers in the line.
        """
        self._line += 1
        if self._over:
            names = self._over
            self._over = []
            values = [number(field) for field in line.split()]
            if len(values) == len(names) and None not in values:
                for name, value in zip(names, values, strict=True):
                    self._print(name, value)
                return None
        begins: dict[str, int] = {}  # of the numbers
        is_data = False
        for layout in LAYOUTS:
            for match in layout.pattern.finditer(line):
                if any(layout.units):
                    self._units = layout.units
                groups = {
                    name: text for name, text in match.groupdict().items() if text is not None
                }
                for name in groups.keys() - _PARTS:
                    begins[name] = match.start(name)
                    self._print(name, number(groups[name]))
                if "value" in groups:
                    begins[groups["name"]] = match.start("value")
                is_data |= self._found(layout, groups)
            if is_data:
                break
        if not is_data:
            if not self._is_over and self._words_or_row(line):
                return []
            return None
        places = [match.start() for match in _NUMBER.finditer(line)]
        if begins and set(begins.values()) <= set(places):
            return [("", len(places)), *((name, places.index(at)) for name, at in begins.items())]
        return None

    def _found(self, layout: Layout, groups: dict[str, str]) -> bool:
        """Take what a layout found.  Return whether that is all there is in the line."""
        match groups:
            case {"part": _}:
                self._begins = True
                self._is_over = False
                self._passed += max(self._width - 1, 0)
                self._prints.append(Sheet(self._wanted, self._line, is_printed=True))
            case {"end": _}:
                self._is_over = True
            case {"again": _}:
                self._is_over = False
            case _ if self._is_over:
                pass
            case {"name": name, "value": value}:
                self._print(name, number(value), groups.get("unit", ""))
            case {"names": text}:
                self._heads = [_ways(text, layout.cells)]
            case {"columns": text}:
                self._columns = re.findall(layout.cells, text)
            case {"over": text}:
                self._over = [name.strip() for name in re.findall(layout.cells, text)]
            case {"row": text}:
                fields, delimiter = _fields(text, glued=True)
                opening = fields[0]
                if number(opening) is not None:
                    opening = ""
                self._row(fields, delimiter, opening)
            case {"set": place, "label": label}:
                self._labels[int(place) + 1] = label
            case {"place": place, "label": label}:
                self._labels[int(place) - 1] = label
            case {"first": label}:
                self._labels[0] = label
            case {"units": units}:
                self._shared = re.findall(r"\(([^()]*)\)", units)
            case _:
                return False
        return True

    def _print(self, name: str, value: float | None, unit: str = "") -> None:
        sheet = self._prints[-1]
        if value is not None and (name in sheet.places or len(sheet.places) < MAX_NAMES):
            sheet.put(sheet.place(name, unit or self._unit(name)), self._line, value)

    def _unit(self, name: str) -> str:
        """Return the unit of a column by its name, or that of its layout's times or energies."""
        kind = role(name)[0]
        default = {"time": self._units[0], "step": "", "other": "", "error": "", "": ""}
        return split_unit(name)[1] or default.get(kind, self._units[1])

    def _words_or_row(self, line: str) -> bool:
        """Read a row, or words that may be a head.  Return whether it is neither."""
        text = line.strip()
        bare = text.lstrip("#@!%; \t")
        if text.startswith("@") or not re.search(r"[\w*]", text):
            return False  # what else xmgrace is told, or a rule
        is_comment = bare != text and number(text.split()[0]) is None
        fields, delimiter = _fields(bare)
        if len(fields) > MAX_COLUMNS:
            return True
        if delimiter is None and len(fields) != self._width:
            divided = _fields(bare, glued=True)[0]
            if len(divided) == self._width:
                fields = divided
        has_number = any(number(each) is not None for each in fields)
        if has_number and not is_comment and self._row(fields, delimiter):
            return False
        if not has_number:
            self._heads = [*self._heads[-20:], _ways(bare)]
        is_like = len(fields) == self._width
        return has_number and not is_like and (is_comment or number(fields[0]) is None)

    def _row(self, fields: list[str], delimiter: str | None, opening: str = "") -> bool:
        """Add a row to its table, which may begin here.  Return whether it is a row."""
        numbers = [number(each) for each in fields]
        is_like = len(fields) == self._width and opening == self._opening
        is_new = self._heads or self._begins or not is_like
        if is_new and self._begin(fields, numbers, opening, delimiter):
            self._delimiter = delimiter
            self._width = len(fields)
            self._opening = opening
            is_like = True
        sheet = self._sheet
        if sheet is None or not is_like:
            if sheet and opening == self._opening and (opening or numbers[0] is not None):
                sheet.skipped += 1
            return False
        sheet.put_row(self._line, numbers)
        return True

    def _begin(
        self,
        fields: list[str],
        numbers: list[float | None],
        opening: str,
        delimiter: str | None,
    ) -> bool:
        """Look for the head of this row.  Return whether a table begins, or goes on below it."""
        before = self._sheet
        names = self._head(fields, numbers)
        if names is None:
            is_like = len(fields) == self._width and opening == self._opening
            names = [""] * len(fields)
            rest = numbers[bool(opening) :]
            is_bare = delimiter and not self._heads  # rows that were cut out of a table
            is_row = None not in rest or self._worth(names, numbers) > 0
            is_row |= bool(is_bare) and len(rest) > rest.count(None) + 1
            is_below = before and not self._begins and (is_like or any(before.names))
            if is_below or not is_row:
                if is_like:
                    self._heads = []
                return False
            names = self._labelled(len(fields))
        units = self._units_of(names, fields)
        has_text = len(self._heads) > 1  # between this head and the rows above
        self._heads = []
        if before and before.names == names and not self._begins:
            repeats = has_text and before.last_time() in numbers  # as at the start of a run
            if not repeats:  # a page of the same table, or a restart
                return True
        self._begins = False
        self._sheet = Sheet(self._wanted, self._line)
        for name, unit in zip(names, units, strict=True):
            self._sheet.add_column(name, unit)
        self._sheets.append(self._sheet)
        return True

    def _head(self, fields: list[str], numbers: list[float | None]) -> list[str] | None:
        """Return the best names above that fit a row, None without any."""
        found: list[str] | None = None
        most = 0
        width = len(fields)
        above = (names for ways in reversed(self._heads) for names in ways)
        labels = [names for names in (self._labelled(width),) if any(names)]
        for names in chain(labels, above, [self._columns]):
            if len(names) == width - 1 and fields[-1] == "":
                names = [*names, ""]
            elif len(names) == width - 1 and numbers[0] is not None and known_names(names) > 1:
                names = ["", *names]  # the rows are numbered
            elif names is self._columns:
                names = [*names, *[""] * (width - len(names))]
            if len(names) == width and (worth := self._worth(names, numbers)) > most:
                found = names
                most = worth
        return found

    def _worth(self, names: list[str], numbers: list[float | None]) -> int:
        """Return how sure it is that these are the names of a row, 0 if they are not."""
        if any(map(_IS_UNIT_ALONE.fullmatch, names)):
            return 0
        choice = choose(names, [""] * len(names), [()] * len(names), self._wanted)
        known = known_names(names)
        if choice and None in [numbers[place] for place in choice.columns]:
            return 0
        asked = [text for text in (self._wanted.time, self._wanted.energy) if choice and text]
        if not all(map(str.isdecimal, asked)):
            return len(names) + 1
        if known > 1:
            return known
        is_data = any(number(name) is not None for name in names)
        is_first = self._sheet is None or self._begins
        return int(is_first and not is_data and (bool(asked) or None not in numbers))

    def _labelled(self, width: int) -> list[str]:
        """Return the names that lines above gave to single columns."""
        places = [0, *range(1 + self._passed, width + self._passed)]
        return [self._labels.get(place, "") for place in places]

    def _units_of(self, names: list[str], fields: list[str]) -> list[str]:
        """Return the unit of each column, as far as it is certain to be its own."""
        units = [self._unit(name) for name in names]
        rows = (row for ways in self._heads if names not in ways for row in ways)
        for row in ([each.strip("()[]") for each in row] for row in rows):
            if len(row) == len(names) and any(map(is_unit, row)) and not any(units):
                units = row
        energies = [unit for unit in self._shared if plain("energy", unit) and unit != "K"]
        for place, name in enumerate(names):
            match = _WITH_UNIT.fullmatch(fields[place])
            is_energy = role(name)[0] in ("conserved", "total", "kinetic", "potential")
            if units[place]:
                continue
            if place and len(self._shared) == 1:
                units[place] = self._shared[0]
            elif is_energy and len(energies) == 1:
                units[place] = energies[0]
            elif match and is_unit(match[2]):
                units[place] = match[2]
        return units


def _shape(line: str) -> str:
    """Return a line without its numbers; lines that are alike have the same."""
    return line.translate(_NO_NUMBERS)


def _ways(text: str, cells: str = "") -> list[list[str]]:
    """Return the names in a head, divided in each way that there may be."""
    text = _without_bars(text.strip().rstrip(",; "))
    if cells:
        return [[name.strip() for name in re.findall(cells, text)]]
    ways = [_split(text, sign) for sign in "\t;,| " if sign in text or sign == " "]
    ways.append(re.split(r"\s{2,}", text))  # names may contain single blanks
    ways.append(re.sub(r"\s+(?=[(\[])", "\0", text).split())  # or a blank before the unit
    ways.append(re.split(r"(?<=[)\]])\s+", text))  # or end with the unit
    return [[name.replace("\0", " ").strip(" '\"#") for name in names] for names in ways if names]


def _without_bars(text: str) -> str:
    """Return a row without the bars at its ends, as Markdown has them."""
    if len(text) > 1 and text[0] == text[-1] == "|":
        return text[1:-1]
    return text


def _split(text: str, delimiter: str) -> list[str]:
    with suppress(csv.Error, ValueError):
        (fields,) = csv.reader([text.strip(" \r\n")], delimiter=delimiter, skipinitialspace=True)
        return [field.strip() for field in fields]
    return []


def _fields(text: str, glued: bool = False) -> tuple[list[str], str | None]:
    """Return the fields of a row and what separates them, None for blanks."""
    text = _without_bars(text.strip())
    bare = re.sub(r'"[^"]*"', "", text)
    for sign in [sign for sign in "\t;,|" if sign in bare]:
        fields = _split(text, sign)
        if fields and not any(re.search(r"\d\s+[-+.\d]", field) for field in fields):
            return fields, sign
    if glued:
        text = _GLUED.sub(" ", text)
    return _split(text, " ") or [""], None


def _of_json(text: io.TextIOBase, wanted: Wanted, file: str) -> list[Sheet]:
    """Read JSON: an object or a list a line, or one document."""
    first = next(
        (line for line in iter(lambda: text.readline(MAX_DOCUMENT), "") if line.strip()), ""
    )
    second = text.readline(MAX_DOCUMENT)
    items: Any = [_parsed(first)]
    if items[0] is not None and second.strip():
        items = chain(items, map(_parsed, chain([second], _lines(text))))
    elif items[0] is None:
        whole = first + second + text.read(MAX_DOCUMENT)
        items = [_parsed(whole)]
        if items[0] is None:
            return _Text(wanted, file).read(iter(whole.splitlines(keepends=True)))
    if isinstance(items, list):
        items = _records(items[0])
    sheet = Sheet(wanted, is_printed=True)
    for line, item in enumerate(items):
        for name, text in _flat(item):
            value = number(str(text))
            if value is not None and (name in sheet.places or len(sheet.places) < MAX_NAMES):
                sheet.put(sheet.place(name, split_unit(name)[1]), line, value)
        check_lines(line)
    return [sheet]


def _parsed(text: str) -> Any:
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return None


def _records(item: Any, depth: int = 0) -> Iterable[Any]:
    """Return the objects or rows in a document: those of a list, or of lists in an object."""
    if isinstance(item, list):
        return item
    if not isinstance(item, dict) or depth > MAX_DEPTH:
        return []
    if isinstance(item.get("columns"), list) and isinstance(item.get("data"), list):
        return [dict(zip(item["columns"], row, strict=False)) for row in item["data"]]
    columns = {
        name: [*each.values()] if isinstance(each, dict) else each
        for name, each in item.items()
        if isinstance(each, list) or (isinstance(each, dict) and all(map(str.isdecimal, each)))
    }
    flat = {
        name: each
        for name, each in columns.items()
        if len(each) > 1 and not isinstance(each[0], (dict, list))
    }
    size = max(map(len, flat.values()), default=0)
    names = [name for name, each in flat.items() if len(each) == size]
    if names:
        return [
            dict(zip(names, row, strict=True))
            for row in zip(*(flat[name] for name in names), strict=True)
        ]
    found = (_records(each, depth + 1) for each in item.values())
    return next((each for each in found if each), [])


def _flat(item: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of an object with their names; those of a list have numbers."""
    if isinstance(item, dict) and name.count(".") < MAX_DEPTH:
        for inner, value in item.items():
            yield from _flat(value, f"{name}.{inner}".lstrip("."))
    elif isinstance(item, list) and not name:
        for place, value in enumerate(item, 1):
            yield str(place), value
    elif not isinstance(item, list):
        yield name, item


def _of_arrays(stream: io.BufferedReader, wanted: Wanted) -> Sheet:
    """Read an .npz of columns, or an .npy of a column, of columns or of records."""
    try:
        loaded: Any = np.load(io.BytesIO(stream.read()), allow_pickle=False)
        names: Any = getattr(loaded, "files", None) or loaded.dtype.names or [""]
        if hasattr(loaded, "zip") and not all(
            name.endswith(".npy") for name in loaded.zip.namelist()
        ):
            raise unreadable("this is a workbook or another archive; save the table as CSV.")
        arrays = [(name, loaded[name or ...]) for name in names]
        columns = [
            (name, column.astype(float))
            for name, each in arrays
            if each.ndim in (1, 2) and each.size
            for column in np.reshape(each, (len(each), -1)).T
        ]
    except UserError:
        raise
    except Exception as error:  # a broken archive may raise anything
        raise unreadable(f"its arrays cannot be read: {printable(str(error), 100)}.") from None
    sheet = Sheet(wanted)
    rows = Counter(len(column) for _, column in columns).most_common(1)
    long = [(name, column) for name, column in columns if len(column) == rows[0][0]]
    for name, _ in long:
        sheet.add_column(name, split_unit(name)[1])
    sheet.extend(0, np.stack([column for _, column in long], axis=1), sheet.kept)
    return sheet
