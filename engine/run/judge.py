"""Judge the methods of a run by their energy errors.

The lockstep shows each method to its judge at look points, a fixed number of steps apart, so a
verdict depends on the scene, the stepping and the step alone.  The core judges the energy error in
bins.  What is known of a method adds evidence:

- A symplectic method can neither gain nor lose energy for good.  Its orbit is regular, and so
  `bounded`, where a theorem says so or nearby trajectories separate no faster than in proportion
  to time, and `chaotic` where they separate exponentially.  A linear map is never chaotic.
- The error of any other method is exactly 0 at the start, and drifts sooner or later: it is
  `bounded` only if it would stay in its band for ten times as long.
"""

import copy
import math
from itertools import pairwise
from typing import NamedTuple, Self

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.tangent import Stretching, at_bottom
from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run import levels
from pendu_tui.engine.run.verdicts import (
    BOUNDED,
    CHAOTIC,
    FAILED,
    GROWS,
    LEAVES,
    UNDECIDED,
    Judgement,
    Progress,
    direction,
)


class LookPoint(NamedTuple):
    """A method at a step where its judge looks."""

    step: int  # own steps since judging began
    error: float  # relative, signed
    low: float  # smallest and largest error since the previous look point
    high: float
    theta: float  # rad, perhaps reduced by whole turns
    omega: float  # rad/s
    energy: float  # s⁻²


def stride(period: float, h: float, model: Model) -> int:
    """Return how many steps of h [s] lie between two look points; for `period` [s] see `Judge`."""
    if not model.turns:  # it may vibrate faster than it swings
        period = math.tau / model.fastest
    return max(1, round(period / levels.LOOKS / abs(h)))


class _Bin(NamedTuple):
    """Sums over the look points of a part of a run, and its lowest and highest error."""

    looks: int
    steps: float
    errors: float
    low: float
    high: float

    def joined(self, other: "_Bin") -> "_Bin":
        return _Bin(
            self.looks + other.looks,
            self.steps + other.steps,
            self.errors + other.errors,
            min(self.low, other.low),
            max(self.high, other.high),
        )


def _with_look(bins: list[_Bin], look: _Bin) -> list[_Bin]:
    """Return the bins of a run with one more look point, in constant memory.

    At first a bin is one look point; 64 merge pairwise.  The last may have fewer than the others.
    """
    if bins and bins[-1].looks < bins[0].looks:
        bins = [*bins[:-1], bins[-1].joined(look)]
    else:
        bins = [*bins, look]
    if len(bins) == levels.MAX_BINS and bins[-1].looks == bins[0].looks:
        pairs = zip(bins[::2], bins[1::2], strict=True)
        bins = [earlier.joined(later) for earlier, later in pairs]
    return bins


