"""LabView: the stage, the chart of their errors, phase space, the events, and the table."""

from collections.abc import Callable
from itertools import pairwise

from textual.app import ComposeResult
from textual.geometry import NULL_OFFSET, NULL_SPACING, Region, Size
from textual.layout import ArrangeResult, Layout, WidgetPlacement
from textual.widget import Widget

from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.error_table import ErrorTable
from pendu_tui.tui.views.lab.event_list import EventList
from pendu_tui.tui.views.lab.stage import Stage
from pendu_tui.tui.views.lab.time_chart import TimeChart
from pendu_tui.tui.views.phase.pane import PhasePane
from pendu_tui.tui.views.view import Box, Pane, View

SMALL = (22, 38)  # columns of the stage and of the chart on the smallest screen


def places(columns: int, rows: int) -> dict[str, Region]:
    """Return the regions of the panes: the stage and events left, charts and phase space right."""
    side = min(max(columns * 3 // 8, SMALL[0]), columns)
    events = 0
    if rows >= 20:  # room for phase space below the chart, too
        events = max(5, -(-rows // 5))
        side = min(side, 2 * (rows - events) + 2)  # a cell is twice as high as wide
        events = rows - min(rows - events, side // 2 + 2)
    regions = {"stage": Region(0, 0, side, rows - events)}
    if events:
        regions["events"] = Region(0, rows - events, side, events)
    stack = ["chart"]
    if rows >= 45:
        stack.append("second_chart")
    if events:
        stack.append("phase")
    if side == columns:
        return regions
    edges = [rows * part // len(stack) for part in range(len(stack) + 1)]
    for name, (top, low) in zip(stack, pairwise(edges), strict=True):
        regions[name] = Region(side, top, columns - side, low - top)
    return regions


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


class Arranged(Box):
    def __init__(self, layout: CellLayout, *panes: Widget) -> None:
        super().__init__(*panes)
        self._layout = layout

    @property
    def layout(self) -> CellLayout:
        return self._layout


class LabView(View):
    def __init__(self, source: Source, shown: Shown, id: str | None = None) -> None:
        super().__init__(source, shown, id)
        self._named: dict[str, Pane] = {
            "stage": Stage(),
            "phase": PhasePane(),
            "events": EventList(),
            "chart": TimeChart(),
            "second_chart": TimeChart(ahead=1),
        }

    def compose(self) -> ComposeResult:
        panes = map(self.with_source, self._named.values())
        yield Arranged(CellLayout(self._regions), *panes)
        yield self.with_source(ErrorTable())

    def zoom(self, factor: float) -> None:
        charts = list(self.query(TimeChart))
        next((each for each in charts if each.pointer is not None), charts[0]).zoom(factor)

    def _regions(self, size: Size) -> dict[Widget, Region]:
        regions = places(size.width, size.height)
        self._named["phase"].can_focus = "phase" in regions  # Tab skips hidden panes
        return {self._named[name]: region for name, region in regions.items()}
