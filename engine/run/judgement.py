"""All thresholds, and what judges take and note."""

import math
from typing import Literal, NamedTuple

from pendu_tui.engine.methods import Method
from pendu_tui.engine.run.verdicts import UNDECIDED

# Thresholds for a method in a run.  z is h·w0 times the longest substep; errors are relative energy
# errors.
# Theorems:
# z: chaos is thinner than exp(-pi²/z): Gelfreich & Lazutkin, Russ. Math. Surv. 56 (2001)
REGULAR_Z = 0.25
FENCED_Z = 0.9  # invariant curves fence orbits in; the last breaks at 0.9857: Greene (1979)
MIN_STEPS_A_TURN = 4  # Nyquist: the error oscillates twice a turn, and beats with fewer steps
ESCAPED_ERROR = 1e6  # no force brings the bob back from there, if the model has no way over the top
NEAR_TOP = 11.0  # w0·period: longer swings come within 30° of upright, where fences break first
# Rounding:
WALK = 32.0  # roundings: eight standard deviations of a random walk of sixteen a step
REFERENCE_ERROR = 1e-9  # of ln(E/E_true): ten times the error of the true motion
MIN_AMPLITUDE = 1e5  # roundings of theta: a smaller damped amplitude is rounded by more than 1e-5
ROUNDING = 1e-12  # of an energy: a million roundings, or a random walk of 1e7
AT_REST = -1 + 1e-9  # an error: nothing is left to lose
# Risk of error: none of 3 300 runs of a million steps was judged wrongly.
LOOKS = 8  # a period: twice the Nyquist rate of the error's second harmonic
MIN_PERIODS = 8  # before a theorem is applied: the orbit has then shown its band
MIN_BINS = 4  # for a line with two degrees of freedom
MIN_BIN_STEPS = 16  # beyond z = 0.4 a swing has fewer, and their extremes miss those of the band
MIN_ONE_WAY = 0.9  # share of moves from bin to bin that makes a straight course
MAX_ONE_WAY = 0.75  # likewise, of wandering: 1 of 300 random walks of 32 bins has more
STEADY_SIGMAS = 5.0  # 5 to 10 of 100 random walks have a steeper line
STRAIGHT_BINS = 24  # of which a random walk goes 9 in 10 the same way once in 60 000
LONG = 4096  # steps that show regularity: chaos separates by e^15 with a Lyapunov number of 0.004
CHAOTIC_SEPARATION = 15.0  # ln, beyond that of regular neighbours
REGULAR_SEPARATION = 5.0  # ln, beyond proportion to time
LYAPUNOV_STEPS = 100_000  # neighbours are followed for so long: tenths of a second in plain Python
SLOPE_SIGMAS = 3.0  # one false slope in 370
HORIZON = 500  # periods for which the slope must leave a bounded error in its band
LEFT = 0.5  # widths: a band so far from the start has left it
RETURNED = 0.25  # widths: a band that reaches so far beyond the start has come back
ONE_BAND = 2.0  # typical widths: half a run that stays in one band is narrower
NO_BAND = 4.5  # typical widths: one that wanders is wider, as are random walks of 32 bins

# Thresholds for the record of any program.  Standard deviations and likelihood ratios are those of
# white noise; tests/bench/foreign.py measures the errors in other noises.
MIN_SAMPLES = 64  # 32 blocks: a line, a wave and a noise leave 25 degrees of freedom
MIN_INDEPENDENT = 30  # correlation times: with fewer, noise and a curve look alike
LEVEL_SIGMAS = 2.0  # 1 or 2 of 100 records of a level have a steeper line
TREND_SIGMAS = 3.3  # 1 of 1000 records of a level has a clearer trend
LINE_SIGMAS_OF_FEW = 8.0  # 2 or 3 of 1000 random walks have a steeper line
CURVE_SIGMAS_OF_FEW = 12.0  # 1 of 1000 random walks has a clearer curve
ODDS = math.log(100)  # of a likelihood ratio: wrong in 1 of 100 where both are as common
WALK_ODDS = math.log(10)  # of a random walk against a level
WAVE_GAIN = 12.0  # of a log likelihood: a wave in a random walk gains up to 10
MIN_CYCLES = 4.0  # of a wave that is called bounded: thirds of the record look alike
TRANSIENT = 0.1  # of the record: a start that is over so early belongs to the preparation
LOST = 0.01  # of the first energy: an energy that falls below has been lost
MULTIPLIED = 10.0  # largest over smallest energy: above, the logarithm is judged, too
WIDENING = 3.0  # fluctuations at the end over those at the start: above, they stay in no band


class LookPoint(NamedTuple):
    """A method at a step where its judge looks."""

    step: int  # own steps since judging began
    error: float  # relative, signed
    low: float  # smallest and largest error since the previous look point
    high: float
    theta: float = 0.0  # rad, perhaps reduced by whole turns
    omega: float = 0.0  # rad/s
    energy: float = 1.0  # s⁻²


MilestoneKind = Literal["over the top", "failed", "verdict", "errors cross"]


class Milestone(NamedTuple):
    """A method goes over the top, fails, gets a verdict, or its error passes another's for good."""

    kind: MilestoneKind
    method: Method
    step: int
    t: float  # s, simulated
    energy_error: float  # relative, at this step
    verdict: str = UNDECIDED
    other: Method | None = None  # whose error was passed
    # of a new verdict:
    trend: float | None = None  # 1/s
    lyapunov: float | None = None  # 1/s
