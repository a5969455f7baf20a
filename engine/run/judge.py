"""Judge: a verdict on an energy error while a run goes on, in constant memory.

A judge sees look points, a fixed number of steps apart, so its verdict is a function of scene, stepping and step.
It draws on three kinds of evidence.

- A symplectic method can neither gain nor lose for good: its orbit is regular and its energy error bounded, or it is
  chaotic.  It is `bounded` where a theorem or a conserved quantity shows that the orbit is regular or fenced in, or
  where neighbouring starts have separated no faster than in proportion to time; `chaotic` where they separate
  exponentially; and it `wanders` if there is no fence, either.
- A linear map is never chaotic: it conserves an ellipse, or it grows.
- Any other method, and a program of which only energies are known, is judged by the bands of the energy error:
  whether they have left the start, whether they have come to rest, and what line they follow.
"""

import copy
import math
from statistics import median
from typing import Self

from engine.methods import Method
from engine.models.model import Model, Phase
from engine.run.bands import MAX_BINS, Bands, Bin, hull, line, rising, steady
from engine.run.judgement import Judgement, LookPoint, Progress, Verdict
from engine.run.tangent import Stretching, conserved_ellipse

# Theorems and bounds.  z = h·w0, times a method's longest substep.
QUIET = 0.25  # z: below, chaos is thinner than exp(-pi²/z), rounding: Gelfreich & Lazutkin, Russ. Math. Surv. 56 (2001)
FENCED = 0.9  # z: below, invariant curves fence orbits of SE and Verlet; the last breaks at 0.9857: Greene (1979)
NEAR_TOP = 11.0  # w0·period: longer swings come within 30° of upright, where the fences break first
CONSERVED = (
    0.045  # z² E: half of what the modified energy of order 4 moves by where its orbit is regular
)
ELLIPSE = 0.15  # relative: the ellipse of swings below 0.7 rad moves by theta²/4, half of it the other way
SMALL = 0.7  # rad
WALK = 8.0  # standard deviations of a random walk of roundings: it gets there once in 10^14 runs
REFERENCE = 1e-9  # of ln(E/E_true): ten times the error of the true motion
GONE = 1e6  # relative energy error from which no force brings a bob back, where there is no way over the top
ROUNDING = 1e-12  # relative energy error after a million roundings
AT_REST = -1 + 1e-9  # relative energy error: nothing is left to lose

# How long to look, by the risk of an error in the million-step truth table: none wrong in 1 600 cells.
LOOKS = 8  # a period: Nyquist for the second harmonic of the error, twice over
MIN_PERIODS = 8  # for a theorem to be applied: the orbit has then shown its band
MIN_BINS = 4  # for a line with two degrees of freedom
MIN_BIN_STEPS = 16  # beyond z = 0.4 a swing has fewer, and their extremes miss those of the band
LONG = 4096  # steps that show an orbit to be regular: a chaotic one separates by e^15 with a Lyapunov number of 0.004
LYAPUNOV_STEPS = 100_000  # neighbours are followed for so long: tenths of a second in plain Python
SIGMAS = 3.0  # of Student's t for a slope: one false trend in 370
HORIZON = 500  # periods for which a bounded error is to stay in its band
THROWN = 1.5  # z: beyond, a method that is not symplectic may be thrown far, and back


def stride(period: float, h: float) -> int:
    """Return how many steps of h [s] lie between two look points; `period` [s] is the exact motion's or 2 pi/w0."""
    return max(1, round(period / LOOKS / abs(h)))


