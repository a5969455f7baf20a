"""Verdict: what a method's energy error does, judged while the run goes on.  In constant memory.

A Judge looks at a method at fixed steps of a run, so its verdict depends on the scene, on h and on the step, not on
how often the screen is drawn.

A symplectic method can neither gain nor lose for good: its orbit is regular, and then its energy error stays
within a band, or chaotic.
- `bounded`: the orbit is known to be regular or fenced in.  Up to h·w0 = 0.25 chaos is thinner than rounding
  (Gelfreich & Lazutkin, Russ. Math. Surv. 56 (2001) 499); up to 0.9, and beyond where the modified energy hardly
  moves or small swings stay on their ellipse, it lies only beside upright: then 8 periods are enough.  Elsewhere,
  near resonances and upright, it takes 4096 steps in which neighbouring starts part at most in proportion to time.
- `chaotic`: neighbouring starts part exponentially; the Lyapunov number says how fast.
- `wanders`: and h·omega has moved by more than 2 pi, so there is no fence: the energy diffuses.

Any other method is judged by the bands of its energy error.
- `grows` and `loses`: the error no longer comes back to its value at the start.  Taken back when it does.  In
  the plane, a millionfold energy `grows` at once.
- `caught`: it stays away from the start and has stopped: the second half of the run lies in one band.
- `wanders`: it goes far up and down, and neither steadily nor within a band.
- `bounded`: it touches its start, and its slope, which is not significant, and three times its uncertainty would
  take more than 500 periods to move it by half the band's width.
The last three take 4096 steps or more, and 64 periods.

`too early`: none of these, yet; for long in a rotation of fewer than three steps a turn, which beats with them.
"""

import math
from statistics import median
from typing import NamedTuple

from engine.methods import Method
from engine.models.model import Model, Phase
from engine.run.bands import FLOOR, MOST_BINS, Bands, hull, rising, steady
from engine.run.judgement import Judgement as Judgement
from engine.run.judgement import Verdict as Verdict
from engine.run.tangent import Stretching, conserved_ellipse


class Look(NamedTuple):
    """A method at one step."""

    theta: float  # rad
    omega: float  # rad/s
    error: float  # relative, of the energy
    low: float  # the smallest and the largest since the look before
    high: float


LOOKS = 8  # a period
LEAST_PERIODS = 8  # for `bounded`
LEAST_BINS = 4
RECENT = 0.5  # of the bins: where the reported slope is measured
LEAST_STEPS = 16  # in a bin: beyond h·w0 = 0.4 a swing has fewer steps, and they show its band badly
QUIET = 0.25  # h·w0 of a symplectic method: below, chaos is thinner than exp(-pi²/0.25), which is rounding
LONG = 4096  # steps that show an orbit to be regular where nothing else does
LYAPUNOV_STEPS = 100_000  # neighbours are followed for so long, some tenths of a second in plain Python
FENCED = 0.9  # h·w0 of a symplectic method: below Greene's 0.9857 invariant curves fence every orbit in
NEAR_TOP = 11.0  # w0 times the period: beyond, the exact motion comes within 30° of upright, where chaos begins
CONSERVED = 0.045  # times z² and the energy: a modified energy that moves less belongs to a regular orbit
ELLIPSE = 0.15  # relative: a conserved ellipse that changes less belongs to a regular orbit
HORIZON = 500  # periods
WANDER = 1e-9  # as far as rounding was seen to carry an energy error, in rotation where theta grows
AT_REST = -1 + 1e-9  # relative energy error: nothing is left
THROWN = 1.5  # h·w0: beyond, a method that is not symplectic may be thrown far, and back
SMALL = 0.7  # rad: swings to which the ellipse is applied
GONE = 1e6  # relative energy error of a bob in the plane: nothing brings it back


def stride(period: float, h: float) -> int:
    """Every how many steps of h [s] a Judge looks; `period` [s] is the exact motion's, or 2 pi/w0 if it has none."""
    return max(1, round(period / LOOKS / abs(h)))


