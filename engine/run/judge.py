"""Judge the methods of a run by their energy errors, and note the run's milestones.

The lockstep shows each method to its judge at look points, a fixed number of steps apart, so a
verdict depends on the scene, the stepping and the step alone.

- A symplectic method can neither gain nor lose energy for good.  Its orbit is regular, and so
  `bounded`, where a theorem says so or neighbouring starts separate no faster than in proportion
  to time.  Where they separate exponentially it is `chaotic`, or `wanders` if no invariant curve
  fences it in.  A linear map is never chaotic.
- Any other method is judged by the bands of its energy error: whether they have left the start
  (`grows`, `loses`), have come to rest elsewhere (`caught`) or nowhere (`wanders`), or stay where
  they began without a trend (`bounded`).
"""

import copy
import math
from collections.abc import Sequence
from itertools import permutations
from typing import Self

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run import judgement as limits
from pendu_tui.engine.run.bands import (
    MAX_BINS,
    Bands,
    Bin,
    fit_line,
    hull,
    one_way_share,
    typical_width,
)
from pendu_tui.engine.run.judgement import LookPoint, Milestone, MilestoneKind
from pendu_tui.engine.run.tangent import Stretching, at_bottom
from pendu_tui.engine.run.verdicts import Judgement, Progress, in_todays_words


def stride(period: float, h: float) -> int:
    """Return how many steps of h [s] lie between two look points.

    `period` [s] is the exact motion's, or 2 pi/w0 if it has none.
    """
    return max(1, round(period / limits.LOOKS / abs(h)))


