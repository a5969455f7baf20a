"""Make the bundled recordings: python -m tests.recordings.make_golden.

The same bytes each time.  Run it only when a scene is meant to change: these files are what later
versions of the methods are measured against.
"""

import math
from pathlib import Path
from typing import NamedTuple

from engine.scenes import Scene
from recordings.headless import Changes, simulate
from recordings.library import GOLDEN, SUFFIX
from recordings.recorder import Recorder


class Golden(NamedTuple):
    scene: Scene
    time: float  # s
    sample_every: int  # steps
    changes: Changes = ()


RECORDINGS = {
    "drift": Golden(
        Scene("drift", watch="Explicit Euler gains energy until it goes over the top; the symplectic ones keep it."),
        time=15,
        sample_every=2,
    ),
    "changes-of-h": Golden(
        Scene("changes-of-h", watch="The step size changes at 3, 6 and 9 s, and with it every method's error."),
        time=12,
        sample_every=3,
        changes=[(60, 0.1), (90, 0.025), (210, 0.05)],
    ),
    "reversed-time": Golden(
        Scene(
            "reversed-time",
            theta=2.5,
            watch="After 5 s time runs back: Verlet returns to the last digit, RK4 nearly, the Eulers get lost.",
        ),
        time=10,
        sample_every=2,
        changes=[(100, -0.05)],
    ),
    "near-separatrix": Golden(
        Scene(
            "near-separatrix",
            theta=math.radians(179.9),
            h=0.02,
            watch="Almost upright: a tiny energy error decides on which side it falls, and when.",
        ),
        time=12,
        sample_every=6,
    ),
    "spin": Golden(
        Scene("spin", omega=8.0, theta=0.0, h=0.02, watch="Over the top, again and again: rotation."),
        time=6,
        sample_every=3,
    ),
}


def make(name: str, path: Path) -> None:
    scene, time, sample_every, changes = RECORDINGS[name]
    with Recorder(path, wall=None, overwrite=True) as recorder:
        for _ in simulate(scene, time, recorder, sample_every, changes):
            pass


if __name__ == "__main__":
    for name in RECORDINGS:
        make(name, GOLDEN / (name + SUFFIX))
