"""Shows a method to a Judge at fixed steps of a run, whatever samples of the run are known."""

import math
from dataclasses import replace
from typing import NamedTuple

from engine.methods import Method
from engine.models.model import EnergyReference, Model, Phase
from engine.run.lockstep import Reading
from engine.run.loops import LoopsOf, advance_with_errors
from engine.run.verdict import Judge, Judgement, Look, Verdict, stride

MOST_STEPS = 20_000
"""Steps between two samples that are taken again, 20 ms at worst; after more, the sample itself is looked at."""


class Seen(NamedTuple):
    """One look at a method."""

    step: int  # of the lockstep, since the first sample
    error: float  # relative, of the energy
    peak: float  # largest size of the error at any step since the first sample
    verdict: Verdict
    news: bool  # the verdict is given with this look


class Judging:
    """Judges one method from a sample on, by its states every `stride` steps, which it computes between samples.

    So verdicts depend on the scene, the stepping and the step only: live, replayed and without a screen.
    """

    def __init__(
        self,
        method: Method,
        model: Model,
        reference: EnergyReference,
        h: float,
        parts: int,
        period: float,
        loops: LoopsOf,
        t: float = 0.0,
    ) -> None:
        """`h` [s] is the lockstep's step, of which the method takes so many `parts`; `t` [s] is where it begins."""
        self._h, self._parts, self._reference, self._t, self._model = h / parts, parts, reference, t, model
        if not (method.general and model.has_force):  # neighbours cannot be followed: it is judged by its energy alone
            judged = replace(method, symplectic=False, modified_energy=None)
        else:
            judged = method
        self._judge = Judge(judged, model, reference.scale, self._h, period)
        self._advance = loops(method, model).advance
        self._stride = stride(period, h)
        self._step = -1  # of the lockstep, since the first sample; -1: there was none
        self._phase: Phase = (0.0, 0.0)
        self._low = self._high = self._peak = 0.0  # relative energy errors since the last look; largest of all

    @property
    def judgement(self) -> Judgement:
        return self._judge.judgement

    def follow(self, step: int, reading: Reading) -> list[Seen]:
        """Take in the reading `step` steps after the first; the looks on the way to it."""
        error = reading.energy_error
        phase = self._model.phase_of(reading.theta, reading.omega, reading.extra)
        seen: list[Seen] = []
        if reading.diverged_at is not None:
            self._judge.fail(step * self._parts)
        elif self._step < 0:
            self._judge.look(0, Look(*self._model.observe(phase)[:2], error, error, error))
            self._low = self._high = error
        elif not self._is_taken_again(step, seen):
            self._low, self._high = min(self._low, reading.energy_error_low), max(self._high, reading.energy_error_high)
            if step // self._stride > self._step // self._stride:
                self._look(step, phase, error, seen)
        self._step, self._phase = step, phase
        return seen

    def _is_taken_again(self, step: int, seen: list[Seen]) -> bool:
        """Take the steps since the last reading again, and look on the way; False if none is due, or it cannot."""
        first = (self._step // self._stride + 1) * self._stride
        if first >= step or step - self._step > MOST_STEPS:
            return False
        at, phase = self._step, self._phase
        for stop in [*range(first, step, self._stride), step]:
            n = (stop - at) * self._parts
            begin = self._t, at * self._parts
            went = advance_with_errors(self._advance, self._reference, phase, self._h, n, math.inf, begin)
            if went.done < n:
                return False
            phase = went.phase
            self._low, self._high = min(self._low, went.low), max(self._high, went.high)
            if stop % self._stride == 0:
                self._look(stop, phase, went.error, seen)
            at = stop
        return True

    def _look(self, step: int, phase: Phase, error: float, seen: list[Seen]) -> None:
        known = self.judgement.verdict
        self._judge.look(step * self._parts, Look(*self._model.observe(phase)[:2], error, self._low, self._high))
        self._peak = max(self._peak, -self._low, self._high)
        self._low = self._high = error
        verdict = self.judgement.verdict
        seen.append(Seen(step, error, self._peak, verdict, verdict != known))
