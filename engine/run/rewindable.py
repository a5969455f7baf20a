"""A run that can also go back, to the bit.

Going back simulates again from an earlier copy of the lockstep.  The older copies are, the further
they lie apart, so their number grows only with the logarithm of the run's length.
"""

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from operator import attrgetter
from typing import NamedTuple

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.loops import LoopsOf, TieredLoops
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.scenes import Scene

COPY_EVERY = 1000  # steps, which take 4 ms: a step back is instant


class _Checkpoint(NamedTuple):
    lockstep: Lockstep
    applied: int  # changes up to here


class RewindableRun:
    """One run: its lockstep, the changes of its stepping, and copies for the way back.

    After a step back, `forward` repeats what came next, changes included.
    """

    def __init__(self, scene: Scene, run: int = 1, loops: LoopsOf = TieredLoops) -> None:
        self.scene = scene
        self.run = run
        self.changes = [SteppingChange(0, 0.0, Stepping(scene.h, cast=scene.cast))]
        self.furthest = 0  # the last step sampled
        self._reset = 0  # the step of the last sample that reset the extremes
        self._applied = 1
        self.lockstep = Lockstep(scene, run, loops=loops, judged=True)
        self._copies = [self._copy()]

    def repeat(self, changes: Iterable[SteppingChange], step: int) -> None:
        """Go to a step with these changes, taken from another run of this scene."""
        for change in changes:
            self.forward(change.step - self.step)
            self.change(change.stepping)
        self.forward(step - self.step)

    @property
    def step(self) -> int:
        return self.lockstep.step

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self.lockstep.t

    @property
    def x(self) -> float:
        """The simulated time so far [s], which increases even while t decreases."""
        return self.x_at(self.step)

    def x_at(self, step: int) -> float:
        """Return the simulated time [s] on the way to a step."""
        last = self.changes[bisect_right(self.changes, step, key=attrgetter("step")) - 1]
        return last.x + (step - last.step) * abs(last.stepping.h)

    @property
    def in_past(self) -> bool:
        """Whether the run has been at a later step, or has a change ahead."""
        return self.step < self.furthest or self._applied < len(self.changes)

    def step_at(self, x: float) -> int:
        """Return the last step that is not after x."""
        last = self.changes[bisect_right(self.changes, x, key=attrgetter("x")) - 1]
        # x is a sum of floats, and the step must not lag because of that
        return last.step + int((x - last.x) / abs(last.stepping.h) + 1e-6)

    @property
    def home(self) -> float:
        """The step at which the simulated time will be 0 again; inf if never."""
        ahead = -self.t / self.lockstep.stepping.h
        if ahead > 0.5 and abs(ahead - round(ahead)) < 1e-6:
            return self.step + round(ahead)
        return math.inf

    def sample(self, resets: bool = True) -> Sample:
        """Return the present readings; at a step before the last reset, extremes are not reset."""
        resets = resets and self.step >= self._reset
        self.furthest = max(self.furthest, self.step)
        if resets:
            self._reset = self.step
        return self.lockstep.sample(resets)

    def forward(self, n: int) -> None:
        target = self.step + n
        while self.step < target:
            if self.step == self._reset:
                self.lockstep.sample()  # to reset the extremes, which a copy may not have done
            stops = [target]
            for change in self.changes[self._applied :]:
                if change.step == self.step:
                    self.lockstep.set_stepping(change.stepping)
                    self._applied += 1
                else:
                    stops.append(change.step)
            if self.step < self._reset:
                stops.append(self._reset)
            self.lockstep.advance(min(stops) - self.step)
            if self.step >= self._copies[-1].lockstep.step + COPY_EVERY:
                self._copies.append(self._copy())
                self._thin()

    def go_to(self, step: int) -> None:
        """Go to a step that the run has been at, before any change made there."""
        at = bisect_right(self._copies, step, key=lambda place: place.lockstep.step) - 1
        if not self._copies[at].lockstep.step <= self.step <= step:
            lockstep, self._applied = self._copies[at]
            self.lockstep = lockstep.copy()
            self.lockstep.run = self.run
        self.forward(step - self.step)

    @contextmanager
    def unchanged_by_errors(self) -> Iterator[None]:
        """Return here if the block raises an error, as a user's method may at any step."""
        before = self._copy()
        try:
            yield
        except BaseException:  # such as TooLongError
            self.lockstep, self._applied = before
            raise

    def change(self, stepping: Stepping) -> None:
        """Step like this from here on; in the past, branch first."""
        x = self.changes[-1].x_at(self.t)
        self.lockstep.set_stepping(stepping)
        self.changes.append(SteppingChange(self.step, self.t, stepping, x))
        self._applied += 1

    def branch(self, run: int) -> None:
        """Go on from here as another run, which shares this one's past only."""
        del self.changes[self._applied :]
        while self._copies[-1].lockstep.step > self.step:
            self._copies.pop()
        self.run = self.lockstep.run = run
        self.furthest = self.step
        self._reset = 0

    def _copy(self) -> _Checkpoint:
        return _Checkpoint(self.lockstep.copy(), self._applied)

    def _thin(self) -> None:
        """Keep the first copy, the last one, and of copies n steps old one in about n/8 steps."""
        kept = self._copies[:1]
        for place, following in pairwise(self._copies[1:]):
            gap = following.lockstep.step - kept[-1].lockstep.step
            if gap > (self.step - place.lockstep.step) // 8:
                kept.append(place)
        self._copies = [*kept, self._copies[-1]]
