"""Many swings at once: a method's phases on arrays, in NumPy or compiled by Numba from the same generator.

The last bits of Numba's sine need not be NumPy's, so a picture made with it is the same on one machine however it is
cut and whoever computes it, but perhaps not the same as without Numba.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from itertools import islice
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.methods import Method
from engine.methods.method import compilable
from engine.models import Pendulum
from engine.models.model import Energy, Force, Phase

Floats = NDArray[np.float64]
Arrays = tuple[Floats, Floats]  # theta [rad] and omega [rad/s], a swing each


class Watched(NamedTuple):
    """What is watched of an ensemble while it swings; energies in s⁻², angles in rad."""

    start: Floats  # energies at the start
    band: (
        Floats  # how far energies may be from there; inf for swings that are not looked at any more
    )
    top: Floats  # how large |theta| may be; likewise
    off: Floats  # energies, less the start's, after the last step
    worst: Floats  # largest |off| so far
    width: Floats  # largest |theta| so far


Watch = Callable[[Arrays, Floats, Watched, int], Iterator[tuple[int, Arrays]]]
"""(phase, h, watched, n): take n steps, and yield steps done and phase there after the last one, and whenever an energy
is out of its band or a swing over its top.  Changes off, worst and width; band and top may be changed.  All arrays are
one-dimensional and of one length."""


def sharing(w0_squared: float) -> tuple[Force, Energy]:
    """The pendulum's force and energy on arrays, which share one sine where both are asked for the same angles.

    It is that of theta/2: sin theta = 2 sin(theta/2) cos(theta/2), with the cosine as a root of 1 - sin²(theta/2).  Its
    error is some epsilon / (pi - |theta|); right for |theta| < 3 pi.  They remember angles: make a pair for each run.
    """
    known = sine = squared = np.empty(0)  # angles, the sine of their halves, and its square

    def look(theta: Floats) -> None:
        nonlocal known, sine, squared
        if theta is not known:
            known, sine = theta, np.sin(theta * 0.5)
            squared = sine * sine

    def force(theta: Any) -> Any:
        look(theta)
        found = np.copysign(np.sqrt(1 - squared), math.pi - np.abs(theta))
        found *= sine
        found *= -2 * w0_squared
        return found

    def energy(phase: Phase) -> Any:
        look(phase[0])
        found = phase[1] * phase[1]
        found *= 0.5
        found += 2 * w0_squared * squared
        return found

    return force, energy


@cache
def plain(method: Method, model: Pendulum) -> Watch:
    """The loop in NumPy."""
    phases, force, energy = method.phases, model.force(np.sin), model.energy(np.sin)

    def watch(phase: Arrays, h: Floats, watched: Watched, n: int) -> Iterator[tuple[int, Arrays]]:
        shares = method.force_evaluations == 1  # the force at the same angles as the energy
        pull, value = sharing(model.w0_squared) if shares else (force, energy)
        start, band, top, off, worst, width = watched
        size, bounded = np.empty_like(off), np.isfinite(band).any()
        for done, phase in enumerate(islice(phases(pull, phase, h), n), 1):  # type: ignore[arg-type] # noqa: B020
            np.subtract(value(phase), start, out=off)
            np.maximum(worst, np.abs(off, out=size), out=worst)
            outside = bounded and (size > band).any()
            np.maximum(width, np.abs(phase[0], out=size), out=width)
            if outside or done == n or (size > top).any():
                yield done, phase

    return watch


@cache
def compiled(method: Method, model: Pendulum) -> Watch:
    """The loop with the steps and what is watched compiled, which takes a second.  Raises ImportError without Numba."""
    numba: Any = import_module("numba")
    inner = numba.njit(
        no_cpython_wrapper=True, no_cfunc_wrapper=True
    )  # never called by Python: compiles twice as fast
    phases = numba.njit(compilable(method.phases))
    force, energy = inner(model.force(np.sin)), model.energy
    look = numba.njit(_looking(inner(energy(np.sin))))

    # The loop over phases is Python's: in compiled code Numba 0.68 never frees what a generator yields.  What the
    # generator itself holds when it is given up, a few arrays, is never freed (numba/numba#1278), so make few of them.
    def watch(phase: Arrays, h: Floats, watched: Watched, n: int) -> Iterator[tuple[int, Arrays]]:
        for done, (theta, omega) in enumerate(islice(phases(force, phase, h), n), 1):
            if look(theta, omega, *watched) > 0 or done == n:
                yield done, (theta, omega)

    return watch


def _looking(energy: Callable[[Phase], Any]) -> Callable[..., int]:
    def looking(
        theta: Floats,
        omega: Floats,
        start: Floats,
        band: Floats,
        top: Floats,
        off: Floats,
        worst: Floats,
        width: Floats,
    ) -> int:
        """How many swings are over their top or out of their band."""
        outside = 0
        for i in range(theta.size):
            off[i] = energy((theta[i], omega[i])) - start[i]
            size, wide = abs(off[i]), abs(theta[i])
            worst[i] = max(size, worst[i])
            width[i] = max(wide, width[i])
            outside += (wide > top[i]) | (size > band[i])
        return outside

    return looking
