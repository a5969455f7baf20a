"""Where the lab's panes go: pure arithmetic, and the Textual Layout that uses it."""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

from textual.geometry import NULL_OFFSET, NULL_SPACING, Region, Size
from textual.layout import ArrangeResult, Layout, WidgetPlacement
from textual.widget import Widget

CHART = 52  # columns at least: a title fits above it
NARROW = 28 + CHART  # columns below which there is no chart
PANE = Size(26, 9)  # of one pendulum at least: the names of the usual cast fit above it
EVENTS = 5  # rows at least
TWO_ROWS = 20  # rows from which on there are events, and phase space below the chart
THREE_ROWS = 45  # rows from which on there are two charts


class Places(NamedTuple):
    """The region of each pane, None where it is not shown."""

    pendulums: tuple[Region, ...] = ()  # of the methods shown, in order; none if they share one
    overlay: Region | None = None  # of all pendulums on one pivot
    events: Region | None = None
    chart: Region | None = None
    second_chart: Region | None = None
    phase: Region | None = None


def places(columns: int, rows: int, methods: int) -> Places:
    """Place pendulums and events to the left, charts and phase space to the right.

    Each method has a pane of its own where there is room.
    """
    events = max(EVENTS, -(-rows // 5)) if rows >= TWO_ROWS else 0
    grid = _grid(columns, rows - events, methods) if columns >= NARROW else None
    if grid is not None:
        across, side = grid
        pendulums = _tiles(side, rows - events, methods, across)
        whole = None
        bottom = rows - events
    else:
        side = (
            columns
            if columns < NARROW
            else min(max(28, columns * 2 // 5), columns - CHART, 2 * rows + 2)
        )
        bottom = min(rows - events, side // 2 + 2) if events else rows
        pendulums = ()
        whole = Region(0, 0, side, bottom)
    listed = Region(0, bottom, side, rows - bottom) if events else None
    if columns < NARROW:
        return Places(pendulums, whole, listed)
    number = 1 + (rows >= TWO_ROWS) + (rows >= THREE_ROWS)
    edges = [rows * part // number for part in range(number + 1)]
    stack = [Region(side, top, columns - side, low - top) for top, low in pairwise(edges)]
    return Places(
        pendulums,
        whole,
        listed,
        chart=stack[0],
        second_chart=stack[1] if number == 3 else None,
        phase=stack[-1] if number > 1 else None,
    )


def _grid(columns: int, rows: int, methods: int) -> tuple[int, int] | None:
    """Return how many pendulums stand side by side, and their columns; None if none fit."""
    best = 0
    found = None
    for across in range(1, min(methods, 3) + 1):
        side = min(max(PANE.width * across, columns * 2 // 5), columns - CHART)
        width = side // across
        height = rows // -(-methods // across)
        least = min(width, 2 * height)  # a cell is twice as high as wide
        if width >= PANE.width and height >= PANE.height and least > best:
            best = least
            found = (across, side)
    return found


def _tiles(columns: int, rows: int, count: int, across: int) -> tuple[Region, ...]:
    """Regions line by line; the last line's ones share its width."""
    down = -(-count // across)
    tiles: list[Region] = []
    for line in range(down):
        top = rows * line // down
        low = rows * (line + 1) // down
        here = min(across, count - line * across)
        lefts = [columns * at // here for at in range(here + 1)]
        tiles += [Region(left, top, end - left, low - top) for left, end in pairwise(lefts)]
    return tuple(tiles)


class CellLayout(Layout):
    """Places widgets where a function of the size puts them; unplaced ones are hidden."""

    name = "cells"

    def __init__(self, regions: Callable[[Size], dict[Widget, Region]]) -> None:
        self._regions = regions

    def arrange(
        self, parent: Widget, children: list[Widget], size: Size, greedy: bool = True
    ) -> ArrangeResult:
        return [
            WidgetPlacement(region, NULL_OFFSET, NULL_SPACING, widget)
            for widget, region in self._regions(size).items()
            if region and widget in children
        ]
