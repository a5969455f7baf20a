"""What the methods do, in sentences.  Each says only what was measured; a forecast extends a measured drift."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from engine.methods import METHODS, Method
from engine.run.observer import Milestone
from tui.playback.source import Source

LARGEST_BAND = 0.2
"""Of the energy: beyond, what is lost on the way there changes the drift itself."""
LONGEST = 1000 * 86400.0  # s; further ahead nobody waits


class Forecast(NamedTuple):
    """When a method that drifts will have a larger energy error than one that stays within a band."""

    seconds: float  # from now on, simulated
    other: Method


def short(method: Method) -> str:
    """The last word of a method's name, where no other ends with it: "Verlet", but "Symplectic Euler"."""
    last = method.label.split()[-1]
    return last if sum(each.label.endswith(last) for each in METHODS) == 1 else method.label


def listed(names: Sequence[str]) -> str:
    """As "A", "A and B", "A, B and C"."""
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def about(seconds: float) -> str:
    """A duration with two digits or so: "40 s", "32 min", "8.4 h", "12 days"."""
    units = (("days", 86400), ("h", 3600), ("min", 60), ("s", 1))
    unit, size = next((unit for unit in units if seconds >= 2 * unit[1]), units[-1])
    value = seconds / size
    return f"{value:.0f} {unit}" if value >= 9.95 else f"{value:.2g} {unit}"


def times(ratio: float) -> str:
    """A ratio with two digits or so: "0.66", "4.3", "440", "1.3e+06"."""
    if not 0.095 <= ratio < 99_999.5:
        return f"{ratio:.1e}"
    return f"{ratio:.2f}" if ratio < 0.95 else f"{ratio:.1f}" if ratio < 9.95 else f"{ratio:.0f}"


def forecast(source: Source, index: int) -> Forecast | None:
    """When the drift of a method, if it goes on, takes it out of the narrowest band that it is still in.

    None without a drift that is known to a tenth; after a change of the step size, for then the largest
    errors of the run are not those of this step size; and for bands too wide or times too long.
    """
    judgement, reading = source.judgements[index], source.sample.readings[index]
    slope, uncertainty = judgement.slope, judgement.uncertainty
    if judgement.verdict != "drifts" or not slope or uncertainty is None or 10 * uncertainty > abs(slope):
        return None
    if any(event.kind == "set_h" and event.run == source.sample.run for event in source.events):
        return None
    bands = [(band, other) for band, other in _bands(source) if band > abs(reading.energy_error)]
    if not bands or bands[0][0] > LARGEST_BAND:
        return None
    seconds = (bands[0][0] - math.copysign(reading.energy_error, reading.energy_error * slope)) / abs(slope)
    return Forecast(seconds, METHODS[bands[0][1]]) if seconds < LONGEST else None


def _bands(source: Source) -> list[tuple[float, int]]:
    """The largest energy error of each method that is bounded, smallest first."""
    return sorted(
        (reading.max_energy_error, index)
        for index, (reading, judgement) in enumerate(zip(source.sample.readings, source.judgements, strict=True))
        if judgement.verdict == "bounded"
    )


def failed(milestone: Milestone) -> str:
    """A method whose numbers ended."""
    return f"{milestone.method.label} failed at {milestone.t:.4g} s: its numbers are no longer finite."


def over_the_top(milestone: Milestone) -> str:
    """A method that went where the exact swing never comes."""
    ratio = times(1 + milestone.energy_error)
    return f"{milestone.method.label} went over the top at {milestone.t:.3g} s with {ratio} times the start's energy."


def staying(source: Source) -> str:
    """The methods that keep their energy; "" if none is known to."""
    bounded = [(m, j) for m, j in zip(METHODS, source.judgements, strict=True) if j.verdict == "bounded"]
    if not bounded:
        return ""
    seconds = min(judgement.periods for _, judgement in bounded) * period(source)
    verb = "stays" if len(bounded) == 1 else "stay"
    return f"{listed([short(m) for m, _ in bounded])} {verb} within a band, no trend in {about(seconds)}."


def period(source: Source) -> float:
    """The time that verdicts count in [s]."""
    return source.exact.period or math.tau / source.scene.w0


def leaving(source: Source, index: int) -> str:
    """A method that gains or loses energy; "" if it is not known to."""
    judgement, name = source.judgements[index], short(METHODS[index])
    sign = {"grows": 1, "drifts": -1}.get(judgement.verdict)
    if sign is None or judgement.slope is None or judgement.slope * sign <= 0:
        return ""
    what = f"{name} {'gains' if judgement.slope > 0 else 'loses'} {abs(judgement.slope):.2g}"
    if ahead := forecast(source, index):
        return f"{what} per second: at this h it leaves {short(ahead.other)}'s band in about {about(ahead.seconds)}."
    error, bands = abs(source.sample.readings[index].energy_error), _bands(source)
    if bands and error > bands[0][0] > 0:
        ratio, other = times(error / bands[0][0]), short(METHODS[bands[0][1]])
        return f"{what} per second: its error is {ratio} times {other}'s largest."
    return f"{what} of its energy per second."


def so_far(source: Source) -> str:
    """The largest energy errors, of the best method and of the worst, while it is too early for more."""
    errors = sorted((reading.max_energy_error, index) for index, reading in enumerate(source.sample.readings))
    (least, nearest), (most, furthest) = errors[0], errors[-1]
    far, near = short(METHODS[furthest]), short(METHODS[nearest])
    return f"Energy errors so far: {least:.2g} ({near}) to {most:.2g} ({far})."
