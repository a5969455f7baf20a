"""PhaseDisplay: phase space, the methods on it, and below them what is at the crosshair or under the pointer."""

from textual.message import Message
from textual.reactive import var

from engine.methods import METHODS
from engine.models.state import State
from engine.phase_space.area import Neighbourhood, Neighbours
from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.cells import CellWidget
from tui.drawing.palette import EXACT, FRAME, TEXT
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.phase.picture import Point, phase_picture
from tui.views.phase.portrait import Portrait
from tui.views.phase.viewport import Viewport
from tui.words.motion import motion_text, place_text

TRAIL = 300  # samples, ten seconds at 30 frames a second
RING_STEPS = 100  # a frame; 52 µs each, so a ring that has to catch up costs 5 ms of a frame at most


class PhaseDisplay(CellWidget, can_focus=True):
    """Draws; who derives from it sets the crosshair, the pointer and the viewport."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    shown: var[Shown] = var(Shown())
    wrap: var[bool] = var(True)
    radius: var[float | None] = var(None)
    """Of the ring of neighbours [rad]; None: no ring."""

    class RingMoved(Message):
        """The ring has caught up, or has come nearer, though the sample is the same."""

    def __init__(self, id: str | None = None, radius: float | None = None) -> None:
        super().__init__(id)
        self.set_reactive(PhaseDisplay.radius, radius)
        self.neighbours = None if radius is None else Neighbours(radius)
        self.ring: Neighbourhood | None = None
        self.crosshair: State | None = None
        self.pointer: tuple[int, int] | None = None  # the cell under it
        self.aiming = False  # the pointer is about to choose a start
        self.zoomed: Viewport | None = None  # None: the whole portrait
        self._whole: Viewport | None = None
        self._portrait: Portrait | None = None
        self._plot: Picture | None = None
        self._catching_up = False

    @property
    def settled(self) -> bool:
        """Whether all of it is shown as it is now."""
        return not (self.drawable and self._catching_up)

    def watch_source(self) -> None:
        """Say what can be done here."""
        live = self.source is not None and self.source.kind == "LIVE"
        self.border_title = f"Phase space: theta, omega ({'click: start, ' if live else ''}wheel: zoom)"

    def watch_sample(self) -> None:
        """Follow the sample."""
        self.draw()

    def watch_shown(self) -> None:
        """Follow the settings."""
        self.draw()

    def watch_wrap(self) -> None:
        """Begin again with the whole portrait."""
        self._whole = self.zoomed = None
        self.draw()

    def watch_radius(self) -> None:
        """Another ring, from the run's start."""
        self.neighbours = None if self.radius is None else Neighbours(self.radius)
        self.ring = None
        self.draw()

    @property
    def cells(self) -> tuple[int, int]:
        """Columns and rows of the plot; a pane that is just being hidden still has one of each."""
        return max(self.room.width, 1), max(self.room.height - 1, 1)

    @property
    def viewport(self) -> Viewport:
        """What is in view."""
        assert self.source is not None
        columns, rows = self.cells
        if self.zoomed is not None:
            if (self.zoomed.columns, self.zoomed.rows) != (columns, rows):
                self.zoomed = self.zoomed.resized(columns, rows)
            return self.zoomed
        whole, held = Viewport.portrait(columns, rows, self.source.scene, self.wrap), self._whole
        same_size = held is not None and (held.columns, held.rows) == (columns, rows)
        if held is None or not (same_size and 0.7 < whole.omega_per_dot / held.omega_per_dot < 1.3):
            self._whole = held = whole  # else it shows enough, and does not jump with every new start
        return held

    @property
    def aim(self) -> State | None:
        """The state at the crosshair or, if there is none, under the pointer."""
        if self.crosshair is not None:
            return self.crosshair
        return None if self.pointer is None else self.viewport.at_cell(*self.pointer)

    def draw(self) -> None:
        """Draw everything."""
        source, sample = self.source, self.sample
        if source is None or sample is None or not self.drawable:
            return
        viewport, w0 = self.viewport, source.scene.w0
        if self._portrait is None or (self._portrait.viewport, self._portrait.w0) != (viewport, w0):
            self._portrait = Portrait.of(viewport, w0)
        orbit = self.aim if self.aiming or self.crosshair is not None else None
        self._plot = phase_picture(self._portrait, self._points(source, sample), self.crosshair, orbit)
        self.tell()

    def _points(self, source: Source, sample: Sample) -> list[Point]:
        self._follow(source, sample)
        length = TRAIL if self.shown.trails else 0
        points = []
        if self.shown.exact:
            points.append(Point(*source.exact.at(sample.t), EXACT, "x"))
        for index in self.shown.indices:
            reading = sample.readings[index]
            trail = source.history.trail(index, length)
            ring = None if self.ring is None else self.ring.rings[index]
            points.append(Point(reading.theta, reading.omega, index, METHODS[index].letter, trail, ring))
        return points

    def _follow(self, source: Source, sample: Sample) -> None:
        """Let the ring keep up; where it has not, go on without waiting for the next sample."""
        if self.neighbours is not None:
            self.ring = self.neighbours.follow(source.scene, sample.run, sample.step, source.changes, RING_STEPS)
            if self.neighbours.step < sample.step and not self._catching_up:
                self._catching_up = True
                self.set_timer(1 / 30, self._catch_up)

    def _catch_up(self) -> None:
        self._catching_up = False
        self.draw()
        self.post_message(self.RingMoved())

    def tell(self) -> None:
        """Say what is at the crosshair or under the pointer, and what the exact swing is as far as there is room."""
        if self.source is None or self._plot is None:
            return
        width, swing = self._plot.characters.shape[1], motion_text(self.source.exact)
        line = Canvas(width, 1).picture()
        if self.aim is None:
            line.write(0, 0, swing, FRAME)
        else:
            room = width - len(swing) - 2
            line.write(0, 0, place_text(self.source.scene.w0, *self.aim, room if room >= 60 else width), TEXT)
            if room >= 60:
                line.write(0, width - len(swing), swing, FRAME)
        self.show_picture(Picture.stacked(self._plot, line))