class Judge:
    """The judge of one method from a start on, or of any program's energies."""

    def __init__(
        self,
        h: float,
        period: float,
        method: Method | None = None,
        model: Model | None = None,
        scale: float = 1.0,
    ) -> None:
        """Begin with no look point.

        `h` [s] is the time between two of its steps, `period` [s] that of the exact motion, or 2 pi/w0 if it has
        none.  Energy errors are relative to `scale` [s⁻²].  Without a method only energies are evidence.
        """
        self.judgement = Judgement()
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._scale = scale
        self._model = model
        self._width = max(MIN_BIN_STEPS, round(period / self._h))  # steps of a bin, at first
        self._energy = Bands(self._width)
        self._first: LookPoint | None = None
        self._steps = 0
        self._relative = model is None or model.energy_error.conserved  # and not ln(E/E_true)
        self._escapes = model is not None and not model.turns  # nothing brings an orbit back
        self._epsilon = method.epsilon if method else 2.0**-53
        self._z = self._h * model.w0 if model else 0.0
        self._map: _SymplecticEvidence | None = None
        if method and model and method.symplectic and method.general and model.has_force:
            self._map = _SymplecticEvidence(method, model, h, period, scale)

    def copy(self) -> Self:
        """Return another judge that goes on from here."""
        other = copy.copy(self)
        other._energy = self._energy.copy()
        other._map = self._map and self._map.copy()
        return other

    def look(self, point: LookPoint) -> None:
        """Take in the next look point; `stride` steps after the one before, or there is a gap."""
        if self._first is None:
            self._first = point
            if self._map:
                self._map.begin(point)
            return
        if self._is_rounding(point):
            return
        if self._map:
            self._map.look(point, self._steps)
        self._steps = point.step
        self.peak = max(self.peak, -point.low, point.high)
        full = self._energy.add(point.step, point.low, point.high, point.error)
        if full and len(self._energy.bins) >= MIN_BINS:
            self._judge()
        elif self.judgement.verdict == "too early":
            self.judgement = self.judgement._replace(
                periods=self._periods, progress=self._progress()
            )
        if self._escapes and point.error > GONE and not (self._map and self._map.form):
            self.judgement = self.judgement._replace(verdict="grows", progress=None)

    def fail(self, steps: int) -> None:
        """Note that the numbers have ended, so many steps after the first look point."""
        self.judgement = Judgement("failed", periods=steps * self._h / self._period)

    @property
    def _periods(self) -> float:
        return self._steps * self._h / self._period

    @property
    def _floor(self) -> float:
        """How far roundings may have carried the error by now."""
        walk = WALK * self._epsilon * math.sqrt(max(self._steps, 1))
        return walk if self._relative else max(walk, REFERENCE)

    def _is_rounding(self, point: LookPoint) -> bool:
        """Return whether the energy of a damped motion is not far above what rounding theta leaves of it."""
        if self._relative or self._model is None:
            return False
        left = (1e3 * self._epsilon * max(abs(point.theta), 1.0) * self._model.w0) ** 2
        return min(point.energy, point.energy * math.exp(-min(point.error, 700.0))) < left

    def _judge(self) -> None:
        verdict = self._symplectic(self._map) if self._map else self._other()
        trend = self._trend(verdict)
        lyapunov = None
        if self._map and verdict in ("chaotic", "wanders"):
            lyapunov = self._map.lyapunov
        self.judgement = trend._replace(
            verdict=verdict,
            periods=self._periods,
            lyapunov=lyapunov,
            progress=self._progress() if verdict == "too early" else None,
        )

    def _progress(self) -> Progress | None:
        """How far it is to the first verdict, or then to the last; None where it depends on what happens."""
        if self._map:
            have, need, unit = self._map.progress(self._steps, self._periods)
        else:
            first = len(self._energy.bins) < MIN_BINS
            steps = MIN_BINS * self._width if first else max(MAX_BINS * self._width, LONG)
            have, need, unit = (
                int(self._periods),
                math.ceil(steps * self._h / self._period),
                "swings",
            )
        return Progress(have, need, unit) if have < need else None

    def _trend(self, verdict: Verdict) -> Judgement:
        """Return a judgement with the recent slope as far as there is evidence for one.

        A symplectic method has none before its verdict.  Where the logarithm of the energy follows a line better
        than the energy, the slope is the energy times the rate at which its logarithm grows.
        """
        if self._map and verdict == "too early":
            return Judgement()
        flat = self._map is not None and self._map.is_conserved
        bands = (
            self._map.modified if self._map and flat and self._map.modified.bins else self._energy
        )
        recent = bands.recent(0.5) if len(bands.bins) >= MAX_BINS / 2 else bands.bins
        folded = [self._fold(each) for each in recent]
        size = 1.0
        trend = line(recent)
        logarithmic = line(folded)
        if folded[-1].middle > 0 and abs(logarithmic.sigmas) > abs(trend.sigmas):
            trend = logarithmic
            size = math.exp(folded[-1].middle)
            recent = folded
        shift = abs(trend.slope) * (recent[-1].step - recent[0].step)
        width = median(each.width for each in recent)
        sampled = (
            1 - math.cos(min(self._z, math.pi / 2))
        ) * width  # by which the extremes of a wobble are missed
        certain = trend.sigmas > SIGMAS
        if verdict in ("grows", "loses"):  # evidence of its own
            certain = abs(trend.slope) > SIGMAS * trend.uncertainty
        significant = certain and shift > max(self._floor, sampled)
        slope = trend.slope / self._h * size
        uncertainty = trend.uncertainty / self._h * size
        if not math.isfinite(slope + uncertainty) or not (significant or verdict != "too early"):
            return Judgement()
        growth = trend.slope / self._h if size > 2 else None
        return Judgement(
            slope=slope, uncertainty=uncertainty, significant=significant, growth=growth
        )

    def _fold(self, band: Bin) -> Bin:
        """Return a band of errors with ln(E/E0) where energy was gained."""
        return Bin(band.step, _folded(band.low), _folded(band.high)) if self._relative else band

    def _symplectic(self, evidence: "_SymplecticEvidence") -> Verdict:
        known = self.judgement.verdict
        if evidence.is_linear:
            if evidence.form is None:
                return self._leaving() or known
        elif evidence.separates(self.peak):
            return "wanders" if evidence.is_free else "chaotic"
        if known in ("bounded", "chaotic", "wanders"):
            return known
        enough = self._periods >= MIN_PERIODS and self._steps >= MIN_BINS * MIN_BIN_STEPS
        return (
            "bounded"
            if evidence.is_long_enough or (enough and evidence.is_regular)
            else "too early"
        )

    def _other(self) -> Verdict:
        known = self.judgement.verdict
        low, high = hull(self._energy.recent(0.25))
        if self._relative and high < AT_REST:
            return "loses"
        many = self._steps >= max(MAX_BINS * self._width, LONG)
        if many and (settled := self._settled(low, high)):
            return settled
        if known in ("caught", "wanders") or (
            known in ("grows", "loses") and self._is_away(low, high)
        ):
            return known
        if leaving := self._leaving():
            return leaving
        if many and (known == "bounded" or self._is_flat(low, high)):
            return "bounded"
        return "too early"

    def _leaving(self) -> Verdict | None:
        """Return the direction in which the last quarter has left the start, if it has."""
        assert self._first is not None
        bins = self._energy.bins
        last = hull(self._energy.recent(0.25))
        gap = self._gap(*last)
        folded = self._fold(Bin(0.0, *last))
        away = max(folded.low - self._first.error, self._first.error - folded.high)
        if away < max(folded.width, self._floor) / 2 or (gap < self._floor and not steady(bins)):
            return None
        if not self._escapes:
            if (
                self._period < 3 * self._h and gap <= 1
            ):  # fewer than three steps a turn beat with it, for long
                return None
            if self._z > THROWN and (len(bins) < 24 or 0.1 < rising(bins) < 0.9):
                return None
        return "grows" if last[0] > self._first.error else "loses"

    def _settled(self, low: float, high: float) -> Verdict | None:
        """Return `caught` where the second half lies in one band away from the start, `wanders` where in none."""
        assert self._first is not None
        spread = self._spread()
        if spread is None:
            return None
        known = self.judgement.verdict
        longer = self._steps >= max(MAX_BINS * self._width, 4 * LONG)
        widest = 3.0 if longer and known != "wanders" else 2.0
        left = known not in ("too early", "bounded") or self._gap(low, high) > (high - low) / 8
        if left and spread < widest and abs((low + high) / 2 - self._first.error) > self._floor:
            return "caught"
        if longer and spread > 4.5 and 0.25 < rising(self._energy.recent(0.5)) < 0.75:
            return "wanders"
        return None

    def _is_flat(self, low: float, high: float) -> bool:
        """Return whether the error touches its start, with no slope that would move it within HORIZON periods."""
        trend = line(self._energy.bins)
        reach = (abs(trend.slope) + 3 * trend.uncertainty) * self._steps
        significant = trend.sigmas > SIGMAS and reach > 10 * self._floor
        width = max(self._energy.width, self._floor)
        near = reach < width / 2 * min(1, self._periods / HORIZON)
        return near and not significant and self._gap(low, high) < self._floor

    def _gap(self, low: float, high: float) -> float:
        """Return how far a band is from the start's error; below 0 inside."""
        assert self._first is not None
        return max(low - self._first.error, self._first.error - high)

    def _is_away(self, low: float, high: float) -> bool:
        """Return whether a band is centred elsewhere than on the start's error."""
        return self._gap(low, high) > -(high - low) / 4

    def _spread(self) -> float | None:
        """Return how many typical bins the band of the second half is wide: about 1 for one band; None if it moves."""
        half = self._energy.recent(0.5)
        middle = len(half) // 2
        early = Bin(0.0, *hull(half[:middle]))
        late = Bin(0.0, *hull(half[middle:]))
        if steady(half):
            return None
        width = max(early.high, late.high) - min(early.low, late.low)
        narrow = 0.1 * (1 + min(early.low, late.low))
        if width < narrow and self._gap(late.low, late.high) > 10 * width:
            return 1.0  # beside the way that it went
        spread = width / max(median(each.width for each in half), self._floor)
        moved = max(abs(late.low - early.low), abs(late.high - early.high))
        return max(spread, 4.0) if moved > width / 4 else spread


