"""AccuracyPane: charts of error over cost and over time; h is chosen on the first, with keyboard or mouse."""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from textwrap import wrap
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType

from engine.accuracy.front import Cost
from engine.accuracy.growth import Growth
from engine.accuracy.references import AnyPoint, References, with_all_methods
from engine.accuracy.study import ErrorKind, Point
from engine.methods import Cast, Method
from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.accuracy.chart import Placed, accuracy_series, charted, growth_chart, nearest, raised
from tui.views.accuracy.words import front_lines, growth_lines, point_words
from tui.views.messages import StepSizeChosen
from tui.views.view import Chooser

MIN_WORDS, MAX_WORDS, ROOMY = 2, 4, 18  # lines of words; as many as that in so many rows
MAX_STEPS = 2_000_000  # of a run for the mark at the present h: some seconds
HERE, CURSOR = "@", "O"
LEGEND = f"{HERE} current h  x useless  ~ rounding  dotted:"


@dataclass
class AccuracyPoints:
    """The points of a study, as far as they have been computed."""

    time: float = 0.0  # s
    steps: Sequence[int] = ()  # of each method's points, ascending
    here: tuple[int, ...] = ()  # steps of each method at the present h
    references: References | None = None
    points: dict[tuple[str, int], Point] = field(
        default_factory=dict
    )  # by a method's key and steps

    def add(self, point: Point) -> None:
        self.points[point.method.key, point.steps] = point

    def of(self, method: Method) -> list[Point]:
        """Return the method's points that every method has, by cost."""
        return [point for steps in self.steps if (point := self.points.get((method.key, steps)))]

    def at_present(self, place: int, method: Method) -> Point | None:
        """Return the point at the present h; only methods of the run have one."""
        return self.points.get((method.key, self.here[place])) if place < len(self.here) else None

    def missing(self, cast: Cast) -> int:
        """Return the number of points that are not there yet."""
        return sum(len(self.steps) - len(self.of(method)) for method in cast)


