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
from itertools import chain
from typing import Any

import numpy as np

from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.layouts import FAILED, LAYOUTS, NUMBER, Layout, is_energy, role
from pendu_tui.tui.cli.tables import SAMPLE, Sheet, Wanted, choose, known_names
from pendu_tui.tui.cli.units import is_unit, plain, split_unit

MAX_LINE = 1 << 20  # bytes
MAX_LINES_BEFORE = 100_000  # the first row
MAX_LINES = 5_000_000  # some seconds; the input may be endless
TOO_MANY = f"more than {MAX_LINES:,} lines; leave some out."
MAX_DOCUMENT = 1 << 28  # characters of JSON
MAX_COLUMNS = 5000
MAX_SHAPES = 10_000
MAX_HEADS = 20  # lines that may be the head of the next row
BLOCK = 1 << 16  # characters
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
_NUMBER_LIKE = re.compile(r"[-+.\d][\d.]*(?:[eEdD][-+]?\d+)?")  # three times as fast as NUMBER
_IS_FAILED = re.compile(FAILED, re.IGNORECASE)
_WITH_UNIT = re.compile(rf"({NUMBER})\s?([^\W\d]\S*)")
_GLUED = re.compile(r"(?<=\d)(?=[-+]\d)|(?<=\d)(?=\*\*)")  # numbers that Fortran ran together
_IS_UNIT_ALONE = re.compile(r"[(\[][^()\[\]]*[)\]]")
_NO_NUMBERS = {ord(sign): None for sign in "0123456789.+-"}
_FORTRAN_POWERS = str.maketrans("dD", "ee")


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
    elif b"\0" in start:
        raise unreadable("this is not text.")
    text = io.TextIOWrapper(stream, encoding=encoding, errors="replace")
    if start.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"["):
        return _of_json(text, wanted, file)
    return _Text(wanted, file).read(_blocks(text))


def unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)


def _blocks(text: io.TextIOBase) -> Iterator[list[str]]:
    """Yield lines, many at a time.  Raises UserError where there is no end to them."""
    count = 0
    rest = ""
    while chunk := text.read(BLOCK):
        *lines, rest = (rest + chunk).split("\n")
        count += len(lines)
        if count > MAX_LINES:
            raise unreadable(TOO_MANY)
        if len(rest) > MAX_LINE:
            raise unreadable("a line is longer than 1 MB; is this a table?")
        yield lines
    yield [rest]


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
        return float(text.replace(",", ".").translate(_FORTRAN_POWERS))
    return None


