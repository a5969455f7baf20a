"""The lab (F2): the stage, charts of errors, phase space, the events, and the table."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from textual import events
from textual.app import ComposeResult
from textual.geometry import NULL_OFFSET, NULL_SPACING, Region, Size
from textual.layout import ArrangeResult, Layout, WidgetPlacement
from textual.widget import Widget

from pendu_tui.engine.models.model import ExactMotion, Model
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.picture import QUIET, TEXT, Picture, ink_of
from pendu_tui.tui.playback.shown import Shown, Stretch
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.error_table import ErrorTable
from pendu_tui.tui.views.phase import PhasePane
from pendu_tui.tui.views.stage import Stage
from pendu_tui.tui.views.view import Box, Memo, Pane, View, Zoomed
from pendu_tui.tui.words.insight import short_name
from pendu_tui.tui.words.numbers import about, seconds
from pendu_tui.tui.words.plain_text import EventLine, event_lines, numbered


class EventList(Pane):
    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E)"
        self._listed: list[EventLine] = []

    def picture(self, source: Source, sample: Sample) -> Picture:
        lines = event_lines(source, self.shown.hidden)
        texts = numbered(lines)[-self.room.height :]
        self._listed = lines[-self.room.height :]
        width = self.room.width
        fitted = [text if len(text) <= width else f"{text[: width - 1]}…" for text in texts]
        inks = map(self._ink, self._listed)
        return Picture([[piece] for piece in zip(fitted, inks, strict=True)])

    def _ink(self, line: EventLine) -> int:
        if line.method is not None:
            return ink_of(line.method, self.cast)
        return {"mark": TEXT}.get(line.kind, QUIET)

    async def on_click(self, event: events.Click) -> None:
        offset = event.get_content_offset(self)
        if offset is not None and offset.y < len(self._listed):
            line = self._listed[offset.y]
            await self.run_action(f"screen.go_to({line.run}, {line.step})")
        else:
            await self.run_action("screen.events")


if TYPE_CHECKING:
    from pendu_tui.tui.drawing.time_chart import Reading, TimePlot


def title(shown: Shown, exact: ExactMotion, model: Model, room: int) -> str:
    """Return what the chart shows; with less `room` [characters], less of it."""
    chart = next(each.chart for each in model.charted() if each.name == shown.quantity)
    span = ", all"
    if shown.stretch is not None:
        span = f", {shown.stretch.begin:.5g} to {shown.stretch.end:.5g} s"
    elif shown.seconds is not None:
        span = f", {about(shown.seconds)}"
    if not shown.log:
        parts = [chart.title, "", span]
    else:
        cycles = {"libration": " per half period", "rotation": " per turn"}
        cycle = ""
        if exact.period and shown.stretch is None:
            cycle = cycles.get(exact.regime, "")
        log_time = "log time, " if shown.has_log_time else ""
        parts = [f"{log_time}max {chart.magnitude or chart.title}", cycle, span]
    texts = ("".join(parts), "".join(parts[::2]), parts[0])
    return next((text for text in texts if len(text) <= room), parts[0])


def _read_out(reading: "Reading", letters: Sequence[str], room: int) -> str:
    text = f"{seconds(reading.t)}:"
    for letter, value in zip(letters, reading.values, strict=True):
        part = f" {letter} {value:.1e}"
        if not math.isnan(value) and len(text) + len(part) <= room:
            text += part
    return text


class TimeChart(Pane):
    EVERY = 20  # its newest column grows slowly
    NEEDS_NUMPY = True

    def __init__(self, ahead: int = 0) -> None:
        """Chart the quantity that is `ahead` places after the chosen one."""
        super().__init__()
        self._ahead = ahead
        self.plot: TimePlot | None = None
        self._chart = Memo(self._charted)
        self.pointer: int | None = None  # its column

    @property
    def _look(self) -> Shown:
        shown = self.shown.of(self.source.sample.run)
        return shown._replace(quantity=shown.quantity_ahead(self._ahead, self.source.scene))

    def picture(self, source: Source, sample: Sample) -> Picture:
        look = self._look
        # the same while paused
        state = (self.room, source.ghost, source.history, source.knows_past, *source.changes)
        self.plot = self._chart(sample, look, *state)
        above = title(look, source.exact, source.scene.equations, self.room.width - 4)
        self.write_titles(above, self._below(self.plot, source, look))
        return self.plot.picture

    def _charted(self, sample: Sample, look: Shown, *_: object) -> "TimePlot":
        from pendu_tui.tui.drawing.time_chart import time_chart

        source = self.source
        history = source.history
        until = sample.t
        back = look.seconds
        if look.stretch is None:
            window = history.window(back)
        else:
            window = history.between(look.stretch.begin, look.stretch.end)
            until = look.stretch.end
            back = until - look.stretch.begin
        ghost = None
        if source.ghost is not None:
            ghost = source.ghost.window(until, back)
        changes = [(x, f"{each.symbol} {each.h:.4g}") for _, _, each, x in source.changes[1:]]
        names = [short_name(method) for method in self.cast]
        return time_chart(
            window, self.cast, look, *self.room, names=names, ghost=ghost, changes=changes
        )

    def _below(self, plot: "TimePlot", source: Source, look: Shown) -> str:
        room = self.room.width - 4
        if self.pointer is not None and (reading := plot.at(self.pointer)) is not None:
            return _read_out(reading, plot.letters, room)
        known = [method.letter for method in self.cast if method.modified_energy]
        if look.quantity == "shadow_error" and len(known) < len(self.cast):
            return f"shadow energy is known only for {' and '.join(known)}"
        if source.ghost is not None:
            return source.ghost.label
        if not source.knows_past:
            return "reading the earlier samples …"
        keys = "e: quantity, w: window, z: zoom, y: axes"
        return keys if len(keys) <= room else keys.rpartition(",")[0]

    async def on_click(self) -> None:
        await self.run_action("screen.quantity")

    def on_mouse_move(self, event: events.MouseMove) -> None:
        self._point(event)
        self.draw()

    def on_leave(self) -> None:
        self.pointer = None
        self.draw()

    def wheel(self, event: events.MouseEvent, factor: float) -> None:
        self._point(event)
        self.zoom(factor)

    def _point(self, event: events.MouseEvent) -> None:
        self.pointer = event.get_content_offset_capture(self).x

    def zoom(self, factor: float) -> None:
        """Zoom by `factor` about the pointer, down to 8 rows of the history."""
        plot = self.plot
        if plot is None:
            return
        window = self.source.history.window()
        ends = plot.zoomed(window, factor, self.pointer)
        if ends is None:
            if self._look.stretch is not None:
                self.post_message(Zoomed(None))
        elif factor >= 1 or len(window.cut(*ends).x) >= 8:
            run = self.source.sample.run
            self.post_message(Zoomed(Stretch(run, *ends, plot.shown.has_log_time)))


SMALL = 22  # columns of the stage on the smallest screen


def places(columns: int, rows: int) -> dict[str, Region]:
    """Return the regions of the panes: the stage and events left, charts and phase space right."""
    side = max(columns * 3 // 8, SMALL)
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
    edges = [rows * part // len(stack) for part in range(len(stack) + 1)]
    for name, (top, low) in zip(stack, pairwise(edges), strict=True):
        regions[name] = Region(side, top, columns - side, low - top)
    return regions


class PaneLayout(Layout):
    """Arranges the lab's panes by their names; those without a place are hidden."""

    def __init__(self, panes: Mapping[str, Pane]) -> None:
        self._panes = panes

    def arrange(
        self, parent: Widget, children: list[Widget], size: Size, greedy: bool = True
    ) -> ArrangeResult:
        regions = places(size.width, size.height)
        self._panes["phase"].can_focus = "phase" in regions  # Tab skips hidden panes
        return [
            WidgetPlacement(region, NULL_OFFSET, NULL_SPACING, self._panes[name])
            for name, region in regions.items()
            if region
        ]


class LabView(View):
    def __init__(self, name: str) -> None:
        self._named: dict[str, Pane] = {
            "stage": Stage(),
            "phase": PhasePane(),
            "events": EventList(),
            "chart": TimeChart(),
            "second_chart": TimeChart(ahead=1),
        }
        super().__init__(name, *self._named.values(), ErrorTable())

    def compose(self) -> ComposeResult:
        *arranged, table = self.panes
        box = Box(*arranged, id="panes")
        box.styles.set_rule("layout", PaneLayout(self._named))
        yield box
        yield table

    def zoom(self, factor: float) -> None:
        charts = list(self.query(TimeChart))
        next((each for each in charts if each.pointer is not None), charts[0]).zoom(factor)


view = LabView
