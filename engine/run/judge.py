"""Judges: a verdict on energies, from whatever evidence there is, and the milestones of a run.

The energies of a method arrive while it runs, at look points a fixed number of steps apart, so the
verdict is a function of scene, stepping and step alone.

- A symplectic method can neither gain nor lose for good: its orbit is regular and `bounded`, or
  chaotic.  It is `bounded` where a theorem keeps the orbit regular, or where neighbouring starts
  have separated no faster than in proportion to time; `chaotic` where they separate exponentially,
  and it `wanders` if no invariant curve holds it, either.  A linear map is never chaotic.
- Any other method is judged by the bands of its energy error: whether they have left the start,
  whether they have come to rest, and what line they follow.
"""

import copy
import math
from collections.abc import Sequence
from itertools import permutations
from typing import Any, Self

from engine.methods import Cast, Method
from engine.models.model import Model
from engine.run import judgement as limits
from engine.run.bands import MAX_BINS, Bands, Bin, hull, line, one_way, typical_width
from engine.run.judgement import (
    Judgement,
    LookPoint,
    Milestone,
    MilestoneKind,
    Progress,
    Verdict,
)
from engine.run.tangent import Stretching, at_bottom


def stride(period: float, h: float) -> int:
    """Return how many steps of h [s] lie between two look points.

    `period` [s] is the exact motion's, or 2 pi/w0 if it has none.
    """
    return max(1, round(period / limits.LOOKS / abs(h)))