class Judge:
    """Judges one method from a start on; another h needs another Judge."""

    def __init__(self, method: Method, model: Model, scale: float, h: float, period: float) -> None:
        """`h` [s] is the method's own step; `period` [s] is that of the exact motion, or 2 pi/w0 if it has none.

        Energy errors are relative to `scale` [s⁻²].
        """
        self._method, self._model, self._h, self._period = method, model, h, period
        self._scale = scale
        self._z, self._w0 = abs(h) * model.w0, model.w0
        self._width = max(LEAST_STEPS, round(period / abs(h)))  # steps of a bin, at first
        self._energy, self._modified = Bands(self._width), Bands(self._width)
        self._neighbours = Stretching(method, model, h)
        self._form = conserved_ellipse(method, h * self._w0)
        self._ellipse = (math.inf, 0.0)  # lowest and highest size seen
        self._omegas = (math.inf, -math.inf)  # rad/s
        self._first: Look | None = None
        self._before: Phase = (0.0, 0.0)
        self._steps = 0
        self.judgement = Judgement()

    def look(self, steps: int, look: Look) -> None:
        """Look at the method so many of its own steps after the first look; `stride` apart, or there is a gap."""
        phase = look.theta, look.omega
        if self._first is None:
            self._first, self._before = look, phase
            return
        if self._method.symplectic:
            self._follow(phase, steps - self._steps)
        self._before, self._steps = phase, steps
        full = self._energy.add(steps, look.low, look.high, look.error)
        if self._method.modified_energy is not None:
            value = self._modified_error(phase)
            self._modified.add(steps, value, value, value)
        if full and len(self._energy.bins) >= LEAST_BINS:
            self._judge()
        if not self._model.rigid and look.error > GONE:
            self.judgement = self.judgement._replace(verdict="grows")

    def fail(self, steps: int) -> None:
        """The method's numbers have ended, so many steps after the first look."""
        self.judgement = Judgement("failed", periods=steps * abs(self._h) / self._period)

    def _follow(self, phase: Phase, steps: int) -> None:
        """Follow neighbouring starts and the ellipse of small swings, for symplectic methods only."""
        self._omegas = min(self._omegas[0], phase[1]), max(self._omegas[1], phase[1])
        if self._form is not None:
            a, b, c = self._form
            theta = math.remainder(phase[0], math.tau) if self._model.turns else phase[0]
            omega = phase[1] / self._w0
            size = a * theta * theta + b * theta * omega + c * omega * omega
            self._ellipse = min(self._ellipse[0], size), max(self._ellipse[1], size)
        if self._z > QUIET and self._neighbours.steps < LYAPUNOV_STEPS and steps <= 2 * stride(self._period, self._h):
            self._neighbours.carry(self._before, steps)

    def _modified_error(self, phase: Phase) -> float:
        """How far the modified energy is from the start's, relative to the energy like energy errors."""
        function, first = self._method.modified_energy, self._first
        assert function is not None
        assert first is not None
        start = function(self._model, (first.theta, first.omega), self._h)
        value = (function(self._model, phase, self._h) - start) / self._scale
        return value if math.isfinite(value) else math.inf

    def _judge(self) -> None:
        flat = self._method.symplectic and self._is_conserved()
        bands = self._modified if flat and len(self._modified.bins) >= LEAST_BINS else self._energy
        rate, spread = bands.line()
        whole = rate / abs(self._h), spread / abs(self._h)
        recent = bands.recent(RECENT) if len(bands.bins) >= MOST_BINS / 2 else bands.bins
        slope, uncertainty = (abs(1 / self._h) * value for value in bands.line(recent))
        periods = self._steps * abs(self._h) / self._period
        verdict = self._symplectic(flat, periods) if self._method.symplectic else self._other(whole, periods)
        finite = math.isfinite(slope) and math.isfinite(uncertainty)
        lyapunov = None
        if verdict in ("chaotic", "wanders") and self._neighbours.steps:
            lyapunov = self._neighbours.log / self._neighbours.steps / abs(self._h)
        significant = abs(slope) > 3 * uncertainty
        self.judgement = Judgement(
            verdict,
            slope if finite else None,
            uncertainty if finite else None,
            significant=significant,
            periods=periods,
            lyapunov=lyapunov,
        )

    def _is_conserved(self) -> bool:
        """Whether the modified energy hardly moves; the energy of velocity Verlet wobbles by z²/4 in small swings."""
        moved = (self._modified.high - self._modified.low) * self._scale
        energy = min(self._scale, 2 * self._model.w0_squared)
        return bool(self._modified.bins) and moved <= max(CONSERVED * self._z**2 * energy, FLOOR * self._scale)

    def _symplectic(self, conserved: bool, periods: float) -> Verdict:
        neighbours, far = self._neighbours, self._w0 * self._period
        # neighbours part in proportion to time, and by 1/k'² or so in the first swing past upright
        if neighbours.steps and neighbours.log > 15 + math.log(neighbours.steps) + far / 2:
            free = (self._omegas[1] - self._omegas[0]) * abs(self._h) > math.tau
            return "wanders" if free else "chaotic"
        if self.judgement.verdict in ("bounded", "chaotic", "wanders"):
            return self.judgement.verdict
        low, high = self._ellipse
        small = self._form is not None and high < self._form[0] * SMALL**2 and high - low < ELLIPSE * (high + low)
        regular = self._z <= QUIET or (far < NEAR_TOP and (self._z <= FENCED or conserved or small))
        if regular and periods >= LEAST_PERIODS and self._steps >= LEAST_BINS * LEAST_STEPS:
            return "bounded"
        if neighbours.steps >= LONG and neighbours.log < 5 + math.log(neighbours.steps):
            return "grows" if self._has_left() and self._energy.low > 1 else "bounded"
        return "too early"

    def _other(self, line: tuple[float, float], periods: float) -> Verdict:
        assert self._first is not None
        slope, uncertainty = line
        bands, verdict, left = self._energy, self.judgement.verdict, self._has_left()
        if hull(bands.recent(0.25))[1] < AT_REST:
            return "loses"
        low, high = hull(bands.recent(0.25))
        many = self._steps >= max(MOST_BINS * self._width, LONG)
        longer = self._steps >= max(MOST_BINS * self._width, 4 * LONG)
        if many and (spread := self._spread()):
            known = verdict not in ("too early", "bounded")
            one_band = spread < (2.0 if verdict == "wanders" or not longer else 3.0)
            away = self._gap(low, high)
            if one_band and abs((low + high) / 2 - self._first.error) > WANDER and (known or away > (high - low) / 8):
                return "caught"
            if longer and spread > 4.5 and 0.25 < rising(bands.recent(0.5)) < 0.75:
                return "wanders"
        if verdict in ("caught", "wanders") or (verdict in ("grows", "loses") and self._is_away(low, high)):
            return verdict
        if left:
            return left
        reach = (abs(slope) + 3 * uncertainty) * self._steps * abs(self._h)
        significant = abs(slope) > 3 * uncertainty and reach > 10 * FLOOR
        near = reach < bands.width / 2 * min(1, periods / HORIZON)
        if many and ((not significant and near and self._gap(low, high) < WANDER) or verdict == "bounded"):
            return "bounded"
        return "too early"

    def _has_left(self) -> Verdict | None:
        """The direction in which the last quarter has left the start, if it has."""
        assert self._first is not None
        bands = self._energy
        low, high = hull(bands.recent(0.25))
        gap, width = self._gap(low, high), max(high - low, FLOOR)
        if gap < (width / 16 if gap > 1 else width / 2) or (gap < WANDER and not steady(bands.bins)):
            return None
        if self._period < 3 * abs(self._h) and gap <= 1:  # fewer than three steps a turn beat with it, for long
            return None
        if self._z > THROWN:
            share = rising(bands.bins)
            if len(bands.bins) < 24 or 0.1 < share < 0.9:
                return None
        return "grows" if low > self._first.error else "loses"

    def _gap(self, low: float, high: float) -> float:
        """How far a band is from the start's error; below 0 inside."""
        assert self._first is not None
        return max(low - self._first.error, self._first.error - high)

    def _is_away(self, low: float, high: float) -> bool:
        """Whether a band is centred elsewhere than on the start's error."""
        return self._gap(low, high) > -(high - low) / 4

    def _spread(self) -> float | None:
        """How many typical bins the band of the second half is wide: about 1 where it is one band; None if it moves."""
        half = self._energy.recent(0.5)
        middle = len(half) // 2
        (low, high), (late_low, late_high) = hull(half[:middle]), hull(half[middle:])
        width = max(high, late_high) - min(low, late_low)
        typical = median(bin_.high - bin_.low for bin_ in half)
        if steady(half):
            return None
        if width < 0.1 * (1 + min(low, late_low)) and self._gap(late_low, late_high) > 10 * width:
            return 1.0  # narrow beside the way that it went
        spread = width / max(typical, FLOOR)
        moved = max(abs(late_low - low), abs(late_high - high))
        return max(spread, 4.0) if moved > width / 4 else spread
