"""What the methods do, in sentences.  Each states only what was measured; a forecast extrapolates a measured slope."""

import math
from collections.abc import Collection, Sequence
from typing import NamedTuple

from engine.methods import GENERAL, Cast, Method
from engine.run.observer import Milestone
from engine.run.verdict import Judgement
from engine.scenes import Scene
from tui.playback.source import Source
from tui.words.numbers import about, two_digits

LARGEST_BAND = 0.2
"""Of the energy: a larger loss changes the rate of loss itself."""
LONGEST = 1000 * 86400.0  # s; later forecasts are left out
LINE = 80  # characters of a sentence, which has one line of the screen
MOSTLY = 0.5  # of the energy; beyond it the sentence gives the share that is lost, and not the rate
STEADY = 0.05
"""Relative change of the period, up to which a rate of loss per second is taken to stay."""


class Forecast(NamedTuple):
    """When the energy error of a method that loses energy will pass that of a bounded one."""

    seconds: float  # from now on, simulated
    other: Method


def short_name(method: Method) -> str:
    """The last word of a method's name if no other name ends with it: "Verlet", but "Symplectic Euler"."""
    last = method.label.split()[-1]
    alone = sum(each.label.endswith(last) for each in GENERAL) == 1
    return last if alone and method.general else method.label


def forecast(source: Source, index: int) -> Forecast | None:
    """When a method's steady loss of energy will take its error past the smallest maximum that it is still below.

    None unless the slope is known to a tenth; after a change of the step size, because the run's maxima
    then belong to another step size; where the period depends on the energy, and the rate of loss with it; and if
    the maximum is too large or the time too long.
    """
    judgement, error = source.judgements[index], source.sample.readings[index].energy_error
    slope, uncertainty = judgement.slope, judgement.uncertainty
    if judgement.verdict != "loses" or not slope or uncertainty is None or 10 * uncertainty > abs(slope):
        return None
    if any(event.kind == "set_h" and event.run == source.sample.run for event in source.events):
        return None
    band, other = next((each for each in _bands(source) if each[0] > abs(error)), (math.inf, 0))
    if band > LARGEST_BAND or not _is_steady(source.scene, band):
        return None
    seconds = (band - math.copysign(error, error * slope)) / abs(slope)
    return Forecast(seconds, source.scene.cast[other]) if seconds < LONGEST else None


def _is_steady(scene: Scene, lost: float) -> bool:
    """Whether the period stays nearly what it is while this share of the energy is lost."""
    model = scene.equations
    if not model.turns:
        return True
    energy = (1 - lost) * model.energy()((scene.theta, scene.omega))
    share = energy / (2 * model.w0_squared)
    there = model.exact(2 * math.asin(math.sqrt(share)), 0.0) if share < 1 else model.exact(0.0, math.sqrt(2 * energy))
    before, after = scene.exact().period, there.period
    return before is not None and after is not None and abs(after / before - 1) < STEADY


def _bands(source: Source) -> list[tuple[float, int]]:
    """The largest energy error of each bounded method, with its index, smallest first."""
    pairs = enumerate(zip(source.sample.readings, source.judgements, strict=True))
    return sorted((reading.max_energy_error, i) for i, (reading, judged) in pairs if judged.verdict == "bounded")


def endings(source: Source) -> dict[int, Milestone]:
    """The methods, by index, that failed or went over the top: their verdict no longer matters."""
    found = [each for each in source.milestones if each.kind in ("over the top", "failed")]
    index = source.scene.cast.index
    return {index(each.method): each for each in sorted(found, key=lambda each: each.kind == "failed")}


def ending(milestone: Milestone, conserved: bool = True) -> str:
    """The sentence on a method that failed, or that went over the top, where the exact pendulum never gets."""
    name = milestone.method.label
    if milestone.kind == "failed":
        return f"{name} failed at {milestone.t:.4g} s: its energy error is no longer finite."
    if not conserved:
        ratio = two_digits(math.exp(min(milestone.energy_error, 700.0)))
        return f"{name} went over the top at {milestone.t:.3g} s with {ratio} times the true energy."
    ratio = two_digits(1 + milestone.energy_error)
    return f"{name} went over the top at {milestone.t:.3g} s with {ratio} times its initial energy."


def passing(milestone: Milestone, other: Method) -> str:
    """The sentence on a method whose error has passed that of a bounded one."""
    what = f"{short_name(milestone.method)}'s error passed {short_name(other)}'s at {milestone.t:.4g} s"
    more = f"{what}: smaller at first, it kept growing."
    return more if len(more) <= LINE else f"{what}."


