"""Accuracy (F4): error over cost; h is chosen with keyboard or mouse."""

import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from textual import events
from textual.binding import Binding, BindingType
from textual.geometry import Size

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.studies.accuracy import (
    Cost,
    ErrorKind,
    Flaw,
    Point,
    cost_of,
    front,
    measured,
    usual,
    with_all_methods,
)
from pendu_tui.tui.drawing.picture import FRAME, Picture, ink_of
from pendu_tui.tui.drawing.plotted import LogLog, Series, loglog_chart
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Chooser, Memo, StepSizeChosen, StudyView
from pendu_tui.tui.words.studies import COSTS, front_words, point_words

MARKS: dict[Flaw, str] = {"lost": "x", "rounding": "~"}
"""The marks of points whose error says nothing about the order."""

ERROR_LABELS: dict[ErrorKind, str] = {
    "theta": "theta error [rad], the largest distance from the exact motion",
    "energy": "relative energy error, the largest over all steps",
    "final": "theta error at the end [rad]",
}
CHART_ROWS = 9  # which leave the words of a small screen two
BESIDE = 0.2  # the dotted line of an order runs at this share of the errors


def accuracy_chart(
    series: Sequence[Series], kind: ErrorKind, cost: Cost, width: int, height: int
) -> LogLog:
    return loglog_chart(series, width, height, x_label=COSTS[cost], y_label=ERROR_LABELS[kind])


def accuracy_series(
    points: Sequence[Point],
    kind: ErrorKind,
    cost: Cost,
    cast: Cast,
    *,
    marks: Sequence[tuple[str, Point]] = (),
) -> list[Series]:
    """Return points as letters, x if useless, ~ if limited by rounding; orders as dots."""

    def series(mark: str, *some: Point) -> Series:
        ink = ink_of(some[0].method, cast)
        return Series(ink, mark, [cost_of(p, cost) for p in some], [p.errors[kind] for p in some])

    lines: list[Series] = []
    slopes: dict[int, Series] = {}  # by order
    for method in dict.fromkeys(point.method for point in points):
        ours = [point for point in points if point.method == method]
        slopes = _slope(ours, kind, cost) | slopes
        lines.append(series(method.letter, *ours))
    flaws = [(MARKS[flaw], point) for point in points if (flaw := point.flaws[kind])]
    marked = [series(mark, point) for mark, point in (*flaws, *marks)]
    return [*slopes.values(), *lines, *marked]


def _slope(ours: Sequence[Point], kind: ErrorKind, cost: Cost) -> dict[int, Series]:
    """Return a line below a method's valid points with the slope of their error, if any.

    It is measured: the energy of a method of order p may be right to a higher one (RK4: 5).
    """
    valid = [p for p in ours if not p.flaws[kind] and p.errors[kind] and cost_of(p, cost)]
    if len(valid) < 2:
        return {}
    costs = np.array([cost_of(point, cost) for point in valid])
    errors = np.array([point.errors[kind] for point in valid])
    order = -round(float(np.polyfit(np.log(costs), np.log(errors), 1)[0]))
    middle = len(valid) // 2
    ends = np.array([costs.min(), costs.max()])
    beside = BESIDE * errors[middle] * (ends / costs[middle]) ** -order
    return {order: Series(FRAME, f"slope {order}", ends, beside, dotted=True)}


