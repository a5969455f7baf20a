"""The input of a Judge, a Look, and its output, a Judgement."""

from typing import Literal, NamedTuple, get_args

Verdict = Literal["too early", "bounded", "loses", "grows", "chaotic", "caught", "wanders"]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)


class Judgement(NamedTuple):
    """The verdict on an energy error so far; no slope before there are four bins."""

    verdict: Verdict = "too early"
    slope: float | None = None  # recent mean change of the relative energy error [1/s]
    uncertainty: float | None = None  # standard deviation of the slope [1/s]
    periods: float = 0.0  # how many periods this rests on
    lyapunov: float | None = None  # 1/s; given where the verdict rests on it
    seconds: float = 0.0  # for which the slope was measured

    @property
    def trend(self) -> float | None:
        """The slope where it is significant; what stays in a band, or wanders about, has none."""
        if self.slope is None or self.uncertainty is None or self.verdict not in ("too early", "grows", "loses"):
            return None
        return self.slope if abs(self.slope) > 3 * self.uncertainty else None


class Look(NamedTuple):
    """A method at one step."""

    theta: float  # rad
    omega: float  # rad/s
    error: float  # relative, of the energy
    low: float  # the smallest and the largest since the look before
    high: float
