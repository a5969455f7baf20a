"""TimeChart: a quantity of all methods over time."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from textual import events

from engine.methods import Cast
from engine.models.model import ExactMotion, Model
from engine.run.lockstep import Sample
from engine.run.stepping import SteppingChange
from tui.drawing.picture import Picture
from tui.playback.shown import Quantity, Shown, Stretch
from tui.playback.source import Source
from tui.views.messages import Asked, Zoomed
from tui.views.view import Pane
from tui.words.numbers import about, seconds

if TYPE_CHECKING:
    from tui.drawing.time_chart import Reading, TimePlot

NAMES: dict[Quantity, tuple[str, str]] = {
    "energy_error": ("energy error dE/E0", "|dE/E0|"),
    "theta_error": ("theta - exact theta [rad]", "theta error [rad]"),
    "shadow_error": ("shadow energy error", "|shadow error|"),
    "energy": ("energy per m L² [1/s²]", "energy [1/s²]"),
}
"""A quantity, and its magnitude for logarithmic charts; models add their own quantities."""
READING = "reading what came before …"
HELP = "e: quantity, w: window, z: zoom, y: log"
MIN_ROWS = 8  # of the history in a stretch; an hour ago they are seconds apart


def modified_energy_of(cast: Cast) -> str:
    """For which methods the chart of the modified energy has a line, unless it has one for all."""
    known = [method.letter for method in cast if method.modified_energy]
    return (
        ""
        if len(known) == len(cast)
        else f"shadow energy is known for {' and '.join(known) or 'none'} only"
    )


def names(quantity: Quantity, model: Model) -> tuple[str, str]:
    """Return the name of a quantity, and that of its magnitude."""
    if quantity == "energy_error" and not model.energy_error.conserved:
        return model.energy_error.name, f"|{model.energy_error.name}|"
    labels = {variable.name: variable.label for variable in model.variables}
    return NAMES[quantity] if quantity in NAMES else (labels[quantity], labels[quantity])


def title(shown: Shown, exact: ExactMotion, model: Model) -> str:
    """Return what the chart shows, and for how long back."""
    name, magnitude = names(shown.quantity, model)
    span = "all" if shown.seconds is None else about(shown.seconds)
    if shown.stretch is not None:
        span = span_text(shown.stretch.begin, shown.stretch.end)
    if not shown.log:
        return f"{name}, {span}"
    each = {"libration": " per half swing", "rotation": " per turn"}.get(exact.regime, "")
    each = each if exact.period and shown.stretch is None else ""
    return f"max {magnitude}{each}, {span}"


def span_text(begin: float, end: float) -> str:
    """A stretch of time, with as many decimals as tell its ends apart: "31.2 to 33.0 s"."""
    before, after = (
        max(1 - math.floor(math.log10(span)), 0)
        for span in (min(begin or end, end - begin), end - begin)
    )
    return f"{begin:.{before}f} to {end:.{after}f} s"


def read_out(reading: "Reading", letters: Sequence[str], room: int) -> str:
    """All methods at a moment, as far as they fit: "12.35 s: e 3.3e+00 s 7.9e-02 v 5.7e-03"."""
    numbers = [f"{value:.1e}" for value in reading.values]
    text = f"{seconds(reading.t)}:"
    for letter, number in zip(letters, numbers, strict=True):
        part = f" {letter} {number}"
        if not number.startswith("nan") and len(text) + len(part) <= room:
            text += part
    return text


def step_changes(changes: Sequence[SteppingChange]) -> list[tuple[float, str]]:
    """Return each change of the step after the start: x [s] and "h 0.1"."""
    marks: list[tuple[float, str]] = []
    x = 0.0
    for before, change in pairwise(changes):
        x += abs(change.t - before.t)
        marks.append((x, f"h {change.stepping.h:.4g}"))
    return marks


class TimeChart(Pane):
    """The pointer reads out a moment, the wheel zooms there."""

    NEEDS_NUMPY = True

    def __init__(self, ahead: int = 0) -> None:
        """`ahead`: the number of quantities from the chosen one to the one that is charted."""
        super().__init__()
        self._ahead = ahead
        self.plot: TimePlot | None = None
        self._plotted: object = None
        self._pointer: int | None = None  # the column under it

    @property
    def is_pointed_at(self) -> bool:
        return self._pointer is not None

    def _look(self, source: Source) -> Shown:
        """Return what to show of the source here."""
        shown = self.shown.of(source.sample.run)
        return shown._replace(quantity=shown.quantity_ahead(self._ahead, source.scene))

    def picture(self, source: Source, sample: Sample) -> Picture:
        look = self._look(source)
        plotted = (sample, look, self.room, source.ghost, source.history, source.knows_past)
        if self.plot is None or plotted != self._plotted:  # the run may be paused
            self._plotted = plotted
            self.plot = self._charted(source, sample, look)
        above = title(look, source.exact, source.scene.equations)
        self.write_titles(above, self._below(source, look, self.room.width - 6))
        return self.plot.picture

    def _charted(self, source: Source, sample: Sample, look: Shown) -> "TimePlot":
        from tui.drawing.time_chart import Marks, time_chart

        until = sample.t
        back = look.seconds
        if look.stretch is None:
            window = source.history.window(back)
        else:
            window = source.history.between(look.stretch.begin, look.stretch.end)
            until = min(until, look.stretch.end)
            back = until - look.stretch.begin
        ghost = source.ghost
        behind = None if ghost is None else (ghost.window(until, back), ghost.scene.cast)
        line = look.line if look.line and look.line.quantity == look.quantity else None
        reference = None if line is None else (line.value, line.name)
        marks = Marks(behind, step_changes(source.changes), reference)
        return time_chart(window, self.cast, look, *self.room, marks)

    def _below(self, source: Source, look: Shown, room: int) -> str:
        """Return what is under the pointer, or how to change the chart."""
        plot = self.plot
        if (
            plot is not None
            and self._pointer is not None
            and (reading := plot.at(self._pointer)) is not None
        ):
            return read_out(reading, [self.cast[place].letter for place in plot.places], room)
        if look.quantity == "shadow_error" and (known := modified_energy_of(self.cast)):
            return known
        if source.ghost is not None:
            return source.ghost.label(room)
        if not source.knows_past:
            return READING
        return HELP

    def on_click(self) -> None:
        self.post_message(Asked("quantity"))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        self._point(event)
        self.draw()

    def on_leave(self) -> None:
        self._pointer = None
        self.draw()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._wheel(event, 0.7)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._wheel(event, 1 / 0.7)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        self._point(event)
        self.zoom(factor)
        event.stop()

    def _point(self, event: events.MouseEvent) -> None:
        offset = event.get_content_offset(self)
        self._pointer = None if offset is None else offset.x

    def zoom(self, factor: float) -> None:
        """Zoom by `factor` about the pointer, down to MIN_ROWS."""
        source = self.source
        plot = self.plot
        if source is None or plot is None or plot.values is None:
            return
        stretch = self._look(source).stretch
        ends = plot.zoomed(source.history.window(), factor, self._pointer)
        if ends is None:
            if stretch is not None:
                self.post_message(Zoomed(None))
        elif factor >= 1 or len(source.history.between(*ends).x) >= MIN_ROWS:
            self.post_message(Zoomed(Stretch(source.sample.run, *ends, plot.log_time)))
