"""Records of names and values: JSON lines, Amber's mdout, the arrays of an .npz."""

import io
import json
import re
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, BinaryIO

from recordings.errors import printable
from tui.cli.heads import (
    MAX_LINES_BEFORE,
    MAX_NAME,
    MAX_NAMES,
    Head,
    Records,
    missing,
    places_of,
    row_of,
    unit_of,
    unreadable,
)

_PAIR = re.compile(r"([A-Za-z][\w()/-]*(?: [\w()/-]+)?)\s*=\s*([-+.\w*]+)")


def is_mdout(line: str) -> bool:
    """Whether a record of Amber's mdout begins in this line."""
    return line.lstrip().startswith("NSTEP") and len(_PAIR.findall(line[:MAX_NAME])) > 1


def of_objects(objects: Iterable[dict[str, Any]], wanted: Sequence[str], unit: str = "") -> Records:
    """Yield a head and the rows of objects with names; `unit` is that of energies without one."""
    names: list[str] = []
    places: tuple[tuple[int, ...], ...] | None = None
    has_head = False
    for number, item in enumerate(objects):
        if list(item) != names:
            names = list(item)
            places = places_of(names[:MAX_NAMES], wanted)
            if places and not has_head:
                has_head = True
                yield Head(places, tuple(unit_of(names[group[0]]) or unit for group in places))
        if places:
            yield row_of([str(value) for value in item.values()], places)
        elif number > MAX_LINES_BEFORE and not has_head:
            break
    if not has_head:
        raise missing(wanted, names)


def parsed(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield the objects of JSON lines; an empty one for a line that is none."""
    for line in lines:
        try:
            item = json.loads(line)
        except (ValueError, RecursionError):
            item = None
        if line.strip():
            yield item if isinstance(item, dict) else {}


def pairs(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
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


def of_arrays(stream: BinaryIO, wanted: Sequence[str]) -> Records:
    """Yield the head and the rows of the arrays in an .npz."""
    import numpy as np

    try:
        source = stream if stream.seekable() else io.BytesIO(stream.read())
        with np.load(source, allow_pickle=False) as arrays:
            names = list(arrays)
            places = places_of(names[:MAX_NAMES], wanted)
            if places is None:
                raise missing(wanted, names)
            columns = [
                np.sum([np.ravel(arrays[names[place]]).astype(float) for place in group], axis=0)
                for group in places
            ]
    except (OSError, ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise unreadable(f"this .npz cannot be read: {printable(str(error), 100)}.") from None
    yield Head(places, tuple(unit_of(names[group[0]]) for group in places))
    yield from zip(*(column.tolist() for column in columns), strict=False)