class _Text:
    """Tables in lines of text."""

    def __init__(self, wanted: Wanted, file: str) -> None:
        self._wanted = wanted
        self._units = ("", "")  # of times and energies, if the layout has only these
        self._heads: dict[str, list[list[str]]] = {}  # lines of words, divided in ways
        self._labels: dict[int, str] = {}  # names of columns by place
        self._passed = 0  # columns of earlier sets
        self._shared: list[str] = []  # units of xmgrace's y axis
        named = (each.columns for each in LAYOUTS if re.search(f"{each.file}$", file))
        self._columns = list(next(named, ()))
        self._sheets: list[Sheet] = []
        self._delimiter: str | None = None
        self._opening = ""  # the word with which each row begins
        self._width = 0  # fields in a row
        self._prints = [Sheet(wanted, is_printed=True)]  # of each run
        self._over: list[str] = []  # names above a line of numbers
        self._is_over = False  # the data have ended
        self._begins = False  # a new run
        self._line = 0
        self._remarks = 0  # lines of text since the last row
        self._shapes: dict[str, list[tuple[str, int]]] = {}  # what lines of known shapes hold

    def read(self, blocks: Iterable[list[str]]) -> list[Sheet]:
        """Return the sheets of these lines, in their order."""
        for block in blocks:
            at = 0
            while at < len(block):
                at += self._read_known(block[at:]) or self._read_line(block[at])
            if self._line > MAX_LINES_BEFORE and not self._sheets and not self._prints[0]:
                raise unreadable(f"{self._line:,} lines without a row; is this a table?")
        named = [sheet for sheet in self._sheets if any(sheet.names)]
        for sheet in self._prints:
            sheet.choose()
            if sheet.choice and sheet.choice.energy and not (named and sheet.choice.doubt):
                named.append(sheet)
        return sorted(named or self._sheets, key=lambda sheet: sheet.line)

    def _read_known(self, lines: list[str]) -> int:
        """Read the first of these lines, as far as they are like earlier ones; count them."""
        if self._heads or self._over or self._is_over or self._begins:
            return 0
        rows: list[int] = []
        others: dict[str, list[int]] = {}
        for place, line in enumerate(lines):
            is_row = self._width > 0 and self._is_like_a_row(line)
            if is_row and not line.lstrip()[:1].isalpha():
                rows.append(place)
                continue
            shape = line.translate(_NO_NUMBERS)
            if shape in self._shapes:
                others.setdefault(shape, []).append(place)
            elif is_row:
                rows.append(place)
            else:
                lines = lines[:place]
                break
        count = self._read_rows(lines, rows)
        for shape, places in others.items():
            self._read_shape(shape, lines, [place for place in places if place < count])
        below = max((place + 1 for place in rows if place < count), default=0)
        if below:
            self._remarks = 0
        self._remarks += sum(map(bool, map(str.strip, lines[below:count])))
        self._line += count
        return count

    def _is_like_a_row(self, line: str) -> bool:
        is_wide = len(_split(line, self._delimiter)) == self._width
        return is_wide and line.startswith(self._opening) and line.strip() != ""

    def _read_rows(self, lines: list[str], rows: list[int]) -> int:
        """Read the lines at these places into the last table.  Return how many lines are done."""
        if not rows:
            return len(lines)
        sheet = self._sheets[-1]
        if len(sheet) < SAMPLE:
            return rows[0]
        if sheet.choice is None:
            sheet.choose()
        texts = [lines[place] for place in rows]
        with suppress(ValueError):
            block = np.loadtxt(
                texts,
                delimiter=self._delimiter,
                comments=None,
                quotechar='"',
                usecols=sheet.kept,
                ndmin=2,
            )
            sheet.extend(self._line + 1 + np.array(rows), block, sheet.kept)
            return len(lines)
        for place, text in zip(rows, texts, strict=True):
            fields = _split(text, self._delimiter)
            numbers = {at: number(fields[at]) for at in sheet.kept}
            if numbers[sheet.kept[0]] is None:
                return place
            sheet.put_row(self._line + 1 + place, numbers)
        return len(lines)

    def _read_shape(self, shape: str, lines: list[str], places: list[int]) -> None:
        """Read the lines at these places, which have a known shape.

        They hold nothing, or numbers: a count, and names with their places in it, -1 for nan.
        """
        holds = self._shapes[shape]
        if not holds or not places:
            return
        text = "\n".join([lines[place] for place in places]).replace("D", "e").replace("d", "e")
        numbers = _NUMBER_LIKE.findall(text)
        count = holds[0][1]
        nans = ["nan"] * len(places)
        try:
            if len(numbers) != count * len(places):
                raise ValueError
            columns = [[*map(float, nans if at < 0 else numbers[at::count])] for _, at in holds[1:]]
        except ValueError:
            first = self._line
            for place in places:
                self._line = first + place
                self._read_line(lines[place])
            self._line = first
            return
        sheet = self._prints[-1]
        kept = [sheet.place(name, self._unit(name)) for name, _ in holds[1:]]
        sheet.extend(self._line + 1 + np.array(places), np.array(columns).T, kept)

    def _read_line(self, line: str) -> int:
        """Read one line: what a layout finds in it, or else words or a row.  Return 1."""
        self._line += 1
        self._remarks += bool(line.strip())
        if self._read_below(line):
            return 1
        values: dict[str, tuple[int, str]] = {}
        is_data = False
        for layout in LAYOUTS:
            for match in layout.pattern.finditer(line):
                if any(layout.units):
                    self._units = layout.units
                groups = {name: text for name, text in match.groupdict().items() if text}
                is_data |= self._found(layout, line, groups)
                if "value" in groups:
                    values[groups["name"]] = (match.start("value"), groups["value"])
                if "step" in groups:
                    values["Step"] = (match.start("step"), groups["step"])
            if is_data:
                break
        is_nothing = not is_data and not self._is_over and self._words_or_row(line)
        if is_nothing or values:
            self._remember(line, values)
        return 1

    def _remember(self, line: str, values: dict[str, tuple[int, str]]) -> None:
        """Remember what lines of this shape hold: these values, at their places in the line."""
        numbers = {match.start(): match[0] for match in _NUMBER_LIKE.finditer(line)}
        holds = [("", len(numbers))]
        for name, (start, text) in values.items():
            if re.search(r"\d", name):  # another name may have the same shape
                return
            if numbers.get(start) == text:
                holds.append((name, [*numbers].index(start)))
            elif _IS_FAILED.fullmatch(text):
                holds.append((name, -1))
            else:
                return
        shape = line.translate(_NO_NUMBERS)
        if len(self._shapes) < MAX_SHAPES and re.search(r"[^\W\d_]", shape):
            self._shapes[shape] = holds if values else []

    def _read_below(self, line: str) -> bool:
        """Read values below their names.  Return whether there are such."""
        names = self._over
        self._over = []
        values = [number(field) for field in line.split()]
        is_below = bool(names) and len(values) == len(names) and None not in values
        if is_below:
            for name, value in zip(names, values, strict=True):
                self._print(name, value)
        return is_below

    def _found(self, layout: Layout, line: str, groups: dict[str, str]) -> bool:
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
            case {"step": value}:
                self._print("Step", number(value))
                return False
            case {"names": text}:
                self._heads = {line: _ways(text, layout.cells)}
            case {"over": text}:
                self._over = [name.strip() for name in re.findall(layout.cells, text)]
            case {"row": text}:
                fields, delimiter = _fields(text, glued=True)
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
            case _:
                return False
        return True

    def _print(self, name: str, value: float | None, unit: str = "") -> None:
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
            self._heads[line] = _ways(bare)
            if len(self._heads) > MAX_HEADS:
                del self._heads[next(iter(self._heads))]
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
        if is_like:
            self._remarks = 0
            self._sheets[-1].put_row(self._line, dict(enumerate(numbers)))
        elif self._sheets and opening == self._opening and (opening or numbers[0] is not None):
            self._sheets[-1].skipped += 1
        return is_like

    def _begin(
        self,
        fields: list[str],
        numbers: list[float | None],
        opening: str,
        delimiter: str | None,
    ) -> bool:
        """Look for the head of this row.  Return whether a table begins, or goes on below it."""
        before = self._sheets[-1] if self._sheets else None
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
                    self._pass_over_heads()
                return False
            names = self._labelled(len(fields))
        units = self._units_of(names, fields)
        self._heads.clear()
        if before and before.names == names and not self._begins:
            repeats = self._remarks > 2 and before.last_time() in numbers  # as a run starts
            if not repeats:  # a page of the same table, or a restart
                return True
        self._begins = False
        self._sheets.append(Sheet(self._wanted, self._line))
        for name, unit in zip(names, units, strict=True):
            self._sheets[-1].add_column(name, unit)
        return True

    def _pass_over_heads(self) -> None:
        """Forget lines that are no heads, and remember those that never will be."""
        for line, ways in self._heads.items():
            if not self._begins and not any(map(self._worth, ways)):
                self._remember(line, {})
        self._heads.clear()

    def _head(self, fields: list[str], numbers: list[float | None]) -> list[str] | None:
        """Return the best names above that fit a row, None without any."""
        found: list[str] | None = None
        most = 0
        width = len(fields)
        above = (names for ways in [*self._heads.values()][::-1] for names in ways)
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

    def _worth(self, names: list[str], numbers: list[float | None] | None = None) -> int:
        """Return how sure it is that these are the names of a row, 0 if they are not.

        Without numbers they are those of any row.
        """
        if any(map(_IS_UNIT_ALONE.fullmatch, names)):
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
        energies = [unit for unit in self._shared if plain("energy", unit) and unit != "K"]
        for place, name in enumerate(names):
            match = _WITH_UNIT.fullmatch(fields[place])
            if units[place]:
                continue
            if place and len(self._shared) == 1:
                units[place] = self._shared[0]
            elif is_energy(name) and len(energies) == 1:
                units[place] = energies[0]
            elif match and is_unit(match[2]):
                units[place] = match[2]
        return units


