"""Loops that advance one method and find the extremes of its energy, in Python or compiled.

Numba compiles them to code with the same bits, about ten times as fast.  It is the optional extra
`fast`, imported at the first use: that takes half a second, and compiling a fifth of a second for
each method and model.  Nothing is cached on disk, because Numba's cache does not notice changes of
functions in other files.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from typing import Any, NamedTuple, Protocol

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.models.model import Energy, EnergyReference, Model, Phase

Advanced = tuple[int, Phase, float, float, float]
"""Steps done, phase and energy there, lowest and highest energy on the way [s⁻²]."""

Advance = Callable[[Phase, float, int, float], Advanced]
"""(phase, h, n, limit) -> Advanced."""


class Loops(Protocol):
    """One method's loops on one model, for one run."""

    def propagate(self, phase: Phase, h: float, n: int) -> Phase:
        """Return the phase after n >= 1 steps, without energies."""

    def advance(self, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        """Advance by n >= 1 steps, or to the last one whose energy is below `limit`."""


LoopsOf = Callable[[Method, Model], Loops]


def advance(
    phases: Iterator[Phase], energy: Energy, phase: Phase, n: int, limit: float
) -> Advanced:
    """Take n phases after `phase`, or up to the last one whose energy is below `limit`."""
    done = 0
    value = math.nan
    low = math.inf
    high = -math.inf
    for following in phases:
        now = energy(following)
        if not now < limit:  # catches nan, too
            break
        phase = following
        value = now
        if now < low:
            low = now
        if now > high:
            high = now
        done += 1
        if done == n:
            break
    return done, phase, value, low, high


def _advance_all(phases: Iterator[Phase], energy: Energy, n: int, limit: float) -> Advanced:
    """Do the same a tenth faster.  Raises OverflowError unless all n steps succeed."""
    low = math.inf
    high = -math.inf
    for phase in islice(phases, n):
        now = energy(phase)
        if low <= now and now <= high:
            continue
        if not now < limit:  # catches nan, too
            raise OverflowError
        if now < low:
            low = now
        if now > high:
            high = now
    return n, phase, now, low, high


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
        if phase is not self._end or h != self._h:
            self._generator = self._phases(phase, h)
            self._h = h
        self._end = None  # a generator that fails cannot go on
        try:
            advanced = _advance_all(self._generator, self._energy, n, limit)
        except OVERFLOW:
            phases = _to_overflow(self._phases(phase, h), self._energy)
            return advance(phases, self._energy, phase, n, limit)
        self._end = advanced[1]
        return advanced


class Errors(NamedTuple):
    """Like Advanced, with energy errors."""

    done: int
    phase: Phase
    energy: float  # s⁻²
    error: float  # there
    low: float  # the lowest and the highest on the way
    high: float


def advance_with_errors(
    advance: Advance,
    reference: EnergyReference,
    phase: Phase,
    h: float,
    n: int,
    limit: float,
    begin: tuple[float, int],
    watch: Callable[[Phase], object] | None = None,
) -> Errors:
    """Advance by n >= 1 steps from `begin`, a time [s] and the steps since then.

    Energies that are not conserved are compared with the true one at each step; `watch` is called
    with each phase.
    """
    if reference.true is None and watch is None:
        done, phase, energy, low, high = advance(phase, h, n, limit)
        return Errors(
            done,
            phase,
            energy,
            reference.error(energy),
            reference.error(low),
            reference.error(high),
        )
    energy = math.nan
    error = math.nan
    low = math.inf
    high = -math.inf
    for k in range(n):
        done, following, now, _, _ = advance(phase, h, 1, limit)
        if not done:
            return Errors(k, phase, energy, error, low, high)
        phase = following
        energy = now
        if watch is not None:
            watch(phase)
        error = reference.error(energy, begin[0] + (begin[1] + k + 1) * h)
        low = min(low, error)
        high = max(high, error)
    return Errors(n, phase, energy, error, low, high)


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


OVERFLOW = (ValueError, ArithmeticError)
"""What Python raises where numbers overflow: the sine of infinity is a ValueError."""


def _to_overflow(phases: Iterator[Phase], energy: Energy) -> Iterator[Phase]:
    """Yield phases until the energy overflows."""
    with suppress(*OVERFLOW):
        for phase in phases:
            energy(phase)
            yield phase


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
    take = inner(advance)

    outer = numba.njit(nogil=True)

    def propagate_phase(phase: Phase, h: float, n: int) -> Any:
        return propagate(phases(force, phase, h), phase, n)

    def advance_phase(phase: Phase, h: float, n: int, limit: float) -> Any:
        return take(phases(force, phase, h), energy, phase, n, limit)

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
