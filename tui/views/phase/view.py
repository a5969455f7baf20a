"""PhaseView: phase space over the whole screen, with a table of areas."""

from functools import lru_cache
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.reactive import var

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.phase_space.section import OrbitKind, Points, kind_of, orbit, pieces
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.palette import TEXT, inks
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.phase.pane import PhasePane
from pendu_tui.tui.views.phase.picture import Section, fact_rows, starts
from pendu_tui.tui.views.view import Pane, StudyView
from pendu_tui.tui.words.orbit import sentence

STARTS = 300  # orbits of a section
ORBIT_STEPS = 2000  # they take a few ms


class SectionPane(PhasePane):
    """The portrait or, after key x, a section of one method."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "section", "Map", tooltip="a method's own map")
    ]

    shows_section: var[bool] = var(False)

    def __init__(self) -> None:
        super().__init__()
        self._drawn_for: object = None
        self._section: Section | None = None
        self._orbits = 0  # of the section, so far

    @property
    def settled(self) -> bool:
        if self.drawable and self.shows_section:
            return self._orbits == STARTS
        return super().settled

    def watch_shows_section(self) -> None:
        if not self.shows_section:
            self._drawn_for = None
            self.workers.cancel_node(self)
        self.draw()

    def picture(self, source: Source, sample: Sample) -> Picture:
        if self.shows_section and (why := source.scene.why_not_mapped):
            self.notify(why, severity="warning")
            self.shows_section = False
        if self.shows_section:
            return self._map(source)
        return super().picture(source, sample)

    def _map(self, source: Source) -> Picture:
        method = self.cast[self.index]
        h = abs(source.stepping.own[self.index])
        model = source.scene.equations
        viewport = self.viewport
        key = (method, model, h, viewport)
        if key != self._drawn_for or self._section is None:
            self._drawn_for = key
            self._section = Section(viewport, model, method, inks(self.cast)[self.index])
            self._orbits = 0
            self.compute(pieces, method, model, h, starts(viewport, STARTS), ORBIT_STEPS)
        title = f"Own map of {method.label}: h {h:g} s, z {h * model.w0:.4g}"
        if self._orbits < STARTS:
            title += f", computing {10 * self._orbits // STARTS / 10:.0%}"
        self.write_titles(title, "wheel: zoom, tab: next method, x: back")
        start = self.cursor or State(source.scene.theta, source.scene.omega)
        plot = self._section.picture(_orbit(method, model, h, start)[0], start, self.cursor)
        _, kind = _orbit(method, model, h, self.aim or start)
        where = "start"
        if self.aim:
            where = f"{self.aim.theta:g}, {self.aim.omega:g}"
        return Picture((*plot.rows, [(f"{where}: {sentence(method, kind)}", TEXT)]))

    def forget(self) -> None:
        self._section = None

    def add(self, result: Points) -> None:
        assert self._section is not None
        self._section.add(result)
        self._orbits += result[0].shape[1]

    def action_section(self) -> None:
        self.shows_section = not self.shows_section


@lru_cache(maxsize=64)
def _orbit(method: Method, model: Model, h: float, start: State) -> tuple[Points, OrbitKind]:
    points = orbit(method, model, h, start, ORBIT_STEPS)
    return points, kind_of(method, model, h, points)


class Facts(Pane):
    """The table below: what each method did to the ring."""

    def __init__(self, pane: SectionPane) -> None:
        super().__init__(id="facts")
        self._pane = pane

    def picture(self, source: Source, sample: Sample) -> Picture:
        rows = fact_rows(source, self.shown, self._pane.neighbours, self.room.width)
        self.styles.height = len(rows)  # more methods, more rows
        return Picture(rows)


class PhaseView(StudyView):
    PANE = SectionPane

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self.with_source(Facts(self.pane))

    def on_resize(self) -> None:
        self._make_room()

    def follow(self, sample: Sample, shown: Shown, read: bool = True) -> None:
        if read:
            self._make_room()
        super().follow(sample, shown, read)

    def _make_room(self) -> None:
        has_room = self.size.height >= 18
        self.query_one(Facts).display = has_room and not self.pane.shows_section
