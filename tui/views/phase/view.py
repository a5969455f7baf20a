"""PhaseView: phase space over the whole screen, with a table of what the methods do to area, or of their orbits."""

import asyncio
from functools import partial

from textual.app import ComposeResult

from engine.models.model import State
from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.views.background import computed
from tui.views.phase.facts import fact_rows
from tui.views.phase.section_pane import STEPS, SectionPane, Wanted, followed
from tui.views.view import Pane, View

RADIUS = 0.1  # rad; large enough to be seen, small enough to stay a ring for a while
MIN_ROWS = 18  # of the screen, with the table
STARTS = 300  # of a section
DELAY = 0.1  # s that a picture has to stand before its section is computed: a wheel turns on and on


class Facts(Pane):
    """The table below: what each method made of the ring, or the orbit of the start under its own map."""

    NEEDS_NUMPY = True

    def __init__(self, pane: SectionPane) -> None:
        super().__init__(id="facts")
        self._pane = pane

    def picture(self, source: Source, sample: Sample) -> Picture:
        if self._pane.shows_section:
            rows = self._orbit_rows(source)
        else:
            rows = fact_rows(source, self.shown, self._pane.neighbours, self.room.width)
        self.styles.height = len(rows)  # more methods, more rows
        return Picture(rows)

    def _orbit_rows(self, source: Source) -> list[Row]:
        from tui.words.orbit import kind_rows

        scene = source.scene
        start = State(scene.theta, scene.omega)
        kinds = []
        for place in self.places:
            h = abs(source.stepping.own[place])
            kinds.append((place, followed(self.cast[place], scene.equations, h, start)[1]))
        head = " The start's orbit under each method's own map (x: back, tab: next method)"
        return [((head, TEXT),), *kind_rows(self.cast, kinds, self.room.width)]


class PhaseView(View):
    """The portrait or a section, and the table below it."""

    def compose(self) -> ComposeResult:
        pane = SectionPane(radius=RADIUS)
        yield self.every_frame(pane)
        yield self.at_5_hz(Facts(pane))

    def on_show(self) -> None:
        self.query_one(SectionPane).focus()

    def on_resize(self) -> None:
        """Where there is little room, leave all of it to the portrait."""
        self.query_one(Facts).display = self.size.height >= MIN_ROWS

    def follow(self, sample: Sample, read: bool = True) -> None:
        """Follow h, too: another one brings no other sample."""
        super().follow(sample, read)
        for pane in self.query(SectionPane):
            if read and pane.shows_section:
                pane.draw()

    def on_section_pane_section_wanted(self) -> None:
        """Compute what is wanted, and nothing else any more."""
        pane = self.query_one(SectionPane)
        self.workers.cancel_node(self)
        if pane.wanted is not None:
            self.compute(partial(self._fill, pane, pane.wanted))
        self.query_one(Facts).draw()

    async def _fill(self, pane: SectionPane, wanted: Wanted) -> None:
        await asyncio.sleep(DELAY)
        from engine.phase_space.section import pieces
        from tui.views.phase.section import starts

        method, model, h, viewport = wanted
        done = 0
        async for piece in computed(pieces, method, model, h, starts(viewport, STARTS), STEPS):
            done += piece[0].shape[1]
            pane.fill(wanted, piece, done / STARTS)