class Judge:
    """The judge of one method from a start on."""

    def __init__(self, h: float, period: float, method: Method, model: Model) -> None:
        """`h` [s] is the method's step; `period` [s] as in `stride`."""
        self.judgement = Judgement("too early")  # in the words of before
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._last: LookPoint | None = None
        self._start_error = 0.0  # at the first look point; bands are relative to it
        self._bin_steps = max(limits.MIN_BIN_STEPS, round(period / self._h))  # at first
        self._bands = Bands(self._bin_steps)
        self._conserved = model.conserves_energy  # else errors are ln(E/E_true)
        self._epsilon = method.epsilon
        self._min_energy = (limits.MIN_AMPLITUDE * method.epsilon * model.w0) ** 2  # s⁻²
        # the band of an error that beats with the steps may leave the start and come back
        fastest_turn = min(period, math.tau / model.w0) if model.turns else math.inf
        self._may_beat = method.symplectic or fastest_turn < limits.MIN_STEPS_A_TURN * self._h
        self._may_escape = not model.turns
        self._orbit: _Orbit | None = None
        if method.symplectic and method.general and not model.without_force:
            self._orbit = _Orbit(method, model, h, period)

    def copy(self) -> Self:
        """Return another judge that goes on from here."""
        other = copy.copy(self)
        other._bands = copy.copy(self._bands)
        other._orbit = copy.copy(self._orbit)
        return other

    def look(self, point: LookPoint) -> None:
        """Take in the next look point; a full bin brings a new judgement."""
        if self._last is None:
            self._last = point
            self._start_error = point.error
            return
        if not self._conserved:
            true_energy = point.energy * math.exp(-point.error)
            if min(point.energy, true_energy) < self._min_energy:
                return  # mostly rounding
        if self._orbit:
            self._orbit.look(self._last, point)
        self._last = point
        self.peak = max(self.peak, -point.low, point.high)
        start = self._start_error
        full = self._bands.add(
            point.step, point.low - start, point.high - start, point.error - start
        )
        if full and len(self._bands.bins) >= limits.MIN_BINS:
            self._judge()
        elif self.judgement.verdict == "too early":
            progress = self._progress()
            self.judgement = self.judgement._replace(periods=self._periods, progress=progress)
        if self._may_escape and point.error > limits.ESCAPED_ERROR:
            self.judgement = self.judgement._replace(verdict="grows", progress=None)

    def fail(self, steps: int) -> None:
        """Note that the numbers have ended, so many steps after the first look point."""
        self.judgement = Judgement("failed", periods=steps * self._h / self._period)

    @property
    def shown(self) -> Judgement:
        """The judgement in today's words."""
        rises = self._last is not None and self._last.error > 0
        return in_todays_words(self.judgement, rises, symplectic=self._orbit is not None)

    @property
    def _steps(self) -> int:
        return self._last.step if self._last else 0

    @property
    def _periods(self) -> float:
        return self._steps * self._h / self._period

    @property
    def _min_steps(self) -> int:
        """The steps after which bands that rest can be told from bands that do not."""
        return max(MAX_BINS * self._bin_steps, limits.LONG)

    @property
    def _rounding(self) -> float:
        """How far roundings may have carried the error by now."""
        walk = limits.WALK * self._epsilon * math.sqrt(self._steps)
        return walk if self._conserved else max(walk, limits.REFERENCE_ERROR)

    def _judge(self) -> None:
        orbit = self._orbit
        previous = self.judgement.verdict
        periods = self._periods
        if orbit:
            verdict = orbit.verdict(previous, self.peak, periods)
        else:
            verdict = self._verdict_of_bands(previous)
        judgement = self._trend(verdict)._replace(verdict=verdict, periods=periods)
        if verdict == "too early":
            judgement = judgement._replace(progress=self._progress())
        elif orbit and orbit.steps and verdict in ("chaotic", "wanders"):
            judgement = judgement._replace(lyapunov=orbit.log / orbit.steps / self._h)
        self.judgement = judgement

    def _progress(self) -> Progress | None:
        """Return how far it is to the first possible verdict, or else to the last one.

        None: a verdict can come any time.
        """
        steps_a_period = self._period / self._h
        if self._orbit and self._orbit.is_regular:
            need: float = limits.MIN_PERIODS
        elif self._orbit:
            need = limits.LONG / steps_a_period
        elif len(self._bands.bins) < limits.MIN_BINS:
            need = limits.MIN_BINS * self._bin_steps / steps_a_period
        else:
            need = self._min_steps / steps_a_period
        if self._periods >= need:
            return None
        return Progress(int(self._periods), math.ceil(need), "swings")

    def _trend(self, verdict: str) -> Judgement:
        """Return a judgement with the recent slope, if there is evidence for one.

        Where a line fits the logarithm of the energy better than the energy, the slope is the
        growth rate of the logarithm times the energy.
        """
        leaves = verdict in ("grows", "loses")
        if not leaves and (self._orbit or verdict != "too early"):
            return Judgement()
        bins = self._bands.bins
        recent = bins
        if len(bins) >= MAX_BINS / 2:  # with fewer, all count: growth that slows down has no slope
            recent = self._bands.recent(0.5)
        logarithms = [
            Bin(step, self._logarithm(low), self._logarithm(high)) for step, low, high in recent
        ]
        trend = fit_line(recent)
        logarithmic = fit_line(logarithms)
        size = 1.0
        if logarithms[-1].middle > 0 and logarithmic.sigmas > trend.sigmas:
            trend = logarithmic
            size = math.exp(logarithms[-1].middle)
        significant = trend.sigmas > limits.SLOPE_SIGMAS
        if leaves:  # the bands have shown the direction, so only that one counts
            direction = 1 if verdict == "grows" else -1
            significant = direction * trend.slope > limits.SLOPE_SIGMAS * trend.uncertainty
        shift = abs(trend.slope) * (recent[-1].step - recent[0].step)
        slope = trend.slope / self._h * size
        uncertainty = trend.uncertainty / self._h * size
        finite = math.isfinite(slope + uncertainty)
        if not (significant and finite and shift > self._rounding):
            return Judgement()
        growth = trend.slope / self._h if size > 2 else None
        return Judgement(slope=slope, uncertainty=uncertainty, growth=growth)

    def _logarithm(self, error: float) -> float:
        """Return ln(E/E0) if energy was gained, else the error; small errors hardly change."""
        return math.log1p(error) if self._conserved and error > 0 else error

    def _verdict_of_bands(self, previous: str) -> str:
        """Return the verdict by the last quarter of the bins, the present band.

        Errors are relative to the start, so the start is at 0.
        """
        low, high = hull(self._bands.recent(0.25))
        width = high - low
        distance = max(low, -high)  # of the band from the start; below 0 if it contains the start
        if self._conserved and high + self._start_error < limits.AT_REST:
            return "loses"
        if settled := self._settled(previous, distance, width):
            return settled
        away = distance > -limits.RETURNED * width
        if previous in ("caught", "wanders") or (previous in ("grows", "loses") and away):
            return previous
        if self._has_left(distance, self._logarithm(low), self._logarithm(high)):
            return "grows" if low > 0 else "loses"
        if self._steps < self._min_steps:
            return "too early"
        stays = distance < self._rounding and self._is_flat
        return "bounded" if stays or previous == "bounded" else "too early"

    def _has_left(self, distance: float, low: float, high: float) -> bool:
        """Return whether a band, in the logarithm, is far enough from the start for its width."""
        if distance < self._rounding or max(low, -high) < limits.LEFT * (high - low):
            return False
        if not self._may_beat:
            return True
        bins = self._bands.bins
        straight = len(bins) >= limits.STRAIGHT_BINS and one_way_share(bins) >= limits.MIN_ONE_WAY
        return distance >= 1 and straight

    def _settled(self, previous: str, distance: float, width: float) -> str | None:
        """Return `caught` if the second half lies in a band elsewhere, `wanders` if in none."""
        half = self._bands.recent(0.5)
        early = previous in ("grows", "loses") and len(half) >= MAX_BINS / 4
        if not (early or self._steps >= self._min_steps):
            return None
        if fit_line(half).sigmas > limits.STEADY_SIGMAS:
            return None
        low, high = hull(half)
        typical_widths = (high - low) / max(typical_width(half), self._rounding)
        left = distance > max(limits.LEFT * width, self._rounding)
        left = left or previous not in ("too early", "bounded")
        if left and typical_widths < limits.ONE_BAND:
            return "caught"
        long = self._steps >= max(self._min_steps, 4 * limits.LONG)
        if long and typical_widths > limits.NO_BAND and one_way_share(half) < limits.MAX_ONE_WAY:
            return "wanders"
        return None

    @property
    def _is_flat(self) -> bool:
        """Whether the slope leaves the error in its band for HORIZON periods."""
        trend = fit_line(self._bands.bins)
        shift = (abs(trend.slope) + limits.SLOPE_SIGMAS * trend.uncertainty) * self._steps
        width = max(typical_width(self._bands.bins), self._rounding)
        return shift < width / 2 * min(1, self._periods / limits.HORIZON)


