"""Course: a run that can also go back, to the bit.

Going back is simulating again from a copy of the lockstep taken earlier.  Copies are the further
apart the older they are, so their number grows with the logarithm of the run's length only.
"""

import copy
import math
from bisect import bisect_right
from collections.abc import Iterable
from typing import NamedTuple, Self

from engine.run.background import unhurried
from engine.run.lockstep import Lockstep, Sample
from engine.scenes import Scene

COPY_EVERY = 1000  # steps; 4 ms of simulation, so a step back is not felt
AGE_PER_GAP = 8  # copies n steps old are about n/8 steps apart


class Pitch(NamedTuple):
    """How a run steps."""

    h: float  # s
    equal_cost: bool = False


class SteppingChange(NamedTuple):
    """A change of how a run steps."""

    step: int  # before which it applies
    x: float  # s, the simulated time run up to there; it goes up even while t goes down
    t: float  # s, simulated time
    h: float  # s
    equal_cost: bool = False


class _Checkpoint(NamedTuple):
    lockstep: Lockstep
    applied: int  # changes


class RewindableRun:
    """One run: its lockstep, the changes of its step size, and the way back.

    Between a step back and the step reached before, forward repeats what was, changes included.
    """

    def __init__(self, scene: Scene, run: int) -> None:
        self.scene = scene
        self.run = run
        self.changes = [SteppingChange(0, 0.0, 0.0, scene.h)]  # the first is the start's
        self.furthest = 0  # the last step sampled
        self._applied = 1
        self._lockstep = Lockstep(scene, run, loops=unhurried)
        self._copies = [self._copy()]

    @classmethod
    def at(cls, scene: Scene, changes: Iterable[tuple[int, Pitch]], step: int) -> Self:
        """The run of a scene at a step, with the changes of how it steps, as (step, pitch), on the way there."""
        course = cls(scene, 1)
        for at, pitch in changes:
            course.forward(at - course.step)
            course.set_h(*pitch)
        course.forward(step - course.step)
        return course

    @property
    def step(self) -> int:
        """Where the run stands."""
        return self._lockstep.step

    @property
    def h(self) -> float:
        """The step size in force [s]."""
        return self._lockstep.h

    @property
    def equal_cost(self) -> bool:
        """Whether all methods spend the same number of force evaluations."""
        return self._lockstep.equal_cost

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self._lockstep.t

    @property
    def x(self) -> float:
        """The simulated time run so far [s]."""
        last = self.changes[self._applied - 1]
        return last.x + (self.step - last.step) * abs(last.h)

    @property
    def in_past(self) -> bool:
        """Whether something is known of what comes next."""
        return self.step < self.furthest or self._applied < len(self.changes)

    def step_at(self, x: float) -> int:
        """The last step that is not after x."""
        at = max(bisect_right(self.changes, x, key=lambda change: change.x), 1)
        last = self.changes[at - 1]
        step = last.step + int((x - last.x) / abs(last.h) + 1e-6)  # x is a sum of floats, the step must not lag for it
        return min(step, self.changes[at].step) if at < len(self.changes) else step

    @property
    def home(self) -> float:
        """The step ahead at which simulated time is back at 0; inf where it runs away from 0, or past it."""
        ahead = -self.t / self.h
        return self.step + round(ahead) if ahead > 0.5 and abs(ahead - round(ahead)) < 1e-6 else math.inf

    def sample(self) -> Sample:
        """What all methods read now."""
        self.furthest = max(self.furthest, self.step)
        return self._lockstep.sample()

    def forward(self, n: int) -> None:
        """Go n steps on."""
        target = self.step + n
        while self.step < target:
            while self._applied < len(self.changes) and self.changes[self._applied].step == self.step:
                self._lockstep.set_h(self.changes[self._applied].h, self.changes[self._applied].equal_cost)
                self._applied += 1
            stops = [target]
            if self._applied < len(self.changes):
                stops.append(self.changes[self._applied].step)
            if self.step < self.furthest:
                stops.append(self.furthest)
            self._lockstep.advance(min(stops) - self.step)
            if self.step == self.furthest:
                self._lockstep.sample()  # the next sample's extremes are again those since this step
            if self.step >= self._copies[-1].lockstep.step + COPY_EVERY:
                self._copies.append(self._copy())
                self._thin()

    def back_to(self, step: int) -> None:
        """Go back to a step, before any change of the step size made there."""
        at = bisect_right(self._copies, step, key=lambda place: place.lockstep.step) - 1
        lockstep, self._applied = self._copies[at]
        self._lockstep = copy.deepcopy(lockstep)
        self._lockstep.run = self.run
        self.forward(step - self.step)

    def set_h(self, h: float, equal_cost: bool = False) -> None:
        """Use step size h [s] from here on, at equal cost or not; in the past, branch first.

        Raises SceneError for a step size that is zero, not finite or absurd.
        """
        x = self.x
        self._lockstep.set_h(h, equal_cost)
        self.changes.append(SteppingChange(self.step, x, self.t, h, equal_cost))
        self._applied += 1

    def branch(self, run: int) -> None:
        """Go on from here as another run, which shares this one's past and not what came next."""
        del self.changes[self._applied :]
        while self._copies[-1].lockstep.step > self.step:
            self._copies.pop()
        self.run = self._lockstep.run = run
        self.furthest = self.step

    def _copy(self) -> _Checkpoint:
        return _Checkpoint(copy.deepcopy(self._lockstep), self._applied)

    def _thin(self) -> None:
        steps = [place.lockstep.step for place in self._copies]
        kept = [0]
        for at in range(1, len(steps)):
            last = at == len(steps) - 1
            if last or steps[at + 1] - steps[kept[-1]] > max(COPY_EVERY, (steps[-1] - steps[at]) // AGE_PER_GAP):
                kept.append(at)
        self._copies = [self._copies[at] for at in kept]