class Judge:
    """The judge of one method from a start on."""

    def __init__(self, h: float, period: float, method: Method, model: Model) -> None:
        """`h` [s] is the method's step, `period` [s] that of the exact motion or 2 pi/w0."""
        self.judgement = Judgement()
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._last: LookPoint | None = None
        self._start = 0.0  # the error there
        self._width = max(limits.MIN_BIN_STEPS, round(period / self._h))  # steps of a bin, at first
        self._energy = Bands(self._width)
        self._relative = model.energy_error.conserved  # and not ln(E/E_true)
        self._epsilon = method.epsilon
        self._least = (limits.ABOVE * method.epsilon * model.w0) ** 2  # s⁻², with friction
        fastest = min(period, math.tau / model.w0) if model.turns else math.inf
        self._returns = method.symplectic or fastest < limits.MIN_STEPS_A_TURN * self._h
        self._escapes = not model.turns  # nothing brings an orbit back
        self._orbit: _Orbit | None = None
        if method.symplectic and method.general and not model.without_force:
            self._orbit = _Orbit(method, model, h, period)

    def copy(self) -> Self:
        """Return another judge that goes on from here."""
        other = copy.copy(self)
        other._energy = copy.copy(self._energy)
        other._orbit = copy.copy(self._orbit)
        return other

    @staticmethod
    def read(times: Any, energies: Any, failed: bool = False, absolute: bool = True) -> Judgement:
        """Judge a whole record: arrays of finite energies at increasing times, in any units.

        `failed`: nan or inf came after the last of them.  The zero of energy means something if it
        is `absolute`, so that an energy can be lost or multiplied.
        """
        from engine.run.energies import judged

        return Judgement("failed") if failed else judged(times, energies, absolute)

    def look(self, point: LookPoint) -> None:
        """Take in the next look point."""
        if self._last is None:
            self._last = point
            self._start = point.error
            return
        if not self._relative:
            true = point.energy * math.exp(-point.error)
            if min(point.energy, true) < self._least:
                return  # hardly above what rounding leaves
        if self._orbit:
            self._orbit.look(self._last, point)
        self._last = point
        self.peak = max(self.peak, -point.low, point.high)
        low, high, now = (error - self._start for error in (point.low, point.high, point.error))
        full = self._energy.add(point.step, low, high, now)
        if full and len(self._energy.bins) >= limits.MIN_BINS:
            self._judge()
        elif self.judgement.verdict == "too early":
            progress = self._progress()
            self.judgement = self.judgement._replace(periods=self._periods, progress=progress)
        if self._escapes and point.error > limits.GONE:
            self.judgement = self.judgement._replace(verdict="grows", progress=None)

    def fail(self, steps: int) -> None:
        """Note that the numbers have ended, so many steps after the first look point."""
        self.judgement = Judgement("failed", periods=steps * self._h / self._period)

    @property
    def _steps(self) -> int:
        return self._last.step if self._last else 0

    @property
    def _periods(self) -> float:
        return self._steps * self._h / self._period

    @property
    def _many(self) -> int:
        """The steps after which bands that rest, or that do not, can be told apart."""
        return max(MAX_BINS * self._width, limits.LONG)

    @property
    def _floor(self) -> float:
        """How far roundings may have carried the error by now."""
        walk = limits.WALK * self._epsilon * math.sqrt(self._steps)
        return walk if self._relative else max(walk, limits.REFERENCE)

    def _judge(self) -> None:
        orbit = self._orbit
        known = self.judgement.verdict
        periods = self._periods
        verdict = orbit.verdict(known, self.peak, periods) if orbit else self._by_bands(known)
        judgement = self._trend(verdict)._replace(verdict=verdict, periods=periods)
        if verdict == "too early":
            judgement = judgement._replace(progress=self._progress())
        elif orbit and orbit.steps and verdict in ("chaotic", "wanders"):
            judgement = judgement._replace(lyapunov=orbit.log / orbit.steps / self._h)
        self.judgement = judgement

    def _progress(self) -> Progress | None:
        """How far it is to the first verdict, or then to the last; None if it can come any time."""
        steps_a_period = self._period / self._h
        if self._orbit and self._orbit.is_regular:
            need: float = limits.MIN_PERIODS
        elif self._orbit:
            need = limits.LONG / steps_a_period
        elif len(self._energy.bins) < limits.MIN_BINS:
            need = limits.MIN_BINS * self._width / steps_a_period
        else:
            need = self._many / steps_a_period
        if self._periods >= need:
            return None
        return Progress(int(self._periods), math.ceil(need), "swings")

    def _trend(self, verdict: Verdict) -> Judgement:
        """Return a judgement with the recent slope, if there is evidence for one.

        Where the logarithm of the energy follows a line better than the energy, the slope is the
        energy times its logarithm's growth rate.
        """
        moves = verdict in ("grows", "loses")
        if not moves and (self._orbit or verdict != "too early"):
            return Judgement()
        # growth that has slowed down has no slope before 32 bins show that it is caught
        bins = self._energy.bins
        recent = self._energy.recent(0.5) if len(bins) >= MAX_BINS / 2 else bins
        folded = [Bin(step, self._fold(low), self._fold(high)) for step, low, high in recent]
        trend = line(recent)
        logarithmic = line(folded)
        size = 1.0
        if folded[-1].middle > 0 and logarithmic.sigmas > trend.sigmas:
            trend = logarithmic
            size = math.exp(folded[-1].middle)
        certain = trend.sigmas > limits.SIGMAS
        if moves:  # evidence of its own
            way = 1 if verdict == "grows" else -1
            certain = way * trend.slope > limits.SIGMAS * trend.uncertainty
        shift = abs(trend.slope) * (recent[-1].step - recent[0].step)
        slope = trend.slope / self._h * size
        uncertainty = trend.uncertainty / self._h * size
        if not (certain and shift > self._floor and math.isfinite(slope + uncertainty)):
            return Judgement()
        growth = trend.slope / self._h if size > 2 else None  # beyond E0
        return Judgement(slope=slope, uncertainty=uncertainty, growth=growth)

    def _fold(self, error: float) -> float:
        """Return ln(E/E0) of an error where energy was gained; small ones hardly change."""
        return math.log1p(error) if self._relative and error > 0 else error

    def _by_bands(self, known: Verdict) -> Verdict:
        low, high = hull(self._energy.recent(0.25))
        gap = max(low, -high)  # from the start; below 0 inside
        if self._relative and high + self._start < limits.AT_REST:
            return "loses"
        if settled := self._settled(known, gap, high - low):
            return settled
        # a band that is centred elsewhere than on the start has not come back
        away = gap > -limits.BACK * (high - low)
        if known in ("caught", "wanders") or (known in ("grows", "loses") and away):
            return known
        if self._leaves(gap, self._fold(low), self._fold(high)):
            return "grows" if low > 0 else "loses"
        flat = gap < self._floor and self._is_flat
        return (
            "bounded" if self._steps >= self._many and (known == "bounded" or flat) else "too early"
        )

    def _leaves(self, gap: float, low: float, high: float) -> bool:
        """Return whether this band is half its width away from the start, in the logarithm."""
        if gap < self._floor or max(low, -high) < limits.AWAY * (high - low):
            return False
        bins = self._energy.bins
        straight = len(bins) >= limits.STRAIGHT_BINS and one_way(bins) >= limits.ONE_WAY
        return not self._returns or (gap >= 1 and straight)

    def _settled(self, known: Verdict, gap: float, width: float) -> Verdict | None:
        """Return `caught` if the second half lies in a band elsewhere, `wanders` if in none."""
        half = self._energy.recent(0.5)
        early = known in ("grows", "loses") and len(half) >= MAX_BINS / 4
        if not (early or self._steps >= self._many) or line(half).sigmas > limits.STEADY:
            return None
        low, high = hull(half)
        bands = (high - low) / max(typical_width(half), self._floor)
        left = known not in ("too early", "bounded") or gap > max(limits.AWAY * width, self._floor)
        if left and bands < limits.ONE_BAND:
            return "caught"
        longer = self._steps >= max(self._many, 4 * limits.LONG)
        if longer and bands > limits.NO_BAND and one_way(half) < limits.NO_WAY:
            return "wanders"
        return None

    @property
    def _is_flat(self) -> bool:
        """Whether the error stays in its band for HORIZON periods by its slope."""
        trend = line(self._energy.bins)
        reach = (abs(trend.slope) + limits.SIGMAS * trend.uncertainty) * self._steps
        width = max(typical_width(self._energy.bins), self._floor)
        return reach < width / 2 * min(1, self._periods / limits.HORIZON)


