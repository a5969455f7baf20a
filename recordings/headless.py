"""Headless runs, whose clock is the simulated time: the same run gives the same bytes."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.loops import LoopsOf, PlainLoops
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import Event, noticed

if TYPE_CHECKING:  # mcap and msgspec are slow to load, and most runs are not recorded
    from pendu_tui.recordings.recorder import Recorder

SAMPLE_EVERY = 1 / 30  # s of simulated time, as often as the live lab paints


def steps_for(scene: Scene, time: float) -> int:
    """Return the number of steps in a simulated time [s]."""
    return max(0, round(time / scene.h))


def simulate(
    scene: Scene,
    time: float,
    recorder: "Recorder | None" = None,
    sample_every: int | None = None,
    loops: LoopsOf = PlainLoops,
    lockstep: Lockstep | None = None,
) -> Iterator[Sample]:
    """Run a scene for `time` [s]; record and yield its samples, the last of which is the result.

    Samples are `sample_every` steps apart, or 1/30 s rounded to whole steps, and include the first
    and the last step.  Pass a `lockstep` to read its milestones or verdicts; close the recorder.
    """
    lockstep = lockstep or Lockstep(scene, loops=loops, judged=recorder is not None)
    last = steps_for(scene, time)
    recorded = 0  # milestones
    every = sample_every or max(1, round(SAMPLE_EVERY / scene.h))
    if recorder:
        recorder.event(Event("start", 1, 0, 0.0, scene=scene), 0.0)
    while True:
        sample = lockstep.sample()
        if recorder:
            recorder.sample(sample, sample.t)
            for milestone in lockstep.milestones[recorded:]:
                recorder.event(noticed(1, milestone), sample.t)
            recorded = len(lockstep.milestones)
        yield sample
        if lockstep.step >= last:
            return
        lockstep.advance(min(every, last - lockstep.step))