def _folded(error: float) -> float:
    """Return ln(E/E0) of an error where energy was gained; small ones hardly change."""
    return math.log1p(error) if error > 0 else error


class _SymplecticEvidence:
    """What shows the orbit of a symplectic method to be regular, fenced in or chaotic."""

    def __init__(self, method: Method, model: Model, h: float, period: float, scale: float) -> None:
        self._method = method
        self._model = model
        self._h = h
        self._scale = scale
        self._z = abs(h) * model.w0
        self._stride = stride(period, h)
        self._far = model.w0 * period
        self.is_linear = not model.turns
        self.form = conserved_ellipse(method, h * model.w0)
        self.modified = Bands(max(MIN_BIN_STEPS, round(period / abs(h))))
        self._neighbours = Stretching(method, model, h)
        self._ellipse = (math.inf, 0.0)  # the smallest and the largest size so far
        self._omegas = (math.inf, -math.inf)  # rad/s
        self._start: float | None = None  # modified energy [s⁻²]
        self._phase: Phase = (0.0, 0.0)

    def copy(self) -> Self:
        other = copy.copy(self)
        other.modified = self.modified.copy()
        other._neighbours = copy.copy(self._neighbours)
        return other

    def begin(self, point: LookPoint) -> None:
        self._phase = (point.theta, point.omega)
        if self._method.modified_energy is not None:
            self._start = self._method.modified_energy(self._model, self._phase, self._h)

    def look(self, point: LookPoint, before: int) -> None:
        """Take in a look point; the one before was at this step."""
        phase = (point.theta, point.omega)
        self._omegas = (min(self._omegas[0], point.omega), max(self._omegas[1], point.omega))
        if self.form is not None:
            a, b, c = self.form
            theta = math.remainder(point.theta, math.tau) if self._model.turns else point.theta
            omega = point.omega / self._model.w0
            size = a * theta * theta + b * theta * omega + c * omega * omega
            self._ellipse = (min(self._ellipse[0], size), max(self._ellipse[1], size))
        steps = point.step - before
        needed = self._z * self._method.longest_substep > QUIET and not self.is_linear
        if needed and self._neighbours.steps < LYAPUNOV_STEPS and steps <= 2 * self._stride:
            self._neighbours.carry(self._phase, steps)
        self._phase = phase
        if self._start is not None and self._method.modified_energy is not None:
            error = (
                self._method.modified_energy(self._model, phase, self._h) - self._start
            ) / self._scale
            error = error if math.isfinite(error) else math.inf
            self.modified.add(point.step, error, error, error)

    @property
    def is_conserved(self) -> bool:
        """Whether the modified energy hardly moves; the energy of velocity Verlet wobbles by z²/4 in small swings."""
        moved = (self.modified.high - self.modified.low) * self._scale
        energy = min(self._scale, 2 * self._model.w0_squared)
        return len(self.modified.bins) >= MIN_BINS and moved <= max(
            CONSERVED * self._z**2 * energy, ROUNDING * self._scale
        )

    @property
    def is_regular(self) -> bool:
        """Whether a theorem or a conserved quantity keeps the orbit from chaos."""
        if self.is_linear:
            return self.form is not None
        z = self._z * self._method.longest_substep
        fastest = max(-self._omegas[0], self._omegas[1]) * abs(self._h)
        if (
            self._method.order > 2 and fastest >= math.pi
        ):  # only the map of order 1 and 2 is periodic in h·omega
            return False
        if z <= QUIET:
            return True
        return self._far < NEAR_TOP and (z <= FENCED or self.is_conserved or self._is_small)

    @property
    def _is_small(self) -> bool:
        """Whether small swings stay on their ellipse."""
        low, high = self._ellipse
        if self.form is None or high >= self.form[0] * SMALL**2:
            return False
        return high - low < ELLIPSE * (high + low)

    def separates(self, peak: float) -> bool:
        """Return whether neighbours separate exponentially, and faster than the orbit itself grows.

        Regular ones separate in proportion to time, and by 1/k'² or so in the first swing past upright.
        """
        steps = self._neighbours.steps
        if not steps:
            return False
        growth = math.log1p(max(peak, 0.0)) / 2
        return self._neighbours.log - growth > 15 + math.log(steps) + self._far / 2

    @property
    def is_free(self) -> bool:
        """Whether h·omega has moved by more than 2 pi, so that there is no fence."""
        return (self._omegas[1] - self._omegas[0]) * abs(self._h) > math.tau

    @property
    def is_long_enough(self) -> bool:
        """Whether neighbours have shown for long that they do not separate exponentially."""
        steps = self._neighbours.steps
        return steps >= LONG and self._neighbours.log < 5 + math.log(steps)

    @property
    def lyapunov(self) -> float | None:
        """1/s."""
        steps = self._neighbours.steps
        return self._neighbours.log / steps / abs(self._h) if steps else None

    def progress(self, steps: int, periods: float) -> tuple[int, int, str]:
        """Return what there is, what a verdict needs, and its unit."""
        if self.is_regular:
            return int(periods), MIN_PERIODS, "swings"
        return self._neighbours.steps, LONG, "steps"
