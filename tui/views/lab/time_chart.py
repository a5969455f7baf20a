"""TimeChart: a quantity of all methods over time."""

import asyncio
from dataclasses import replace
from functools import partial

from textual.content import Content

from engine.methods import Cast
from engine.models.model import ExactMotion
from engine.run.lockstep import Sample
from tui.playback.shown import Quantity, Shown
from tui.playback.source import Source
from tui.views.messages import Asked
from tui.views.view import Pane
from tui.words.numbers import about

NAMES: dict[Quantity, tuple[str, str]] = {
    "energy_error": ("energy error dE/E0", "|dE/E0|"),
    "theta_error": ("theta - exact theta [rad]", "theta error [rad]"),
    "shadow_error": ("shadow energy error", "|shadow error|"),
    "energy": ("energy per m L² [1/s²]", "energy [1/s²]"),
    "spring_energy": ("energy in the spring, 1 at the start", "spring energy (1 at start)"),
}
"""Of the quantity itself, and of its magnitude for a logarithmic chart."""
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
    if not shown.log:
        return f"{name}, {span}"
    each = {"libration": " per half swing", "rotation": " per turn"}.get(exact.regime, "") if exact.period else ""
    return f"max {magnitude}{each}, {span}"


class TimeChart(Pane):
    """Builds the chart in a thread, always from the newest data; samples that come too quickly are skipped."""

    def __init__(self, id: str | None = None, ahead: int = 0) -> None:
        """`ahead`: so many quantities after the one that is chosen."""
        super().__init__(id)
        self._ahead = ahead
        self._wanted = asyncio.Event()
        self._building = False
        self._title = ""

    @property
    def settled(self) -> bool:
        """Whether the chart shows the newest data."""
        return not (self._building or self._wanted.is_set())

    def _look(self, source: Source) -> Shown:
        """What to show of the source here."""
        return replace(self.shown, quantity=self.shown.quantity_ahead(self._ahead, source.scene))

    def on_click(self) -> None:
        """Show the next quantity."""
        self.post_message(Asked("quantity"))

    def on_mount(self) -> None:
        """Build from the first paint on: plotext takes as long to import as all else takes to paint."""
        self.call_after_refresh(self._start)

    def _start(self) -> None:
        self.run_worker(self._build_on_demand(), group="chart")

    def paint(self, source: Source, sample: Sample) -> None:
        self._wanted.set()
        look = self._look(source)
        text = title(look, source.exact, source.scene.equations.conserved)
        if text != self._title:  # setting it paints all of the pane
            self._title = text
            self.border_title = Content(text)  # as markup, units in brackets would be gone
            unknown = modified_energy_of(self.cast) if look.quantity == "shadow_error" else ""
            self.border_subtitle = unknown or "e: quantity, w: window, y: log"

    async def _build_on_demand(self) -> None:
        from tui.drawing.chart import time_chart  # brings NumPy, which can wait for the first paint

        while True:
            await self._wanted.wait()
            self._wanted.clear()
            if self.source is None or not self.drawable:
                continue
            self._building = True
            shown, (width, height) = self._look(self.source), self.room
            build = partial(time_chart, log=shown.log, seconds=shown.seconds, shown=self.places)
            window = self.source.history.window(shown.seconds)
            try:
                self.show_picture(await asyncio.to_thread(build, window, self.cast, shown.quantity, width, height))
            except Exception as error:
                self.fail(error)
            self._building = False