def staying(source: Source, hidden: Collection[str] = ()) -> str:
    """The sentence on the bounded methods that are not hidden; "" if there are none yet."""
    judged = zip(source.scene.cast, source.judgements, strict=True)
    bounded = [(m, j) for m, j in judged if j.verdict == "bounded" and m.key not in hidden]
    if not bounded:
        return ""
    period = source.exact.period or math.tau / source.scene.w0  # the unit of Judgement.periods
    seconds = min(judgement.periods for _, judgement in bounded) * period
    *names, last = [short_name(method) for method, _ in bounded]
    who = f"{', '.join(names)} and {last} stay" if names else f"{last} stays"
    return f"{who} bounded; no trend over {about(seconds)}." if seconds else f"{who} bounded."


def astray(name: str, judgement: Judgement, error: float) -> str:
    """The sentence on a method that is chaotic, wanders or is caught; "" for others."""
    match judgement.verdict:
        case "chaotic" | "wanders" if judgement.lyapunov:
            what = "is chaotic" if judgement.verdict == "chaotic" else "wanders in chaos"
            return f"{name} {what}: two close starts part tenfold every {about(math.log(10) / judgement.lyapunov)}."
        case "chaotic":
            return f"{name} is chaotic: two close starts part exponentially."
        case "wanders":
            return f"{name} wanders: its energy goes up and down, without a trend and in no band."
        case "caught":
            return f"{name} is caught: its energy error stays in a band, now {error:+.3g}."
    return ""


def leaving(source: Source, index: int) -> str:
    """The sentence on a method that is not bounded; "" if that is not known."""
    method, judgement = source.scene.cast[index], source.judgements[index]
    name, error = short_name(method), source.sample.readings[index].energy_error
    conserved = source.scene.equations.energy_error.conserved
    if text := astray(name, judgement, error):
        return text
    if conserved and judgement.verdict == "loses" and -error > MOSTLY:
        share = "all" if -error > 1 - 1e-6 else f"{-100 * error:.4g} %"
        return f"{name} has lost {share} of its energy."
    slope = {"grows": 1, "loses": -1}.get(judgement.verdict, 0) * (judgement.trend or 0)
    if slope <= 0:
        return ""
    unit = "% of E0/s" if conserved else "% of the true energy a second"
    what = f"{name} {'gains' if judgement.verdict == 'grows' else 'loses'} {two_digits(100 * slope)} {unit}"
    if ahead := forecast(source, index):
        return f"{what}; its error will pass {short_name(ahead.other)}'s in about {about(ahead.seconds)}."
    bands = _bands(source)
    if bands and abs(error) > bands[0][0] > 0:
        ratio, other = two_digits(abs(error) / bands[0][0]), short_name(source.scene.cast[bands[0][1]])
        if len(more := f"{what}; its error is {ratio} times {other}'s maximum.") <= LINE:
            return more
    return f"{what}."


def so_far(source: Source, hidden: Collection[str] = ()) -> str:
    """The largest energy errors of the best and of the worst method, for as long as there is no verdict."""
    known = zip(source.scene.cast, source.sample.readings, strict=True)
    errors = sorted((reading.max_energy_error, at) for at, (m, reading) in enumerate(known) if m.key not in hidden)
    if not errors:
        return ""
    (least, nearest), (most, furthest) = errors[0], errors[-1]
    near, far = short_name(source.scene.cast[nearest]), short_name(source.scene.cast[furthest])
    text = f"Energy errors so far: {least:.2g} ({near}) to {most:.2g} ({far})."
    return text if len(text) <= LINE else text.replace("Energy errors so far", "Energy errors")


def limit_warning(cast: Cast, zs: Sequence[float]) -> str:
    """As "unstable: e, s v (z > 2), r (z > 2.83)", the methods by their letters; "" below all limits.

    `zs` are in the order of the cast.  Explicit Euler is never stable, so it is named only beside others.
    """
    letters: dict[float, list[str]] = {}
    for method, z in zip(cast, zs, strict=True):
        if method.linear_limit and method.linear_limit < z:
            letters.setdefault(method.linear_limit, []).append(method.letter)
    each = ", ".join(f"{' '.join(who)} (z > {limit:.3g})" for limit, who in letters.items())
    always = [method.letter for method in cast if method.linear_limit == 0.0]
    return f"unstable: {', '.join([*always, each])}" if each else ""
