"""AccuracyPane: the chart of cost against accuracy, to choose h from with the keyboard."""

import asyncio
from collections.abc import Sequence
from functools import partial
from textwrap import wrap
from typing import ClassVar

from textual.binding import BindingType
from textual.worker import Worker, WorkerState

from engine.accuracy.study import REASONS, ErrorKind, Point
from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT
from tui.playback.source import Source
from tui.views.accuracy.chart import accuracy_chart, power
from tui.views.keys import Key, bindings
from tui.views.messages import StepSizeChosen
from tui.views.view import Chooser
from tui.words.scope import left_out

WORDS = 2  # lines
MOST_STEPS = 2_000_000  # of a run for the mark at the present h: some seconds
HERE, CURSOR = "@", "O"
LEGEND = f"{HERE} current h  x useless  ~ rounding  dotted:"

_GROUP = "accuracy"
KEYS = (
    Key("left", "arrows", "cursor, to choose a point", "move(-1)", _GROUP),
    Key("right", "", "", "move(1)", _GROUP),
    Key("up", "", "", "method(-1)", _GROUP),
    Key("down", "", "", "method(1)", _GROUP),
    Key("enter", "enter", "use the h of the cursor's point", "choose", _GROUP, "Take it"),
    Key("tab", "tab", "the next method in words", "method(1)", _GROUP, "Next method"),
    Key("escape", "esc", "leave the cursor", "cancel", _GROUP),
)


class AccuracyPane(Chooser[int]):
    """Draws the points known so far, with a mark at the present h of each method, and describes one of them."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(*KEYS)

    def __init__(self) -> None:
        super().__init__()
        self.time, self.rungs = 0.0, list[int]()
        self.here: tuple[int, ...] = ()  # steps of each method at the present h
        self.points: dict[tuple[int, int], Point] = {}  # by method and steps
        self._drawn: object = None
        self._building = False

    def begin(self, time: float, rungs: Sequence[int]) -> None:
        """Start over: points of other step counts, methods or pendulums are to come."""
        self.border_subtitle = f"{LEGEND} {', '.join(map(power, sorted({method.order for method in self.cast})))}"
        self.time, self.rungs, self.points, self.cursor, self.here = time, list(rungs), {}, None, ()

    def add(self, point: Point) -> None:
        """Take in a point; it is drawn with one of the next samples."""
        if point.method in self.cast:
            self.points[self.cast.index(point.method), point.steps] = point

    @property
    def kind(self) -> ErrorKind:
        """The error that is charted: what the lab's chart shows, energy or theta."""
        return "theta" if self.shown.quantity == "theta_error" else "energy"

    @property
    def missing(self) -> int:
        """How many points of the ladder are not there yet."""
        wanted = [(index, steps) for index in range(len(self.cast)) for steps in self.rungs]
        return sum(place not in self.points for place in wanted)

    @property
    def settled(self) -> bool:
        """Whether everything is there and drawn."""
        if self.source is not None and not self.source.scene.general:
            return True
        wanted = [(index, steps) for index, steps in enumerate(self.here) if 1 < steps <= MOST_STEPS]
        known = bool(self.rungs) and not self.missing and all(place in self.points for place in wanted)
        return known and self._drawn == self._state

    @property
    def aim(self) -> Point | None:
        """The point that is described: at the cursor, or at the present h."""
        if self.cursor is not None:
            return self.points.get((self.index, self.rungs[self.cursor]))
        return self.points.get((self.index, self.here[self.index])) if self.here else None

    @property
    def _state(self) -> object:
        return frozenset(self.points), self.here, self.index, self.cursor, self.shown, self.room

    def paint(self, source: Source, sample: Sample) -> None:
        """Build a chart of what is new in a thread, unless one is being built; the next sample asks again."""
        if why := left_out(source.scene, "The accuracy chart"):
            self.border_title, self.border_subtitle, self._drawn = "Accuracy (F4)", "", None
            self.show([[(f" {line}", TEXT)] for line in wrap(why, max(self.room.width - 2, 1))])
            return
        if self._drawn != self._state and not self._building:
            self._building = True
            self.run_worker(self._build(), group="chart", exit_on_error=False)

    def on_worker_state_changed(self, event: Worker.StateChanged) -> None:
        """Say what failed; the next change asks for another chart."""
        if event.state is WorkerState.ERROR and event.worker.error is not None:
            self._drawn, self._building = self._state, False
            self.fail(event.worker.error)

    async def _build(self) -> None:
        state, kind, shown = self._state, self.kind, self.places
        points = [p for (i, steps), p in sorted(self.points.items()) if i in shown and steps in self.rungs]
        here = [
            (HERE, self.points[place]) for place in enumerate(self.here) if place in self.points and place[0] in shown
        ]
        marks = [*here, *([(CURSOR, self.aim)] if self.cursor is not None and self.aim else [])]
        width, height = self.room
        chart = partial(accuracy_chart, points, kind, "evaluations", width, max(height - WORDS, 1), marks=marks)
        picture = await asyncio.to_thread(chart)
        rows = [picture.row(y) for y in range(len(picture.characters))]
        state_text = f", {self.missing} points left" if self.missing else ""
        self.border_title = f"Accuracy (F4) over {self.time:g} s: {kind} error{state_text}"
        said = wrap(self._words(), max(width - 2, 1), max_lines=WORDS, placeholder=" …")
        self.show([*rows, *([(f" {line}", TEXT)] for line in said)])
        self._drawn, self._building = state, False

    def _words(self) -> str:
        point = self.aim
        if point is None:
            return "" if self.missing else "the current h is not on this chart: it is too large or too small"
        place = "current h" if self.cursor is None else "Enter: use this h" if self.is_live else ""
        flaw = point.flaw(self.kind)
        return (
            f"{point.method.label} at h {point.h:.4g} s: {self.kind} error {point.error(self.kind):.1e}"
            f"{f' ({REASONS[flaw]})' if flaw else ''} for {point.force_evaluations} force evaluations; {place}"
        )

    def action_move(self, right: int) -> None:
        """Move the cursor along the method's points; those to the right cost more."""
        if self.rungs:
            if self.cursor is None:
                steps = self.here[self.index] if self.here else self.rungs[0]
                at = min(range(len(self.rungs)), key=lambda rung: abs(self.rungs[rung] - steps))
            else:
                at = self.cursor + right
            self.cursor = min(max(at, 0), len(self.rungs) - 1)
            self.draw()

    def choose(self, rung: int) -> None:
        assert self.source is not None
        h = self.time / self.rungs[rung]
        self.post_message(StepSizeChosen(self.source.stepping.with_own(self.cast[self.index], h)))
