"""Check that a user's function is a method as the lab, its charts and its files need it."""

from itertools import islice
from typing import Any, cast

import numpy as np

from pendu_tui.engine.methods.measure import PENDULUM, START, Measured, after, evaluations, measured
from pendu_tui.engine.methods.method import Phases
from pendu_tui.engine.methods.own import OwnMethodError, guarded, on_force, own_function
from pendu_tui.engine.models.model import Phase

H = 0.05  # s
STEPS = 80
CUT = 37  # steps; a prime, so that a method that counts to a round number of up to 40 shows it
SAME = 1e-9  # relative; rounding differs by far less, wrong numbers by far more


def measured_text(source: str, key: str, file: str) -> Measured:
    """Examine and measure the function `key` of a text.  Raises OwnMethodError."""
    return _examined(own_function(source, key, file), f"{file}: {key}")


def measured_function(function: Phases) -> Measured:
    """Examine and measure a generator function (force, phase, h).  Raises OwnMethodError."""
    name = getattr(function, "__name__", "step")
    file = getattr(getattr(function, "__code__", None), "co_filename", name)
    return _examined(guarded(function, file), name)


def _examined(function: Phases, who: str) -> Measured:
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
    if _path(phases, START) != path:
        raise OwnMethodError(
            f"{who} gives other numbers when it is run again; a method must give the same bits."
        )
    if _path(phases, path[CUT - 1])[STEPS - CUT - 1] != path[-1]:
        raise OwnMethodError(
            f"{who} keeps more than theta and omega from step to step: {STEPS} steps differ from "
            f"{CUT} and {STEPS - CUT}; a run is cut anywhere, so start from theta and omega alone."
        )
    if not evaluations(phases)[0] > 0:
        raise OwnMethodError(f"{who} never evaluates the force.")
    for kind, are_same in (("NumPy arrays", _are_same_arrays), ("complex numbers", _are_complex)):
        try:
            if not are_same(phases, path):
                raise OwnMethodError(f"{who} gives other numbers than for floats")
        except OwnMethodError as error:
            why = str(error).rstrip(".")
            raise OwnMethodError(
                f"{why}; this was with {kind}, which stability needs: use only +, -, * and / on "
                "theta and omega, and theta = theta + x instead of theta += x."
            ) from None


def _path(phases: Phases, start: Phase) -> list[Phase]:
    return list(islice(phases(PENDULUM.force(), start, H), STEPS))


def _are_same_arrays(phases: Phases, path: list[Phase]) -> bool:
    """Return whether arrays give the numbers that floats give, and are not changed in place."""
    theta, omega, h = (np.full(3, value) for value in (*START, H))
    arrays = [theta, omega]
    copies = [theta.copy(), omega.copy()]
    for phase in islice(phases(PENDULUM.force(np.sin), (theta, omega), cast(float, h)), STEPS):
        arrays += phase
        copies += [array.copy() for array in phase]
    floats = np.ravel([START, *path])
    return np.array_equal(arrays, copies) and np.allclose(
        [array[0] for array in arrays], floats, SAME, SAME
    )


def _are_complex(phases: Phases, path: list[Phase]) -> bool:
    """Return whether real parts are as with floats, and imaginary parts the derivative."""

    def end(nudge: Any) -> Any:
        theta, omega = (START + nudge).tolist()
        return np.array(after(phases, PENDULUM.force(np.sin), (theta, omega), H, STEPS))

    for along in np.eye(2):
        displaced = end(1e-100j * along)
        slope = (end(1e-6 * along) - end(-1e-6 * along)) / 2e-6
        if not np.allclose(displaced.real, path[-1], SAME, SAME):
            return False
        if not np.allclose(displaced.imag / 1e-100, slope, 1e-4, 1e-4):
            return False
    return True
