"""PhaseView: phase space over the whole screen, with a table of what the methods do to area."""

from textual.app import ComposeResult

from tui.drawing.cells import CellWidget
from tui.views.phase.facts import fact_rows
from tui.views.phase.pane import KEYS, PhasePane
from tui.views.view import View

RADIUS = 0.1  # rad; large enough to be seen, small enough to stay a ring for a while

ROOMY = 18  # rows from which on there is room for the table


class PhaseView(View):
    """The portrait, and the table below it."""

    KEYS = KEYS

    def compose(self) -> ComposeResult:
        yield self.moving(PhasePane(radius=RADIUS), late=True)
        yield CellWidget(id="facts")

    def on_show(self) -> None:
        self.query_one(PhasePane).focus()

    def on_resize(self) -> None:
        """Where there is little room, leave all of it to the portrait."""
        self.query_one("#facts").display = self.size.height >= ROOMY

    def watch_sample_10hz(self) -> None:
        self._write_facts()

    def on_phase_pane_ring_moved(self) -> None:
        self._write_facts()

    def _write_facts(self) -> None:
        facts, pane = self.query_one("#facts", CellWidget), self.query_one(PhasePane)
        if self.source is not None and facts.drawable:
            try:
                facts.show(fact_rows(self.source, self.shown, pane.neighbours, pane.ring, facts.size.width))
            except Exception as error:
                facts.fail(error)
