"""The judges of a run's methods, and the milestones that follow from what they see."""

import copy
from collections.abc import Sequence
from typing import Self

from engine.methods import Cast
from engine.models.model import Model
from engine.run.judge import Judge
from engine.run.judgement import ROUNDING, Judgement, LookPoint, Milestone, MilestoneKind


class Judges:
    """One judge a method, since the last change of the stepping, and the milestones of the whole run.

    Errors cross where the largest error so far of a method that gains or loses energy passes that
    of a bounded one: for good, as it does not with other pairs.
    """

    def __init__(self, cast: Cast, model: Model, period: float) -> None:
        """`period` [s] is the exact motion's, or 2 pi/w0 if it has none."""
        self.milestones: list[Milestone] = []
        self._cast = cast
        self._model = model
        self._period = period
        self._judges: list[Judge] = []
        # whether a method that leaves is still below a bounded one that it was below
        self._below: dict[tuple[int, int], bool] = {}

    @property
    def judgements(self) -> list[Judgement]:
        """The verdicts since the last change of the stepping, in the order of the cast."""
        return [judge.judgement for judge in self._judges]

    def copy(self) -> Self:
        """Return other judges that go on from here."""
        other = copy.copy(self)
        other.milestones = self.milestones.copy()
        other._judges = [judge.copy() for judge in self._judges]
        other._below = self._below.copy()
        return other

    def restart(self, steps: Sequence[float], points: Sequence[LookPoint | None]) -> None:
        """Judge anew from these look points on, each method with its own step size [s]."""
        self._below = {}
        self._judges = []
        for method, h, point in zip(self._cast, steps, points, strict=True):
            judge = Judge(h=h, period=self._period, method=method, model=self._model)
            self._judges.append(judge)
            if point is None:
                judge.fail(0)
            else:
                judge.look(point)

    def look(self, step: int, t: float, points: Sequence[LookPoint | None]) -> None:
        """Show each judge its method at a step of the lockstep; None: its numbers have ended."""
        for index, (judge, point) in enumerate(zip(self._judges, points, strict=True)):
            if point is None:
                continue
            before = judge.judgement.verdict
            judge.look(point)
            now = judge.judgement
            if now.verdict != before:
                verdict = Milestone("verdict", self._cast[index], step, t, point.error, now.verdict)
                self.milestones.append(verdict._replace(trend=now.slope, lyapunov=now.lyapunov))
        for index, other in self._crossings():
            if point := points[index]:
                crossing = Milestone("errors cross", self._cast[index], step, t, point.error)
                self.milestones.append(crossing._replace(other=self._cast[other]))

    def note(self, kind: MilestoneKind, index: int, step: int, t: float, error: float) -> None:
        """Note what happens to a method once in a run."""
        if not self.has(kind, index):
            self.milestones.append(Milestone(kind, self._cast[index], step, t, error))

    def has(self, kind: MilestoneKind, index: int) -> bool:
        """Return whether this has happened to a method."""
        return any(
            each.kind == kind and each.method == self._cast[index] for each in self.milestones
        )

    def fail(self, index: int, steps: int) -> None:
        """Note that a method's numbers have ended, so many of its steps after the restart."""
        self._judges[index].fail(steps)

    def _crossings(self) -> list[tuple[int, int]]:
        """Return the pairs (passing, passed) that are new since the last look."""
        found = []
        for index, leaving in enumerate(self._judges):
            for other, bounded in enumerate(self._judges):
                if leaving.judgement.verdict not in ("grows", "loses"):
                    continue
                if bounded.judgement.verdict != "bounded" or bounded.peak <= ROUNDING:
                    continue
                if leaving.peak <= bounded.peak:
                    self._below.setdefault((index, other), True)
                elif self._below.get((index, other)):
                    self._below[index, other] = False  # once is enough
                    found.append((index, other))
        return found
