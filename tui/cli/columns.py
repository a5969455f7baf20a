"""Two columns of another program's table: times and energies from a CSV, an .xvg, a log, a file or stdin.

Lines are read one by one, so a table may stand between other text.  The delimiter is that of the header: a tab, a
semicolon, a comma or blanks.  Lines that start with # or @ are comments, but for names of columns: those of a header
after a #, and of `@ s0 legend "Total Energy"` and `@ xaxis label "Time (ps)"` as GROMACS writes them.
"""

import csv
import math
import re
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice

from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.options import did_you_mean

MOST_NAMES = 200  # of columns, in a hint
LATEST = 1e300  # a time; squares and differences of later ones overflow
MOST_BETWEEN = 20  # lines between a header and the first row, such as units
REASONS = {
    "text_or_gap": "text or a gap",
    "time_not_later": "time not later than before",
    "time_not_finite": "time not finite",
    "energy_not_finite": "energy not finite",
}
"""Why a line below the header is not used: in JSON, and for people."""

_LEGEND = re.compile(r'@\s*(?:s(\d+)\s+legend|(xaxis)\s+label)\s+"(.*)"')
_UNIT = re.compile(r"\s*[(\[].*[)\]]$")


@dataclass
class Columns:
    """What was read."""

    times: "array[float]" = field(default_factory=lambda: array("d"))
    energies: "array[float]" = field(default_factory=lambda: array("d"))  # finite, one a time, in increasing time
    skipped: dict[str, int] = field(default_factory=lambda: dict.fromkeys(REASONS, 0))  # why -> how many lines
    diverged_at: float | None = None  # the time from which on energies are nan or inf, to the end


def read_columns(lines: Iterable[str], time: str, energy: str) -> Columns:
    """Read the columns of these names, or numbers from 1.  Raises UserError if there are none."""
    found = Columns()
    rows, delimiter, places = _header(iter(lines), (time, energy))
    last, failed = -LATEST, None
    times, energies, skipped = found.times, found.energies, found.skipped
    most = max(places) + 1
    words = [_plain(name) for name in (time, energy)]
    decimal_commas = False
    for line in rows:
        if decimal_commas:
            line = line.replace(",", ".")
        try:
            fields = line.split(delimiter, most) if '"' not in line else _fields(line, delimiter, most)
            now, value = float(fields[places[0]]), float(fields[places[1]])
        except (ValueError, IndexError):
            if not (text := line.strip()) or text[0] in "#@":
                continue
            fields = _fields(line, delimiter)
            if all(word in text.casefold() for word in words) and (again := _places(fields, (time, energy))):
                places, most = again, max(again) + 1  # a log's next run
                continue
            numbers = [_number(fields[place]) for place in places if place < len(fields)]
            read = [number for number in numbers if number is not None]
            if len(read) < len(places):
                skipped["text_or_gap"] += 1
                continue
            now, value = read
            decimal_commas = delimiter != "," and "," in fields[places[1]]
        if not last < now < LATEST:
            skipped["time_not_later" if now <= last else "time_not_finite"] += 1
            continue
        last = now
        if not math.isfinite(value):
            skipped["energy_not_finite"] += 1
            failed = now if failed is None else failed
            continue
        failed = None
        times.append(now)
        energies.append(value)
    found.diverged_at = failed
    return found


def _number(text: str) -> float | None:
    """A number, also with a decimal comma, or with Fortran's D."""
    try:
        return float(text.strip().replace(",", ".").replace("D", "e").replace("d", "e"))
    except ValueError:
        return None


def _fields(line: str, delimiter: str | None, most: int = -1) -> list[str]:
    """The fields of a line, or the first `most` and the rest of it."""
    texts = line.split(delimiter, most)
    if '"' not in line:
        return [text.strip() for text in texts]
    if delimiter is not None and not any(text.count('"') % 2 for text in texts[:-1]):  # no delimiter within quotes
        return [text.strip().strip('"') for text in texts]
    if delimiter is None:
        return [a or b for a, b in re.findall(r'"([^"]*)"|(\S+)', line)]
    return [text.strip() for text in next(csv.reader([line.replace("\r", " ").strip()], delimiter=delimiter), [])]