def _ways(text: str, cells: str = "") -> list[list[str]]:
    """Return the names in a head, divided in each way that there may be."""
    text = _without_bars(text.strip().rstrip(",; "))
    if cells:
        return [[name.strip() for name in re.findall(cells, text)]]
    ways = [_split(text, sign) for sign in ("\t", ";", ",", "|", None) if (sign or text) in text]
    ways.append(re.split(r"\s{2,}", text))  # names may contain single blanks
    ways.append(re.sub(r"\s+(?=[(\[])", "\0", text).split())  # or a blank before the unit
    ways.append(re.split(r"(?<=[)\]])\s+", text))  # or end with the unit
    return [[name.replace("\0", " ").strip(" '\"#") for name in names] for names in ways if names]


def _without_bars(text: str) -> str:
    """Return a row without the bars at its ends, as Markdown has them."""
    if len(text) > 1 and text[0] == text[-1] == "|":
        return text[1:-1]
    return text


def _split(text: str, delimiter: str | None) -> list[str]:
    """Return the fields between delimiters, None for blanks; what is in quotes is one field."""
    if '"' not in text:
        return text.strip(" \r\n").split(delimiter)
    with suppress(csv.Error, ValueError):
        (fields,) = csv.reader(
            [text.strip(" \r\n")], delimiter=delimiter or " ", skipinitialspace=True
        )
        return fields
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
    return _split(text, None) or [""], None


