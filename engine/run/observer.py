"""What is known of a run up to now: the verdict on each method, and what happened when.

Nothing here is recorded: it follows from the samples, so a replay tells what the lab told.
"""

import math
from bisect import bisect_right, insort
from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Literal

from engine.methods import METHODS, Method
from engine.models.exact_pendulum import ExactMotion
from engine.models.pendulum import acceleration, energy, energy_scale
from engine.models.state import Phase
from engine.run.lockstep import Reading, Sample, parts
from engine.run.verdict import Judgement, Trend, Verdict
from engine.scenes import Scene

PARTS = parts()
MOST_STEPS = 20_000
"""Steps between two samples that are gone through again to find when a method went over the top, 20 ms at worst."""


@dataclass(frozen=True, slots=True)
class Milestone:
    """Something that a method did: it went over the top, its numbers ended, or it earned a verdict."""

    kind: Literal["over the top", "failed", "verdict"]
    index: int  # into METHODS
    step: int
    t: float  # s, simulated
    energy_error: float  # relative, at this step
    verdict: Verdict = "too early"

    @property
    def method(self) -> Method:
        """Who it was."""
        return METHODS[self.index]


_step = attrgetter("step")


class RunObserver:
    """Watches one run, sample by sample."""

    def __init__(self, scene: Scene, exact: ExactMotion) -> None:
        self._scene = scene
        self._period = exact.period or math.tau / scene.w0
        self._turn = self._period if exact.regime == "rotation" else math.inf  # s
        self._bottom = math.tau * round(scene.theta / math.tau) if exact.regime == "libration" else None
        self._milestones: list[Milestone] = []
        self._before: Sample | None = None
        self._x = 0.0  # s, the simulated time run through
        self.seen = -1
        """The last step that was looked at."""
        self.judge_anew(0)

    @property
    def judgements(self) -> list[Judgement]:
        """The verdicts on the run since the last change of the step size."""
        return [trend.judgement for trend in self._trends]

    def milestones(self, step: int) -> list[Milestone]:
        """What happened up to a step, in its order."""
        return self._milestones[: bisect_right(self._milestones, step, key=_step)]

    def judge_anew(self, step: int) -> None:
        """The step size changes here: verdicts begin anew, and what came later has never been."""
        self._milestones = self.milestones(step)
        self._known = {(each.kind, each.index) for each in self._milestones}
        self._trends = [Trend(self._period) for _ in METHODS]
        if self._before is not None and self._before.step == step:
            for trend, reading in zip(self._trends, self._before.readings, strict=True):
                trend.read(self._x, reading)
        else:
            self._before, self.seen = None, step - 1

    def add(self, sample: Sample) -> None:
        """Take in a sample; one that lies before the last is known already."""
        if sample.step <= self.seen:
            return
        before, self._before, self.seen = self._before, sample, sample.step
        per_turn = math.inf
        if before is not None and (passed := abs(sample.t - before.t)):  # none, between steps in a file that lies
            self._x += passed
            per_turn = self._turn * (sample.step - before.step) / passed
        for index, (trend, reading) in enumerate(zip(self._trends, sample.readings, strict=True)):
            known = trend.judgement.verdict
            trend.read(self._x, reading, per_turn)
            verdict = trend.judgement.verdict
            if reading.diverged_at is not None:
                self._note(Milestone("failed", index, sample.step, reading.diverged_at, reading.energy_error))
            elif verdict != known:
                milestone = Milestone("verdict", index, sample.step, sample.t, reading.energy_error, verdict)
                insort(self._milestones, milestone, key=_step)
            if before is None or ("over the top", index) in self._known:
                continue
            if self.is_over(reading.theta) and not self.is_over(before.readings[index].theta):
                self._note(self._crossing(index, before, sample))

    def is_over(self, theta: float) -> bool:
        """Whether theta [rad] is where the exact swing never comes: beyond the top."""
        return self._bottom is not None and abs(theta - self._bottom) > math.pi

    def _note(self, milestone: Milestone) -> None:
        """Keep what happens to a method but once."""
        if (milestone.kind, milestone.index) not in self._known:
            self._known.add((milestone.kind, milestone.index))
            insort(self._milestones, milestone, key=_step)

    def _crossing(self, index: int, before: Sample, sample: Sample) -> Milestone:
        """Where between two samples a method goes over the top.

        The steps between them are taken again, whole or in the parts of equal cost, whichever leads to
        the sample.  Where neither does, as when the step size changed in a gap, or there are too many,
        it is where it was first seen there.
        """
        steps = sample.step - before.step
        if steps <= MOST_STEPS:
            for part in {1, PARTS[index]}:
                h, end = (sample.t - before.t) / (steps * part), sample.readings[index].theta
                path = list(self._path(METHODS[index], before.readings[index], h, steps * part))
                if math.isclose(path[-1][0], end, rel_tol=1e-6):
                    n = next((n for n, (theta, _) in enumerate(path, 1) if self.is_over(theta)), len(path))
                    step = before.step + math.ceil(n / part)
                    return Milestone("over the top", index, step, before.t + n * h, self._error(path[n - 1]))
        return Milestone("over the top", index, sample.step, sample.t, sample.readings[index].energy_error)

    def _path(self, method: Method, begin: Reading, h: float, steps: int) -> Iterator[Phase]:
        force, phase = acceleration(self._scene.w0_squared), (begin.theta, begin.omega)
        for _ in range(steps):
            yield (phase := method.step(force, phase, h))

    def _error(self, phase: Phase) -> float:
        scene = self._scene
        start = energy(scene.w0_squared, scene.theta, scene.omega)
        error: float = (energy(scene.w0_squared, *phase) - start) / energy_scale(scene.w0_squared, start)
        return error
