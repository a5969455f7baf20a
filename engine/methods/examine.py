"""Check that a user's function is a method as the lab, its charts and its files need it."""

import math
from itertools import islice
from linecache import getlines
from typing import Any, cast

import numpy as np

from pendu_tui.engine.methods.measure import PENDULUM, START, Measured, after, evaluations, measured
from pendu_tui.engine.methods.method import Phases
from pendu_tui.engine.methods.own import (
    MAX_SOURCE,
    OwnMethod,
    OwnMethodError,
    guarded,
    on_force,
    own_function,
    own_method,
)
from pendu_tui.engine.models.model import Phase

H = 0.05  # s
STEPS = 80
CUT = 37  # steps; a prime, so that a method that counts to a round number of up to 40 shows it
SAME = 1e-9  # relative; rounding differs by far less, wrong numbers by far more


def load(source: str, key: str, letter: str, file: str) -> OwnMethod:
    """Return a user's method, examined and measured.  Raises OwnMethodError."""
    return own_method(source, key, letter, file, examined(source, key, file))


def examined(source: str, key: str, file: str) -> Measured:
    """Return the properties of a user's method.

    Raises OwnMethodError, whose text is a sentence for the user.
    """
    if len(source) > MAX_SOURCE:
        raise OwnMethodError(
            f"{file} is too long; use a file of at most {MAX_SOURCE:,} characters."
        )
    phases = on_force(own_function(source, key, file))
    try:
        _examine(phases, f"{file}: {key}")
        return measured(phases)
    except (ValueError, ArithmeticError) as error:
        raise OwnMethodError(f"{file}: {key} overflows on an ordinary swing ({error}).") from None


def properties(function: Phases) -> Measured:
    """Return the properties of a generator function (force, phase, h), examined.

    Raises OwnMethodError.
    """
    name = getattr(function, "__name__", "step")
    file = getattr(getattr(function, "__code__", None), "co_filename", name)
    phases = on_force(guarded(function, name, "".join(getlines(file)), file))
    try:
        _examine(phases, name)
        return measured(phases)
    except (ValueError, ArithmeticError) as error:
        raise OwnMethodError(f"{name} overflows on an ordinary swing ({error}).") from None


def _examine(phases: Phases, who: str) -> None:
    force = PENDULUM.force()
    path = _path(phases, START)
    if not all(math.isfinite(value) for phase in path for value in phase):
        raise OwnMethodError(f"{who} does not stay finite for {STEPS} steps of an ordinary swing.")
    if _path(phases, START) != path:
        raise OwnMethodError(
            f"{who} gives other numbers when it is run again; a method must give the same bits."
        )
    middle = after(phases, force, START, H, CUT)
    if after(phases, force, middle, H, STEPS - CUT) != path[-1]:
        raise OwnMethodError(
            f"{who} keeps more than theta and omega from step to step: {STEPS} steps differ from "
            f"{CUT} and {STEPS - CUT}; a run is cut anywhere, so start from theta and omega alone."
        )
    if not evaluations(phases)[0] > 0:
        raise OwnMethodError(f"{who} never evaluates the force.")
    for kind, examined in (
        ("NumPy arrays", _examine_arrays),
        ("complex numbers", _examine_complexes),
    ):
        try:
            same = examined(phases, path, who)
        except OwnMethodError as error:
            raise OwnMethodError(
                f"{str(error).rstrip('.')}; this was with {kind}, which stability needs."
            ) from None
        if not same:
            raise OwnMethodError(
                f"{who} gives other numbers for {kind} than for floats; use only +, -, * and / on "
                "theta and omega."
            )


def _path(phases: Phases, start: Phase) -> list[Phase]:
    return list(islice(phases(PENDULUM.force(), start, H), STEPS))


def _examine_arrays(phases: Phases, path: list[Phase], who: str) -> bool:
    """Return whether arrays give the numbers that floats give."""
    start = tuple(np.full(3, value) for value in START)
    h = np.full(3, H)
    arrays: list[Any] = [*start, h]
    copies = [array.copy() for array in arrays]
    for phase in islice(phases(PENDULUM.force(np.sin), start, cast(float, h)), STEPS):
        arrays += phase
        copies += [array.copy() for array in phase]
    if not all(map(np.array_equal, arrays, copies)):
        raise OwnMethodError(
            f"{who} changes an array in place; write theta = theta + x instead of theta += x."
        )
    return np.allclose([array[0] for array in arrays[3:]], np.ravel(path), rtol=SAME, atol=SAME)


def _examine_complexes(phases: Phases, path: list[Phase], who: str) -> bool:
    """Return whether real parts are as with floats, and imaginary parts the derivative."""
    force = PENDULUM.force(np.sin)
    for along in ((1.0, 0.0), (0.0, 1.0)):

        def ends(nudge: complex, along: Phase = along) -> Any:
            start = START[0] + nudge * along[0], START[1] + nudge * along[1]
            return np.array(after(phases, force, start, H, STEPS))

        displaced = ends(1e-100j)
        slope = (ends(1e-6) - ends(-1e-6)) / 2e-6
        if not np.allclose(displaced.real, path[-1], rtol=SAME, atol=SAME):
            return False
        if not np.allclose(displaced.imag / 1e-100, slope, rtol=1e-4, atol=1e-4):
            return False
    return True
