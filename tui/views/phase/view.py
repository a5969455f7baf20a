"""PhaseView: phase space over the whole screen, with a table of what the methods do to area."""

import asyncio
from functools import partial

from textual.app import ComposeResult

from engine.run.lockstep import Sample
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.background import computed
from tui.views.phase.facts import fact_rows
from tui.views.phase.pane import ORBIT_STEPS, SectionPane, Wanted
from tui.views.view import Pane, StudyView

MIN_ROWS = 18  # of the screen, with the table
STARTS = 300  # of a section
DELAY = 0.1  # s that a picture has to stand before its section is computed: a wheel turns on and on


class Facts(Pane):
    """The table below: what each method made of the ring."""

    NEEDS_NUMPY = True

    def __init__(self, pane: SectionPane) -> None:
        super().__init__(id="facts")
        self._pane = pane

    def picture(self, source: Source, sample: Sample) -> Picture:
        rows = fact_rows(source, self.shown, self._pane.neighbours, self.room.width)
        self.styles.height = len(rows)  # more methods, more rows
        return Picture(rows)


class PhaseView(StudyView[SectionPane]):
    """The portrait or a section, and the table below it."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(SectionPane(), id)
        self._computed: Wanted | None = None

    def compose(self) -> ComposeResult:
        yield self.every_frame(self.pane)
        yield self.at_5_hz(Facts(self.pane))

    def on_resize(self) -> None:
        self._make_room()

    def _make_room(self) -> None:
        """Leave all of the view to a map, and to a portrait where there is little room."""
        has_room = self.size.height >= MIN_ROWS
        self.query_one(Facts).display = has_room and not self.pane.shows_section

    def compute_missing(self, source: Source) -> None:
        """Compute the section that is wanted, and nothing else any more."""
        self._make_room()
        if self.pane.shows_section:
            self.pane.draw()  # another h brings no other sample
        wanted = self.pane.wanted
        if wanted != self._computed:
            self._computed = wanted
            self.workers.cancel_node(self)
            if wanted is not None:
                self.compute(partial(self._fill, wanted))

    async def _fill(self, wanted: Wanted) -> None:
        await asyncio.sleep(DELAY)
        from engine.phase_space.section import pieces
        from tui.views.phase.section import starts

        method, model, h, viewport = wanted
        done = 0
        begun = starts(viewport, STARTS)
        async for piece in computed(pieces, method, model, h, begun, ORBIT_STEPS):
            done += piece[0].shape[1]
            self.pane.fill(wanted, piece, done / STARTS)
