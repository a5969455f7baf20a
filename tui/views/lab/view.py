"""LabView: the pendulums, the chart of their errors, phase space, the events, and the table."""

from collections.abc import Callable
from itertools import pairwise

from textual.app import ComposeResult
from textual.geometry import NULL_OFFSET, NULL_SPACING, Region, Size
from textual.layout import ArrangeResult, Layout, WidgetPlacement
from textual.widget import Widget

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import MAX_METHODS
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.lab.error_table import ErrorTable
from pendu_tui.tui.views.lab.event_list import EventList
from pendu_tui.tui.views.lab.pendulums import Pendulum
from pendu_tui.tui.views.lab.time_chart import TimeChart
from pendu_tui.tui.views.phase.pane import PhasePane
from pendu_tui.tui.views.view import Box, Pane, View

CHART = 52  # columns at least, so that its title fits
NARROW = 28 + CHART  # columns below which there is no chart
PANE = Size(26, 9)  # at least, so that the names of the usual cast fit


def places(columns: int, rows: int, methods: int) -> tuple[list[Region], dict[str, Region]]:
    """Return the regions of the pendulums, none if they share one, and of the other panes.

    Pendulums and events are to the left, charts and phase space to the right.
    """
    events = 0
    if rows >= 20:  # room for phase space below the chart, too
        events = max(5, -(-rows // 5))
    bottom = rows - events
    tiles: list[Region] = []
    others: dict[str, Region] = {}
    side = columns
    across = 0
    if columns >= NARROW:
        across, side = _grid(columns, bottom, methods)
    if across:
        tiles = _tiles(side, bottom, methods, across)
    else:
        if columns >= NARROW:
            side = min(max(28, columns * 2 // 5), columns - CHART, 2 * rows + 2)
        if events:
            bottom = min(bottom, side // 2 + 2)
        others["overlay"] = Region(0, 0, side, bottom)
    if events:
        others["events"] = Region(0, bottom, side, rows - bottom)
    if columns >= NARROW:
        stack = ["chart"]
        if rows >= 45:
            stack.append("second_chart")
        if events:
            stack.append("phase")
        edges = [rows * part // len(stack) for part in range(len(stack) + 1)]
        for name, (top, low) in zip(stack, pairwise(edges), strict=True):
            others[name] = Region(side, top, columns - side, low - top)
    return tiles, others


def _grid(columns: int, rows: int, methods: int) -> tuple[int, int]:
    """Return how many pendulums stand side by side, and their columns; 0 if none fit."""
    best = 0
    grid = (0, columns)
    for across in range(1, min(methods, 3) + 1):
        side = min(max(PANE.width * across, columns * 2 // 5), columns - CHART)
        width = side // across
        height = rows // -(-methods // across)
        least = min(width, 2 * height)  # a cell is twice as high as wide
        if width >= PANE.width and height >= PANE.height and least > best:
            best = least
            grid = (across, side)
    return grid


def _tiles(columns: int, rows: int, count: int, across: int) -> list[Region]:
    down = -(-count // across)
    tiles: list[Region] = []
    for line in range(down):
        top = rows * line // down
        low = rows * (line + 1) // down
        here = min(across, count - line * across)
        lefts = [columns * at // here for at in range(here + 1)]
        tiles += [Region(left, top, end - left, low - top) for left, end in pairwise(lefts)]
    return tiles


class CellLayout(Layout):
    """A layout computed by a function of the size; it hides widgets without a region."""

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


class Stage(Box):
    def __init__(self, layout: CellLayout, *panes: Widget) -> None:
        super().__init__(*panes)
        self._layout = layout

    @property
    def layout(self) -> CellLayout:
        return self._layout


class LabView(View):
    """Rearranges its panes when their size or the methods shown change."""

    def __init__(self, source: Source, shown: Shown, id: str | None = None) -> None:
        super().__init__(source, shown, id)
        self._arranged_for: object = None
        drag: list[tuple[float, float]] = []
        self.pendulums = [Pendulum(drag, place) for place in range(MAX_METHODS)]
        self._others: dict[str, Pane] = {
            "overlay": Pendulum(drag),
            "phase": PhasePane(),
            "events": EventList(),
            "chart": TimeChart(),
            "second_chart": TimeChart(ahead=1),
        }

    def compose(self) -> ComposeResult:
        panes = map(self.with_source, [*self.pendulums, *self._others.values()])
        yield Stage(CellLayout(self._regions), *panes)
        yield self.with_source(ErrorTable())

    def zoom(self, factor: float) -> None:
        charts = list(self.query(TimeChart))
        next((each for each in charts if each.pointer is not None), charts[0]).zoom(factor)

    @property
    def _places(self) -> list[int]:
        return self.shown.places(self.source.scene.cast)

    def _regions(self, size: Size) -> dict[Widget, Region]:
        tiles, others = places(size.width, size.height, len(self._places))
        self._others["phase"].can_focus = "phase" in others  # Tab skips hidden panes
        shown = [self.pendulums[place] for place in self._places]
        regions: dict[Widget, Region] = dict(zip(shown, tiles, strict=False))
        return regions | {self._others[name]: region for name, region in others.items()}

    def follow(self, sample: Sample, shown: Shown, read: bool = True) -> None:
        super().follow(sample, shown, read)
        if read and self._places != self._arranged_for:
            self._arranged_for = self._places
            # refreshing one pane is enough: Textual then arranges its parent anew
            self._others["overlay"].refresh(layout=True)
