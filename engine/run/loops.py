"""Loops that advance one method and find the extremes of its energy, in Python or compiled.

Numba compiles them to code with the same bits, about ten times as fast.  It is the optional extra
`fast`, imported at the first use: that takes half a second, and compiling a fifth of a second for
each method and model.  Nothing is cached on disk, because Numba's cache does not notice changes of
functions in other files.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, partial
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from typing import Any, NamedTuple, Protocol

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.models.model import Energy, Model, Phase

OVERFLOW = (ValueError, ArithmeticError)
"""What Python raises where numbers overflow: the sine of infinity is a ValueError."""


class Advanced(NamedTuple):
    """Where some steps have led."""

    done: int  # steps
    phase: Phase
    energy: float  # s⁻², there; nan if no step was taken
    low: float  # s⁻², the lowest and the highest on the way
    high: float


Advance = Callable[[Phase, float, int, float], Advanced]
"""(phase, h, n, limit) -> Advanced."""

Take = Callable[[Phase, float, int, float], tuple[Phase, float, float, float]]
"""(phase, h, n, limit) -> what `take` returns."""


class Loops(Protocol):
    """One method's loops on one model, for one run."""

    def propagate(self, phase: Phase, h: float, n: int) -> Phase:
        """Return the phase after n >= 1 steps, without energies."""

    def advance(self, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        """Advance by n >= 1 steps, or to the last one whose energy is below `limit`."""


LoopsOf = Callable[[Method, Model], Loops]


def take(
    phases: Iterator[Phase], energy: Energy, n: int, limit: float
) -> tuple[Phase, float, float, float]:
    """Take n >= 1 phases; return the last, its energy, the lowest and the highest.

    Raises OverflowError unless each energy is below `limit`.
    """
    low = math.inf
    high = -math.inf
    for _, phase in zip(range(n), phases):  # noqa: B905  Numba lacks it
        now = energy(phase)
        if low <= now and now <= high:
            continue
        if not now < limit:  # catches nan, too
            raise OverflowError
        if now < low:
            low = now
        if now > high:
            high = now
    return phase, now, low, high


def advance(take: Take, phase: Phase, h: float, n: int, limit: float) -> Advanced:
    """Advance by n steps, or by halves of them to the last one that succeeds."""
    with suppress(*OVERFLOW):
        return Advanced(n, *take(phase, h, n, limit))
    if n == 1:
        return Advanced(0, phase, math.nan, math.inf, -math.inf)
    half = n // 2
    first = advance(take, phase, h, half, limit)
    if first.done < half:
        return first
    second = advance(take, first.phase, h, n - half, limit)
    if not second.done:
        return first
    low = min(first.low, second.low)
    high = max(first.high, second.high)
    return Advanced(half + second.done, second.phase, second.energy, low, high)


class PlainLoops:
    """The loops in Python.  A call that continues the previous one continues its generator."""

    def __init__(self, method: Method, model: Model) -> None:
        self._phases = method.on(model)
        self._energy = model.energy()
        self._end: Phase | None = None
        self._h = 0.0
        self._generator: Iterator[Phase] = iter(())

    def propagate(self, phase: Phase, h: float, n: int) -> Phase:
        return next(islice(self._phases(phase, h), n - 1, None))

    def advance(self, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        return advance(self._take, phase, h, n, limit)

    def _take(
        self, phase: Phase, h: float, n: int, limit: float
    ) -> tuple[Phase, float, float, float]:
        if phase is not self._end or h != self._h:
            self._generator = self._phases(phase, h)
            self._h = h
        self._end = None  # a generator that fails cannot go on
        taken = take(self._generator, self._energy, n, limit)
        self._end = taken[0]
        return taken


def count_evaluations(method: Method, model: Model, phase: Phase, h: float, n: int) -> int:
    """Count the force evaluations of n >= 1 steps, or those of `Model.counted_parts`."""
    count = 0

    def counted(function: Callable[..., Any]) -> Callable[..., Any]:
        def counting(*arguments: Any) -> Any:
            nonlocal count
            count += 1
            return function(*arguments)

        return counting

    takes, phases = method.phases_for(model)
    taken = getattr(model, takes)()
    if takes == "parts":
        replaced = {name: counted(getattr(taken, name)) for name in model.counted_parts}
        taken = taken._replace(**replaced)
    else:
        taken = counted(taken)
    next(islice(phases(taken, phase, h), n - 1, None))
    return count


COMPILED_FROM = 1_000_000  # steps of a method: they take as long as importing and compiling


@cache
def available() -> bool:
    """Return whether Numba is installed, without importing it."""
    return find_spec("numba") is not None


class CompiledLoops(NamedTuple):
    """Loops in machine code, which several runs may share."""

    propagate: Callable[[Phase, float, int], Phase]
    advance: Advance


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
    inner = compiler_of_parts(numba)
    phases = inner(compilable(method.phases))
    force = Series(model.w0_squared) if is_series else inner(model.force())
    energy = inner(model.energy())
    last = inner(_last)
    taken = inner(take)

    outer = numba.njit(nogil=True)

    def propagate_phase(phase: Phase, h: float, n: int) -> Any:
        return last(phases(force, phase, h), n)

    def take_phases(phase: Phase, h: float, n: int, limit: float) -> Any:
        return taken(phases(force, phase, h), energy, n, limit)

    return CompiledLoops(outer(propagate_phase), partial(advance, outer(take_phases)))


def compiler_of_parts(numba: Any) -> Any:
    """Return a compiler of functions that Python never calls, which takes half the time."""
    return numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)


def _last(phases: Iterator[Phase], n: int) -> Phase:
    for _, phase in zip(range(n), phases):  # noqa: B007, B905
        pass
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
