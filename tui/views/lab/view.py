"""LabView: four pendulums, the chart of their errors, phase space, the events, and the table."""

from collections.abc import Iterator

from textual.app import ComposeResult
from textual.containers import Grid, Horizontal
from textual.widget import Widget

from engine.methods import METHODS
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

    def compose(self) -> ComposeResult:
        with _Row():
            with Box(id="side"):
                with _Square(id="pendulums"):
                    yield from self._pendulums()
                yield EventList().data_bind(View.source, sample=View.sample_10hz)
            yield self.moving(Pendulum(range(len(METHODS)), id="overlay"))
            with Box(id="charts"):
                yield TimeChart().data_bind(View.source, View.shown, sample=View.sample_5hz)
                yield self.moving(PhasePane(), late=True)
        yield ErrorTable().data_bind(View.source, View.shown, sample=View.sample_10hz)
        yield LargeTable().data_bind(View.source, View.shown, sample=View.sample_10hz)

    def _pendulums(self) -> Iterator[Widget]:
        for index in range(len(METHODS)):
            yield self.moving(Pendulum([index]))

    def watch_shown(self) -> None:
        """Hidden methods leave their room to the others."""
        shown = self.shown.indices
        for index, pendulum in enumerate(self.query("#pendulums Pendulum")):
            pendulum.display = index in shown
        self.query_one("#pendulums").set_class(len(shown) < 3, "-few")
