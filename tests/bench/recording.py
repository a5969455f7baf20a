"""Measure the cost of recording a frame, and of opening, seeking in and replaying a day."""

import random
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.playback.replay import Replay

LIMITS = {"open_seconds": 1.0, "seek_seconds_median": 0.01, "memory_mb": 100}
FRAMES = 30  # a second
SEEKS = 200


def record(path: Path, hours: float) -> float:
    """Record the samples of one minute repeatedly; return the processor time of a frame [s]."""
    lockstep = Lockstep(DEFAULT_SCENE)
    minute = []
    for _ in range(60 * FRAMES):
        minute.append(lockstep.sample())
        lockstep.advance(1)
    frames = round(hours * 3600 * FRAMES)
    with Recorder(path) as recorder:
        recorder.event(Event("start", 1, 0, 0.0, scene=DEFAULT_SCENE), 0.0)
        began = time.process_time()
        for frame in range(frames):
            sample = minute[frame % len(minute)]
            recorder.sample(sample._replace(step=frame, t=frame / FRAMES), frame / FRAMES)
            if frame % (120 * FRAMES) == 0:
                recorder.event(Event("mark", 1, frame, 0.0), frame / FRAMES)
        return (time.process_time() - began) / frames


def replay_frame(recording: Recording, begin: float) -> float:
    """Return the processor time of a frame [s] over ten seconds of a replay."""
    replay = Replay(recording, clock=time.perf_counter)
    replay.tick(0.0)
    replay.seek(begin)
    while not replay.fill():
        pass
    began = time.process_time()
    for frame in range(1, 10 * FRAMES + 1):
        replay.tick(frame / FRAMES)
    return (time.process_time() - began) / (10 * FRAMES)


def measure(share: float) -> dict[str, Any]:
    import resource  # which Windows lacks

    hours = 24.0 * share
    chance = random.Random(1)
    seeks = []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        cost = record(path, hours)
        began = time.perf_counter()
        recording = Recording.open(path)
        opened = time.perf_counter() - began
        for _ in range(SEEKS):
            clock = chance.uniform(0, recording.length)
            began = time.perf_counter()
            assert recording.at(clock) is not None
            seeks.append(time.perf_counter() - began)
        near_start = replay_frame(recording, 10.0)
        near_end = replay_frame(recording, recording.length - 15.0)
        return {
            "hours": hours,
            "megabytes": round(path.stat().st_size / 1e6, 1),
            "record_frame_ms": round(1000 * cost, 3),
            "open_seconds": round(opened, 3),
            "seek_seconds_median": round(median(seeks), 5),
            "replay_frame_ms": [round(1000 * near_start, 3), round(1000 * near_end, 3)],
            "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000,
        }
