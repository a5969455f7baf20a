"""Make the bundled recordings: python -m tests.recordings.make_golden.

The same bytes each time.  Run it only when a scene or the recorded fields are meant to change:
later versions of the methods are measured against these files.
"""

import math
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from pendu_tui.engine.methods import EXPLICIT_EULER, RK4, SYMPLECTIC_EULER, VELOCITY_VERLET, Cast
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.files import GOLDEN, SUFFIX
from pendu_tui.recordings.recorder import Recorder
from tests.recordings.examples import Changes, with_changes


class Golden(NamedTuple):
    scene: Scene
    time: float  # s
    sample_every: int  # steps
    changes: Changes = ()
    then: tuple[Cast, ...] = ()  # the methods of the runs that follow from the same start


MADE = (
    Golden(
        Scene(
            "drift",
            watch="Explicit Euler gains energy until it goes over the top; the symplectic ones keep it.",
        ),
        time=15,
        sample_every=2,
    ),
    Golden(
        Scene(
            "changes-of-h",
            watch="The step size changes at 3, 6 and 9 s, and with it every method's error.",
        ),
        time=12,
        sample_every=3,
        changes=[(60, 0.1), (90, 0.025), (210, 0.05)],
    ),
    Golden(
        Scene(
            "reversed-time",
            theta=2.5,
            watch="After 5 s time runs back: Verlet returns to the last digit, RK4 nearly, the Eulers get lost.",
        ),
        time=10,
        sample_every=2,
        changes=[(100, -0.05)],
    ),
    Golden(
        Scene(
            "near-separatrix",
            theta=math.radians(179.9),
            h=0.02,
            watch="Almost upright: a tiny energy error decides on which side it falls, and when.",
        ),
        time=12,
        sample_every=6,
    ),
    Golden(
        Scene(
            "spin", omega=8.0, theta=0.0, h=0.02, watch="Over the top, again and again: rotation."
        ),
        time=6,
        sample_every=3,
    ),
    Golden(
        Scene(
            "linear",
            theta=0.5,
            h=0.2,
            watch="The linear oscillator: every swing gains explicit Euler the same factor, costs RK4 the same share.",
            model="linear",
        ),
        time=12,
        sample_every=2,
    ),
    Golden(
        Scene(
            "verdicts",
            watch="Explicit Euler gains energy, RK4 loses some, the symplectic ones stay bounded.",
        ),
        time=60,
        sample_every=24,
    ),
    Golden(
        Scene(
            "swapped-cast",
            watch="Three runs from one start: the two Eulers, Verlet and RK4, and all four again.",
            cast=(EXPLICIT_EULER, SYMPLECTIC_EULER),
        ),
        time=4,
        sample_every=2,
        then=((VELOCITY_VERLET, RK4), (RK4, VELOCITY_VERLET, EXPLICIT_EULER, SYMPLECTIC_EULER)),
    ),
    Golden(
        replace(
            SCENES["damped"],
            watch="Friction stops the swing; explicit Euler gains energy against it. Errors are ln(E/E_true).",
        ),
        time=20,
        sample_every=8,
    ),
    Golden(
        replace(
            SCENES["stiff-slow"],
            watch="A bob on a stiff spring, h·omega = 1: RK4 takes the energy out of the spring, IMEX Euler all of it.",
        ),
        time=6,
        sample_every=8,
        changes=[(200, 0.01)],
    ),
)
RECORDINGS = {made.scene.name: made for made in MADE}


class Later:
    """A recorder for a run that follows others."""

    def __init__(self, recorder: Recorder, run: int) -> None:
        self._recorder, self._run, self._begin = recorder, run, recorder.seconds

    def event(self, event: Event, clock: float) -> None:
        self._recorder.event(event._replace(run=self._run), self._begin + clock)

    def sample(self, sample: Sample, clock: float) -> None:
        self._recorder.sample(sample._replace(run=self._run), self._begin + clock)


def make(name: str, path: Path) -> None:
    scene, time, sample_every, changes, then = RECORDINGS[name]
    with Recorder(path, wall=None, overwrite=True) as recorder:
        for run, cast in enumerate((scene.cast, *then), 1):
            later = Later(recorder, run)
            list(with_changes(replace(scene, cast=cast), time, later, changes, sample_every))


if __name__ == "__main__":
    for name in RECORDINGS:
        make(name, GOLDEN / (name + SUFFIX))
