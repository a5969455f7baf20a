"""Judge: a verdict on energies, from whatever evidence there is.

The energies of a method arrive while it runs, at look points a fixed number of steps apart, so the
verdict is a function of scene, stepping and step alone.  It rests on three kinds of evidence.

- A symplectic method can neither gain nor lose for good: its orbit is regular and its energy error
  bounded, or it is chaotic.  It is `bounded` where a theorem or a conserved quantity keeps the orbit
  regular, or where neighbouring starts have separated no faster than in proportion to time;
  `chaotic` where they separate exponentially; and it `wanders` if no fence holds it, either.
- A linear map is never chaotic: it conserves an ellipse, or it grows.
- Any other method is judged by the bands of its energy error: whether they have left the start,
  whether they have come to rest, and what line they follow.

A record of energies alone, of any program, is read at once: `engine.run.energies` says how.
"""

import copy
import math
from statistics import median
from typing import Any, Self

from engine.methods import Method
from engine.models.model import Model, Phase
from engine.run import judgement as limits
from engine.run.bands import MAX_BINS, Bands, Bin, hull, line, rising, steady
from engine.run.judgement import Judgement, LookPoint, Progress, Verdict
from engine.run.tangent import Stretching, conserved_ellipse


def stride(period: float, h: float) -> int:
    """Return how many steps of h [s] lie between two look points.

    `period` [s] is the exact motion's, or 2 pi/w0 if it has none.
    """
    return max(1, round(period / limits.LOOKS / abs(h)))


