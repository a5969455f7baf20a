"""Small recordings for tests, the same each time."""

import math
from collections.abc import Sequence
from pathlib import Path

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import Entry, Event, noticed
from pendu_tui.recordings.recorder import FLUSH_EVERY, Recorder
from pendu_tui.recordings.recording import Recording

SCENE = Scene("test", theta=2.0, h=0.1)


def start(run: int = 1, scene: Scene = SCENE):
    return Event("start", run, 0, 0.0, scene=scene)


def two_runs():
    """Two runs with all kinds of events, the second of which continues from the first."""
    entries = []

    def note(clock: float, value: Sample | Event):
        entries.append(Entry(clock, value))

    def advance(lockstep: Lockstep, steps: int, *clocks: float):
        for clock in clocks:
            lockstep.advance(steps)
            note(clock, lockstep.sample())

    first = Lockstep(SCENE, run=1)
    note(0.0, start())
    note(0.0, first.sample())
    advance(first, 3, 0.5, 1.0, 1.5)
    note(1.5, Event("set_h", 1, 9, first.t, h=0.05))
    first.set_stepping(Stepping(0.05))
    note(1.5, Event("speed", 1, 9, first.t, speed=2.0))
    advance(first, 3, 2.0, 2.5)
    note(2.5, Event("pause", 1, 15, first.t))
    note(2.5, Event("mark", 1, 15, first.t, text="what is this?"))
    advance(first, 1, 2.5)  # a step while paused: the clock stands
    note(2.5, Event("resume", 1, 16, first.t))
    second = Lockstep(SCENE, run=2)
    second.advance(9)
    second.set_stepping(Stepping(0.05))
    second.advance(3)
    note(2.75, start(2))
    note(2.75, Event("set_h", 2, 9, 0.9, h=0.05))
    note(2.75, Event("set_h", 2, 12, second.t, h=-0.1, equal_cost=True))
    second.set_stepping(Stepping(-0.1, equal_cost=True))
    note(2.75, second.sample())
    advance(second, 2, 3.5, 4.0)
    return entries


def samples_of(recording: Recording):
    return [entry for entry in recording.entries() if isinstance(entry.value, Sample)]


def record(path: Path, entries: list[Entry]):
    """Write entries, with a chunk each second as in the lab."""
    flushed_at = 0.0
    with Recorder(path) as recorder:
        for clock, value in entries:
            recorder.add(value, clock)
            if clock >= flushed_at + FLUSH_EVERY:
                recorder.flush()
                flushed_at = clock
    return path


def with_changes(
    scene: Scene,
    time: float,
    recorder: Recorder,
    changes: Sequence[tuple[int, float]],
    sample_every: int,
):
    """`simulate` with changes, each a step and h from there on; the clock always runs forwards."""
    lockstep = Lockstep(scene, judged=True)
    clock = 0.0
    remaining = time
    recorded = 0  # milestones

    def sampled():
        nonlocal recorded
        sample = lockstep.sample()
        recorder.add(sample, clock)
        for milestone in lockstep.milestones[recorded:]:
            recorder.add(noticed(1, milestone), clock)
        recorded = len(lockstep.milestones)
        return sample

    recorder.add(start(scene=scene), 0.0)
    yield sampled()
    for step, h in (*changes, (math.inf, 0.0)):
        begin = clock
        first = lockstep.step
        size = abs(lockstep.stepping.h)
        last = first + max(0, round(remaining / size))
        end = int(min(step, last))
        while lockstep.step < end:
            lockstep.advance(min(sample_every, end - lockstep.step))
            clock = begin + (lockstep.step - first) * size
            yield sampled()
        if end == last:
            return
        remaining -= (end - first) * size
        if h != lockstep.stepping.h:
            recorder.add(Event("set_h", 1, end, lockstep.t, h=h), clock)
            lockstep.set_stepping(Stepping(h, cast=scene.cast))
