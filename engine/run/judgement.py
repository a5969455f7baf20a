"""The vocabulary of judging: verdicts with their definitions, what a judge is fed, and what it returns."""

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
    """The verdict on an energy error up to a look point, and its slope as far as there is evidence for one."""

    verdict: Verdict = "too early"
    slope: float | None = None  # mean change of the relative energy error per unit of time [1/s]
    uncertainty: float | None = None  # standard deviation of the slope
    significant: bool = False  # the slope differs from 0 by the test of Student's t
    periods: float = 0.0  # how many periods the verdict rests on
    lyapunov: float | None = None  # 1/s; only where the verdict rests on it
    progress: Progress | None = None  # only while it is too early
    growth: float | None = (
        None  # 1/s, of the logarithm of the error; only beyond the initial energy
    )

    def __str__(self) -> str:
        """Return the verdict, with the progress to it if it is too early for one."""
        return f"{self.verdict}: {self.progress}" if self.progress else self.verdict

    @property
    def trend(self) -> float | None:
        """The slope where it is significant and goes the verdict's way; what stays in a band, or wanders, has none."""
        if self.slope is None or not self.significant:
            return None
        ways = {"grows": self.slope > 0, "loses": self.slope < 0, "too early": True}
        return self.slope if ways.get(self.verdict) else None


MilestoneKind = Literal["over the top", "failed", "verdict", "errors cross"]


class Milestone(NamedTuple):
    """A method went over the top, failed, was given a verdict, or its error passed another's for good."""

    kind: MilestoneKind
    method: Method
    step: int
    t: float  # s, simulated
    energy_error: float  # relative, at this step
    verdict: Verdict = "too early"
    other: Method | None = None  # the method whose error was passed
    trend: float | None = None  # 1/s; with a verdict, as are the others
    lyapunov: float | None = None  # 1/s
