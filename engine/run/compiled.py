"""The loops of engine.run.loops compiled by Numba: the same bits, about ten times as fast.

Numba is the optional extra `fast`, imported at the first use: that takes half a second, and
compiling a fifth of a second for each method and model.  Nothing is cached on disk, because Numba's
cache does not notice changes of functions in other files.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any, NamedTuple

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.models.model import Model, Phase
from pendu_tui.engine.run import loops
from pendu_tui.engine.run.loops import Advanced, Loops, PlainLoops

COMPILED_FROM = 1_000_000  # steps of a method: they take as long as importing and compiling


@cache
def available() -> bool:
    """Return whether Numba is installed, without importing it."""
    return find_spec("numba") is not None


class CompiledLoops(NamedTuple):
    """Loops in machine code, which several runs may share."""

    propagate: Callable[[Phase, float, int], Phase]
    advance: Callable[[Phase, float, int, float], Advanced]


class Series(NamedTuple):
    """What a series takes of the model."""

    w0_squared: float


def compiled(method: Method, model: Model) -> Loops:
    """Return the method's loops on this model, compiled; its parameters become constants.

    They release the interpreter's lock while they run.  The plain loops are returned where Numba's
    sine is not Python's, for a user's own method or one that is not general, and for models without
    a force.  Raises ImportError without Numba.
    """
    return _compiled(method, model) or PlainLoops(method, model)


@cache
def _compiled(method: Method, model: Model) -> CompiledLoops | None:
    from pendu_tui.engine.methods.own import OwnMethod  # slow to import

    numba: Any = import_module("numba")
    is_series = not method.force_evaluations
    general = method.general and not model.without_force and not isinstance(method, OwnMethod)
    if not (general or is_series) or not _same_sine(numba):
        return None
    # functions that Python never calls compile twice as fast without wrappers
    inner = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)
    phases = inner(compilable(method.phases))
    force = Series(model.w0_squared) if is_series else inner(model.force())
    energy = inner(model.energy())
    propagate = inner(_propagate)
    advance = inner(loops.advance)

    outer = numba.njit(nogil=True)

    def propagate_phase(phase: Phase, h: float, n: int) -> Any:
        return propagate(phases(force, phase, h), phase, n)

    def advance_phase(phase: Phase, h: float, n: int, limit: float) -> Any:
        return advance(phases(force, phase, h), energy, phase, n, limit)

    return CompiledLoops(outer(propagate_phase), outer(advance_phase))


def _propagate(phases: Iterator[Phase], phase: Phase, n: int) -> Phase:
    for following in phases:
        phase = following
        n -= 1
        if n == 0:
            break
    return phase


class TieredLoops:
    """Plain loops that are compiled after enough steps of a run, if Numba is installed."""

    def __init__(
        self,
        method: Method,
        model: Model,
        fast: Callable[[Method, Model], Loops | None] = compiled,
        expected_steps: int = 0,
    ) -> None:
        """`fast` returns the compiled loops, or None while there are none."""
        self._method = method
        self._model = model
        self._fast = fast
        self._expected_steps = expected_steps
        self._plain = PlainLoops(method, model)
        self._compiled: Loops | None = None
        self._steps = 0

    def _loops(self, n: int) -> Loops:
        self._steps += n
        if max(self._steps, self._expected_steps) < COMPILED_FROM or not available():
            return self._plain
        self._compiled = self._compiled or self._fast(self._method, self._model)
        return self._compiled or self._plain

    def propagate(self, phase: Phase, h: float, n: int) -> Phase:
        return self._loops(n).propagate(phase, h, n)

    def advance(self, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        return self._loops(n).advance(phase, h, n, limit)


@cache
def _same_sine(numba: Any) -> bool:
    """Return whether compiled code has the bits of Python's sine, which depends on libraries."""
    sine = numba.njit(lambda x: math.sin(x))
    return all(sine(x) == math.sin(x) for x in (0.001 * n for n in range(20_000)))
