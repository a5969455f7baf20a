"""What recording costs a frame, and what eight hours of it cost to open, to seek in and to hold: one JSON object."""

import json
import os
import random
import resource
import subprocess
import sys
import time
from pathlib import Path
from statistics import median, quantiles
from tempfile import TemporaryDirectory

from engine.run.lockstep import Lockstep
from engine.scenes import DEFAULT_SCENE
from recordings.events import Event
from recordings.format import encode_event, encode_readings
from recordings.recorder import Recorder
from recordings.recording import Recording

FRAMES = 30  # a second
HOURS = 8
SEEKS = 200


def start() -> Event:
    """The start of the default scene."""
    return Event("start", 1, 0, 0.0, scene=DEFAULT_SCENE)


def seconds_a_frame(folder: Path) -> float:
    """Processor time that recording takes of a frame [s], flushes included, while the lab runs for a minute."""
    frames = 60 * FRAMES
    lockstep = Lockstep(DEFAULT_SCENE)
    samples = []
    for _ in range(frames):
        samples.append(lockstep.sample())
        lockstep.advance(1)
    with Recorder(folder / "frames.mcap") as recorder:
        recorder.event(start(), 0.0)
        began = time.process_time()
        for frame, sample in enumerate(samples):
            recorder.sample(sample, frame / FRAMES)
        return (time.process_time() - began) / frames


def long_recording(path: Path, hours: float) -> None:
    """A recording of so many hours.  The numbers of a minute are used again; only clocks and steps go on."""
    lockstep = Lockstep(DEFAULT_SCENE)
    minute = []
    for _ in range(60 * FRAMES):
        minute.append(encode_readings(lockstep.sample()))
        lockstep.advance(1)
    with Recorder(path) as recorder:
        recorder.event(start(), 0.0)
        topics = recorder._topics
        for frame in range(round(hours * 3600 * FRAMES)):
            recorder._add(list(zip(topics, minute[frame % len(minute)], strict=True)), frame / FRAMES)
            recorder.samples += 1
            if frame % (120 * FRAMES) == 0:
                recorder._add([("/pendu/events", encode_event(Event("mark", 1, frame, 0.0)))], frame / FRAMES)
            recorder._flush_if_due()


def peak_memory() -> float:
    """Of this process [MB].  Linux's own count: getrusage's begins with what the parent had when it forked."""
    status = Path("/proc/self/status")
    if status.exists():
        return int(status.read_text().split("VmHWM:")[1].split()[0]) / 1000
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000


def watch(path: Path) -> dict[str, float]:
    """Open it, seek in it at random and step; in a process of its own, because of the memory."""
    bare = peak_memory()
    began = time.perf_counter()
    recording = Recording.open(path)
    opened = time.perf_counter() - began
    assert recording.complete
    chance = random.Random(1)
    seeks, steps = [], []
    for _ in range(SEEKS):
        clock = chance.uniform(0, recording.length)
        began = time.perf_counter()
        place = recording.at(clock)
        assert place is not None
        seeks.append(time.perf_counter() - began)
        began = time.perf_counter()
        recording.previous(place)
        steps.append(time.perf_counter() - began)
    return {
        "open_seconds": opened,
        "seek_seconds_median": median(seeks),
        "seek_seconds_max": max(seeks),
        "step_back_seconds_p99": quantiles(steps, n=100)[98],
        "memory_mb": peak_memory(),
        "memory_before_opening_mb": bare,
    }


def main() -> None:
    """Measure and print."""
    if len(sys.argv) > 1:
        print(json.dumps(watch(Path(sys.argv[1]))))
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        cost = seconds_a_frame(Path(folder))
        long_recording(path, HOURS)
        size = path.stat().st_size
        command = [sys.executable, __file__, str(path)]
        watched = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    print(
        json.dumps(
            {
                "benchmark": "recording",
                "microseconds_a_frame": round(cost * 1e6, 1),
                "share_of_a_core_at_30_fps": round(cost * FRAMES, 5),
                "hours": HOURS,
                "megabytes": round(size / 1e6, 1),
                "cores": os.cpu_count(),
                **{name: round(value, 4) for name, value in watched.items()},
            }
        )
    )


if __name__ == "__main__":
    main()
