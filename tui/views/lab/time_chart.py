"""TimeChart: a quantity of all methods over time."""

import asyncio
import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from textual import events
from textual.content import Content

from engine.methods import Cast
from engine.models.model import ExactMotion
from engine.run.lockstep import Sample
from tui.playback.history import ErrorHistory
from tui.playback.shown import LARGEST, Quantity, Shown, Stretch
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
    "spring_energy": ("energy in the spring, 1 at the start", "spring energy (1 at start)"),
}
"""Of the quantity itself, and of its magnitude for a logarithmic chart."""
READING = "reading what came before …"
HELP, HELP_ZOOMED = "e: quantity, w: window, z: zoom, y: log", "z Z: zoom, ( ): earlier, later, w: back"
LONGEST = 2.0  # s of the run for which a chart stands, though its last column be longer
FEWEST = 8  # rows of the history in a stretch; an hour ago they are seconds apart
LOGARITHM = ("ln(E/E_true)", "|ln(E/E_true)|")
"""The energy error where the true motion does not keep its energy."""


def modified_energy_of(cast: Cast) -> str:
    """For which methods the chart of the modified energy has a line, unless it has one for all."""
    known = [method.letter for method in cast if method.modified_energy]
    return "" if len(known) == len(cast) else f"shadow energy is known for {' and '.join(known) or 'none'} only"


def title(shown: Shown, exact: ExactMotion, conserved: bool = True) -> str:
    """What the chart shows, and for how long back."""
    name, magnitude = NAMES[shown.quantity] if conserved or shown.quantity != "energy_error" else LOGARITHM
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
    before, after = (max(1 - math.floor(math.log10(span)), 0) for span in (min(begin or end, end - begin), end - begin))
    return f"{begin:.{before}f} to {end:.{after}f} s"


def read_out(reading: "Reading", letters: Sequence[str], room: int) -> str:
    """All methods at a moment, as far as there is room: "12.35 s: e 3.3, s 0.079, v 0.0057, r 3.8e-5"."""
    numbers = [
        f"{'<' if value < 0 else '>'} {value:.0e}".replace("e+0", "e")
        if abs(value) >= LARGEST  # which is drawn at the edge
        else f"{value:.2g}".replace("e-0", "e-")
        for value in reading.values
    ]
    text = f"{seconds(reading.t)}:"
    for letter, number in zip(letters, numbers, strict=True):
        part = f" {letter} {number}"
        if not number.startswith("nan") and len(text) + len(part) <= room:
            text += part
    return text


