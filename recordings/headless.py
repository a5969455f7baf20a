"""Headless runs, and how many steps they may take.

The clock of their recordings is the simulated time, so the same run gives the same bytes.
"""

from collections.abc import Callable, Iterator

from engine.run.lockstep import Lockstep, Sample
from engine.run.loops import LoopsOf, plain
from engine.run.observer import RunObserver
from engine.scenes import Scene
from recordings.errors import RecordingError
from recordings.events import Event, noticed
from recordings.recorder import Recorder

SAMPLE_EVERY = 1 / 30  # s of simulated time, as often as the live lab paints


def steps_for(scene: Scene, time: float) -> int:
    """The number of steps in this much simulated time [s]."""
    return max(0, round(time / scene.h))


def simulate(
    scene: Scene,
    time: float,
    recorder: Recorder | None = None,
    sample_every: int | None = None,
    loops: LoopsOf = plain,
    observer: RunObserver | None = None,
) -> Iterator[Sample]:
    """Run a scene for `time` [s]; record and yield its samples, of which the last is the result.

    What an `observer` notices is recorded, too; without one, a recording has one of its own.

    Samples are `sample_every` steps apart, or 1/30 s rounded to whole steps; always the first and the
    last step.  Memory does not grow.  The caller closes the recorder; without a wall clock, the recording has the
    same bytes each time.
    """
    lockstep, last = Lockstep(scene, loops=loops), steps_for(scene, time)
    every = sample_every or max(1, round(SAMPLE_EVERY / scene.h))
    if recorder:
        observer = observer or RunObserver(scene, loops)
        recorder.event(Event("start", 1, 0, 0.0, scene=scene), 0.0)
    while True:
        sample = lockstep.sample()
        if recorder:
            recorder.sample(sample, sample.t)
        for milestone in observer.add(sample) if observer else ():
            if recorder:
                recorder.event(noticed(1, milestone), sample.t)
        yield sample
        if lockstep.step >= last:
            return
        lockstep.advance(min(every, last - lockstep.step))


MOST_STEPS = 10_000_000  # simulated again of a file, unless more are asked for: less than a minute
STEP_SECONDS = 5e-6  # of all four methods in plain Python, about


class StepBudget:
    """How many steps may be simulated, and how to show how far they are."""

    def __init__(self, steps: int) -> None:
        self.steps = self._left = steps
        self.show: Callable[[float], object] | None = None  # called with the share done of what is due

    def spend(self, run: int, step: int, steps: int) -> None:
        """Take so many steps off, or raise RecordingError."""
        if steps > self._left:
            needed = self.steps - self._left + steps
            raise RecordingError(
                f"run {run} claims to reach step {step}; to simulate {needed} steps takes about"
                f" {_duration(needed * STEP_SECONDS)}, and the limit is {self.steps} steps; if you trust the file, use"
                f" --max-steps {needed}"
            )
        self._left -= steps


def _duration(seconds: float) -> str:
    """About how long."""
    for size, unit in ((31_557_600, "years"), (86_400, "days"), (3600, "hours"), (60, "minutes")):
        if seconds >= 2 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} seconds"
