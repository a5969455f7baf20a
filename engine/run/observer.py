"""What is known of a run up to now: the verdict on each method, and what happened when.

It follows from the samples.  A recording holds what the lab noticed, because a later version may judge otherwise.
"""

import math
from bisect import bisect_right, insort
from collections import defaultdict
from itertools import islice
from operator import attrgetter
from typing import Any

from engine.methods import Method
from engine.models.model import Phase
from engine.run.crossing import Crossings
from engine.run.judgement import Milestone as Milestone
from engine.run.judgement import MilestoneKind as MilestoneKind
from engine.run.judging import MOST_STEPS, Judging, Seen
from engine.run.lockstep import Reading, Sample
from engine.run.loops import OVERFLOW, LoopsOf, plain
from engine.run.stepping import Stepping, SteppingChange
from engine.run.verdict import Judgement
from engine.scenes import Scene

_step = attrgetter("step")


class RunObserver:
    """Watches one run, live, replayed or without a screen, sample by sample."""

    def __init__(self, scene: Scene, loops: LoopsOf = plain) -> None:
        """`loops` take the steps between samples again."""
        self.scene = scene
        self._loops = loops
        self.exact = exact = scene.exact()
        self.reference = scene.equations.reference(scene.theta, scene.omega)
        self.seen = -1
        """The last step that was looked at."""
        self._period = exact.period or math.tau / scene.w0
        swings = scene.equations.turns and exact.regime == "libration"
        self._bottom = math.tau * round(scene.theta / math.tau) if swings else None
        self._start = SteppingChange(0, 0.0, Stepping(scene.h, cast=scene.cast))
        self._milestones: list[Milestone] = []
        self._before: Sample | None = None
        self._modified_starts: dict[int, list[float]] = {}  # by the step of the change that they begin at
        self.judge_anew(0)

    @property
    def judgements(self) -> list[Judgement]:
        """The verdicts on the run since the last change of the stepping."""
        return [judging.judgement for judging in self._judgings] or [Judgement()] * len(self.scene.cast)

    def milestones(self, step: int) -> list[Milestone]:
        """What happened up to a step, in its order."""
        return self._milestones[: bisect_right(self._milestones, step, key=_step)]

    def judge_anew(self, step: int) -> None:
        """The stepping changes here: verdicts begin anew, and what came later has never been."""
        self._milestones = self.milestones(step)
        self._known = {(each.kind, each.method) for each in self._milestones}
        self._modified_starts = {at: starts for at, starts in self._modified_starts.items() if at < step}
        self._judgings: list[Judging] = []
        self._crossings = Crossings()
        if self._before is not None and self._before.step == step:
            self._begin = self._before
        else:
            self._before, self.seen = None, step - 1

    def add(self, sample: Sample, change: SteppingChange | None = None) -> list[Milestone]:
        """Take in a sample and the last change of the stepping before it; what lies before the last is known already.

        Without a change, the run has stepped alike since its start.  Returns the milestones on the way.
        """
        if sample.step <= self.seen:
            return []
        change = change or self._start
        if self.seen <= change.step:
            self.judge_anew(change.step)
        news: list[Milestone] = []
        before, self._before, self.seen = self._before, sample, sample.step
        if before is None:
            self._begin = sample
        if not self._judgings:
            self._judgings, self._h = self._begun(change.stepping), change.stepping.h
        looks: defaultdict[int, dict[int, Seen]] = defaultdict(dict)  # by step, at what is seen of each method
        for index, (method, judging, reading) in enumerate(
            zip(self.scene.cast, self._judgings, sample.readings, strict=True)
        ):
            for seen in judging.follow(sample.step - self._begin.step, reading):
                looks[seen.step][index] = seen
                if seen.news and reading.diverged_at is None:
                    news.append(self._seen("verdict", method, seen, verdict=seen.verdict))
            if reading.diverged_at is not None and self._is_new("failed", method):
                error = reading.energy_error
                news.append(Milestone("failed", method, sample.step, reading.diverged_at, error))
            if (
                before is not None
                and self._is_new("over the top", method)
                and self._is_over(reading.theta)
                and not self._is_over(before.readings[index].theta)
            ):
                news.append(self._crossing(index, before, sample, change.stepping))
        for step in sorted(looks):
            for index, other in self._crossings.add(looks[step]):
                method, passed = self.scene.cast[index], self.scene.cast[other]
                news.append(self._seen("errors cross", method, looks[step][index], other=passed))
        for milestone in news:
            self._known.add((milestone.kind, milestone.method))
            insort(self._milestones, milestone, key=_step)
        return news

    def _seen(self, kind: MilestoneKind, method: Method, seen: Seen, **what: Any) -> Milestone:
        """The milestone of a look."""
        t = self._begin.t + seen.step * self._h
        return Milestone(kind, method, self._begin.step + seen.step, t, seen.error, **what)

    def _begun(self, stepping: Stepping) -> list[Judging]:
        """A judging of each method from the sample on at which this stepping begins."""
        scene, reference = self.scene, self.reference
        judgings = [
            Judging(method, scene.equations, reference, stepping.h, part, self._period, self._loops, self._begin.t)
            for method, part in zip(scene.cast, stepping.parts, strict=True)
        ]
        for judging, reading in zip(judgings, self._begin.readings, strict=True):
            judging.follow(0, reading)
        return judgings

    def modified_energy_errors(self, before: Sample | None, sample: Sample, change: SteppingChange) -> list[float]:
        """How far each method's modified energy is from where it was when the stepping last changed, relative.

        Another step size has another modified energy.  nan for a method without one, and where no sample
        `before` this one has been seen since the change.
        """
        starts = self._modified_starts.get(change.step)
        if starts is None:
            if before is None or not change.step <= before.step < sample.step:
                return [math.nan] * len(self.scene.cast)
            starts = self._modified_starts[change.step] = self._modified_energies(before, change.stepping)
        energies = self._modified_energies(sample, change.stepping)
        return [(now - start) / self.reference.scale for now, start in zip(energies, starts, strict=True)]

    def _modified_energies(self, sample: Sample, stepping: Stepping) -> list[float]:
        energies = [
            method.modified_energy(self.scene.equations, (reading.theta, reading.omega), h)
            if method.modified_energy and self.scene.equations.has_force
            else math.nan
            for method, reading, h in zip(self.scene.cast, sample.readings, stepping.own, strict=True)
        ]
        return [energy if math.isfinite(energy) else math.nan for energy in energies]  # it overflows where H does not

    def _is_over(self, theta: float) -> bool:
        """Whether theta [rad] is where the exact motion never comes: beyond the top."""
        return self._bottom is not None and abs(theta - self._bottom) > math.pi

    def _is_new(self, kind: str, method: Method) -> bool:
        """Whether this has not happened to a method before."""
        return (kind, method) not in self._known

    def _crossing(self, index: int, before: Sample, sample: Sample, stepping: Stepping) -> Milestone:
        """Where between two samples a method goes over the top.

        The steps between them are taken again.  Where they do not lead to the sample, as when the step size
        changed in a gap, or where there are too many, it is where it was first seen there.
        """
        method, part, found = self.scene.cast[index], stepping.parts[index], sample.readings[index]
        steps, h = (sample.step - before.step) * part, stepping.h / part
        phases = self._phases(method, before.readings[index], h, steps if steps <= MOST_STEPS * part else 0)
        if phases and math.isclose(phases[-1][0], found.theta, rel_tol=1e-6):
            for n, phase in enumerate(phases, 1):
                if self._is_over(phase[0]):
                    step, t = before.step + math.ceil(n / part), before.t + n * h
                    error = self.reference.error(self.scene.equations.energy()(phase), t)
                    return Milestone("over the top", method, step, t, error)
        return Milestone("over the top", method, sample.step, sample.t, found.energy_error)

    def _phases(self, method: Method, reading: Reading, h: float, steps: int) -> list[Phase]:
        """The phases after so many steps from a reading; none if they end before."""
        model = self.scene.equations
        phase = model.phase_of(reading.theta, reading.omega, reading.extra)
        try:
            return list(islice(method.on(model)(phase, h), steps))
        except OVERFLOW:
            return []
