"""Verdicts and their definitions, the table of thresholds, a judge's input and its judgement."""

import math
from typing import Literal, NamedTuple, get_args

from engine.methods import Method

Verdict = Literal[
    "bounded", "grows", "loses", "chaotic", "caught", "wanders", "failed", "too early"
]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)

DEFINITIONS: dict[Verdict, str] = {
    "bounded": "the energy stays in a band around its start, without a trend",
    "grows": "the energy rises and no longer comes back to its start",
    "loses": "the energy falls and no longer comes back to its start",
    "chaotic": "nearby starts separate exponentially, and the energy stays in a band",
    "caught": "the energy has left its start and stays in another band",
    "wanders": "the energy goes far up and down, without a trend and in no band",
    "failed": "the numbers have ended: nan, infinite, or too large for a double",
    "too early": "the data do not support one of these yet",
}
"""One definition of each verdict, for the help, the README and every judge."""

FALSE_ALARMS: dict[Verdict, float] = {
    "bounded": 0.6,
    "grows": 0.5,
    "loses": 0.4,
    "caught": 0.8,
    "wanders": 6.3,
}
"""How many of 100 such verdicts on energies alone are wrong, by tests/bench/foreign.py."""


# A method in a run.  z = h·w0, times a method's longest substep; errors are relative energy errors.
# Theorems:
# z: chaos is thinner than exp(-pi²/z): Gelfreich & Lazutkin, Russ. Math. Surv. 56 (2001)
QUIET = 0.25
FENCED = 0.9  # z: below, invariant curves fence orbits in; the last breaks at 0.9857: Greene (1979)
MIN_STEPS_A_TURN = 4  # Nyquist for the error, which turns twice as often: fewer beat with it
GONE = 1e6  # an error from which no force brings a bob back, where there is no way over the top
NEAR_TOP = 11.0  # w0·period: longer swings come within 30° of upright, where fences break first
# Rounding:
WALK = 32.0  # roundings: eight standard deviations of a random walk of sixteen a step
REFERENCE = 1e-9  # of ln(E/E_true): ten times the error of the true motion
ABOVE = 1e5  # times the rounding of theta: 1e-5 of a damped amplitude is rounding then
ROUNDING = 1e-12  # of an energy: a million roundings, or a random walk of 1e7
AT_REST = -1 + 1e-9  # an error: nothing is left to lose
# Risk of error: none wrong in 3 300 runs of a million steps.
LOOKS = 8  # a period: Nyquist for the second harmonic of the error, twice over
MIN_PERIODS = 8  # for a theorem to be applied: the orbit has then shown its band
MIN_BINS = 4  # for a line with two degrees of freedom
MIN_BIN_STEPS = 16  # beyond z = 0.4 a swing has fewer, and their extremes miss those of the band
ONE_WAY = 0.9  # of the moves from bin to bin
NO_WAY = 0.75  # of the moves: so many of 31 go one way in 1 of 300 random walks
STEADY = 5.0  # standard deviations: 5 to 10 of 100 random walks have a steeper line
STRAIGHT_BINS = 24  # of which a random walk goes 9 in 10 the same way once in 60 000
LONG = 4096  # steps that show regularity: chaos separates by e^15 with a Lyapunov number of 0.004
APART = 15.0  # ln of separation beyond that of regular neighbours: chaos
TOGETHER = 5.0  # ln of separation beyond proportion to time: still regular
LYAPUNOV_STEPS = 100_000  # neighbours are followed for so long: tenths of a second in plain Python
SIGMAS = 3.0  # of Student's t for a slope: one false trend in 370
HORIZON = 500  # periods for which a bounded error is to stay in its band
AWAY = 0.5  # of its width: a band so far from the start has left it
BACK = 0.25  # of its width: a band that reaches so far beyond the start has come back
ONE_BAND = 2.0  # typical bins are as wide as the half of a run that lies in one band
NO_BAND = 4.5  # of one that does not; random walks of 32 bins are wider

# A record of any program.  Standard deviations and likelihood ratios are those of white noise;
# tests/bench/foreign.py measures the errors in other noises.
MIN_SAMPLES = 64  # 32 blocks: a line, a wave and a noise leave 25 degrees of freedom
MIN_INDEPENDENT = 30  # correlation times: with fewer, noise and a curve look alike
STILL = 2.0  # standard deviations: a level exceeds them in 1 or 2 of 100 records
TREND = 3.3  # standard deviations: a level exceeds them in 1 of 1000 records
LINE_OF_FEW = 8.0  # standard deviations: 2 or 3 of 1000 random walks have a steeper line
CURVE_OF_FEW = 12.0  # standard deviations: 1 in 1000 random walks has a clearer curve
ODDS = math.log(100)  # of a likelihood ratio: wrong in 1 of 100 where both are as common
WALK_ODDS = math.log(10)  # of the likelihood ratio of a random walk and a level
WAVE = 12.0  # of a likelihood ratio: a wave in a random walk gains up to 10
MIN_CYCLES = 4.0  # of a wave that is called bounded: thirds of the record look alike
TRANSIENT = 0.1  # of the record: a start that is over so early belongs to the preparation
LOST = 0.01  # of the first energy: losing all of it is no other level
MULTIPLIED = 10.0  # times the smallest energy: what multiplies is judged in its logarithm
WIDENING = 3.0  # times as much as at its start: what fluctuates so at its end is in no band


class LookPoint(NamedTuple):
    """The energy error of a method, or of any program, at a step where its judge looks."""

    step: int  # own steps (or samples) since judging began
    error: float  # relative, signed
    low: float  # the smallest and the largest since the look point before
    high: float
    theta: float = 0.0  # rad, perhaps less whole turns; of a method only, as are the others
    omega: float = 0.0  # rad/s
    energy: float = 1.0  # s⁻²


class Progress(NamedTuple):
    """How far it is to a verdict: "4 of 8 swings"."""

    have: int
    need: int
    unit: str  # "swings", "steps", "independent samples"

    def __str__(self) -> str:
        return f"{self.have} of {self.need} {self.unit}"


class Judgement(NamedTuple):
    """A verdict on energies so far, and their slope if there is evidence for one."""

    verdict: Verdict = "too early"
    slope: float | None = None  # mean change of the relative energy error per unit of time [1/s]
    uncertainty: float | None = None  # standard deviation of the slope
    periods: float = 0.0  # how many periods the verdict rests on
    lyapunov: float | None = None  # 1/s; only where the verdict rests on it
    progress: Progress | None = None  # only while it is too early
    growth: float | None = None  # 1/s, of the logarithm of the error; only beyond E0
    # of a whole record, in its own units
    transient: float = 0.0  # time at the start that was left out
    first: int = 0  # the index of the first sample that was judged
    independent: float = 0.0  # correlation times in the record
    fluctuation: float | None = None  # standard deviation about a line

    def __str__(self) -> str:
        """Return the verdict, with the progress to it if it is too early for one."""
        return f"{self.verdict}: {self.progress}" if self.progress else self.verdict


MilestoneKind = Literal["over the top", "failed", "verdict", "errors cross"]


class Milestone(NamedTuple):
    """A method went over the top, failed, got a verdict, or its error passed another's for good."""

    kind: MilestoneKind
    method: Method
    step: int
    t: float  # s, simulated
    energy_error: float  # relative, at this step
    verdict: Verdict = "too early"
    other: Method | None = None  # the method whose error was passed
    trend: float | None = None  # 1/s; with a verdict, as are the others
    lyapunov: float | None = None  # 1/s