class Judge:
    """The judge of one method from a start on, or of a record of any program's energies."""

    def __init__(
        self,
        h: float = 1.0,
        period: float = 1.0,
        method: Method | None = None,
        model: Model | None = None,
        scale: float = 1.0,
    ) -> None:
        """Begin without evidence; a judge that only reads a record needs no argument.

        `h` [s] is the time between two of the method's steps, `period` [s] that of the exact
        motion, or 2 pi/w0 if it has none.  Energy errors are relative to `scale` [s⁻²].
        """
        self.judgement = Judgement()
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._model = model
        self._width = max(limits.MIN_BIN_STEPS, round(period / self._h))  # steps of a bin, at first
        self._energy = Bands(self._width)
        self._first: LookPoint | None = None
        self._steps = 0
        self._relative = model is None or model.energy_error.conserved  # and not ln(E/E_true)
        self._escapes = model is not None and not model.turns  # nothing brings an orbit back
        self._epsilon = method.epsilon if method else 2.0**-53
        self._z = self._h * model.w0 if model else 0.0
        fastest = min(period, math.tau / model.w0) if model and model.turns else math.inf
        self._may_return = fastest < limits.MIN_STEPS_A_TURN * self._h
        self._orbit: _Orbit | None = None
        if method and model and method.symplectic:
            self._may_return = True
            if method.general and model.has_force:
                self._orbit = _Orbit(method, model, h, period, scale)

    def copy(self) -> Self:
        """Return another judge that goes on from here."""
        other = copy.copy(self)
        other._energy = self._energy.copy()
        other._orbit = self._orbit and self._orbit.copy()
        return other

    def read(
        self, times: Any, energies: Any, failed: bool = False, absolute: bool = True
    ) -> Judgement:
        """Judge a whole record: arrays of finite energies at increasing times, in any units.

        `failed`: nan or inf came after the last of them.  The zero of energy means something if it
        is `absolute`, so that an energy can be lost or multiplied.
        """
        from engine.run.energies import judged

        self.judgement = Judgement("failed") if failed else judged(times, energies, absolute)
        return self.judgement

    def look(self, point: LookPoint) -> None:
        """Take in the next look point; `stride` steps after the one before, or there is a gap."""
        if self._first is None:
            self._first = point
            if self._orbit:
                self._orbit.begin(point)
            return
        if self._is_rounding(point):
            return
        if self._orbit:
            self._orbit.look(point, self._steps)
        self._steps = point.step
        self.peak = max(self.peak, -point.low, point.high)
        full = self._energy.add(point.step, point.low, point.high, point.error)
        if full and len(self._energy.bins) >= limits.MIN_BINS:
            self._judge()
        elif self.judgement.verdict == "too early":
            self.judgement = self.judgement._replace(
                periods=self._periods, progress=self._progress()
            )
        if self._escapes and point.error > limits.GONE and not (self._orbit and self._orbit.form):
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
        walk = limits.WALK * self._epsilon * math.sqrt(max(self._steps, 1))
        return walk if self._relative else max(walk, limits.REFERENCE)

    def _is_rounding(self, point: LookPoint) -> bool:
        """Return whether a damped energy is not far above what rounding theta leaves of it."""
        if self._relative or self._model is None:
            return False
        theta = max(abs(point.theta), 1.0)
        left = (limits.ABOVE_ROUNDING * self._epsilon * theta * self._model.w0) ** 2
        return min(point.energy, point.energy * math.exp(-min(point.error, 700.0))) < left

    def _judge(self) -> None:
        verdict = self._by_orbit(self._orbit) if self._orbit else self._by_bands()
        lyapunov = None
        if self._orbit and verdict in ("chaotic", "wanders"):
            lyapunov = self._orbit.lyapunov
        self.judgement = self._trend(verdict)._replace(
            verdict=verdict,
            periods=self._periods,
            lyapunov=lyapunov,
            progress=self._progress() if verdict == "too early" else None,
        )

    def _progress(self) -> Progress | None:
        """How far it is to the first verdict, or then to the last.

        None where it depends on what happens.
        """
        if self._orbit and not self._orbit.is_regular:
            progress = Progress(self._orbit.steps, limits.LONG, "steps")
        else:
            steps = self._many
            if len(self._energy.bins) < limits.MIN_BINS:
                steps = limits.MIN_BINS * self._width
            need = math.ceil(steps * self._h / self._period)
            if self._orbit:
                need = limits.MIN_PERIODS
            progress = Progress(int(self._periods), need, "swings")
        return progress if progress.have < progress.need else None

    @property
    def _many(self) -> int:
        """The steps after which bands that rest, or that do not, can be told apart."""
        return max(MAX_BINS * self._width, limits.LONG)

    def _trend(self, verdict: Verdict) -> Judgement:
        """Return a judgement with the recent slope as far as there is evidence for one.

        A symplectic method has none before its verdict.  Where the logarithm of the energy follows
        a line better than the energy, the slope is the energy times its logarithm's growth rate.
        """
        if self._orbit and verdict == "too early":
            return Judgement()
        bands = self._energy
        if self._orbit and self._orbit.is_conserved:
            bands = self._orbit.modified
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
        # look points z apart miss the extremes of a wobble by so much of its width
        missed = (1 - math.cos(min(self._z, math.pi / 2))) * median(each.width for each in recent)
        certain = trend.sigmas > limits.SIGMAS
        if verdict in ("grows", "loses"):  # evidence of its own
            certain = abs(trend.slope) > limits.SIGMAS * trend.uncertainty
        significant = certain and shift > max(self._floor, missed)
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

    def _by_orbit(self, orbit: "_Orbit") -> Verdict:
        known = self.judgement.verdict
        if orbit.is_linear:
            if orbit.form is None:
                return self._leaving() or known
        elif orbit.separates(self.peak):
            return "wanders" if orbit.is_free else "chaotic"
        if known in ("bounded", "chaotic", "wanders"):
            return known
        enough = self._periods >= limits.MIN_PERIODS
        enough = enough and self._steps >= limits.MIN_BINS * limits.MIN_BIN_STEPS
        if orbit.is_long_enough or (enough and orbit.is_regular):
            return "bounded"
        return "too early"

    def _by_bands(self) -> Verdict:
        known = self.judgement.verdict
        last = hull(self._energy.recent(0.25))
        if self._relative and last[1] < limits.AT_REST:
            return "loses"
        if settled := self._settled(last):
            return settled
        # a band that is centred elsewhere than on the start's error has not come back
        away = self._gap(last) > -(last[1] - last[0]) / 4
        if known in ("caught", "wanders") or (known in ("grows", "loses") and away):
            return known
        if leaving := self._leaving():
            return leaving
        if self._steps >= self._many and (known == "bounded" or self._is_flat(last)):
            return "bounded"
        return "too early"

    def _leaving(self) -> Verdict | None:
        """Return the direction in which the last quarter has left the start, if it has."""
        assert self._first is not None
        bins = self._energy.bins
        last = hull(self._energy.recent(0.25))
        gap = self._gap(last)
        folded = self._fold(Bin(0.0, *last))
        away = max(folded.low - self._first.error, self._first.error - folded.high)
        if gap < self._floor or away < folded.width / 2:
            return None
        straight = len(bins) >= limits.STRAIGHT_BINS and not 0.1 < rising(bins) < 0.9
        if self._may_return and (gap < 1 or not straight):
            return None
        return "grows" if last[0] > self._first.error else "loses"

    def _settled(self, last: tuple[float, float]) -> Verdict | None:
        """Return `caught` where the second half lies in one band away from the start.

        `wanders` where it lies in none, and neither rises nor falls.
        """
        assert self._first is not None
        half = self._energy.recent(0.5)
        gap = self._gap(last)
        width = last[1] - last[0]
        known = self.judgement.verdict
        far = gap > width and known in ("grows", "loses") and len(half) >= MAX_BINS / 4
        if not (far or self._steps >= self._many) or steady(half):
            return None
        low, high = hull(half)
        bands = (high - low) / max(median(each.width for each in half), self._floor)
        left = known not in ("too early", "bounded") or gap > width / 8
        shift = abs((last[0] + last[1]) / 2 - self._first.error)
        if left and bands < limits.ONE_BAND and shift > 10 * self._floor:
            return "caught"
        longer = self._steps >= max(MAX_BINS * self._width, 4 * limits.LONG)
        if longer and bands > limits.NO_BAND and 0.25 < rising(half) < 0.75:
            return "wanders"
        return None

    def _is_flat(self, last: tuple[float, float]) -> bool:
        """Return whether the error touches its start, and stays for HORIZON periods by its slope."""
        trend = line(self._energy.bins)
        reach = (abs(trend.slope) + limits.SIGMAS * trend.uncertainty) * self._steps
        significant = trend.sigmas > limits.SIGMAS and reach > 10 * self._floor
        width = max(self._energy.width, self._floor)
        near = reach < width / 2 * min(1, self._periods / limits.HORIZON)
        return near and not significant and self._gap(last) < self._floor

    def _gap(self, band: tuple[float, float]) -> float:
        """Return how far a band is from the start's error; below 0 inside."""
        assert self._first is not None
        return max(band[0] - self._first.error, self._first.error - band[1])


