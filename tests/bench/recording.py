"""What recording costs a frame, and what hours of it cost to open, to seek in and to replay: one JSON object.

python tests/bench/recording.py [HOURS]
"""

import json
import os
import random
import resource
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from engine.run.lockstep import Lockstep
from engine.scenes import DEFAULT_SCENE
from recordings.events import Event
from recordings.recorder import Recorder
from recordings.recording import Recording

FRAMES = 30  # a second
SEEKS = 200


def seconds_a_frame(folder: Path) -> float:
    """Return the processor time that recording takes of a frame [s], flushes included."""
    lockstep = Lockstep(DEFAULT_SCENE)
    samples = []
    for _ in range(60 * FRAMES):
        samples.append(lockstep.sample())
        lockstep.advance(1)
    with Recorder(folder / "frames.mcap") as recorder:
        recorder.event(Event("start", 1, 0, 0.0, scene=DEFAULT_SCENE), 0.0)
        began = time.process_time()
        for frame, sample in enumerate(samples):
            recorder.sample(sample, frame / FRAMES)
        return (time.process_time() - began) / len(samples)


def long_recording(path: Path, hours: float) -> None:
    """Record so many hours.  The numbers of a minute are used again; only clocks and steps go on."""
    lockstep = Lockstep(DEFAULT_SCENE)
    minute = []
    for _ in range(60 * FRAMES):
        minute.append(lockstep.sample())
        lockstep.advance(1)
    with Recorder(path) as recorder:
        recorder.event(Event("start", 1, 0, 0.0, scene=DEFAULT_SCENE), 0.0)
        for frame in range(round(hours * 3600 * FRAMES)):
            sample = minute[frame % len(minute)]
            recorder.sample(sample._replace(step=frame, t=frame / FRAMES), frame / FRAMES)
            if frame % (120 * FRAMES) == 0:
                recorder.event(Event("mark", 1, frame, 0.0), frame / FRAMES)


def peak_memory() -> float:
    """Return the most memory that this process had [MB]; getrusage begins with what its parent had."""
    status = Path("/proc/self/status")
    if status.exists():
        return int(status.read_text().split("VmHWM:")[1].split()[0]) / 1000
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000


def watch(path: Path) -> dict[str, float]:
    """Open it, seek in it at random and step; in a process of its own, because of the memory."""
    began = time.perf_counter()
    recording = Recording.open(path)
    opened = time.perf_counter() - began
    chance = random.Random(1)
    seeks = []
    for _ in range(SEEKS):
        clock = chance.uniform(0, recording.length)
        began = time.perf_counter()
        assert recording.at(clock) is not None
        seeks.append(time.perf_counter() - began)
    found = {
        "open_seconds": opened,
        "seek_seconds_median": median(seeks),
        "seek_seconds_max": max(seeks),
    }
    return found | frames(recording) | {"memory_mb": peak_memory()}


def frames(recording: Recording) -> dict[str, float]:
    """Replay ten seconds at 1x near the start and near the end: the processor time of a frame [s]."""
    from tui.playback.marks import Marks
    from tui.playback.replay import Replay

    found = {}
    for name, begin in (("start", 10.0), ("end", recording.length - 15.0)):
        now = 0.0
        replay = Replay(recording, Marks(recording.path), clock=time.perf_counter)
        replay.tick(now)
        replay.seek(begin)
        while not replay.fill():
            pass
        began = time.process_time()
        for _ in range(10 * FRAMES):
            now += 1 / FRAMES
            replay.tick(now)
        found[f"frame_seconds_near_the_{name}"] = (time.process_time() - began) / (10 * FRAMES)
    return found


def main() -> None:
    """Measure and print."""
    if sys.argv[1:2] == ["--watch"]:
        print(json.dumps(watch(Path(sys.argv[2]))))
        return
    hours = float(sys.argv[1]) if len(sys.argv) > 1 else 24.0
    with TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        cost = seconds_a_frame(Path(folder))
        long_recording(path, hours)
        size = path.stat().st_size
        command = [sys.executable, __file__, "--watch", str(path)]
        watched = json.loads(
            subprocess.run(command, check=True, capture_output=True, text=True).stdout
        )
    facts = {
        "microseconds_a_frame": round(cost * 1e6, 1),
        "hours": hours,
        "megabytes": round(size / 1e6, 1),
    }
    found = {name: round(value, 5) for name, value in watched.items()}
    print(json.dumps({"benchmark": "recording", "cores": os.cpu_count(), **facts, **found}))


if __name__ == "__main__":
    main()
