"""Headless runs.  The clock of their recordings is the simulated time, so the same run gives the same bytes."""

from collections.abc import Iterator, Sequence

from engine.run.lockstep import Lockstep, Sample
from engine.run.loops import LoopsOf, plain
from engine.run.stepping import Stepping
from engine.scenes import Scene
from recordings.events import Event
from recordings.recorder import Recorder

SAMPLE_EVERY = 1 / 30  # s of simulated time, as often as the live lab paints

Changes = Sequence[tuple[int, float]]
"""(step, h): from this step on, this step size [s].  Steps ascend."""


def segments(scene: Scene, time: float, changes: Changes = ()) -> Iterator[tuple[int, int, float]]:
    """(first step, last step, h) of each stretch of constant h.  Backwards or forwards, |h| adds to the time [s]."""
    first, h, left = 0, scene.h, time
    for change, following in changes:
        if first + round(left / abs(h)) <= change:
            break
        yield first, change, h
        left -= (change - first) * abs(h)
        first, h = change, following
    yield first, first + max(0, round(left / abs(h))), h


def steps_for(scene: Scene, time: float, changes: Changes = ()) -> int:
    """The number of steps in this much simulated time [s]."""
    return [last for _, last, _ in segments(scene, time, changes)][-1]


def simulate(
    scene: Scene,
    time: float,
    recorder: Recorder | None = None,
    sample_every: int | None = None,
    changes: Changes = (),
    loops: LoopsOf = plain,
) -> Iterator[Sample]:
    """Run a scene for `time` [s]; record and yield its samples, of which the last is the result.

    Samples are `sample_every` steps apart, or 1/30 s rounded to whole steps; always the first and the
    last step and the step of each change.  Memory does not grow.  The caller closes the recorder;
    without a wall clock, the recording has the same bytes each time.
    """
    lockstep = Lockstep(scene, loops=loops)
    clock = 0.0  # s, simulated; goes up while t goes down

    def record(value: Sample | Event) -> None:
        if isinstance(value, Sample) and recorder:
            recorder.sample(value, clock)
        elif isinstance(value, Event) and recorder:
            recorder.event(value, clock)

    record(Event("start", 1, 0, 0.0, scene=scene))
    record(sample := lockstep.sample())
    yield sample
    for first, last, h in segments(scene, time, changes):
        if h != lockstep.stepping.h:
            record(Event("set_h", 1, first, lockstep.t, h=h))
            lockstep.set_stepping(Stepping(h, cast=scene.cast))
        begin = clock
        every = sample_every or max(1, round(SAMPLE_EVERY / abs(h)))
        while lockstep.step < last:
            lockstep.advance(min(every, last - lockstep.step))
            clock = begin + (lockstep.step - first) * abs(h)
            record(sample := lockstep.sample())
            yield sample