class Judge:
    """The judge of one method, from a given step onwards."""

    def __init__(
        self, h: float, period: float, method: Method, model: Model, start: LookPoint
    ) -> None:
        """`h` [s] is the method's step; `period` [s] the exact motion's, or 2 pi/w0 without one."""
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._method = method
        self._model = model
        self._start_error = start.error  # bands are relative to it
        self._last = start
        self._judged = 0  # the step of the last judgement
        self._bins: list[_Bin] = []  # replaced and never changed in place
        self._left = ""  # the word of the first judgement that it leaves
        # the band of an error that beats with the steps may leave the start and come back
        fastest_turn = min(period, math.tau / model.w0) if model.turns else math.inf
        self._may_beat = fastest_turn < levels.MIN_STEPS_A_TURN * self._h
        self._orbit: _Orbit | None = None
        if method.symplectic and method.general and not model.without_force:
            self._orbit = _Orbit(method, model, h, period)
        self.judgement = Judgement(progress=self.progress_at(0))

    def copy(self) -> Self:
        """Return another judge that continues from here."""
        other = copy.copy(self)
        other._orbit = copy.copy(self._orbit)
        return other

    def look(self, point: LookPoint) -> None:
        """Take in the next look point; one step in eight or fewer brings a new judgement."""
        if self._is_rounded(point):
            return
        if self._orbit:
            self._orbit.look(self._last, point)
        low = point.low - self._start_error
        high = point.high - self._start_error
        look = _Bin(1, (self._last.step + point.step) / 2, (low + high) / 2, low, high)
        self._bins = _with_look(self._bins, look)
        self._last = point
        self.peak = max(self.peak, -point.low, point.high)
        last_is_full = self._bins[-1].looks == self._bins[0].looks
        is_full = last_is_full and len(self._bins) >= levels.MIN_BINS
        is_due = self._swings >= levels.MIN_SWINGS and point.step >= levels.LONGER_BY * self._judged
        if is_full and is_due:
            self._judged = point.step
            self.judgement = self._judgement()
        self._add_evidence(point)

    def fail(self) -> None:
        """Note that the numbers have ended."""
        self.judgement = Judgement(FAILED)

    @property
    def _swings(self) -> float:
        return self._last.step * self._h / self._period

    def _is_rounded(self, point: LookPoint) -> bool:
        """Return whether a damped energy is mostly rounding."""
        if self._model.conserves_energy:
            return False
        true_energy = point.energy * math.exp(-point.error)  # the error is ln(E/E_true)
        least = (levels.MIN_AMPLITUDE * self._method.epsilon * self._model.w0) ** 2  # s⁻²
        return min(point.energy, true_energy) < least

    def _add_evidence(self, point: LookPoint) -> None:
        """Complete the judgement by what is known at each look point."""
        found = self.judgement
        if self._orbit:
            verdict = self._orbit.verdict(found.verdict, self.peak, self._swings)
            found = found._replace(verdict=verdict)
            if verdict == CHAOTIC:
                lyapunov = self._orbit.log / self._orbit.steps / self._h  # of the neighbour so far
                found = found._replace(lyapunov=lyapunov)
        elif not self._model.turns and point.error > levels.ESCAPED_ERROR:
            found = found._replace(verdict=GROWS)
        if found.verdict == UNDECIDED:
            found = found._replace(progress=self.progress_at(self._last.step))
        else:
            found = found._replace(progress=None, reason="")
        self.judgement = found

    def _judgement(self) -> Judgement:
        """Return the judgement of the core, or what is known better of this run."""
        # a run begins without numpy
        from pendu_tui.engine.run.core import bins_of_looks, judge_bins, measure_bins

        # how far roundings may have carried the error by now
        rounding = levels.WALK * self._method.epsilon * math.sqrt(self._last.step)
        if not self._model.conserves_energy:
            rounding = max(rounding, levels.REFERENCE_ERROR)
        bins = bins_of_looks(self._bins, self._h, rounding)
        if self._orbit:
            measured = measure_bins(bins)
            return measured._replace(verdict=self.judgement.verdict, is_evident=False)
        found = judge_bins(bins, levels.AHEAD)
        present = self._bins[-(len(self._bins) // 4) :]
        low = min(each.low for each in present)
        high = max(each.high for each in present)
        away = max(low, -high)  # how far the present band is from the start
        if found.verdict == UNDECIDED:
            found = self._kept(found, low, high)
        elif found.verdict == BOUNDED and away > max(levels.LEFT * (high - low), rounding):
            found = found._replace(verdict=direction(low), rests=True)
        elif reason := self._doubt(found.verdict, away > rounding):
            found = found._replace(verdict=UNDECIDED, reason=reason, rests=False)
        if found.verdict in LEAVES:
            self._left = self._left or found.verdict
        return found

    def _kept(self, found: Judgement, low: float, high: float) -> Judgement:
        """Return the earlier verdict with the new numbers, until the energy is back in its band."""
        before = self.judgement
        beyond = low if before.verdict == GROWS else -high
        if before.verdict in LEAVES and beyond > -levels.AWAY * (high - low):
            return found._replace(verdict=before.verdict, rests=before.rests)
        return found

    def _doubt(self, verdict: str, is_away: bool) -> str:
        """Return why a verdict of the core does not hold for this run; "" if it does."""
        is_long = self._last.step >= levels.LONG
        moves = len(self._bins) - 1
        rises = sum(a.low + a.high < b.low + b.high for a, b in pairwise(self._bins))
        is_straight = max(rises, moves - rises) >= levels.MIN_ONE_WAY * moves
        if self._may_beat and not (is_long and is_straight):
            return levels.BEATS
        if verdict in LEAVES and self._method.symplectic:
            return levels.RETURNS
        if self._left not in ("", verdict):
            return levels.TURNED
        if verdict in LEAVES:
            return ""
        if is_away:
            return levels.NEAR
        return "" if is_long else levels.SHORT

    def progress_at(self, step: int) -> Progress | None:
        """Return how far it is from a step to the first possible verdict, or else to the last one.

        None: a verdict can come any time.
        """
        swings = step * self._h / self._period
        need = levels.LONG * self._h / self._period
        if self._orbit and self._orbit.is_regular:
            need = levels.MIN_PERIODS
        elif not self._orbit and not self._may_beat and swings < levels.MIN_SWINGS:
            need = levels.MIN_SWINGS
        if swings >= need:
            return None
        return Progress(int(swings), math.ceil(need), "cycles")


class _Orbit(Stretching):
    """Evidence that the orbit of a symplectic method is regular, fenced in or chaotic."""

    def __init__(self, method: Method, model: Model, h: float, period: float) -> None:
        super().__init__(method, model, h)
        self._z = abs(h) * model.w0 * method.longest_substep
        self._swing = model.w0 * period  # rad; the longer, the nearer to upright
        self._periodic_in_omega = method.order <= 2  # with the period 2 pi/h
        self._linear = model.is_linear
        bottom = at_bottom(method, h * model.w0)
        # |trace| < 2: small swings move on ellipses
        self._stable = abs(bottom.theta_theta + bottom.omega_omega) < 2
        self._fastest = 0.0  # rad/s, of its look points

    def look(self, previous: LookPoint, point: LookPoint) -> None:
        """Take in a look point: follow a neighbour from the previous one."""
        self._fastest = max(self._fastest, abs(point.omega))
        needed = self._z > levels.REGULAR_Z and not self._linear
        if needed and self.steps < levels.LYAPUNOV_STEPS:
            self.carry((previous.theta, previous.omega), point.step - previous.step)

    @property
    def is_regular(self) -> bool:
        """Whether a theorem keeps the orbit from chaos."""
        if self._linear:
            return self._stable
        turn_a_step = self._fastest * abs(self._h)  # rad
        if not self._periodic_in_omega and turn_a_step >= math.pi:
            return False
        fenced = self._z <= levels.FENCED_Z and self._swing < levels.NEAR_TOP
        return fenced or self._z <= levels.REGULAR_Z

    def verdict(self, previous: str, peak: float, periods: float) -> str:
        """Return the verdict; `peak` is the largest |energy error| so far.

        Neighbours on regular orbits separate in proportion to time, and by about 1/k'² in the
        first swing past upright.  The growth of the orbit itself is instability, not chaos.
        """
        if self._linear and not self.is_regular:
            return GROWS
        regular = math.log(max(self.steps, 1))
        growth = math.log1p(peak) / 2  # the energy goes as the square of the orbit
        if self.log - growth > regular + self._swing / 2 + levels.CHAOTIC_SEPARATION:
            return CHAOTIC
        if previous != UNDECIDED:
            return previous
        proved = self.is_regular and periods >= levels.MIN_PERIODS
        seen = self.steps >= levels.LONG and self.log < regular + levels.REGULAR_SEPARATION
        return BOUNDED if proved or seen else UNDECIDED
