"""Heads of tables: which columns have the wanted names, and their units."""

import csv
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.options import did_you_mean

MAX_NAME = 200  # characters of a column's name
MAX_NAMES = 200  # columns of a header
MAX_LINES_BEFORE = 100_000  # the first row


class Head(NamedTuple):
    """The wanted columns of a table: the fields that add up to each, and its unit."""

    places: tuple[tuple[int, ...], ...]
    units: tuple[str, ...]


Row = Sequence[float | None]  # a number for each wanted column; None: text or a gap
Records = Iterator[Head | Row]


def row_of(fields: Sequence[str], places: Iterable[Iterable[int]]) -> Row:
    """Return the numbers of a row, also with decimal commas or with Fortran's D."""
    row: list[float | None] = []
    for group in places:
        numbers = [number_of(fields[place]) if place < len(fields) else None for place in group]
        present = [number for number in numbers if number is not None]
        row.append(sum(present) if len(present) == len(numbers) else None)
    return row


def number_of(text: str) -> float | None:
    """Return the number that a field has, if it has one."""
    try:
        return float(text.replace(",", ".").replace("D", "e").replace("d", "e"))
    except ValueError:
        return None


def fields_of(line: str, delimiter: str | None) -> list[str]:
    """Return the fields of a line, without quotes; no delimiter: blanks."""
    if '"' not in line:
        return [text.strip() for text in line.split(delimiter)]
    try:
        (fields,) = csv.reader([line.strip()], delimiter=delimiter or " ", skipinitialspace=True)
    except (csv.Error, ValueError):
        return []
    return [text.strip() for text in fields]


def delimiter_of(line: str) -> str | None:
    """Return a tab, a semicolon or a comma outside quotes; None for blanks."""
    bare = re.sub(r'"[^"]*"', "", line)
    return next((sign for sign in "\t;," if sign in bare), None)


def places_of(
    fields: Sequence[str], wanted: Sequence[str], named: bool = False
) -> tuple[tuple[int, ...], ...] | None:
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
    ways: tuple[Callable[[str], str], ...] = (
        str.strip,
        lambda text: text.strip().casefold(),
        _plain,
    )
    for like in ways:
        asked = like(name)
        for place, text in enumerate(fields):
            if len(text) <= MAX_NAME and like(text) == asked:
                return place
    return None


def unit_of(name: str) -> str:
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


def missing(wanted: Sequence[str], names: Sequence[str]) -> UserError:
    """Return the error that names do not have a wanted column."""
    lost = next(
        (name for name in wanted if not name.isdecimal() and not places_of(names, [name])), None
    )
    if lost is None:
        return unreadable("no row has a number in each column; columns count from 1.")
    present = [printable(name, 40) for name in names[:20] if name]
    others = (
        f"; choose from {', '.join(present)}." if present else "; give columns by number, from 1."
    )
    hint = did_you_mean(lost, present)
    return UserError(f"there is no column {printable(lost, 40)!r}{hint or others}")


def unreadable(sentence: str) -> UserError:
    """Return the error that an input cannot be read."""
    return UserError(sentence, Exit.INPUT_UNREADABLE)
