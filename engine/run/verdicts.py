"""The verdicts on energies: words, how they are shown, what a judge returns, and its limits.

This is the only place that spells a verdict; everything else names its constant or reads VERDICTS.
"""

import math
from typing import Final, Literal, NamedTuple

from pendu_tui.engine.methods import Method

BOUNDED: Final = "bounded"
GROWS: Final = "grows"
LOSES: Final = "loses"
CHAOTIC: Final = "chaotic"
FAILED: Final = "failed"
UNDECIDED: Final = "undecided"

TOO_LARGE = 1e300
"""An energy as large has failed: squares and differences overflow."""

LEAVES = (GROWS, LOSES)
"""The verdicts on an energy that has left its start for good."""


class Verdict(NamedTuple):
    """A verdict, and how it is shown."""

    word: str
    sign: str  # before the word, for those who cannot tell colours
    ink: Literal["good", "text", "warn", "quiet"]
    meaning: str


VERDICTS: dict[str, Verdict] = {
    verdict.word: verdict
    for verdict in (
        Verdict(
            BOUNDED,
            sign="=",
            ink="good",
            meaning="the energy stays in a band; any drift adds up to less than the band's width",
        ),
        Verdict(
            GROWS,
            sign="+",
            ink="text",
            meaning="the mean energy has risen for good; if it has levelled off, "
            "the trend shown starts there",
        ),
        Verdict(
            LOSES,
            sign="-",
            ink="text",
            meaning="the mean energy has fallen for good; if it has levelled off, "
            "the trend shown starts there",
        ),
        Verdict(
            CHAOTIC,
            sign="!",
            ink="text",
            meaning="only in runs of a symplectic method: nearby trajectories separate "
            "exponentially",
        ),
        Verdict(
            FAILED,
            sign="!",
            ink="warn",
            meaning="the computation has broken down: a value is nan, infinite or too large, "
            "or a step has no solution",
        ),
        Verdict(
            UNDECIDED,
            sign="",
            ink="quiet",
            meaning="the data do not yet support any of these; the reason says what is missing",
        ),
    )
}


def direction(change: float) -> str:
    """Return the verdict of an energy that changes for good."""
    if change > 0:
        return GROWS
    return LOSES


class Progress(NamedTuple):
    """How far it is to a verdict: "4 of 8 cycles"."""

    have: int
    need: int
    unit: str  # "cycles", "steps", "samples"

    def __str__(self) -> str:
        return f"{self.have} of {self.need} {self.unit}"


class Judgement(NamedTuple):
    """A verdict on energies so far, with the slope of their mean, and what is known about it.

    Slopes are relative energy errors per second in a run, and in a record's own units.
    """

    verdict: str = UNDECIDED
    slope: float | None = None
    uncertainty: float | None = None  # of the slope: 68 % lie within
    lyapunov: float | None = None  # 1/s, where the verdict rests on it
    progress: Progress | None = None  # while it is known what is missing
    bound: float | None = None  # |slope| is below it with a probability of 99 %
    share: float | None = None  # what the slope adds up to so far, over the width of the band
    reason: str = ""  # of `undecided`: what is missing, and whether a longer record helps
    is_evident: bool = False  # the slope stands out from 0
    rests: bool = False  # the energy stays in another band than at first
    independent: float = 0.0  # samples
    fluctuation: float | None = None  # standard deviation about a line

    @property
    def trend(self) -> float | None:
        """The slope, if there is evidence for one, and the energy is not bounded."""
        return self.slope if self.is_evident and self.verdict not in (BOUNDED, CHAOTIC) else None

    def scaled(self, factor: float) -> "Judgement":
        """Return the judgement of energies multiplied by a factor."""
        names = ("slope", "uncertainty", "bound", "fluctuation")
        values = {name: getattr(self, name) for name in names}
        return self._replace(**{name: v and v * factor for name, v in values.items()})

    def __str__(self) -> str:
        missing = self.progress or self.reason
        return f"{self.verdict}: {missing}" if missing else self.verdict


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


LONGEST = 1e4  # a record of this many times the length is no advice


def not_within(
    limit: float, name: str, slope: float | None, bound: float | None, sign: float = 1.0
) -> str:
    """Return why a slope may be above a limit; "" if its bound of 99 % rules that out.

    With `sign` -1: below it.  The uncertainty of a slope in white noise falls like length**-1.5.
    """
    if slope is None or bound is None or not math.isfinite(slope + bound):
        return f"cannot tell: {name} is not known"
    margin = max(0.0, bound - abs(slope))
    excess = sign * (slope - limit)
    if excess + margin <= 0:
        return ""
    if excess > margin:
        side = {1.0: "above", -1.0: "below"}[sign]
        return f"{name} is {slope:.3g}, {side} {limit:g}"
    advice = "a longer record may not help"
    if excess:
        longer = math.ceil((margin / abs(excess)) ** (2 / 3))
        if longer <= LONGEST:
            advice = f"a record about {longer} times as long would settle it"
    return f"cannot tell: {name} is {slope:.3g} ± {margin:.1g} at 99 %; {advice}"
