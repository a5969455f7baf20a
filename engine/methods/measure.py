"""Measured properties of a method: order, cost, symplecticity, reversibility, linear limit.

Tests compare them with the fields of METHODS.  A user's own method is first checked for what the
lab, its charts and its files rely on; then the measured values become its fields.
"""

import cmath
import math
from functools import partial
from itertools import islice
from operator import neg
from statistics import linear_regression
from typing import Any, cast

import numpy as np

from pendu_tui.engine.methods.method import SMALL_ERROR, Measured, Phases
from pendu_tui.engine.methods.own import OwnMethodError, on_force
from pendu_tui.engine.methods.tangent import jacobian
from pendu_tui.engine.models.model import Force, Phase
from pendu_tui.engine.models.pendulum import Pendulum

PENDULUM = Pendulum(9.81)
START = (1.0, 0.3)
LARGE_H = 0.2  # s; with small steps a high order hides a change of area, or a miss of the start
WIDEST_Z = 16  # of the search for a limit
RUNGS = 2048  # in each 1 of z: they are two thirds of the narrowest gap apart, BM6's
NO_LIMIT_BELOW = 0.1  # z, below which some unstable methods grow by less than rounding
H = 0.05  # s, of the steps with which a user's own method is checked
STEPS = 80
CUT = 37  # steps; a prime, so that a method that counts to a round number of up to 40 shows it
SAME = 1e-9  # relative; rounding differs by far less, wrong numbers by far more
LINEAR_ROUNDING = 3e-13  # of a linear step; the limit moves by up to a thousand times as much


def measured(phases: Phases) -> Measured:
    """Measure all properties.  Raises what the method raises."""
    return Measured(
        order(phases),
        *evaluations(phases),
        is_symplectic(phases),
        is_reversible(phases),
        linear_limit(phases),
    )


def after(phases: Phases, force: Force, phase: Phase, h: Any, steps: int) -> Phase:
    """Return the phase after some steps."""
    return next(islice(phases(force, phase, h), steps - 1, None))


def order(phases: Phases) -> float | None:
    """Return the slope of log theta error over log h, over half a period, of the smallest six h.

    None: fewer than three h have an error below SMALL_ERROR that is no rounding.

    Over longer times the loss of energy adds a power of its own, and RK4 reads 5 to 6.6.
    """
    exact = PENDULUM.exact(*START)
    force = PENDULUM.force()
    half = (exact.period or 1.0) / 2
    points: list[tuple[float, float]] = []
    for power in range(2, 25):
        steps = round(2 ** (power / 2))
        largest = 0.0
        for step, phase in enumerate(islice(phases(force, START, half / steps), steps), 1):
            largest = max(largest, abs(phase[0] - exact.at(step * half / steps).theta))
            if not largest < SMALL_ERROR:  # or nan
                break
        if largest <= 1e-14 * steps:  # rad: rounding
            break
        if largest < SMALL_ERROR:
            points.append((math.log(half / steps), math.log(largest)))
    if len(points) < 3:
        return None
    return linear_regression(*zip(*points[-6:], strict=True)).slope


def evaluations(phases: Phases) -> tuple[float, int]:
    """Return the mean force evaluations of a step, and how many more a run has at its start."""
    count = 0
    force = PENDULUM.force()

    def counted(theta: Any) -> Any:
        nonlocal count
        count += 1
        return force(theta)

    after(phases, counted, START, 0.05, 50)
    first = count
    after(phases, counted, START, 0.05, 100)
    fifty = count - 2 * first
    return fifty / 50, first - fifty


def is_symplectic(phases: Phases) -> bool:
    """Return whether a step keeps area wherever it starts."""
    bound = partial(phases, PENDULUM.force(cmath.sin))
    starts = [(theta, omega) for theta in (-2.0, 0.0, 1.0, 3.0) for omega in (-4.0, 0.0, 3.0)]
    return all(abs(jacobian(bound, start, LARGE_H).determinant - 1) < 1e-12 for start in starts)


def is_reversible(phases: Phases) -> bool:
    """Return whether swings that turn round after 10 s come back to their start, but for rounding.

    100 steps with a dozen forces each are rounded.
    """
    force = PENDULUM.force()
    for start in ((2.0, 0.3), (0.5, 2.0), (0.3, 8.0)):
        theta, omega = after(phases, force, start, LARGE_H, 50)
        theta, omega = after(phases, force, (theta, -omega), LARGE_H, 50)
        if not math.dist((theta, -omega), start) < 1e-11:  # or nan
            return False
    return True


