"""Reference lines on the chart of error against seconds: a Taylor series, and the closed form."""

from collections.abc import Iterator
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.accuracy.study import COMPARISONS, TIMED_STEPS, Clock, Point, Study, shortest
from pendu_tui.engine.methods.method import Method
from pendu_tui.engine.models.exact_pendulum import exact_pendulum
from pendu_tui.engine.scenes import Scene

ABSENT = "Taylor's series is for shorter runs of the pendulum, where Numba compiles the methods."
TAYLOR_20 = Method(
    key="taylor_20",
    label="Taylor, order 20",
    letter="t",
    phases=lambda *_: iter(()),
    formula="",
    order=20,
    force_evaluations=0,
    reference="",
    used=None,
)


class References(NamedTuple):
    """The reference lines; `absent` says why there is no series."""

    closed_form: float  # s, of COMPARISONS + 1 states
    taylor: tuple[Point, ...]
    absent: str | None


def references(scene: Scene, time: float, clock: Clock, fast: bool) -> References:
    """Time the reference lines over `time` [s]; `fast`: compiled."""
    motion: Any = scene.exact().at
    states: Any = _states
    series: tuple[Point, ...] = ()
    if fast and scene.equations.has_separatrix:
        njit = import_module("numba").njit
        motion = exact_pendulum(scene.w0_squared, scene.theta, scene.omega, compile=njit).at
        states = njit(_states)
        series = tuple(taylor_points(scene, time, clock))
    times = np.linspace(0, time, COMPARISONS + 1)
    seconds, _ = shortest(lambda: states(motion, times), 20, clock)
    return References(seconds, series, None if series else ABSENT)


def _states(motion: Any, times: Any) -> Any:
    return [motion(t) for t in times]


def taylor_points(scene: Scene, time: float, clock: Clock) -> Iterator[Point]:
    """Yield timed points, the loosest tolerance first."""
    fastest = max(scene.w0, abs(scene.omega))
    if time * fastest > 1e6:  # rad of motion, which take too long
        return
    solve = import_module("pendu_tui.engine.accuracy.taylor").solve  # needs Numba
    study = Study(scene, time)
    times = np.linspace(0, time, COMPARISONS + 1)
    start = (scene.w0_squared, scene.theta, scene.omega)
    for power in range(1, 18):
        tolerance = fastest * 10.0**-power
        states, steps = solve(*start, times, tolerance)
        off = np.abs(states[:, 0] - study.thetas)
        energies = scene.equations.energy(np.sin)(states.T)
        energy_error = np.abs(energies - energies[0]).max() / study.energy_scale
        errors = (float(off.max()), float(energy_error), float(off[-1]))
        flaws = study.flaws(errors, 16 * steps)  # a step rounds 16 times as often as a force
        runs = max(1, TIMED_STEPS // steps)
        seconds = shortest(partial(solve, *start, times[-1:], tolerance), runs, clock)
        yield Point(TAYLOR_20, time, scene.w0, steps, *errors, flaws, *seconds, tolerance)
