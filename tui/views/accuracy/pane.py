"""AccuracyPane: error over cost and over time; h is chosen with keyboard or mouse."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType

from engine.accuracy.front import Cost, front
from engine.accuracy.growth import Growth
from engine.accuracy.study import ErrorKind, Point, with_all_methods
from engine.methods import Cast, Method
from engine.run.lockstep import Sample
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.accuracy.chart import (
    Placed,
    accuracy_chart,
    accuracy_series,
    growth_chart,
    nearest,
    placed,
)
from tui.views.messages import StepSizeChosen
from tui.views.view import Chooser
from tui.words.accuracy import front_words, growth_lines, point_words

MIN_WORDS, MAX_WORDS, ROOMY = 2, 4, 18  # lines of words; as many as that in so many rows
MAX_STEPS = 2_000_000  # of a run for the mark at the present h: some seconds
HERE = "@"
CURSOR = "O"
COST: Cost = "evaluations"
LEGEND = f"{HERE} current h  x no digit right  ~ limited by rounding"


@dataclass
class AccuracyPoints:
    """The points of a study, as far as they have been computed."""

    time: float = 0.0  # s
    steps: Sequence[int] = ()  # of each method's points, ascending
    here: tuple[int, ...] = ()  # steps of each method at the present h
    points: dict[tuple[str, int], Point] = field(default_factory=dict)  # by method's key and steps

    def of(self, method: Method) -> list[Point]:
        """Return the method's points that every method has, by cost."""
        return [point for steps in self.steps if (point := self.points.get((method.key, steps)))]

    def at_present(self, place: int, method: Method) -> Point | None:
        """Return the point at the present h; only methods of the run have one."""
        return self.points.get((method.key, self.here[place])) if place < len(self.here) else None


