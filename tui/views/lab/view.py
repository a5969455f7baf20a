"""LabView: four pendulums, the chart of their errors, phase space, the events, and the table."""

from collections.abc import Iterator

from textual.app import ComposeResult
from textual.containers import Grid, Horizontal
from textual.widget import Widget

from engine.scenes import MOST_METHODS
from tui.drawing.faults import Guarded
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.event_list import EventList
from tui.views.lab.large_table import LargeTable
from tui.views.lab.pendulums import Pendulum
from tui.views.lab.time_chart import TimeChart
from tui.views.phase.pane import KEYS, PhasePane
from tui.views.view import Box, View


class _Row(Guarded, Horizontal):
    BLANK = True


class _Square(Guarded, Grid):
    BLANK = True


class LabView(View):
    """The style sheet decides which panes there are and how large, by the size of the terminal."""

    KEYS = KEYS

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id)
        self._laid_out: list[int] | None = None

    def on_mount(self) -> None:
        super().on_mount()
        self._lay_out()

    def compose(self) -> ComposeResult:
        with _Row():
            with Box(id="side"):
                with _Square(id="pendulums"):
                    yield from self._pendulums()
                yield EventList().data_bind(View.source, sample=View.sample_10hz)
            yield self.moving(Pendulum(id="overlay"))
            with Box(id="charts"):
                yield TimeChart().data_bind(View.source, View.shown, sample=View.sample_5hz)
                yield self.moving(PhasePane(), late=True)
        yield ErrorTable().data_bind(View.source, View.shown, sample=View.sample_10hz)
        yield LargeTable().data_bind(View.source, View.shown, sample=View.sample_10hz)

    def _pendulums(self) -> Iterator[Widget]:
        for place in range(MOST_METHODS):
            yield self.moving(Pendulum(place))

    def watch_shown(self) -> None:
        self._lay_out()

    def watch_sample_10hz(self) -> None:
        self._lay_out()

    def _lay_out(self) -> None:
        """A pendulum for each method that is shown: the others leave their room to them."""
        shown = self.shown.places(self.source.scene.cast) if self.source is not None else []
        if shown == self._laid_out or not self.is_mounted:
            return
        self._laid_out = shown
        for place, pendulum in enumerate(self.query("#pendulums Pendulum")):
            pendulum.display = place in shown
        self.query_one("#pendulums").set_class(len(shown) < 3, "-few").set_class(len(shown) > 4, "-many")