def _header(lines: Iterator[str], names: Sequence[str]) -> tuple[Iterator[str], str | None, tuple[int, ...]]:
    """The lines of the table, its delimiter, and the places of two columns."""
    legend: dict[int, str] = {}
    header: list[str] = []
    empty = True
    for line in lines:
        empty = False
        if match := _LEGEND.match(line):
            legend[0 if match[2] else int(match[1]) + 1] = match[3]
            continue
        delimiter, is_comment = _delimiter(line), line.lstrip()[:1] in ("#", "@")
        fields = _fields(line.lstrip("#@ \t") if is_comment else line, delimiter)
        if places := _places(fields, names):
            return *_first_row(lines, delimiter), places
        if _has_numbers(fields) and not is_comment:
            known = [legend.get(place, "") for place in range(len(fields))]
            if places := _places(known, names) or _numbered(names, len(fields)):
                return chain([line], lines), delimiter, places
        elif len(fields) > len(header):
            header = fields[:MOST_NAMES]
    if empty:
        raise UserError("the input is empty; nothing to judge.", Exit.INPUT_UNREADABLE)
    raise _missing(names, list(legend.values()) or header)


def _first_row(lines: Iterator[str], delimiter: str | None) -> tuple[Iterator[str], str | None]:
    """The lines below a header, and the delimiter of the first of them that has numbers."""
    before: list[str] = []
    for line in islice(lines, MOST_BETWEEN):
        before.append(line)
        if _has_numbers(_fields(line, own := _delimiter(line))):
            delimiter = own
            break
    return chain(before, lines), delimiter


def _missing(names: Sequence[str], header: list[str]) -> UserError:
    lost = next((name for name in names if not name.isdecimal() and _place(header, name) is None), None)
    if lost is None:
        return UserError(f"no line has numbers in the columns {' and '.join(names)}.", Exit.INPUT_UNREADABLE)
    known = [printable(name, 40) for name in header[:20] if name]
    others = f"; choose from {', '.join(known)}." if known else "; give columns by number, from 1."
    return UserError(f"there is no column {printable(lost)!r}{did_you_mean(lost, known) or others}")


def _has_numbers(fields: list[str]) -> bool:
    return sum(_number(text) is not None for text in fields) >= 2


def _numbered(names: Sequence[str], width: int) -> tuple[int, ...] | None:
    """The places of columns given by number, if a row is as wide."""
    if not all(name.isdecimal() for name in names):
        return None
    places = tuple(int(name) - 1 for name in names)
    return places if min(places) >= 0 and max(places) < width else None


def _delimiter(line: str) -> str | None:
    """A tab, a semicolon or a comma outside quotes; None for blanks."""
    bare = re.sub(r'"[^"]*"', "", line)
    return next((sign for sign in "\t;," if sign in bare), None)


def _places(fields: list[str], names: Sequence[str]) -> tuple[int, ...] | None:
    """The places of the columns in a header; a header has a name for each that is asked for by name."""
    if all(name.isdecimal() for name in names):
        return None
    places = [int(name) - 1 if name.isdecimal() else _place(fields, name) for name in names]
    found = tuple(place for place in places if place is not None and 0 <= place < len(fields))
    return found if len(found) == len(names) else None


def _place(fields: list[str], name: str) -> int | None:
    """The place of a column: by its name, or but for case, or but for case and unit."""
    ways: tuple[Callable[[str], str], ...] = (str.strip, lambda text: text.strip().casefold(), _plain)
    for like in ways:
        same = [place for place, text in enumerate(fields) if like(text) == like(name)]
        if same:
            return same[0]
    return None


def _plain(name: str) -> str:
    """A name without its unit, in lower case."""
    return _UNIT.sub("", name.strip()).casefold()