class TimeChart(Pane):
    """Builds the chart in a thread from the newest data, again when that makes a column more.

    The pointer reads out a moment, the wheel zooms there.
    """

    PAUSE = 0.35

    def __init__(self, ahead: int = 0) -> None:
        """`ahead`: so many quantities after the one that is chosen."""
        super().__init__()
        self._ahead = ahead
        self._wanted = asyncio.Event()
        self._building = False
        self._titles: object = None
        self._plot: TimePlot | None = None
        self._built: Sample | None = None  # what the plot shows, or the one being built
        self._history: ErrorHistory | None = None  # that it shows; another one knows more of the past
        self._knew_past = True
        self._pointer: int | None = None  # the column under it

    @property
    def settled(self) -> bool:
        """Whether no chart is being built or is wanted."""
        return not (self._building or self._wanted.is_set())

    @property
    def is_pointed_at(self) -> bool:
        return self._pointer is not None

    def _look(self, source: Source) -> Shown:
        """What to show of the source here."""
        shown = self.shown.of(source.sample.run)
        return shown._replace(quantity=shown.quantity_ahead(self._ahead, source.scene))

    def on_click(self) -> None:
        self.post_message(Asked("quantity"))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        offset = event.get_content_offset(self)
        self._pointer = None if offset is None else offset.x
        self._tell()

    def on_leave(self) -> None:
        self._pointer = None
        self._tell()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._wheel(event, 0.7)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._wheel(event, 1 / 0.7)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        offset = event.get_content_offset(self)
        self._pointer = None if offset is None else offset.x
        self.zoom(factor)
        event.stop()

    def zoom(self, factor: float, shift: float = 0.0) -> None:
        """Ask for `factor` times the stretch about the pointer, or a `shift` of it later, if that has FEWEST rows."""
        if (source := self.source) is None or (plot := self._plot) is None or plot.values is None:
            return
        history, run, stretch = source.history, source.sample.run, self._look(source).stretch
        if stretch is not None:  # the plot may not show it yet
            begin, end = stretch.begin, stretch.end
            plot = replace(plot, ends=(math.log10(begin), math.log10(end)) if plot.log_time else (begin, end))
        elif shift:
            return
        ends = plot.zoomed(history.window(), factor, None if shift else self._pointer, shift)
        if ends is None:
            if stretch is not None:
                self.post_message(Zoomed(None))
        elif factor >= 1 or len(history.between(*ends).x) >= FEWEST:
            self.post_message(Zoomed(Stretch(run, *ends, plot.log_time)))

    def on_mount(self) -> None:
        """Build from the first paint on: plotext takes as long to import as all else takes to paint."""
        self.call_after_refresh(self._start)

    def _start(self) -> None:
        self.run_worker(self._build_on_demand(), group="chart")

    def is_due(self, sample: Sample) -> bool:
        """Whether another chart would show more: a column more, or more of the past."""
        source, built, plot = self.source, self._built, self._plot
        if source is None or built is None or plot is None or sample.run != built.run:
            return True
        if source.history is not self._history or source.knows_past != self._knew_past:
            return True
        stretch = self._look(source).stretch
        if stretch is not None and min(built.t, sample.t) > stretch.end:
            return False
        if source.is_at_rest:
            return sample != built
        return abs(sample.t - built.t) >= min(plot.column, LONGEST) and super().is_due(sample)

    def paint(self, source: Source, sample: Sample) -> None:
        if self._built is not None and sample.run != self._built.run:
            self._plot = None
        self._wanted.set()
        self._tell()

    def _tell(self) -> None:
        """Say in the title what is shown, and below what is under the pointer, or how to change it."""
        if (source := self.source) is None:
            return
        self._knew_past = source.knows_past
        look, plot, room = self._look(source), self._plot, self.room.width - 6
        above = title(look, source.exact, source.scene.equations.energy_error.conserved)
        reading = plot.at(self._pointer) if plot is not None and self._pointer is not None else None
        if plot is not None and reading is not None:
            letters = [self.cast[place].letter for place in plot.places if place < len(self.cast)]
            below = read_out(reading, letters, room)
        else:
            below = modified_energy_of(self.cast) if look.quantity == "shadow_error" else ""
            help_text = READING if not self._knew_past else HELP if look.stretch is None else HELP_ZOOMED
            below = below or (source.ghost.label(room) if source.ghost else help_text)
        if (above, below) != self._titles:  # setting them paints all of the pane
            self._titles = above, below
            self.border_title, self.border_subtitle = Content(above), Content(below)  # as markup, [rad] would be gone

    async def _build_on_demand(self) -> None:
        from tui.drawing.time_chart import time_chart  # brings NumPy, which can wait for the first paint

        while True:
            await self._wanted.wait()
            self._wanted.clear()
            if self.source is None or self.sample is None or not self.drawable:
                continue
            self._building, self._built, self._history = True, self.sample, self.source.history
            shown, (width, height), ghost = self._look(self.source), self.room, self.source.ghost
            history, stretch, until, back = self.source.history, shown.stretch, self.sample.t, shown.seconds
            window = history.window(back) if stretch is None else history.between(*stretch[1:3])
            if stretch is not None:
                until = min(until, stretch.end)
                back = until - stretch.begin
            behind = None if ghost is None else (ghost.window(until, back), ghost.scene.cast)
            build = partial(
                time_chart,
                log=shown.log,
                seconds=shown.seconds,
                stretch=stretch,
                shown=self.places,
                ghost=behind,
            )
            run = self.sample.run
            plot = await asyncio.to_thread(build, window, self.cast, shown.quantity, width, height)
            if self.source.sample.run == run:  # else another one has begun, maybe with other methods
                self.show(plot.picture)
                self._plot = plot
            if self._pointer is not None:
                self._tell()
            self._building = False
