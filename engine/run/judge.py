"""Judge the methods of a run by their energy errors, and note the run's milestones.

The lockstep shows each method to its judge at look points, a fixed number of steps apart, so a
verdict depends on the scene, the stepping and the step alone.  The core judges the energy error in
bins.  What is known of a method adds evidence:

- A symplectic method can neither gain nor lose energy for good.  Its orbit is regular, and so
  `bounded`, where a theorem says so or neighbouring starts separate no faster than in proportion
  to time, and `chaotic` where they separate exponentially.  A linear map is never chaotic.
- The error of any other method is exactly 0 at the start, and drifts sooner or later: it is
  `bounded` only if it would stay in its band for ten times as long.
"""

import copy
import math
from collections.abc import Sequence
from itertools import pairwise, permutations
from typing import TYPE_CHECKING, NamedTuple, Self

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run import levels
from pendu_tui.engine.run.tangent import Stretching, at_bottom
from pendu_tui.engine.run.verdicts import (
    BOUNDED,
    CHAOTIC,
    FAILED,
    GROWS,
    LEAVES,
    LOSES,
    UNDECIDED,
    Judgement,
    Milestone,
    MilestoneKind,
    Progress,
)

if TYPE_CHECKING:
    from pendu_tui.engine.run.core import Bins


class LookPoint(NamedTuple):
    """A method at a step where its judge looks."""

    step: int  # own steps since judging began
    error: float  # relative, signed
    low: float  # smallest and largest error since the previous look point
    high: float
    theta: float = 0.0  # rad, perhaps reduced by whole turns
    omega: float = 0.0  # rad/s
    energy: float = 1.0  # s⁻²


def stride(period: float, h: float) -> int:
    """Return how many steps of h [s] lie between two look points.

    `period` [s] is the exact motion's, or 2 pi/w0 if it has none.
    """
    return max(1, round(period / levels.LOOKS / abs(h)))


class _Bin(NamedTuple):
    """A part of a run."""

    step: float  # its middle
    mean: float  # of the errors at its look points
    low: float
    high: float

    def joined(self, other: "_Bin") -> "_Bin":
        """Return the bin of both, which are equally long."""
        step = (self.step + other.step) / 2
        mean = (self.mean + other.mean) / 2
        return _Bin(step, mean, min(self.low, other.low), max(self.high, other.high))


