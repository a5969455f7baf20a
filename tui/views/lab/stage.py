"""Stage: the methods' pendulums, which can be dragged and thrown."""

from collections.abc import Sequence
from math import asin, atan2, copysign, hypot, isfinite, nan, pi, remainder, tau
from typing import NamedTuple

from textual import events
from textual.geometry import Offset

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.palette import inks
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.lab.lanes import TRAIL, Bob, Look, lanes, stage_picture
from pendu_tui.tui.views.reach import amplitude, reach
from pendu_tui.tui.views.view import Held, Pane

TITLES = ("One pendulum, a lane for each method", "Pendulum, in lanes", "In lanes")
SPRINGS = ("One bob on a spring for each method", "Bobs on springs", "Springs")
HARDEST = 5.0  # w0 of a throw: 6 times the energy that takes a pendulum over the top
MAGNIFIED = (0.4, 0.8)  # rad, between which the widest of small swings is enlarged


class Lens(NamedTuple):
    """A scale of angles: up to `half` [rad] they are enlarged, and the rest fits the circle."""

    half: float = pi
    times: int = 1

    def __call__(self, theta: float) -> float:
        if self.times == 1 or not isfinite(theta):
            return theta
        rest = remainder(theta, tau)
        edge = self.times * self.half
        seen = self.times * abs(rest)
        if seen > edge:
            seen = edge + (abs(rest) - self.half) * (pi - edge) / (pi - self.half)
        return theta - rest + copysign(seen, rest)


class Stage(Pane):
    MOVES = True

    def __init__(self) -> None:
        super().__init__()
        self._drag: list[tuple[float, float]] = []  # s of the event, rad
        self._down: Offset | None = None  # where the button went down
        self._drawn: tuple[Sequence[Bob], Look] = (), Look()

    def picture(self, source: Source, sample: Sample) -> Picture:
        held = self.shown.held is not None
        scene = source.scene
        model = scene.equations
        swing = reach(scene, source.stepping, sample, self.places)
        lens = self._lens(swing.frame)
        widest = swing.widest
        if source.ghost is not None:
            widest = min(max(widest, source.ghost.widest), pi)
        if held:
            widest = pi
        look = Look(
            widest=lens(widest),
            amplitude=lens(amplitude(model, scene.theta, scene.omega)),
            rigid=model.rigid,
            joins=abs(source.stepping.h) * model.fastest <= 1,
        )
        if not held:
            look = look._replace(
                exact=lens(source.exact.at(sample.t).theta),
                exact_length=model.exact_length(scene.theta, scene.omega, sample.t),
            )
        self._drawn = self._bobs(source, sample, lens), look
        self._write_titles(lens, held)
        return stage_picture(*self.room, *self._drawn)

    def _lens(self, frame: float) -> Lens:
        """Return the scale that enlarges small swings to fill the stage."""
        half = self.shown.theta or frame
        columns, rows = self.room
        narrow, wide = MAGNIFIED
        widest = min(max(asin(min(columns / (4 * rows), 1.0)), narrow), wide)
        times = int(widest / half)
        if times < 2 or self.shown.overview or self.shown.held is not None:
            return Lens()
        return Lens(half, times)

    def _bobs(self, source: Source, sample: Sample, lens: Lens) -> list[Bob]:
        scene = source.scene
        model = scene.equations
        held = self.shown.held is not None
        ghosts = {}
        if source.ghost is not None and not held:
            ghosts = source.ghost.rods(sample.t)
        bobs = []
        for place in self.places:
            method = scene.cast[place]
            reading = sample.readings[place]
            bob = Bob(lens(reading.theta), inks(scene.cast)[place], method.letter)
            if not held:
                trail = []
                if model.rigid:
                    trail = [*source.history.thetas(place, TRAIL), reading.theta]
                bob = bob._replace(
                    ahead=copysign(1.0, reading.omega),
                    trail=[lens(theta) for theta in trail],
                    length=model.length(reading.extra),
                    diverged=reading.diverged_at is not None,
                    ghost=lens(ghosts.get(method.key, nan)),
                )
            bobs.append(bob)
        return bobs

    def _write_titles(self, lens: Lens, held: bool) -> None:
        room = self.room.width - 4
        titles: Sequence[str] = TITLES
        if not self.source.scene.equations.rigid:
            titles = SPRINGS
        if len(self.places) == 1:
            titles = [self.cast[self.places[0]].label]
        if lens.times > 1:
            note = f", small angles ×{lens.times}"
            titles = [*(f"{title}{note}" for title in titles), note.removeprefix(", ")]
        below = "drag: throw it"
        if held:
            below = "let go: start here"
        elif room >= 32:
            below = "drag: throw it · dotted: exact"
        self.write_titles(next((each for each in titles if len(each) <= room), titles[-1]), below)

    # The mouse

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            self.capture_mouse()
            self._down = event.screen_offset

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        """Hold the bobs at the pointer once this is clearly a drag, not a click."""
        if self._down is None:
            return
        across, down = event.screen_offset - self._down
        if not self._drag and max(abs(across), 2 * abs(down)) < 3:
            return
        x, y = event.get_content_offset_capture(self)
        right = 2 * x + 1 - self.room.width  # from a pivot in the middle
        down = 4 * y + 2 - 2 * self.room.height
        theta = round(atan2(right, down), 3)
        self._drag.append((event.time, theta))
        self.post_message(Held(theta))

    async def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._down is None:
            return
        drag = [*self._drag]
        self._let_go()
        if drag:
            self.post_message(Held(None))
            self._throw(drag, event.time)
        elif (place := self._place_at(event)) is not None:
            await self.run_action(f"screen.show_alone({place})")

    def _throw(self, drag: Sequence[tuple[float, float]], now: float) -> None:
        """Start a run from the last angle, at the pointer's speed over the last 0.1 s."""
        recent = [(time, theta) for time, theta in drag if now - time < 0.1] or drag[-1:]
        first_time, first_theta = recent[0]
        last_time, last_theta = recent[-1]
        seconds = (last_time - first_time) * abs(self.source.playhead.speed)
        omega = 0.0
        if seconds > 0:
            omega = remainder(last_theta - first_theta, tau) / seconds
        # moves that came late come at once, as if the pointer had been fast
        fastest = HARDEST * self.source.scene.w0
        omega = round(min(max(omega, -fastest), fastest), 2)
        self.start_at(last_theta, omega)

    def _let_go(self) -> None:
        self.release_mouse()
        self._down = None
        self._drag.clear()

    def _place_at(self, event: events.MouseUp) -> int | None:
        """Return the place in the cast whose lane, or bob on a spring, was clicked."""
        offset = event.get_content_offset(self)
        if offset is None or not self.places:
            return None
        bobs, look = self._drawn
        found = lanes(*self.room, len(bobs), look.widest, look.rigid)
        x = 2 * offset.x + 1.0
        y = 4 * offset.y + 2.0
        far = [hypot(x - right, y - down) for right, down in map(found.place, bobs, found.radii)]
        if look.rigid:
            out = hypot(x - found.x, y - found.y)
            far = [abs(out - radius) for radius in found.radii]
        nearest = min(range(len(far)), key=far.__getitem__)
        if far[nearest] > 2 * found.bob + 2:
            return None
        return self.places[nearest]