class AccuracyPane(Chooser[Point]):
    """Draws the points computed so far, marks each method's h, and describes one point."""

    BINDING_GROUP_TITLE = "Accuracy"
    HELP = "Click on a point to use its h; point at one to see its numbers."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("e", "chart", "Error", tooltip="error in theta or in energy"),
        Binding("asterisk", "all", "All", True, "*", tooltip="all methods, or those shown"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.time = 0.0  # s, the length of the study
        self.steps: Sequence[int] = ()  # a point of each method for each, ascending
        self.here: Sequence[int] = ()  # steps at the current h, by method of the run
        self.points: dict[tuple[str, int], Point] = {}  # by method's key and steps
        self.all = False  # whether to include methods outside the cast
        self._chosen: ErrorKind | None = None
        self._drawn: Sequence[Point] = ()
        self._chart = Memo(self._charted)
        self._study = Memo(self._begun)

    def _compute_missing(self, source: Source) -> None:
        scene = source.scene
        own = source.stepping.own
        self._study(scene.theta, scene.omega, scene.equations, self.cast, self.all)
        here = [round(self.time / abs(h)) for h in own]
        if here != self.here:
            self.here = here
            known = {*self.steps, *(steps for _, steps in self.points)}
            wanted = [each for each in sorted({*here} - known) if 1 < each <= 2_000_000]
            if wanted:  # more steps would take too long
                self.compute(measured, scene, self.time, wanted, group="here")

    def _begun(self, *_: object) -> None:
        """Begin a study, of which there is nothing yet."""
        scene = self.source.scene
        self.workers.cancel_node(self)
        self.time, self.steps = usual(scene, self.all)
        self.here = ()
        self.points = {}
        self.cursor = self.pointer = None
        self.compute(measured, scene.with_cast(self.cast), self.time, self.steps, group="ladder")

    def forget(self) -> None:
        self._study.forget()

    def add(self, result: Point) -> None:
        self.points[result.method.key, result.steps] = result

    @property
    def cast(self) -> Cast:
        scene = self.source.scene
        if self.all and not scene.why_not_mapped:
            scene = with_all_methods(scene)
        return scene.cast

    @property
    def chart(self) -> ErrorKind:
        """The lab chart's error, until another is chosen."""
        return self._chosen or ("theta" if self.shown.quantity == "theta_error" else "energy")

    def points_of(self, method: Method) -> list[Point]:
        """Return the method's points at the shared numbers of steps, by cost."""
        return [point for each in self.steps if (point := self.points.get((method.key, each)))]

    def present(self, place: int) -> Point | None:
        """Return the point at the current h; only methods of the run have one."""
        if place >= len(self.here):
            return None
        return self.points.get((self.cast[place].key, self.here[place]))

    @property
    def missing(self) -> int:
        return sum(len(self.steps) - len(self.points_of(method)) for method in self.cast)

    @property
    def aim(self) -> Point | None:
        return self.pointer or self.cursor or self.present(self.index)

    def picture(self, source: Source, sample: Sample) -> Picture:
        if why := source.scene.why_not_mapped:
            self.write_titles("Accuracy (F4)")
            return Picture(self.words(why))
        self._compute_missing(source)
        if self.cursor is not None:  # it may be on another method's line
            key = self.cast[self.index].key, self.cursor.steps
            self.cursor = self.points.get(key, self.cursor)
        computed = self._study.arguments, self.here, len(self.points)
        chosen = self.index, self.cursor, self.chart
        chart = self._chart(self.room, computed, chosen, self.shown).picture
        left = f", computing, {self.missing} points left" if self.missing else ""
        title = f"Accuracy (F4) over {self.time:g} s: {self.chart} error{left}"
        self.write_titles(title, "@ current h  x no correct digit  ~ limited by rounding")
        words = self.words(*self._sentences(), rows=self.room.height - len(chart.rows))
        return Picture([*chart.rows, *words])

    def _charted(self, room: Size, *_: object) -> LogLog:
        words = 6 if self.all else 4  # `all` adds the letters of all methods
        size = room.width, max(room.height - words, min(room.height, CHART_ROWS))
        points = [point for place in self.places for point in self.points_of(self.cast[place])]
        marks = [("@", point) for place in self.places if (point := self.present(place))]
        if self.cursor is not None:
            marks.append(("O", self.cursor))
        series = accuracy_series(points, self.chart, "evaluations", self.cast, marks=marks)
        drawn = [*points, *(point for _, point in marks)]
        self._drawn = [point for point in drawn if 0 < point.errors[self.chart] < math.inf]
        return accuracy_chart(series, self.chart, "evaluations", *size)

    def _sentences(self) -> list[str]:
        words = ["the current h is not on this chart; the arrows choose a point"]
        if self.missing:
            words = []
        if self.aim is not None:
            words = [point_words(self.aim, self.chart)]
        if not self.missing:
            points = [point for method in self.cast for point in self.points_of(method)]
            cheapest = front(points, self.chart, "evaluations")
            words.append(front_words(cheapest, "evaluations"))
        if self.all:
            words.append(", ".join(f"{each.letter} {each.label}" for each in self.cast))
        return words

    def action_chart(self) -> None:
        self._chosen = "energy" if self.chart == "theta" else "theta"
        self.draw()

    def action_all(self) -> None:
        self.all = not self.all
        self.draw()

    def action_move(self, right: int, up: int) -> None:
        if up:
            self.action_method(-up)
            return
        points = self.points_of(self.cast[self.index])
        if not points:
            return
        here = points[0].steps
        if self.cursor is not None:
            here = self.cursor.steps
        elif self.index < len(self.here):
            here = self.here[self.index]
        ahead = points[::right]
        further = (point for point in ahead if (point.steps - here) * right > 0)
        self.cursor = next(further, ahead[-1])
        self.draw()

    def place_under(self, event: events.MouseEvent) -> Point | None:
        """Return the nearest point that is drawn within 6 columns or 3 rows."""
        x, y = event.get_content_offset_capture(self)

        def distance(point: Point) -> float:
            column, row = self._chart.result.cell(point.force_evaluations, point.errors[self.chart])
            return math.hypot(column - x, 2 * (row - y))

        near = min(self._drawn, key=distance, default=None)
        if near is None or distance(near) > 6:
            return None
        return near

    def choose(self, place: Point) -> None:
        self.described = place.method.key
        self.pointer = None
        self.post_message(StepSizeChosen(self.source.stepping.with_own(place.method, place.h)))


def view(name: str) -> StudyView:
    return StudyView(name, AccuracyPane())
