"""Headless runs.  Their recording clock is the simulated time, so the same run gives the same bytes."""

from collections.abc import Iterator

from engine.run.lockstep import Lockstep, Sample
from engine.run.loops import LoopsOf, plain
from engine.run.observer import RunObserver
from engine.scenes import Scene
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
