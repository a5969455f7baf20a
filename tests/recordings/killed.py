"""A lab with random key presses, until it is killed: python -m tests.recordings.killed FILE LOG.

Each frame it appends to LOG the time and the last sample that its recorder has taken.
"""

import os
import random
import sys
import time
from dataclasses import replace
from pathlib import Path

from pendu_tui.engine.methods import GENERAL, USUAL_CAST
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.tui.playback.live import Live
from tests.own_methods import load
from tests.recordings.examples import SCENE

FRAME = 1 / 30  # s
HEUN = """
def my_heun(force, phase, h):
    theta, omega = phase
    while True:
        a = force(theta)
        b = force(theta + h * omega)
        theta, omega = theta + h / 2 * (2 * omega + h * a), omega + h / 2 * (a + b)
        yield theta, omega
"""
OWN = (load(HEUN, "my_heun"),)
KEYS = (
    *[lambda live: live.pause(not live.playhead.paused)] * 4,
    *[lambda live: live.step(1)] * 8,
    lambda live: live.step(10),
    lambda live: live.step(-3),
    lambda live: live.change(live.stepping._replace(h=0.02)),
    lambda live: live.change(live.stepping._replace(h=-0.05)),
    lambda live: live.start(
        replace(live.scene, cast=tuple(random.sample(USUAL_CAST, 3)), model="pendulum")
    ),
    lambda live: live.start(replace(live.scene, cast=GENERAL[:5] + OWN, model="pendulum")),
    lambda live: live.start(replace(live.scene, model="linear")),
    lambda live: live.mark("here"),
    lambda live: live.restart(),
)


class Noting(LiveRecorder):
    """Remembers its last sample."""

    last = (0, 0)  # run, step

    def add(self, value, clock):
        super().add(value, clock)
        if isinstance(value, Sample):
            self.last = (value.run, value.step)


def main(path: Path, log: Path):
    """Play at 30 frames a second, and press about three keys a second."""
    recorder = Noting(path)
    live = Live(SCENE)
    live.record(recorder)
    log_file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    while True:
        live.tick(time.monotonic())
        if random.random() < 0.1:
            random.choice(KEYS)(live)
        run, step = recorder.last
        os.write(log_file, f"{time.monotonic()} {run} {step}\n".encode())
        time.sleep(FRAME)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
