"""Many swings at once: a method's phases on arrays, in NumPy or compiled by Numba.

The last bits of Numba's sine may differ from NumPy's, and with them the results; apart from that
they do not depend on how an ensemble is cut.
"""

from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from itertools import islice
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.models.model import Phase
from pendu_tui.engine.run.loops import compiler_of_parts

Floats = NDArray[np.float64]
Arrays = tuple[Floats, Floats]  # theta [rad] and omega [rad/s], a swing each


class Watched(NamedTuple):
    """The limits and extremes of each swing of an ensemble; energies in s⁻², angles in rad."""

    start: Floats  # energies at the start
    band: Floats  # largest allowed energy difference from the start; inf: no limit
    top: Floats  # largest allowed |theta|; inf: no limit
    off: Floats  # energies, less the start's, after the last step
    worst: Floats  # largest |off| so far
    width: Floats  # largest |theta| so far


Watch = Callable[[Arrays, Floats, Watched, int], Iterator[tuple[int, Arrays]]]
"""(phase, h, watched, n): take n steps.

Yields the steps done and the phase there after the last step, and whenever an energy is out of its
band or a swing over its top.  Updates off, worst and width; the caller may change band and top.
All arrays are one-dimensional and of one length.
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
            np.fmax(worst, np.abs(off, out=size), out=worst)
            outside = bounded and (size > band).any()
            np.fmax(width, np.abs(phase[0], out=size), out=width)
            if outside or done == n or (size > top).any():
                yield done, phase

    return watch


@cache
def compiled(method: Method, model: Pendulum) -> Watch:
    """Return the compiled loop, or NumPy's for a user's own method.

    Raises ImportError without Numba.
    """
    if isinstance(method, OwnMethod):
        return plain(method, model)
    numba: Any = import_module("numba")
    inner = compiler_of_parts(numba)
    phases = numba.njit(compilable(method.phases))
    force = inner(model.force(np.sin))
    look = numba.njit(_looking(inner(model.energy(np.sin))))

    # The loop over phases is Python's, because in compiled code Numba 0.68 never frees what a
    # generator yields.  It does not free the few arrays that an abandoned generator holds, either
    # (numba/numba#1278), so make few generators.
    def watch(phase: Arrays, h: Floats, watched: Watched, n: int) -> Iterator[tuple[int, Arrays]]:
        for done, (theta, omega) in enumerate(islice(phases(force, phase, h), n), 1):
            if look(theta, omega, *watched) > 0 or done == n:
                yield done, (theta, omega)

    return watch


def _looking(energy: Callable[[Phase], Any]) -> Callable[..., int]:
    """Return a function that updates the extremes, and counts the swings beyond their limits."""

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
        outside = 0
        for i in range(theta.size):
            off[i] = energy((theta[i], omega[i])) - start[i]
            size = abs(off[i])
            wide = abs(theta[i])
            worst[i] = max(worst[i], size)  # of a step without solution, nan: as before
            width[i] = max(width[i], wide)
            outside += (wide > top[i]) | (size > band[i])
        return outside

    return looking
