"""Many swings at once: a method's phases on arrays, in NumPy or compiled by Numba.

The last bits of Numba's sine need not be NumPy's: a picture made with Numba is the same however it
is cut and whoever computes it, but perhaps not as without Numba.
"""

from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from itertools import islice
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.methods import Method
from engine.methods.method import compilable
from engine.methods.own import OwnMethod
from engine.models import Pendulum
from engine.models.model import Phase

Floats = NDArray[np.float64]
Arrays = tuple[Floats, Floats]  # theta [rad] and omega [rad/s], a swing each


class Watched(NamedTuple):
    """What is watched of an ensemble while it swings; energies in s⁻², angles in rad."""

    start: Floats  # energies at the start
    band: Floats  # how far energies may be from there; inf: not looked at any more
    top: Floats  # how large |theta| may be; likewise
    off: Floats  # energies, less the start's, after the last step
    worst: Floats  # largest |off| so far
    width: Floats  # largest |theta| so far


Watch = Callable[[Arrays, Floats, Watched, int], Iterator[tuple[int, Arrays]]]
"""(phase, h, watched, n): take n steps.

Yields steps done and phase there after the last one, and whenever an energy is out of its band or a
swing over its top.  Changes off, worst and width; band and top may be changed.  All arrays are
one-dimensional and of one length.
"""


@cache
def plain(method: Method, model: Pendulum) -> Watch:
    """Return the loop in NumPy."""
    force = model.force(np.sin)
    energy = model.energy(np.sin)

    def watch(phase: Arrays, h: Floats, watched: Watched, n: int) -> Iterator[tuple[int, Arrays]]:
        start, band, top, off, worst, width = watched
        size = np.empty_like(off)
        bounded = np.isfinite(band).any()
        phases = islice(method.phases(force, phase, h), n)  # type: ignore[arg-type]
        for done, phase in enumerate(phases, 1):
            np.subtract(energy(phase), start, out=off)
            np.maximum(worst, np.abs(off, out=size), out=worst)
            outside = bounded and (size > band).any()
            np.maximum(width, np.abs(phase[0], out=size), out=width)
            if outside or done == n or (size > top).any():
                yield done, phase

    return watch


@cache
def compiled(method: Method, model: Pendulum) -> Watch:
    """Return the loop, compiled unless it is a user's.  Raises ImportError without Numba."""
    if isinstance(method, OwnMethod):
        return plain(method, model)
    numba: Any = import_module("numba")
    # What Python never calls compiles twice as fast without wrappers.
    inner = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)
    phases = numba.njit(compilable(method.phases))
    force = inner(model.force(np.sin))
    energy = model.energy
    look = numba.njit(_looking(inner(energy(np.sin))))

    # The loop over phases is Python's: in compiled code Numba 0.68 never frees what a generator
    # yields.  What the generator itself holds when it is given up, a few arrays, is never freed
    # (numba/numba#1278), so make few of them.
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
        """Return how many swings are over their top or out of their band."""
        outside = 0
        for i in range(theta.size):
            off[i] = energy((theta[i], omega[i])) - start[i]
            size = abs(off[i])
            wide = abs(theta[i])
            worst[i] = max(size, worst[i])
            width[i] = max(wide, width[i])
            outside += (wide > top[i]) | (size > band[i])
        return outside

    return looking
