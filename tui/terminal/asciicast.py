"""Asciicast: what a terminal is sent to show one screen after another, as a recording of asciinema's, version 2.

Only cells that changed are sent, so that the same screens are the same bytes, however they came about.
https://docs.asciinema.org/manual/asciicast/v2/
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, zip_longest
from operator import itemgetter

from rich.cells import cell_len
from rich.color import ColorSystem
from rich.segment import Segment
from rich.style import Style

from tui.terminal.sgr import without_repeated_colours

Cell = tuple[str, Style]
"""A character, "" in the right half of a wide one, and how it looks."""

GAP = 6  # unchanged cells that are sent again: to move the cursor past them takes as much
BEGIN, END = "\x1b[?25l\x1b[2J", "\x1b[0m\x1b[?25h"  # hide the cursor, clear the screen; show the cursor
_NOTHING: Cell = ("", Style())


def header(size: tuple[int, int], title: str) -> str:
    """The first line, for a screen of so many columns and rows."""
    columns, rows = size
    return json.dumps({"version": 2, "width": columns, "height": rows, "title": title}, ensure_ascii=False)


def event(t: float, sent: str) -> str:
    """A line: what the terminal is sent at a time [s]."""
    return json.dumps([round(t, 6), "o", sent], ensure_ascii=False)


def cells(rows: Iterable[Iterable[Segment]]) -> list[list[Cell]]:
    """The cells of a screen, row by row."""
    return [list(_row(segments)) for segments in rows]


def _row(segments: Iterable[Segment]) -> Iterator[Cell]:
    for text, style, control in segments:
        for character in "" if control else text:
            look = style or Style.null()
            yield character, look
            if cell_len(character) == 2:
                yield "", look


def changed(before: Sequence[Sequence[Cell]], after: Sequence[Sequence[Cell]]) -> str:
    """What makes one screen of the other."""
    parts = []
    for y, row in enumerate(after):
        for start, end in _spans(before[y] if y < len(before) else (), row):
            parts.append(f"\x1b[{y + 1};{start + 1}H")
            for style, run in groupby(row[start:end], itemgetter(1)):
                text = "".join(character for character, _ in run)
                parts.append(style.render(text, color_system=ColorSystem.TRUECOLOR))
    return without_repeated_colours("".join(parts))


def _spans(before: Sequence[Cell], after: Sequence[Cell]) -> Iterator[tuple[int, int]]:
    """(first, end) of stretches of a row that changed, with what little lies between them."""
    places = [at for at, (old, new) in enumerate(zip_longest(before, after, fillvalue=_NOTHING)) if old != new]
    start = end = -1
    for at in places:
        if start < 0:
            start = at
        elif at - end > GAP:
            yield start, end
            start = at
        end = at + 1
    if start >= 0:
        while start and not after[start][0]:  # not from the middle of a wide character
            start -= 1
        yield start, end