def linear_limit(phases: Phases) -> float:
    """Return the first z beyond which small swings grow, to 1e-9; 0: at once, inf: not found.

    The search goes upwards, as methods of high order have islands of stability beyond it.
    """
    if not is_stable(phases, NO_LIMIT_BELOW):
        return 0.0
    rungs = np.arange(int(NO_LIMIT_BELOW * RUNGS), WIDEST_Z * RUNGS) / RUNGS
    unstable_rungs = rungs[~is_stable(phases, rungs)]
    if not len(unstable_rungs):
        return math.inf
    unstable = float(unstable_rungs[0])
    stable = unstable - 1 / RUNGS
    while unstable - stable > 1e-10:
        middle = (stable + unstable) / 2
        if is_stable(phases, middle):
            stable = middle
        else:
            unstable = middle
    return stable


def is_stable(phases: Phases, z: Any) -> Any:
    """Return whether both eigenvalues of a linear step lie in the unit disc, but for rounding.

    `z` is a number or an array.  They do if det <= 1 and |trace| <= 1 + det: Jury, Theory and
    Application of the z-Transform Method (1964).
    """
    zero = 0.0 * z
    a, c = after(phases, neg, (zero + 1.0, zero), z, 1)
    b, d = after(phases, neg, (zero, zero + 1.0), z, 1)
    area = a * d - b * c
    return (area <= 1 + LINEAR_ROUNDING) & (abs(a + d) <= 1 + area + LINEAR_ROUNDING)


def examined(function: Phases, who: str) -> Measured:
    """Examine and measure a guarded function, called `who` in errors.  Raises OwnMethodError."""
    phases = on_force(function)
    try:
        _examine(phases, who)
        return measured(phases)
    except (ValueError, ArithmeticError) as error:
        raise OwnMethodError(f"{who} overflows on an ordinary swing ({error}).") from None


def _examine(phases: Phases, who: str) -> None:
    """Raise OwnMethodError unless the lab, its charts and its files can use a method."""
    path = _path(phases, START)
    if not np.isfinite(path).all():
        raise OwnMethodError(f"{who} does not stay finite for {STEPS} steps of an ordinary swing.")
    if _path(phases, path[CUT - 1])[STEPS - CUT - 1] != path[-1]:
        raise OwnMethodError(
            f"{who} gives different numbers when restarted after {CUT} of {STEPS} steps; a run "
            "may stop and resume after any step, so a step may use only theta and omega."
        )
    for kind, are_same in (("NumPy arrays", _are_same_arrays), ("complex numbers", _are_complex)):
        try:
            if not are_same(phases):
                raise OwnMethodError(f"{who} gives different numbers from those with floats")
        except OwnMethodError as error:
            why = str(error).rstrip(".")
            raise OwnMethodError(
                f"{why}; this was with {kind}, which stability needs: use only +, -, * and / on "
                "theta and omega, and theta = theta + x instead of theta += x."
            ) from None


def _path(phases: Phases, start: Phase) -> list[Phase]:
    return list(islice(phases(PENDULUM.force(), start, H), STEPS))


def _are_same_arrays(phases: Phases) -> bool:
    """Return whether arrays give the numbers that floats give, and are not changed in place."""
    theta, omega, h = (np.full(3, value) for value in (*START, H))
    arrays = [theta, omega]
    for phase in islice(phases(PENDULUM.force(np.sin), (theta, omega), cast(float, h)), STEPS):
        arrays += phase
    floats = np.ravel([START, *_path(phases, START)])
    return np.allclose(np.transpose(arrays), floats, SAME, SAME)


def _are_complex(phases: Phases) -> bool:
    """Return whether imaginary parts are the derivative."""

    def end(nudge: Any) -> Any:
        theta, omega = np.add(START, nudge).tolist()
        return np.array(after(phases, PENDULUM.force(np.sin), (theta, omega), H, STEPS))

    derivative = end(1e-100j).imag / 1e-100
    slope = (end(1e-6) - end(-1e-6)) / 2e-6
    return np.allclose(derivative, slope, 1e-4, 1e-4)
