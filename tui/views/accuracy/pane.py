"""AccuracyPane: the chart of speed against accuracy, to choose h from with the keyboard."""

import asyncio
from collections.abc import Sequence
from functools import partial
from textwrap import wrap
from typing import ClassVar

from textual.binding import BindingType
from textual.reactive import var

from engine.accuracy.study import REASONS, ErrorKind, Point
from engine.methods import METHODS
from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.accuracy.chart import POWERS, accuracy_chart
from tui.views.keys import Key, bindings
from tui.views.messages import StepSizeChosen

WORDS = 2  # lines
MOST_STEPS = 2_000_000  # of a run for the mark at the present h: some seconds
HERE, CURSOR = "X", "O"
POWERS_OF_H = ", ".join(POWERS[order] for order in sorted({method.order for method in METHODS}))
LEGEND = f"{HERE} you are here; x failed; ~ only rounding; dotted: error as {POWERS_OF_H}"

_GROUP = "accuracy"
KEYS = (
    Key("left", "arrows", "cursor, to choose a point", "move(-1)", _GROUP),
    Key("right", "", "", "move(1)", _GROUP),
    Key("up", "", "", "method(-1)", _GROUP),
    Key("down", "", "", "method(1)", _GROUP),
    Key("enter", "enter", "use the h of the cursor's point", "choose", _GROUP),
    Key("tab", "tab", "the next method in words", "method(1)", _GROUP),
    Key("escape", "esc", "leave the cursor", "cancel", _GROUP),
)


class AccuracyPane(CellWidget, can_focus=True):
    """Draws the points that there are, "you are here" for each method, and one of them in words."""

    DEFAULT_CSS = """
    AccuracyPane { border: round $panel-lighten-2; width: 1fr; height: 1fr; }
    AccuracyPane { border-title-color: $foreground; border-subtitle-color: $foreground; }
    AccuracyPane:focus { border: round $primary; }
    """
    BINDINGS: ClassVar[list[BindingType]] = bindings(*KEYS)

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    shown: var[Shown] = var(Shown())

    def __init__(self) -> None:
        super().__init__()
        self.border_subtitle = LEGEND
        self.index = 2  # the method that is spoken of
        self.cursor: int | None = None  # a rung
        self.time, self.rungs = 0.0, list[int]()
        self.here: tuple[int, ...] = ()  # steps of each method at the present h
        self.points: dict[tuple[int, int], Point] = {}  # by method and steps
        self._drawn: object = None
        self._building = False

    def begin(self, time: float, rungs: Sequence[int]) -> None:
        """Wait for other points."""
        self.time, self.rungs, self.points, self.cursor = time, list(rungs), {}, None

    def add(self, point: Point) -> None:
        """Take in a point; it is drawn with one of the next samples."""
        self.points[METHODS.index(point.method), point.steps] = point

    @property
    def kind(self) -> ErrorKind:
        """The error that is charted: what the lab's chart shows, energy or theta."""
        return "theta" if self.shown.quantity == "theta_error" else "energy"

    @property
    def missing(self) -> int:
        """How many points of the ladder are not there yet."""
        wanted = [(index, steps) for index in range(len(METHODS)) for steps in self.rungs]
        return sum(place not in self.points for place in wanted)

    @property
    def settled(self) -> bool:
        """Whether everything is there and drawn."""
        wanted = [(index, steps) for index, steps in enumerate(self.here) if 1 < steps <= MOST_STEPS]
        known = bool(self.rungs) and not self.missing and all(place in self.points for place in wanted)
        return known and self._drawn == self._state

    @property
    def aim(self) -> Point | None:
        """The point that is spoken of: the cursor's, or the one here."""
        if self.cursor is not None:
            return self.points.get((self.index, self.rungs[self.cursor]))
        return self.points.get((self.index, self.here[self.index])) if self.here else None

    @property
    def _state(self) -> object:
        return frozenset(self.points), self.here, self.index, self.cursor, self.shown, self.room

    def watch_sample(self) -> None:
        """Draw what is new."""
        if self._drawn != self._state:
            self.draw()

    def draw(self) -> None:
        """Build the chart in a thread, unless one is being built; the next sample asks again."""
        if self.drawable and not self._building:
            self._building = True
            self.run_worker(self._build(), group="chart")

    async def _build(self) -> None:
        state, kind, shown = self._state, self.kind, self.shown.indices
        points = [p for (i, steps), p in sorted(self.points.items()) if i in shown and steps in self.rungs]
        here = [
            (HERE, self.points[place]) for place in enumerate(self.here) if place in self.points and place[0] in shown
        ]
        marks = [*here, *([(CURSOR, self.aim)] if self.cursor is not None and self.aim else [])]
        width, height = self.room
        chart = partial(accuracy_chart, points, kind, "evaluations", width, max(height - WORDS, 1), marks=marks)
        picture = await asyncio.to_thread(chart)
        rows = [picture.row(y) for y in range(len(picture.characters))]
        state_text = f", computing: {self.missing} points to come" if self.missing else ""
        self.border_title = f"Accuracy over {self.time:g} s: {kind} error up, force evaluations across{state_text}"
        said = wrap(self._words(), max(width - 2, 1), max_lines=WORDS, placeholder=" …")
        self.show([*rows, *([(f" {line}", TEXT)] for line in said)])
        self._drawn, self._building = state, False

    def _words(self) -> str:
        point = self.aim
        if point is None:
            return "" if self.missing else "you are not on this chart: h is too large or too small"
        place = "you are here" if self.cursor is None else "enter uses this h" if self._is_live else ""
        flaw = point.flaw(self.kind)
        return (
            f"{point.method.label} at h {point.h:.4g} s: {self.kind} error {point.error(self.kind):.1e}"
            f"{f' ({REASONS[flaw]})' if flaw else ''} for {point.force_evaluations} force evaluations; {place}"
        )

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """A recording's h cannot be chosen; its arrows and enter are not the pane's."""
        if action in ("choose", "cancel"):
            return self._is_live and self.cursor is not None
        return self._is_live or action != "move"

    @property
    def _is_live(self) -> bool:
        return self.source is not None and self.source.kind == "LIVE"

    def action_move(self, right: int) -> None:
        """Move the cursor along the method's points, to the right towards the dearer ones."""
        if self.rungs:
            if self.cursor is None:
                steps = self.here[self.index] if self.here else self.rungs[0]
                at = min(range(len(self.rungs)), key=lambda rung: abs(self.rungs[rung] - steps))
            else:
                at = self.cursor + right
            self.cursor = min(max(at, 0), len(self.rungs) - 1)
            self.draw()

    def action_method(self, down: int) -> None:
        """Go to the next method that is shown."""
        if shown := self.shown.indices:
            at = shown.index(self.index) if self.index in shown else -1
            self.index = shown[(at + down) % len(shown)]
            self.draw()

    def action_choose(self) -> None:
        """Use the h of the cursor's point."""
        if self.source is not None and (point := self.aim) is not None:
            self.cursor = None
            self.post_message(StepSizeChosen(self.source.stepping.with_own(point.method, point.h)))

    def action_cancel(self) -> None:
        """Leave the cursor."""
        self.cursor = None
        self.draw()