class AccuracyPane(Chooser[Point]):
    """Draws the points computed so far, marks each method's h, and describes one point."""

    BINDING_GROUP_TITLE = "Accuracy"
    HELP = "A click uses that point's h; the pointer reads points out."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("e", "chart", "Over time", tooltip="next chart: time, theta, …"),
        Binding("asterisk", "all", "All", True, "*", tooltip="all methods, or the shown"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.study = AccuracyPoints()
        self.growths: list[Growth] = []  # at the present h
        self.all = False  # the methods that are not in the cast, too
        self.over_time = False  # the chart of errors in theta over time
        self._kind: ErrorKind | None = None  # None: as the lab's chart
        self.placed: Placed = []  # on the chart
        self._chart = Picture()
        self._charted: object = None

    def begin(self, study: AccuracyPoints) -> None:
        """Show the points of another study, which are to come."""
        self.study = study
        self.cursor = self.pointer = None
        self.placed = []

    def add(self, computed: Point | Growth) -> None:
        """Take in what has been computed; it is drawn with one of the next samples."""
        if isinstance(computed, Growth):
            self.growths = [*self.growths, computed]
        else:
            self.study.points[computed.method.key, computed.steps] = computed

    @property
    def cast(self) -> Cast:
        """The methods on the chart: those of the run first."""
        if self.all and self.source is not None and self.source.scene.general:
            return with_all_methods(self.source.scene).cast
        return super().cast

    @property
    def kind(self) -> ErrorKind:
        """The error charted over cost: the lab chart's, until another is chosen."""
        return self._kind or ("theta" if self.shown.quantity == "theta_error" else "energy")

    @property
    def missing(self) -> int:
        """How many points are not there yet."""
        return sum(len(self.study.steps) - len(self.study.of(method)) for method in self.cast)

    @property
    def settled(self) -> bool:
        """Whether everything is there and drawn."""
        study = self.study
        if self.source is not None and not self.source.scene.general:
            return True
        if not study.steps or self.missing or self._charted != self._state:
            return False
        if self.over_time and len(self.growths) < len(study.here):
            return False
        run = zip(self.cast, study.here, strict=False)
        wanted = {(method.key, steps) for method, steps in run if 1 < steps <= MAX_STEPS}
        return wanted <= study.points.keys()

    @property
    def aim(self) -> Point | None:
        """The point that is described: under the pointer, at the cursor, or at the present h."""
        method = self.cast[self.index]
        if self.cursor is not None:  # of the method that was described before, maybe
            self.cursor = self.study.points.get((method.key, self.cursor.steps), self.cursor)
        return self.pointer or self.cursor or self.study.at_present(self.index, method)

    @property
    def _state(self) -> object:
        """What the chart depends on."""
        study = self.study
        computed = id(study), study.here, len(study.points), len(self.growths)
        chosen = self.index, self.cursor, self.kind, self.over_time, self.all
        return computed, chosen, self.shown, self.room

    def picture(self, source: Source, sample: Sample) -> Picture:
        if why := source.scene.why_not_mapped:
            self.write_titles("Accuracy (F4)", "")
            return Picture(self.words(why))
        aim = self.aim
        if self._charted != self._state:
            self._charted = self._state
            words = MAX_WORDS if self.room.height >= ROOMY else MIN_WORDS
            if self.all and words == MAX_WORDS:
                words += 2  # for the letters of all methods
            self._draw_chart(self.room.width, max(self.room.height - words, 1))
        self._write_titles()
        return Picture([*self._chart.rows, *self.words(*self._sentences(aim))][: self.room.height])

    def _draw_chart(self, width: int, height: int) -> None:
        """Draw error over cost, and note where the points are; or error over time."""
        study = self.study
        if self.over_time:
            shown = [each for each in self.growths if each.method.key not in self.shown.hidden]
            self._chart = growth_chart(shown, self.cast, width, height)
            self.placed = []
            return
        methods = [(place, self.cast[place]) for place in self.places]
        points = [point for _, method in methods for point in study.of(method)]
        marks = [(HERE, point) for at in methods if (point := study.at_present(*at))]
        if self.cursor is not None:
            marks.append((CURSOR, self.cursor))
        series = accuracy_series(
            points, self.kind, COST, self.cast, marks=marks, whole=len(study.steps)
        )
        self._chart = accuracy_chart(series, self.kind, COST, width, height)
        every = [*points, *(point for _, point in marks)]
        self.placed = placed(series, every, self.kind, width, height)

    def _write_titles(self) -> None:
        """Write above what is charted, and below what its marks are."""
        if self.over_time:
            self.write_titles("Theta error over time, at each method's h", "")
            return
        left = f", computing, {self.missing} points left" if self.missing else ""
        title = f"Accuracy (F4) over {self.study.time:g} s: {self.kind} error{left}"
        self.write_titles(title, LEGEND)

    def _sentences(self, aim: Point | None) -> list[str]:
        """Return the words on a point and the cheapest methods, or on how errors grow."""
        study = self.study
        if self.over_time:
            return growth_lines(self.growths, done=len(self.growths) == len(study.here))
        cheapest = []
        if not self.missing:
            points = [point for method in self.cast for point in study.of(method)]
            cheapest = [front_words(front(points, self.kind, COST), COST)]
        if self.all:
            cheapest.append(", ".join(f"{each.letter} {each.label}" for each in self.cast))
        if aim is not None:
            return [point_words(aim, self.kind, self._note), *cheapest]
        why = "the current h is not on this chart: it is too large or too small"
        if self.index >= len(study.here):
            why = f"{self.cast[self.index].label} is not shown; the arrows choose one of its points"
        return [why, *cheapest]

    @property
    def _note(self) -> str:
        if self.pointer is None and self.cursor is None:
            return "current h"
        if not self.is_live:
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
        """Chart all methods, or the cast alone; the view has them computed."""
        self.all = not self.all
        self.over_time = False

    def action_move(self, right: int, up: int) -> None:
        """Move along a method's points, costlier ones to the right, or to another method."""
        if up:
            self.action_method(-up)
            return
        points = self.study.of(self.cast[self.index])
        if not points:
            return
        here = self.cursor.steps if self.cursor else self._present_steps(points)
        further = [point for point in points if (point.steps - here) * right > 0]
        ends = points[-1:] if right > 0 else points[:1]
        self.cursor = (further or ends)[0 if right > 0 else -1]
        self.draw()

    def _present_steps(self, points: Sequence[Point]) -> int:
        here = self.study.here
        return here[self.index] if self.index < len(here) else points[0].steps

    def place_under(self, event: events.MouseEvent) -> Point | None:
        return nearest(self.placed, *event.get_content_offset_capture(self))

    def choose(self, place: Point) -> None:
        if self.source is not None:
            self.describe(self.cast.index(place.method))
            self.pointer = None
            stepping = self.source.stepping.with_own(place.method, place.h)
            self.post_message(StepSizeChosen(stepping))