def _folded(error: float) -> float:
    """Return ln(E/E0) of an error where energy was gained; small ones hardly change."""
    return math.log1p(error) if error > 0 else error


class _Orbit:
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
        self.modified = Bands(max(limits.MIN_BIN_STEPS, round(period / abs(h))))
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
        needed = self._z * self._method.longest_substep > limits.QUIET and not self.is_linear
        if needed and self.steps < limits.LYAPUNOV_STEPS and steps <= 2 * self._stride:
            self._neighbours.carry(self._phase, steps)
        self._phase = phase
        if self._start is not None and self._method.modified_energy is not None:
            energy = self._method.modified_energy(self._model, phase, self._h)
            error = (energy - self._start) / self._scale
            error = error if math.isfinite(error) else math.inf
            self.modified.add(point.step, error, error, error)

    @property
    def steps(self) -> int:
        """Over how many steps neighbours were followed."""
        return self._neighbours.steps

    @property
    def is_conserved(self) -> bool:
        """Whether the modified energy hardly moves.

        The energy of velocity Verlet wobbles by z²/4 in small swings.
        """
        moved = (self.modified.high - self.modified.low) * self._scale
        energy = min(self._scale, 2 * self._model.w0_squared)
        most = max(limits.CONSERVED * self._z**2 * energy, limits.ROUNDING * self._scale)
        return len(self.modified.bins) >= limits.MIN_BINS and moved <= most

    @property
    def is_regular(self) -> bool:
        """Whether a theorem or a conserved quantity keeps the orbit from chaos."""
        if self.is_linear:
            return self.form is not None
        z = self._z * self._method.longest_substep
        fastest = max(-self._omegas[0], self._omegas[1]) * abs(self._h)
        if self._method.order > 2 and fastest >= math.pi:
            return False  # only the map of order 1 and 2 is periodic in h·omega
        if z <= limits.QUIET:
            return True
        fenced = z <= limits.FENCED or self.is_conserved or self._is_small
        return self._far < limits.NEAR_TOP and fenced

    @property
    def _is_small(self) -> bool:
        """Whether small swings stay on their ellipse."""
        low, high = self._ellipse
        if self.form is None or high >= self.form[0] * limits.SMALL**2:
            return False
        return high - low < limits.ELLIPSE * (high + low)

    def separates(self, peak: float) -> bool:
        """Return whether neighbours separate exponentially, and faster than the orbit itself grows.

        Regular ones separate in proportion to time, and by 1/k'² or so in the first swing past
        upright.
        """
        growth = math.log1p(max(peak, 0.0)) / 2
        regular = math.log(max(self.steps, 1)) + self._far / 2
        return self._neighbours.log - growth > regular + limits.APART

    @property
    def is_free(self) -> bool:
        """Whether h·omega has moved by more than 2 pi, so that there is no fence."""
        return (self._omegas[1] - self._omegas[0]) * abs(self._h) > math.tau

    @property
    def is_long_enough(self) -> bool:
        """Whether neighbours have shown for long that they do not separate exponentially."""
        regular = math.log(max(self.steps, 1)) + limits.TOGETHER
        return self.steps >= limits.LONG and self._neighbours.log < regular

    @property
    def lyapunov(self) -> float | None:
        """1/s."""
        return self._neighbours.log / self.steps / abs(self._h) if self.steps else None