class AccuracyPane(Chooser[int]):
    """Draws the points computed so far, with a mark at the present h of each method, and describes one of them."""

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
        self.study = AccuracyPoints()
        self.growths: list[Growth] = []  # at the present h
        self.all = (
            False  # the methods that are not in the cast, and the reference lines, over seconds
        )
        self.over_time = False  # the chart of errors in theta over time
        self.pointer: AnyPoint | None = None
        self._kind: ErrorKind | None = None  # None: as the lab's chart
        self.placed: list[Placed] = []  # on the chart
        self._chart = Picture()
        self._charted: object = None

    def begin(self, study: AccuracyPoints) -> None:
        """Show the points of another study, which are to come."""
        self.study = study
        self.cursor = None
        self.pointer = None
        self.placed = []

    def add(self, computed: Point | References | Growth) -> None:
        """Take in what has been computed; it is drawn with one of the next samples."""
        if isinstance(computed, References):
            self.study.references = computed
        elif isinstance(computed, Growth):
            self.growths = [*self.growths, computed]
        else:
            self.study.add(computed)

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
        """How many points, and reference lines, are not there yet."""
        missing = self.study.missing(self.cast)
        if self.all and self.study.references is None:
            missing += 1
        return missing

    @property
    def settled(self) -> bool:
        """Whether everything is there and drawn."""
        if self.source is not None and not self.source.scene.general:
            return True
        if not self.study.steps or self.missing or self._charted != self._state:
            return False
        if self.over_time and len(self.growths) < len(self.study.here):
            return False
        run = zip(self.cast, self.study.here, strict=False)
        return all(
            (method.key, steps) in self.study.points
            for method, steps in run
            if 1 < steps <= MAX_STEPS
        )

    @property
    def aim(self) -> AnyPoint | None:
        """The point that is described: under the pointer, at the cursor, or at the present h."""
        if self.pointer is not None:
            return self.pointer
        method = self.cast[self.index]
        if self.cursor is not None:
            return self.study.points.get((method.key, self.study.steps[self.cursor]))
        return self.study.at_present(self.index, method)

    @property
    def _state(self) -> object:
        """What the chart depends on."""
        study = self.study
        computed = len(study.points), study.references, len(self.growths)
        chosen = self.index, self.cursor, self.kind, self.over_time, self.all
        return id(study), study.here, computed, chosen, self.shown, self.room

    def picture(self, source: Source, sample: Sample) -> Picture:
        width = self.room.width
        if why := source.scene.why_not_mapped:
            self.write_titles("Accuracy (F4)", "")
            return Picture([[(f" {line}", TEXT)] for line in wrap(why, max(width - 2, 1))])
        if self._charted != self._state:
            self._charted = self._state
            height = max(
                self.room.height - (MAX_WORDS if self.room.height >= ROOMY else MIN_WORDS), 1
            )
            if self.over_time:
                shown = [
                    growth for growth in self.growths if growth.method.key not in self.shown.hidden
                ]
                self._chart, self.placed = growth_chart(shown, self.cast, width, height), []
            else:
                self._chart, self.placed = self._over_cost(width, height)
        self._write_titles()
        lines = [line for words in self._words() for line in wrap(words, max(width - 2, 1))]
        return Picture(
            [*self._chart.rows, *([(f" {line}", TEXT)] for line in lines)][: self.room.height]
        )

    def _write_titles(self) -> None:
        """Write above what is charted, and below what its marks are."""
        if self.over_time:
            self.write_titles("Theta error over time, at each method's h", "dotted: slopes t, t²")
            return
        powers = ", ".join(
            raised("h", order) for order in sorted({method.order for method in self.cast})
        )
        left = f", {self.missing} points left" if self.missing else ""
        title = f"Accuracy (F4) over {self.study.time:g} s: {self.kind} error{left}"
        self.write_titles(title, f"{LEGEND} {powers}")

    def _over_cost(self, width: int, height: int) -> tuple[Picture, list[Placed]]:
        """Return the chart of error over cost, and where the points are on it."""
        study = self.study
        methods = [(place, self.cast[place]) for place in self.places]
        points = [point for _, method in methods for point in study.of(method)]
        marks = [(HERE, point) for at in methods if (point := study.at_present(*at))]
        if self.cursor is not None and isinstance(self.aim, Point):
            marks.append((CURSOR, self.aim))
        every: list[AnyPoint] = [*points, *(point for _, point in marks)]
        if study.references:
            every += study.references.taylor
        series = accuracy_series(
            points, self.kind, self.cost, marks, study.references, len(study.steps), self.cast
        )
        return charted(series, every, self.kind, self.cost, width, height)

    def _words(self) -> list[str]:
        study = self.study
        if self.over_time:
            return growth_lines(self.growths, done=len(self.growths) == len(study.here))
        ahead = []
        if not self.missing:
            points = [point for method in self.cast for point in study.of(method)]
            ahead = front_lines(points, study.references, self.kind, self.cost)
        if (point := self.aim) is not None:
            return [point_words(point, self.kind, self._note(point)), *ahead]
        if self.missing:
            return [""]
        if self.index >= len(study.here):
            return [
                f"{self.cast[self.index].label} is not shown; the arrows choose one of its points",
                *ahead,
            ]
        return ["the current h is not on this chart: it is too large or too small", *ahead]

    def _note(self, point: AnyPoint) -> str:
        if self.pointer is None and self.cursor is None:
            return "current h"
        if not (self.is_live and isinstance(point, Point)):
            return ""
        return "click: use this h" if self.pointer else "Enter: use this h"

    def action_chart(self) -> None:
        """Show the next chart: error over time, theta error over cost, energy error over cost."""
        if self.over_time:
            self.over_time = False
            self._kind = "theta"
        elif self.kind == "theta":
            self._kind = "energy"
        else:
            self.over_time = True
        self.draw()

    def action_all(self) -> None:
        """Chart all methods and the reference lines, or the cast alone; the view has them computed."""
        self.all = not self.all
        self.over_time = False

    def action_move(self, right: int) -> None:
        """Move the cursor along the method's points; those to the right cost more."""
        steps = self.study.steps
        if not steps:
            return
        if self.cursor is not None:
            at = self.cursor + right
        else:
            here = self.study.here[self.index] if self.index < len(self.study.here) else steps[0]
            at = bisect_right(steps, here) if right > 0 else bisect_left(steps, here) - 1
        self.cursor = min(max(at, 0), len(steps) - 1)
        self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if (under := self._under(event)) is not self.pointer:
            self.pointer = under
            self.draw()

    def on_leave(self) -> None:
        self.pointer = None
        self.draw()

    def on_click(self, event: events.Click) -> None:
        if isinstance(point := self._under(event), Point) and self.is_live:
            self.cursor = self.pointer = None
            self.describe(self.cast.index(point.method))
            self._use(point)

    def choose(self, place: int) -> None:
        self._use(self.study.points.get((self.cast[self.index].key, self.study.steps[place])))

    def _use(self, point: Point | None) -> None:
        if self.source is not None and point is not None:
            self.post_message(StepSizeChosen(self.source.stepping.with_own(point.method, point.h)))

    def _under(self, event: events.MouseEvent) -> AnyPoint | None:
        return nearest(self.placed, *event.get_content_offset_capture(self))