class _Orbit(Stretching):
    """What shows the orbit of a symplectic method to be regular, fenced in or chaotic."""

    def __init__(self, method: Method, model: Model, h: float, period: float) -> None:
        super().__init__(method, model, h)
        self._z = abs(h) * model.w0 * method.longest_substep
        self._far = model.w0 * period
        self._low_order = method.order <= 2
        self._linear = not model.turns
        bottom = at_bottom(method, h * model.w0)
        self._stable = abs(bottom.theta_theta + bottom.omega_omega) < 2  # small swings, on ellipses
        self._slowest = math.inf  # rad/s
        self._fastest = -math.inf

    def look(self, before: LookPoint, point: LookPoint) -> None:
        """Take in a look point."""
        self._slowest = min(self._slowest, point.omega)
        self._fastest = max(self._fastest, point.omega)
        needed = self._z > limits.QUIET and not self._linear
        if needed and self.steps < limits.LYAPUNOV_STEPS:
            self.carry((before.theta, before.omega), point.step - before.step)

    @property
    def is_regular(self) -> bool:
        """Whether a theorem keeps the orbit from chaos."""
        if self._linear:
            return self._stable
        fastest = max(-self._slowest, self._fastest) * abs(self._h)
        if not self._low_order and fastest >= math.pi:
            return False  # only the map of order 1 and 2 is periodic in h·omega
        fenced = self._z <= limits.FENCED and self._far < limits.NEAR_TOP
        return fenced or self._z <= limits.QUIET

    def verdict(self, known: Verdict, peak: float, periods: float) -> Verdict:
        """Return the verdict after another; `peak` is the largest |energy error| so far.

        Neighbours of regular orbits separate in proportion to time, and by 1/k'² or so in the first
        swing past upright; what the orbit itself grows by is instability, not chaos.
        """
        if self._linear and not self.is_regular:
            return "grows"
        regular = math.log(max(self.steps, 1))
        growth = math.log1p(peak) / 2  # the energy goes as the square of the orbit
        if self.log - growth > regular + self._far / 2 + limits.APART:
            # beyond 2 pi of h·omega there is no fence
            free = (self._fastest - self._slowest) * abs(self._h) > math.tau
            return "wanders" if free else "chaotic"
        if known != "too early":
            return known
        proved = self.is_regular and periods >= limits.MIN_PERIODS
        seen = self.steps >= limits.LONG and self.log < regular + limits.TOGETHER
        return "bounded" if proved or seen else "too early"