class Bands:
    """The bins of a run, in constant memory: at first one a look point; 64 merge pairwise.

    `bins` is replaced and never changed in place, so `copy.copy` makes an independent copy.
    """

    def __init__(self) -> None:
        self.bins: list[_Bin] = []
        self._open: list[_Bin] = []
        self._size = 1  # look points in a bin

    def add(self, each: _Bin) -> bool:
        """Add a look point; return whether a bin is full."""
        self._open = [*self._open, each]
        if len(self._open) < self._size:
            return False
        while len(self._open) > 1:
            self._open = _merged(self._open)
        self.bins = [*self.bins, *self._open]
        self._open = []
        if len(self.bins) == levels.MAX_BINS:
            self.bins = _merged(self.bins)
            self._size *= 2
        return True

    def recent(self) -> tuple[float, float]:
        """Return the lowest and the highest value of the last quarter of the bins."""
        last = self.bins[-max(1, len(self.bins) // 4) :]
        return min(each.low for each in last), max(each.high for each in last)

    @property
    def one_way(self) -> float:
        """The share of moves from bin to bin that go the more common way: 0.5 to 1."""
        middles = [each.low + each.high for each in self.bins]
        rising = sum(a < b for a, b in pairwise(middles))
        falling = sum(a > b for a, b in pairwise(middles))
        return 0.5 + abs(rising - falling) / max(len(middles) - 1, 1) / 2

    def as_bins(self, h: float, rounding: float) -> "Bins":
        """Return the bins for the core, in seconds."""
        import numpy as np  # a run begins without it

        from pendu_tui.engine.run.core import Bins

        steps, means, lows, highs = np.array(self.bins).T
        spreads = (highs - lows) / math.sqrt(8)  # those of a sine
        return Bins(steps * h, means, lows, highs, spreads, rounding)


def _merged(bins: list[_Bin]) -> list[_Bin]:
    return [a.joined(b) for a, b in zip(bins[::2], bins[1::2], strict=True)]


class Judge:
    """The judge of one method from a start on."""

    def __init__(self, h: float, period: float, method: Method, model: Model) -> None:
        """`h` [s] is the method's step; `period` [s] as in `stride`."""
        self.judgement = Judgement()
        self.peak = 0.0  # the largest |error| of all steps so far
        self._h = abs(h)
        self._period = period
        self._last: LookPoint | None = None
        self._start_error = 0.0  # at the first look point; bands are relative to it
        self._judged = 0  # the step of the last judgement
        self._bands = Bands()
        self._conserved = model.conserves_energy  # else errors are ln(E/E_true)
        self._epsilon = method.epsilon
        self._min_energy = (levels.MIN_AMPLITUDE * method.epsilon * model.w0) ** 2  # s⁻²
        self._returns = method.symplectic
        # the band of an error that beats with the steps may leave the start and come back
        fastest_turn = min(period, math.tau / model.w0) if model.turns else math.inf
        self._may_beat = fastest_turn < levels.MIN_STEPS_A_TURN * self._h
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
        """Take in the next look point; one step in eight or fewer brings a new judgement."""
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
        start = self._start_error
        step = (self._last.step + point.step) / 2
        self._last = point
        self.peak = max(self.peak, -point.low, point.high)
        full = self._bands.add(
            _Bin(step, point.error - start, point.low - start, point.high - start)
        )
        is_due = self._swings >= levels.MIN_SWINGS and point.step >= levels.LONGER_BY * self._judged
        if full and is_due and len(self._bands.bins) >= levels.MIN_BINS:
            self._judged = point.step
            self.judgement = self._judgement()
        if self._orbit:
            self._follow(self._orbit)
        if self.judgement.verdict == UNDECIDED:
            progress = self._progress()
            reason = str(progress or self.judgement.reason)
            self.judgement = self.judgement._replace(progress=progress, reason=reason)
        self.judgement = self.judgement._replace(periods=self._swings)
        if self._may_escape and point.error > levels.ESCAPED_ERROR:
            self.judgement = self.judgement._replace(verdict=GROWS, progress=None, reason="")

    def fail(self, steps: int) -> None:
        """Note that the numbers have ended, so many steps after the first look point."""
        self.judgement = Judgement(FAILED, periods=steps * self._h / self._period)

    @property
    def _steps(self) -> int:
        return self._last.step if self._last else 0

    @property
    def _swings(self) -> float:
        return self._steps * self._h / self._period

    @property
    def _rounding(self) -> float:
        """How far roundings may have carried the error by now."""
        walk = levels.WALK * self._epsilon * math.sqrt(self._steps)
        return walk if self._conserved else max(walk, levels.REFERENCE_ERROR)

    def _judgement(self) -> Judgement:
        from pendu_tui.engine.run.core import growth_of, judge_bins, measure_bins

        bins = self._bands.as_bins(self._h, self._rounding)
        if self._orbit:
            measured = measure_bins(bins)
            return measured._replace(verdict=self.judgement.verdict, is_evident=False)
        found = self._checked(judge_bins(bins, steady=True))
        if found.verdict == GROWS:
            found = found._replace(growth=growth_of(bins))
        return found

    def _follow(self, orbit: "_Orbit") -> None:
        """Give the verdict that is known of an orbit."""
        verdict = orbit.verdict(self.judgement.verdict, self.peak, self._swings)
        lyapunov = None
        if verdict == CHAOTIC and orbit.steps:
            lyapunov = orbit.log / orbit.steps / self._h
        found = self.judgement._replace(verdict=verdict, lyapunov=lyapunov)
        if verdict != UNDECIDED:
            found = found._replace(progress=None, reason="")
        self.judgement = found

    def _checked(self, found: Judgement) -> Judgement:
        """Return a judgement of the core, or what is known better of this run."""
        low, high = self._bands.recent()
        if self._conserved and high + self._start_error < levels.AT_REST:
            return found._replace(verdict=LOSES, reason="")
        leaves = found.verdict in LEAVES
        if leaves and self._returns:
            return found._replace(verdict=UNDECIDED, reason=levels.RETURNS)
        straight = self._steps >= levels.LONG and self._bands.one_way >= levels.MIN_ONE_WAY
        if leaves and self._may_beat and not straight:
            return found._replace(verdict=UNDECIDED, reason=levels.BEATS)
        away = max(low, -high)  # how far the present band is from the start
        if found.verdict == BOUNDED and away > max(levels.LEFT * (high - low), self._rounding):
            return found._replace(verdict=GROWS if low > 0 else LOSES, rests=True)
        if found.verdict == BOUNDED and away > self._rounding:
            return found._replace(verdict=UNDECIDED, reason=levels.NEAR)
        if found.verdict == BOUNDED and self._steps < levels.LONG:
            return found._replace(verdict=UNDECIDED, reason=levels.SHORT)
        before = self.judgement.verdict
        if found.verdict == UNDECIDED and before in LEAVES:
            beyond = low if before == GROWS else -high
            if beyond > -levels.AWAY * (high - low):
                return found._replace(verdict=before, reason="")
        return found

    def _progress(self) -> Progress | None:
        """Return how far it is to the first possible verdict, or else to the last one.

        None: a verdict can come any time.
        """
        steps_a_period = self._period / self._h
        long = levels.LONG / steps_a_period
        if self._orbit:
            need = float(levels.MIN_PERIODS) if self._orbit.is_regular else long
        elif self._swings < levels.MIN_SWINGS and not self._may_beat:
            need = float(levels.MIN_SWINGS)
        else:
            need = long
        if self._swings >= need:
            return None
        return Progress(int(self._swings), math.ceil(need), "swings")


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
        needed = self._z > levels.REGULAR_Z and not self._linear
        if needed and self.steps < levels.LYAPUNOV_STEPS:
            self.carry((previous.theta, previous.omega), point.step - previous.step)

    @property
    def is_regular(self) -> bool:
        """Whether a theorem keeps the orbit from chaos."""
        if self._linear:
            return self._stable
        turn_a_step = max(-self._min_omega, self._max_omega) * abs(self._h)  # rad
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
        for method, judge, point in zip(self._cast, self._judges, points, strict=True):
            if point is None:
                continue
            previous = judge.judgement.verdict
            judge.look(point)
            now = judge.judgement
            if now.verdict != previous:
                verdict = Milestone("verdict", method, step, t, point.error, now.verdict)
                self.milestones.append(verdict._replace(trend=now.trend, lyapunov=now.lyapunov))
        self._note_crossings(step, t, points)

    def _note_crossings(self, step: int, t: float, points: Sequence[LookPoint | None]) -> None:
        for (index, leaving), (other, bounded) in permutations(enumerate(self._judges), 2):
            leaves = leaving.judgement.verdict in LEAVES
            stays = bounded.judgement.verdict == BOUNDED and bounded.peak > levels.ROUNDING
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

    def fail(self, index: int, steps: int) -> None:
        """Note that a method's numbers have ended, so many of its steps after the restart."""
        self._judges[index].fail(steps)
