"""Small recordings for tests, the same each time."""

import struct
from pathlib import Path

import zstandard

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


def run_of(scene: Scene, *acts: int | Stepping):
    """The entries of a run whose clock shows the simulated time.

    A number takes so many steps to a sample; a stepping is a change.
    """
    lockstep = Lockstep(scene, judged=True)
    clock = 0.0
    noted = 0  # milestones
    entries = [Entry(clock, start(scene=scene))]
    for act in acts:
        if isinstance(act, Stepping):
            lockstep.set_stepping(act)
            event = Event("set_h", 1, lockstep.step, lockstep.t, h=act.h)
            entries.append(Entry(clock, event))
        else:
            lockstep.advance(act)
            clock += act * abs(lockstep.stepping.h)
            found = (noticed(1, each) for each in lockstep.milestones[noted:])
            entries += [Entry(clock, value) for value in (lockstep.sample(), *found)]
            noted = len(lockstep.milestones)
    return entries


def false_head(packed: int = 4_000_000):
    """The head of a chunk that claims to have so many bytes, and 4 MB of contents."""
    frame = zstandard.ZstdCompressor().compress(bytes(4_000_000))[:18]
    numbers = (6, packed + 44, 1, 2, 4_000_000, 1, b"\x04\x00\x00\x00zstd", packed)
    return struct.pack("<BQQQQI8sQ", *numbers) + frame