class _Orbit(Stretching):
    """Evidence that the orbit of a symplectic method is regular, fenced in or chaotic."""

    def __init__(self, method: Method, model: Model, h: float, period: float) -> None:
        super().__init__(method, model, h)
        self._z = abs(h) * model.w0 * method.longest_substep
        self._swing = model.w0 * period  # rad; the longer, the nearer to upright
        self._periodic_in_omega = method.order <= 2  # with the period 2 pi/h
        self._linear = not model.turns
        bottom = at_bottom(method, h * model.w0)
        # |trace| < 2: small swings move on ellipses
        self._stable = abs(bottom.theta_theta + bottom.omega_omega) < 2
        self._min_omega = math.inf  # rad/s
        self._max_omega = -math.inf

    def look(self, previous: LookPoint, point: LookPoint) -> None:
        """Take in a look point: follow a neighbour from the previous one."""
        self._min_omega = min(self._min_omega, point.omega)
        self._max_omega = max(self._max_omega, point.omega)
        needed = self._z > limits.REGULAR_Z and not self._linear
        if needed and self.steps < limits.LYAPUNOV_STEPS:
            self.carry((previous.theta, previous.omega), point.step - previous.step)

    @property
    def is_regular(self) -> bool:
        """Whether a theorem keeps the orbit from chaos."""
        if self._linear:
            return self._stable
        turn_a_step = max(-self._min_omega, self._max_omega) * abs(self._h)  # rad
        if not self._periodic_in_omega and turn_a_step >= math.pi:
            return False
        fenced = self._z <= limits.FENCED_Z and self._swing < limits.NEAR_TOP
        return fenced or self._z <= limits.REGULAR_Z

    def verdict(self, previous: str, peak: float, periods: float) -> str:
        """Return the verdict; `peak` is the largest |energy error| so far.

        Neighbours on regular orbits separate in proportion to time, and by about 1/k'² in the
        first swing past upright.  The growth of the orbit itself is instability, not chaos.
        """
        if self._linear and not self.is_regular:
            return "grows"
        regular = math.log(max(self.steps, 1))
        growth = math.log1p(peak) / 2  # the energy goes as the square of the orbit
        if self.log - growth > regular + self._swing / 2 + limits.CHAOTIC_SEPARATION:
            # a fence would hold h·omega within a range of 2 pi
            free = (self._max_omega - self._min_omega) * abs(self._h) > math.tau
            return "wanders" if free else "chaotic"
        if previous != "too early":
            return previous
        proved = self.is_regular and periods >= limits.MIN_PERIODS
        seen = self.steps >= limits.LONG and self.log < regular + limits.REGULAR_SEPARATION
        return "bounded" if proved or seen else "too early"


class Judges:
    """A judge for each method since the last change of the stepping, and the run's milestones.

    Errors cross where the largest error so far of a method that gains or loses energy passes that
    of a bounded one.  With other pairs it might pass back.
    """

    def __init__(self, cast: Cast, model: Model, period: float) -> None:
        """`period` [s] is that of `stride`."""
        self.milestones: list[Milestone] = []
        self._cast = cast
        self._model = model
        self._period = period
        self._judges: list[Judge] = []
        # pairs of a leaving method and a bounded one whose error is still the larger
        self._below: frozenset[tuple[int, int]] = frozenset()

    @property
    def judgements(self) -> list[Judgement]:
        """The judgements since the last change of the stepping, in the order of the cast."""
        return [judge.shown for judge in self._judges]

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
        for method, judge, point in zip(self._cast, self._judges, points, strict=True):
            if point is None:
                continue
            previous = judge.shown.verdict
            judge.look(point)
            now = judge.shown
            if now.verdict != previous:
                verdict = Milestone("verdict", method, step, t, point.error, now.verdict)
                self.milestones.append(verdict._replace(trend=now.slope, lyapunov=now.lyapunov))
        self._note_crossings(step, t, points)

    def _note_crossings(self, step: int, t: float, points: Sequence[LookPoint | None]) -> None:
        for (index, leaving), (other, bounded) in permutations(enumerate(self._judges), 2):
            leaves = leaving.judgement.verdict in ("grows", "loses")
            stays = bounded.judgement.verdict == "bounded" and bounded.peak > limits.ROUNDING
            if not (leaves and stays):
                continue
            pair = (index, other)
            point = points[index]
            if leaving.peak <= bounded.peak:
                self._below |= {pair}
            elif point and pair in self._below:
                self._below -= {pair}
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
