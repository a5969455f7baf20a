"""A run that can also go back, to the bit.

Going back is simulating again from a copy of the lockstep taken earlier.  The older copies
are, the further they lie apart, so their number grows with the logarithm of the run's length only.
"""

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import NamedTuple

from engine.run.compiled import TieredLoops
from engine.run.judgement import Judgement, Milestone
from engine.run.lockstep import Lockstep, Sample
from engine.run.loops import LoopsOf
from engine.run.stepping import Stepping, SteppingChange
from engine.scenes import Scene

COPY_EVERY = 1000  # steps; 4 ms of simulation, so a step back is not felt


class _Checkpoint(NamedTuple):
    lockstep: Lockstep
    applied: int  # changes that are in force or past


class RewindableRun:
    """One run: its lockstep, the changes of its step size, and the way back.

    Between a step back and the step reached before, forward repeats what was, changes included.
    """

    def __init__(self, scene: Scene, run: int = 1, loops: LoopsOf = TieredLoops) -> None:
        self.scene = scene
        self.run = run
        self.changes = [SteppingChange(0, 0.0, Stepping(scene.h, cast=scene.cast))]
        self.furthest = 0  # the last step sampled
        self._reset = 0  # the last step from which lows and highs count
        # s, the simulated time run up to each change; it goes up even while t goes down
        self._x = [0.0]
        self._applied = 1
        self._lockstep = Lockstep(scene, run, loops=loops, judged=True)
        self._copies = [self._copy()]

    def repeat(self, changes: Iterable[SteppingChange], step: int) -> None:
        """Go to a step with these changes, which another run of this scene made."""
        for change in changes:
            self.forward(change.step - self.step)
            self.set_stepping(change.stepping)
        self.forward(step - self.step)

    @property
    def step(self) -> int:
        return self._lockstep.step

    @property
    def stepping(self) -> Stepping:
        return self._lockstep.stepping

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self._lockstep.t

    @property
    def x(self) -> float:
        """The simulated time run so far [s]; it goes up even while t goes down."""
        last = self._applied - 1
        return self._x[last] + (self.step - self.changes[last].step) * abs(
            self.changes[last].stepping.h
        )

    @property
    def judgements(self) -> list[Judgement]:
        """The verdicts at this step, since the last change of the stepping."""
        return self._lockstep.judgements

    @property
    def milestones(self) -> Sequence[Milestone]:
        """What the methods have done up to this step; those ahead come again, and are the same."""
        return self._lockstep.milestones

    @property
    def in_past(self) -> bool:
        """Whether a later step, or a change, is known already."""
        return self.step < self.furthest or self._applied < len(self.changes)

    def step_at(self, x: float) -> int:
        """The last step that is not after x."""
        at = max(bisect_right(self._x, x), 1)
        last = self.changes[at - 1]
        begin = self._x[at - 1]
        # x is a sum of floats, and the step must not lag because of that
        step = last.step + int((x - begin) / abs(last.stepping.h) + 1e-6)
        if at < len(self.changes):
            return min(step, self.changes[at].step)
        return step

    @property
    def home(self) -> float:
        """Return the step at which the simulated time is back at 0; inf if it never is."""
        ahead = -self.t / self.stepping.h
        if ahead > 0.5 and abs(ahead - round(ahead)) < 1e-6:
            return self.step + round(ahead)
        return math.inf

    def sample(self, resets: bool = True) -> Sample:
        """Return the readings now; a step that is repeated resets no lows and highs."""
        resets = resets and self.step >= self.furthest
        self.furthest = max(self.furthest, self.step)
        if resets:
            self._reset = self.step
        return self._lockstep.sample(resets)

    def forward(self, n: int) -> None:
        target = self.step + n
        while self.step < target:
            while (
                self._applied < len(self.changes) and self.changes[self._applied].step == self.step
            ):
                self._lockstep.set_stepping(self.changes[self._applied].stepping)
                self._applied += 1
            stops = [target]
            if self._applied < len(self.changes):
                stops.append(self.changes[self._applied].step)
            if self.step < self._reset:
                stops.append(self._reset)
            self._lockstep.advance(min(stops) - self.step)
            if self.step == self._reset:
                # the next sample's extremes are again those since this step
                self._lockstep.sample()
            if self.step >= self._copies[-1].lockstep.step + COPY_EVERY:
                self._copies.append(self._copy())
                self._thin()

    def back_to(self, step: int) -> None:
        """Go back to a step, before any change of the step size made there."""
        at = bisect_right(self._copies, step, key=lambda place: place.lockstep.step) - 1
        lockstep, self._applied = self._copies[at]
        self._lockstep = lockstep.copy()
        self._lockstep.run = self.run
        self.forward(step - self.step)

    @contextmanager
    def unchanged_by_errors(self) -> Iterator[None]:
        """Stay here if the block raises an error, as a user's method may at any step."""
        before = self._copy()
        try:
            yield
        except Exception:
            self._lockstep, self._applied = before
            raise

    def set_stepping(self, stepping: Stepping) -> None:
        """Step like this from here on; in the past, branch first.

        Raises SceneError for an absurd h.
        """
        x = self.x
        self._lockstep.set_stepping(stepping)
        self.changes.append(SteppingChange(self.step, self.t, stepping))
        self._x.append(x)
        self._applied += 1

    def branch(self, run: int) -> None:
        """Go on from here as another run, which shares this one's past and not what came next."""
        del self.changes[self._applied :], self._x[self._applied :]
        while self._copies[-1].lockstep.step > self.step:
            self._copies.pop()
        self.run = self._lockstep.run = run
        self.furthest = self.step
        self._reset = min(self._reset, self.step)

    def _copy(self) -> _Checkpoint:
        return _Checkpoint(self._lockstep.copy(), self._applied)

    def _thin(self) -> None:
        """Keep the first copy, the last one, and of those n steps old one in about n/8 steps."""
        kept = self._copies[:1]
        for place, following in pairwise(self._copies[1:]):
            gap = following.lockstep.step - kept[-1].lockstep.step
            if gap > max(COPY_EVERY, (self.step - place.lockstep.step) // 8):
                kept.append(place)
        self._copies = [*kept, self._copies[-1]]
