"""PhaseView: phase space over the whole screen, with a table of what the methods do to area, or of their orbits."""

import asyncio
from functools import partial

from textual.app import ComposeResult

from engine.models.model import State
from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture, Row
from tui.views.background import computed
from tui.views.phase.facts import fact_rows
from tui.views.phase.section_pane import STEPS, SectionPane, Wanted, followed
from tui.views.view import View

RADIUS = 0.1  # rad; large enough to be seen, small enough to stay a ring for a while
MIN_ROWS = 18  # of the screen, with the table
STARTS = 300  # of a section
DELAY = 0.1  # s that a picture has to stand before its section is computed: a wheel turns on and on


class PhaseView(View):
    """The portrait or a section, and the table below it."""

    def compose(self) -> ComposeResult:
        yield self.every_frame(SectionPane(radius=RADIUS))
        yield CellWidget(id="facts")

    def on_show(self) -> None:
        self.query_one(SectionPane).focus()

    def on_resize(self) -> None:
        """Where there is little room, leave all of it to the portrait."""
        self.query_one("#facts").display = self.size.height >= MIN_ROWS

    def wake(self) -> None:
        super().wake()
        self._write_facts()

    def follow(self, sample: Sample, read: bool = True) -> None:
        """Follow h, too: another one brings no other sample."""
        super().follow(sample, read)
        if read:
            pane = self.query_one(SectionPane)
            if pane.shows_section:
                pane.draw()
            self._write_facts()

    def on_section_pane_section_wanted(self) -> None:
        """Compute what is wanted, and nothing else any more."""
        pane = self.query_one(SectionPane)
        self.workers.cancel_node(self)
        if pane.wanted is not None:
            self.compute(partial(self._fill, pane, pane.wanted))
        self._write_facts()

    async def _fill(self, pane: SectionPane, wanted: Wanted) -> None:
        await asyncio.sleep(DELAY)
        from engine.phase_space.section import pieces
        from tui.views.phase.section import starts

        method, model, h, viewport = wanted
        done = 0
        async for piece in computed(pieces, method, model, h, starts(viewport, STARTS), STEPS):
            done += piece[0].shape[1]
            pane.fill(wanted, piece, done / STARTS)

    def _write_facts(self) -> None:
        facts, pane = self.query_one("#facts", CellWidget), self.query_one(SectionPane)
        if self.source is not None and facts.drawable:
            width = facts.size.width
            if pane.shows_section:
                rows = self._orbit_rows(width)
            else:
                rows = fact_rows(self.source, self.shown, pane.neighbours, width)
            facts.styles.height = len(rows)  # more methods, more rows
            facts.show(Picture(rows))

    def _orbit_rows(self, width: int) -> list[Row]:
        from tui.words.orbit import kind_rows

        assert self.source is not None
        scene = self.source.scene
        start = State(scene.theta, scene.omega)
        kinds = []
        for place in self.shown.places(scene.cast):
            h = abs(self.source.stepping.own[place])
            kinds.append((place, followed(scene.cast[place], scene.equations, h, start)[1]))
        head = " The start's orbit under each method's own map (x: back, tab: next method)"
        return [((head[:width], TEXT),), *kind_rows(scene.cast, kinds, width)]