class Judges:
    """A judge for each method since the last change of the stepping, and the run's milestones.

    Errors cross where the largest error so far of a method that gains or loses energy passes that
    of a bounded one: for good, as it does not with other pairs.
    """

    def __init__(self, cast: Cast, model: Model, period: float) -> None:
        """`period` [s] is the exact motion's, or 2 pi/w0 if it has none."""
        self.milestones: list[Milestone] = []
        self._cast = cast
        self._model = model
        self._period = period
        self._judges: list[Judge] = []
        # pairs of a method that leaves and a bounded one whose error is the larger
        self._below: frozenset[tuple[int, int]] = frozenset()

    @property
    def judgements(self) -> list[Judgement]:
        """The verdicts since the last change of the stepping, in the order of the cast."""
        return [judge.judgement for judge in self._judges]

    def copy(self) -> Self:
        """Return other judges that go on from here."""
        other = copy.copy(self)
        other.milestones = self.milestones.copy()
        other._judges = [judge.copy() for judge in self._judges]
        return other

    def restart(self, steps: Sequence[float], points: Sequence[LookPoint | None]) -> None:
        """Judge anew from these look points on, each method with its own step size [s]."""
        self._below = frozenset()
        self._judges = [
            Judge(h=h, period=self._period, method=method, model=self._model)
            for method, h in zip(self._cast, steps, strict=True)
        ]
        for judge, point in zip(self._judges, points, strict=True):
            if point is None:
                judge.fail(0)
            else:
                judge.look(point)

    def look(self, step: int, t: float, points: Sequence[LookPoint | None]) -> None:
        """Show each judge its method at a step of the lockstep; None: its numbers have ended."""
        for index, (judge, point) in enumerate(zip(self._judges, points, strict=True)):
            if point is None:
                continue
            before = judge.judgement.verdict
            judge.look(point)
            now = judge.judgement
            if now.verdict != before:
                verdict = Milestone("verdict", self._cast[index], step, t, point.error, now.verdict)
                self.milestones.append(verdict._replace(trend=now.slope, lyapunov=now.lyapunov))
        for (index, leaving), (other, bounded) in permutations(enumerate(self._judges), 2):
            leaves = leaving.judgement.verdict in ("grows", "loses")
            stays = bounded.judgement.verdict == "bounded" and bounded.peak > limits.ROUNDING
            if not (leaves and stays):
                continue
            if leaving.peak <= bounded.peak:
                self._below |= {(index, other)}
            elif (index, other) in self._below and (point := points[index]):
                self._below -= {(index, other)}
                crossing = Milestone("errors cross", self._cast[index], step, t, point.error)
                self.milestones.append(crossing._replace(other=self._cast[other]))

    def note(self, kind: MilestoneKind, index: int, step: int, t: float, error: float) -> None:
        """Note what happens to a method once in a run."""
        self.milestones.append(Milestone(kind, self._cast[index], step, t, error))

    def has(self, kind: MilestoneKind, index: int) -> bool:
        """Return whether this has happened to a method."""
        method = self._cast[index]
        return any((each.kind, each.method) == (kind, method) for each in self.milestones)

    def fail(self, index: int, steps: int) -> None:
        """Note that a method's numbers have ended, so many of its steps after the restart."""
        self._judges[index].fail(steps)
