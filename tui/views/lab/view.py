"""LabView: the pendulums, the chart of their errors, phase space, the events, and the table."""

from textual.app import ComposeResult
from textual.geometry import Region, Size
from textual.widget import Widget

from engine.run.lockstep import Sample
from engine.scenes import MOST_METHODS
from tui.playback.source import Source
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.event_list import EventList
from tui.views.lab.layout import CellLayout, places
from tui.views.lab.pendulums import Pendulum
from tui.views.lab.time_chart import TimeChart
from tui.views.phase.pane import PhasePane
from tui.views.reach import Reach
from tui.views.view import Box, View


class Stage(Box):
    """What is above the table.  Its size decides which panes there are and how large."""

    def __init__(self, view: "LabView", *panes: Widget) -> None:
        super().__init__(*panes)
        self._layout = CellLayout(view.regions)

    @property
    def layout(self) -> CellLayout:
        return self._layout


class LabView(View):
    """Arranges the panes anew when their size, the cast or what is shown of it changes."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id)
        self._arranged_for: object = None
        reach = Reach()
        self.pendulums = [Pendulum(reach, place) for place in range(MOST_METHODS)]
        self.overlay = Pendulum(reach, id="overlay")
        self.chart, self.second_chart, self.phase = TimeChart(), TimeChart(ahead=1), PhasePane()
        self.events = EventList()

    def compose(self) -> ComposeResult:
        moving = [self.every_frame(pane) for pane in (*self.pendulums, self.overlay, self.phase)]
        still = [self.at_5_hz(pane) for pane in (self.events, self.chart, self.second_chart)]
        yield Stage(self, *moving, *still)
        yield self.at_5_hz(ErrorTable())

    def zoom(self, factor: float) -> None:
        (self.second_chart if self.second_chart.is_pointed_at else self.chart).zoom(factor)

    def regions(self, size: Size) -> dict[Widget, Region]:
        """Place the panes on a stage of this size; hidden methods leave their room to others."""
        shown = self.shown.places(self.source.scene.cast) if self.source is not None else []
        found = places(size.width, size.height, len(shown))
        self.phase.can_focus = found.phase is not None  # Tab is not to lead where nobody sees it
        regions: dict[Widget, Region] = {
            self.pendulums[place]: region
            for place, region in zip(shown, found.pendulums, strict=False)
        }
        others: dict[Widget, Region | None] = {
            self.overlay: found.overlay,
            self.events: found.events,
            self.chart: found.chart,
            self.second_chart: found.second_chart,
            self.phase: found.phase,
        }
        return regions | {pane: region for pane, region in others.items() if region is not None}

    def watch_shown(self) -> None:
        self._arrange()

    def watch_source(self, source: Source | None) -> None:
        self._arrange()

    def follow(self, sample: Sample, read: bool = True) -> None:
        if read:
            self._arrange()
        super().follow(sample, read)

    def _arrange(self) -> None:
        """Have Textual arrange the stage again, where that would change anything."""
        shown = self.shown.places(self.source.scene.cast) if self.source is not None else []
        if shown != self._arranged_for and self.is_mounted:
            self._arranged_for = shown
            # of one pane: Textual forgets what it knows of what is around it
            self.overlay.refresh(layout=True)
