"""SectionPane: the phase space of the view, which can also show the phase portrait of a method's own map."""

from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from textual.binding import Binding, BindingType
from textual.content import Content
from textual.message import Message
from textual.reactive import var

from engine.methods import Method
from engine.models.model import Model, State
from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT, inks
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.phase.pane import PhasePane
from tui.views.phase.viewport import Viewport

if TYPE_CHECKING:  # what brings NumPy can wait for the first paint
    from engine.phase_space.section import OrbitKind, Points
    from tui.views.phase.section import Section

STEPS = 2000  # of an orbit: some ms


class Wanted(NamedTuple):
    """What a section depends on."""

    method: Method
    model: Model
    h: float  # s
    viewport: Viewport


class SectionPane(PhasePane):
    """The portrait or, after x, the section of the method that is described."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "section", "Map", tooltip="a method's own map"),
        Binding("tab", "next_map", "map of the next method", show=False),
    ]

    shows_section: var[bool] = var(False)

    class SectionWanted(Message):
        """Another section is to be computed, or none."""

    def __init__(self, radius: float | None = None) -> None:
        super().__init__(radius)
        self.wanted: Wanted | None = None
        self.share = 0.0  # of the section that is there
        self._section: Section | None = None

    @property
    def settled(self) -> bool:
        return self.share == 1 if self.drawable and self.shows_section else super().settled

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return super().check_action(action, parameters) and (
            action != "next_map" or self.shows_section
        )

    def watch_shows_section(self) -> None:
        if not self.shows_section:
            self.wanted = self._section = None
            self.watch_source()
            self.post_message(self.SectionWanted())
        self.draw()

    def picture(self, source: Source, sample: Sample) -> Picture:
        if self.shows_section and (why := source.scene.why_not_mapped):
            self.notify(why, severity="warning")
            self.shows_section = False
        if self.shows_section:
            return self._section_picture(source)
        return super().picture(source, sample)

    def _section_picture(self, source: Source) -> Picture:
        """Return the section, and a line about the orbit at the crosshair, under the pointer, or of the start."""
        from tui.views.phase.section import Section
        from tui.words.orbit import sentence

        method, model, h = (
            self.cast[self.index],
            source.scene.equations,
            abs(source.stepping.own[self.index]),
        )
        wanted = Wanted(method, model, h, self.viewport)
        if wanted != self.wanted or self._section is None:
            self.wanted, self.share = wanted, 0.0
            self._section = Section(wanted.viewport, model, method, inks(self.cast)[self.index])
            self._retitle()
            self.post_message(self.SectionWanted())
        start = self.cursor or State(source.scene.theta, source.scene.omega)
        points, _ = followed(method, model, h, start)
        plot = self._section.picture(points, start, self.cursor)
        aim = self.aim
        _, kind = followed(method, model, h, aim or start)
        where = "start" if aim is None else f"{aim.theta:g}, {aim.omega:g}"
        return Picture.stacked(plot, Picture.of_line(f"{where}: {sentence(method, kind)}", TEXT))

    def fill(self, wanted: Wanted, points: "Points", share: float) -> None:
        """Add some orbits to a section, unless another one is wanted by now."""
        if wanted == self.wanted and self._section is not None:
            self._section.add(points)
            self.share = share
            self._retitle()
            self.draw()

    def _retitle(self) -> None:
        """Name what is shown; a new title has Textual send all of the pane, so progress is in tenths."""
        if self.wanted is not None:
            method, model, h, _ = self.wanted
            done = "" if self.share == 1 else f", computing {int(10 * self.share) / 10:.0%}"
            title = f"Own map of {method.label}: h {h:g} s, z {h * model.w0:.4g}{done}"
            if title != str(self.border_title):
                self.border_title = Content(title)

    def action_section(self) -> None:
        self.shows_section = not self.shows_section

    def action_next_map(self) -> None:
        self.action_method(1)


@lru_cache(maxsize=64)
def followed(method: Method, model: Model, h: float, start: State) -> "tuple[Points, OrbitKind]":
    """Return the orbit of a start, and its kind."""
    from engine.phase_space.section import kind_of, orbit

    points = orbit(method, model, h, start, STEPS)
    return points, kind_of(method, model, h, points)