def _of_json(text: io.TextIOBase, wanted: Wanted, file: str) -> list[Sheet]:
    """Read JSON: an object or a list a line, or one document."""
    lines = _lines(text)
    first = next((line for line in lines if line.strip()), "")
    second = next(lines, "")
    item = _parsed(first)
    items: Iterable[Any] = _records(item)
    if item is not None and second.strip():
        items = chain([item], map(_parsed, chain([second], lines)))
    elif item is None:
        whole = first + second + text.read(MAX_DOCUMENT)
        item = _parsed(whole)
        if item is None:
            return _Text(wanted, file).read([whole.split("\n")])
        items = _records(item)
    sheet = Sheet(wanted, is_printed=True)
    for line, item in enumerate(items):
        for name, text in _flat(item):
            sheet.print(name, split_unit(name)[1], line, number(str(text)))
    return [sheet]


def _lines(text: io.TextIOBase) -> Iterator[str]:
    for _ in range(MAX_LINES):
        line = text.readline(MAX_DOCUMENT)
        if not line:
            return
        yield line
    raise unreadable(TOO_MANY)


def _parsed(text: str) -> Any:
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return None


def _records(item: Any) -> Iterable[Any]:
    """Return the objects or rows in a document: those of a list, or of lists in an object."""
    if isinstance(item, list):
        return item
    if not isinstance(item, dict):
        return []
    columns = {}
    for name, each in item.items():
        if isinstance(each, dict) and all(map(str.isdecimal, each)):  # pandas
            each = [*each.values()]
        if isinstance(each, list) and len(each) > 1 and not isinstance(each[0], (dict, list)):
            columns[name] = each
    size = max(map(len, columns.values()), default=0)
    columns = {name: each for name, each in columns.items() if len(each) == size}
    if columns:
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return next(filter(None, map(_records, item.values())), [])


def _flat(item: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of an object with their names; those of a list have numbers."""
    if isinstance(item, dict):
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
    block = np.stack([column for _, column in long], axis=1)
    sheet.extend(np.arange(len(block)), block, sheet.kept)
    return sheet
