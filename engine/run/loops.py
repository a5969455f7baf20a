"""Loops that advance one method and find the extremes of its energy."""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import islice
from typing import Any, NamedTuple, Protocol

from pendu_tui.engine.methods import Method
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

    takes_parts = method.phases_from_parts(model)
    if takes_parts is not None:
        parts = model.parts()
        replaced = {name: counted(getattr(parts, name)) for name in model.counted_parts}
        phases = takes_parts(parts._replace(**replaced), phase, h)
    elif not model.second_order and method.on_rates is not None:
        phases = method.on_rates(counted(model.rates()), phase, h)
    else:
        phases = method.phases(counted(model.force()), phase, h)
    next(islice(phases, n - 1, None))
    return count


OVERFLOW = (ValueError, ArithmeticError)
"""What Python raises where numbers overflow: the sine of infinity is a ValueError."""


def _to_overflow(phases: Iterator[Phase], energy: Energy) -> Iterator[Phase]:
    """Yield phases until the energy overflows."""
    with suppress(*OVERFLOW):
        for phase in phases:
            energy(phase)
            yield phase
