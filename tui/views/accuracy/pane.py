"""AccuracyPane: charts of error over cost and over time; h is chosen on the first, with keyboard or mouse."""

import asyncio
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from textwrap import wrap
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType

from engine.accuracy.front import Cost
from engine.accuracy.growth import Growth
from engine.accuracy.references import AnyPoint, References, with_all_methods
from engine.accuracy.study import ErrorKind, Point
from engine.methods import Cast
from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.views.accuracy.chart import Placed, accuracy_series, charted, growth_chart, nearest, raised
from tui.views.accuracy.words import front_lines, growth_lines, point_words
from tui.views.messages import StepSizeChosen
from tui.views.view import Chooser

WORDS, MOST_WORDS, ROOMY = 2, 4, 18  # lines of words; as many as that in so many rows
MOST_STEPS = 2_000_000  # of a run for the mark at the present h: some seconds
HERE, CURSOR = "@", "O"
LEGEND = f"{HERE} current h  x useless  ~ rounding  dotted:"


class AccuracyPane(Chooser[int]):
    """Draws the points known so far, with a mark at the present h of each method, and describes one of them."""

    BINDING_GROUP_TITLE = "Accuracy"
    HELP = "A click uses that point's h; the pointer reads points out."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "move(-1)", "cursor, to choose a point", False, "arrows"),
        Binding("right", "move(1)"),
        Binding("up", "method(-1)"),
        Binding("down", "method(1)"),
        Binding("enter", "choose", "Use h", tooltip="use the cursor's h"),
        Binding("tab", "method(1)", "the next method in words", show=False),
        Binding("escape", "cancel", "leave the cursor", False, "esc"),
        Binding("e", "chart", "Over time", tooltip="next chart: time, theta, …"),
        Binding("asterisk", "all", "All", True, "*", tooltip="all methods, or the shown"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.time, self.rungs = 0.0, list[int]()
        self.all = False  # the methods that are not in the cast, and the reference lines, over seconds
        self.over_time = False  # the chart of errors in theta over time
        self._kind: ErrorKind | None = None  # None: as the lab's chart
        self.here: tuple[int, ...] = ()  # steps of each method at the present h
        self.points: dict[tuple[int, int], Point] = {}  # by method and steps
        self.references: References | None = None
        self.growths: list[Growth] = []  # at the present h
        self.pointer: AnyPoint | None = None
        self._cells, self._chart = list[Placed](), list[Row]()
        self._drawn: object = None
        self._building = False

    def begin(self, time: float, rungs: Sequence[int]) -> None:
        """Start over: points of other step counts, methods or pendulums are to come."""
        self.time, self.rungs, self.points, self.cursor, self.here = time, list(rungs), {}, None, ()
        self.references, self.pointer, self._cells = None, None, []
        self._explain()

    def _explain(self) -> None:
        """Say what the chart's marks are."""
        powers = ", ".join(raised("h", order) for order in sorted({method.order for method in self.cast}))
        self.border_subtitle = "dotted: slopes t, t²" if self.over_time else f"{LEGEND} {powers}"

    def add(self, found: Point | References | Growth) -> None:
        """Take in what has been computed; it is drawn with one of the next samples."""
        if isinstance(found, References):
            self.references = found
        elif isinstance(found, Growth):
            self.growths = [*self.growths, found]
        elif found.method in self.cast:
            self.points[self.cast.index(found.method), found.steps] = found

    @property
    def cast(self) -> Cast:
        """The methods on the chart: those of the run first."""
        if self.all and self.source is not None and self.source.scene.general:
            return with_all_methods(self.source.scene).cast
        return super().cast

    @property
    def kind(self) -> ErrorKind:
        """The error that is charted over cost: what the lab's chart shows, until another one is asked for."""
        return self._kind or ("theta" if self.shown.quantity == "theta_error" else "energy")

    @property
    def cost(self) -> Cost:
        """Seconds where there are reference lines, which count nothing else."""
        return "seconds" if self.all else "evaluations"

    @property
    def missing(self) -> int:
        """How many points of the ladder are not there yet."""
        wanted = [(index, steps) for index in range(len(self.cast)) for steps in self.rungs]
        return sum(place not in self.points for place in wanted) + (self.all and self.references is None)

    @property
    def settled(self) -> bool:
        """Whether everything is there and drawn."""
        if self.source is not None and not self.source.scene.general:
            return True
        wanted = [(index, steps) for index, steps in enumerate(self.here) if 1 < steps <= MOST_STEPS]
        known = bool(self.rungs) and not self.missing and all(place in self.points for place in wanted)
        grown = not self.over_time or len(self.growths) == len(self.here)
        return known and grown and self._drawn == self._state

    @property
    def aim(self) -> AnyPoint | None:
        """The point that is described: under the pointer, at the cursor, or at the present h."""
        if self.pointer is not None:
            return self.pointer
        if self.cursor is not None:
            return self.points.get((self.index, self.rungs[self.cursor]))
        return self.points.get((self.index, self.here[self.index])) if self.index < len(self.here) else None

    @property
    def _state(self) -> object:
        computed = frozenset(self.points), self.references is None, tuple(map(id, self.growths))
        return computed, self.here, self.index, self.cursor, self.shown, self.room, self.kind, self.over_time, self.all

    def paint(self, source: Source, sample: Sample) -> None:
        """Build a chart of what is new in a thread, unless one is being built; the next sample asks again."""
        if why := source.scene.why_not_mapped:
            self.border_title, self.border_subtitle, self._drawn = "Accuracy (F4)", "", None
            self.show(Picture([[(f" {line}", TEXT)] for line in wrap(why, max(self.room.width - 2, 1))]))
            return
        if self._drawn != self._state and not self._building:
            self._building = True
            self.run_worker(self._build(), group="chart")

    async def _build(self) -> None:
        state, lines = self._state, MOST_WORDS if self.room.height >= ROOMY else WORDS
        draw = self._growth if self.over_time else self._accuracy
        picture, self._cells = await asyncio.to_thread(draw, self.room.width, max(self.room.height - lines, 1))
        self._chart = [*picture.rows]
        left = f", {self.missing} points left" if self.missing else ""
        over_cost = f"Accuracy (F4) over {self.time:g} s: {self.kind} error{left}"
        self.border_title = "Theta error over time, at each method's h" if self.over_time else over_cost
        self.tell()
        self._drawn, self._building = state, False

    def tell(self) -> None:
        """Show the chart, and words below it."""
        lines = [line for words in self._words() for line in wrap(words, max(self.room.width - 2, 1))]
        self.show(Picture([*self._chart, *([(f" {line}", TEXT)] for line in lines)][: self.room.height]))

    def _accuracy(self, width: int, height: int) -> tuple[Picture, list[Placed]]:
        """The chart of error over cost, and where the points are on it."""
        kind, cost, shown = self.kind, self.cost, self.places
        points = [p for (i, steps), p in sorted(self.points.items()) if i in shown and steps in self.rungs]
        marks = [(HERE, p) for place in enumerate(self.here) if place[0] in shown and (p := self.points.get(place))]
        if self.cursor is not None and (at := self.points.get((self.index, self.rungs[self.cursor]))):
            marks.append((CURSOR, at))
        every: list[AnyPoint] = [*points, *(p for _, p in marks), *(self.references.taylor if self.references else ())]
        series = accuracy_series(points, kind, cost, marks, self.references, len(self.rungs), self.cast)
        return charted(series, every, kind, cost, width, height)

    def _growth(self, width: int, height: int) -> tuple[Picture, list[Placed]]:
        """The chart of error over time, of the methods that are shown."""
        hidden = self.shown.hidden
        shown = [growth for growth in self.growths if growth.method.key not in hidden]
        return growth_chart(shown, self.cast, width, height), []

    def _words(self) -> list[str]:
        if self.over_time:
            return growth_lines(self.growths, done=len(self.growths) == len(self.here))
        ladder = [point for (_, steps), point in self.points.items() if steps in self.rungs]
        ahead = [] if self.missing else front_lines(ladder, self.references, self.kind, self.cost)
        if (point := self.aim) is not None:
            return [point_words(point, self.kind, self._note(point)), *ahead]
        said = "the current h is not on this chart: it is too large or too small"
        if self.index >= len(self.here):
            said = f"{self.cast[self.index].label} is not on stage; the arrows choose one of its points"
        return ["" if self.missing else said, *ahead]

    def _note(self, point: AnyPoint) -> str:
        if self.pointer is None and self.cursor is None:
            return "current h"
        takes = self.is_live and isinstance(point, Point)
        return f"{'click' if self.pointer else 'Enter'}: use this h" if takes else ""

    def action_chart(self) -> None:
        """The next chart: error over time, theta error over cost, energy error over cost."""
        if self.over_time:
            self.over_time, self._kind = False, "theta"
        elif self.kind == "theta":
            self._kind = "energy"
        else:
            self.over_time = True
        self._explain()
        self.draw()

    def action_all(self) -> None:
        """Chart all methods and the reference lines, or the cast alone; the view has them computed."""
        self.all, self.over_time = not self.all, False

    def action_move(self, right: int) -> None:
        """Move the cursor along the method's points; those to the right cost more."""
        if self.rungs:
            here = self.here[self.index] if self.index < len(self.here) else self.rungs[0]
            at = bisect_right(self.rungs, here) if right > 0 else bisect_left(self.rungs, here) - 1
            self.cursor = min(max(at if self.cursor is None else self.cursor + right, 0), len(self.rungs) - 1)
            self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if (under := self._under(event)) is not self.pointer:
            self.pointer = under
            self.tell()

    def on_leave(self) -> None:
        if self.pointer is not None:
            self.pointer = None
            self.tell()

    def on_click(self, event: events.Click) -> None:
        if isinstance(point := self._under(event), Point) and self.is_live:
            self.cursor = self.pointer = None
            self.describe(self.cast.index(point.method))
            self._use(point)

    def choose(self, rung: int) -> None:
        self._use(self.points.get((self.index, self.rungs[rung])))

    def _use(self, point: Point | None) -> None:
        if self.source is not None and point is not None:
            self.post_message(StepSizeChosen(self.source.stepping.with_own(point.method, point.h)))

    def _under(self, event: events.MouseEvent) -> AnyPoint | None:
        return nearest(self._cells, *event.get_content_offset_capture(self))
