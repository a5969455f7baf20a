"""The insight of the moment: `insight` chooses a kind and its numbers, SENTENCES has the words.

Each states only what was measured; a forecast extrapolates a measured slope.
"""

import math
import string
from collections.abc import Collection, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from engine.methods import USUAL_CAST, Method
from engine.run.judgement import Judgement, Milestone
from engine.run.lockstep import Sample
from engine.scenes import Scene
from tui.playback.source import Source
from tui.words.numbers import about, two_digits

WATCH = 8.0  # s of the clock at the beginning of a run, for the scene's own sentence
FRESH = 6.0  # s of the clock for which a milestone is news
TURN = 8.0  # s of the clock until the next of the lasting sentences
MAX_BAND = 0.2  # of the energy; a larger loss changes the rate of loss itself
MAX_FORECAST = 1000 * 86400.0  # s
MAX_RATE_LOSS = 0.5  # of the energy; beyond it the share that is lost says more than the rate
MAX_PERIOD = 2.0  # of small swings; near the separatrix the rate of loss changes with the energy
UNCHANGED = 0.05  # relative change of the energy that is not worth a number

SENTENCES = {
    "at rest": "Nothing moves: the pendulum started at rest in equilibrium.",
    "returned": "Back at t = 0; angle and speed off by {misses} rad.",
    "watch": "{text}",
    "new step": "h is {h:.4g} s now; r starts again with it, the old run dimmed below.",
    "failed": "{0} failed at {t:.4g} s: its energy error is no longer finite.",
    "over the top": "{0} went over the top at {t:.3g} s.",
    "over the top with": (
        "{0} went over the top at {t:.3g} s with {ratio:two} times its initial energy."
    ),
    "over the top with true": (
        "{0} went over the top at {t:.3g} s with {ratio:two} times the true energy."
    ),
    "errors cross": "{0}'s error passed {1}'s at {t:.4g} s: smaller at first, it kept growing.",
    "bounded": "{names} bounded; no trend over {seconds:about}.",
    "chaotic": "{0} is chaotic: nearby starts separate exponentially.",
    "chaotic at": "{0} is chaotic: nearby starts separate tenfold every {seconds:about}.",
    "wanders": "{0} wanders: its energy goes up and down, without a trend and in no band.",
    "wanders at": "{0} wanders in chaos: nearby starts separate tenfold every {seconds:about}.",
    "caught": "{0} has settled at an energy error of about {error:+.3g}.",
    "lost": "{0} has lost {share:percent} of its energy.",
    "gains": "{0} gains {rate:share} of {unit} per s.",
    "multiplies": "{0}'s energy grows tenfold every {seconds:about}.",
    "loses": "{0} loses {rate:share} of {unit} per s.",
    "will pass": (
        "{0} loses {rate:share} of E0 per s; its error will pass {1}'s in {seconds:about}."
    ),
    "exceeds": (
        "{0} {gains} {rate:share} of {unit} per s; its error is {ratio:two} × {1}'s maximum."
    ),
    "so far alone": "{0}'s largest energy error so far is {most:share}.",
    "so far": "Energy errors so far: {least:share} ({0}) to {most:share} ({1}).",
}


IRREGULAR = ("chaotic", "chaotic at", "wanders", "wanders at", "caught")
"""Kinds that matter of a method that went over the top, too."""


class Insight(NamedTuple):
    """A fact about the run: its kind, a key of SENTENCES, its methods and its numbers."""

    kind: str
    methods: tuple[Method, ...] = ()
    values: Mapping[str, Any] = MappingProxyType({})


class _Words(string.Formatter):
    """Knows the formats `about`, `two`, `share` and `percent` besides Python's own."""

    def format_field(self, value: Any, format_spec: str) -> str:
        match format_spec:
            case "about":
                return about(value)
            case "two":
                return two_digits(value)
            case "share":
                return f"{two_digits(100 * value)} %" if 1e-6 <= value < 10 else two_digits(value)
            case "percent":
                return "all" if value > 1 - 1e-6 else f"{100 * value:.4g} %"
        return str(super().format_field(value, format_spec))


def sentence(found: Insight) -> str:
    """Return an insight in words."""
    names = [short_name(method) for method in found.methods]
    *first, last = names or [""]
    joined = f"{', '.join(first)} and {last} stay" if first else f"{last} stays"
    return _Words().format(SENTENCES[found.kind], *names, names=joined, **found.values)


def short_name(method: Method) -> str:
    """Return a usual method's last word if it is unique: "Verlet", but "Symplectic Euler"."""
    last = method.label.split()[-1]
    alone = sum(each.label.endswith(last) for each in USUAL_CAST) == 1
    return last if alone and method in USUAL_CAST else method.label


def insight_text(source: Source, hidden: Collection[str] = ()) -> str:
    """Return the insight of the moment in words."""
    return sentence(insight(source, hidden))


def insight(source: Source, hidden: Collection[str] = ()) -> Insight:
    """Choose: equilibrium, the return to t = 0, news, the scene's own, or the lasting ones in turn.

    Methods whose keys are `hidden` are not mentioned.
    """
    sample = source.sample
    returned = source.history.returned
    pace = abs(source.playhead.speed)
    if source.exact.regime == "equilibrium":
        return Insight("at rest")
    if text := _moment(source):
        return Insight("watch", values={"text": text})
    if returned is not None and abs(sample.t) < WATCH:
        return _returned(source.scene, returned, hidden)
    if found := _new_step(source, FRESH * pace) or _news(source, FRESH * pace, hidden):
        return found
    if abs(sample.t) < WATCH * pace and (watch := _watch(source, hidden)):
        return watch
    known = lasting(source, hidden)
    turn = int(sample.step * abs(source.stepping.h) / (TURN * pace))
    return known[turn % len(known)]


def _moment(source: Source) -> str:
    """Return what the scene's shot says at its moment."""
    scene = source.scene
    shot = scene.shot
    if shot.moment is None or source.stepping.h != scene.h:
        return ""
    return shot.sentence if source.sample.step == round(shot.moment / scene.h) else ""


def _new_step(source: Source, seconds: float) -> Insight | None:
    """Return what r does after a change of h in the lab."""
    if source.kind != "LIVE" or len(source.changes) < 2:
        return None
    before, last = source.changes[-2:]
    h = last.stepping.h
    if source.sample.step - last.step >= seconds / abs(h) or abs(before.stepping.h) == abs(h):
        return None
    return Insight("new step", values={"h": h})


def _news(source: Source, seconds: float, hidden: Collection[str]) -> Insight | None:
    """Return the latest milestone: failures first, then over the top, crossings, verdicts."""
    kinds = ("verdict", "errors cross", "over the top", "failed")
    since = source.sample.step - seconds / abs(source.stepping.h)
    recent = [
        each for each in source.milestones if each.step > since and each.method.key not in hidden
    ]
    for milestone in sorted(
        recent, key=lambda each: (kinds.index(each.kind), each.step), reverse=True
    ):
        if milestone.kind != "verdict":
            return milestone_insight(milestone, source.scene.equations.energy_error.conserved)
        index = source.scene.cast.index(milestone.method)
        is_bounded = milestone.verdict == "bounded"
        if found := bounded(source, hidden) if is_bounded else drift(source, index):
            return found
    return None


def _watch(source: Source, hidden: Collection[str]) -> Insight | None:
    """Return the scene's own sentence, which holds for its own step only and its methods."""
    scene = source.scene
    named = any(method.key in hidden and short_name(method) in scene.watch for method in scene.cast)
    if not scene.watch or source.stepping.h != scene.h or named:
        return None
    return Insight("watch", values={"text": scene.watch})


def lasting(source: Source, hidden: Collection[str] = ()) -> list[Insight]:
    """Return all insights on the methods that are shown, the most important first; at least one."""
    ended = {
        index: each for index, each in endings(source).items() if each.method.key not in hidden
    }
    found = list(_on_methods(source, ended, hidden))
    watch = _watch(source, hidden)
    outdated = any(short_name(each.method) in source.scene.watch for each in ended.values())
    if found:
        return [*found, watch] if watch and not outdated else found
    return [_so_far(source, hidden)]


def _on_methods(
    source: Source, ended: Mapping[int, Milestone], hidden: Collection[str]
) -> Iterator[Insight]:
    conserved = source.scene.equations.energy_error.conserved
    for milestone in sorted(ended.values(), key=lambda each: (each.kind != "failed", each.step)):
        yield milestone_insight(milestone, conserved)
    if staying := bounded(source, hidden):
        yield staying
    for index, method in enumerate(source.scene.cast):
        if method.key in hidden:
            continue
        found = drift(source, index)
        if found and (index not in ended or found.kind in IRREGULAR):
            yield found


def endings(source: Source) -> dict[int, Milestone]:
    """Return by index the methods that failed or went over the top."""
    ended = [each for each in source.milestones if each.kind in ("over the top", "failed")]
    index = source.scene.cast.index
    return {
        index(each.method): each for each in sorted(ended, key=lambda each: each.kind == "failed")
    }


def milestone_insight(milestone: Milestone, conserved: bool = True) -> Insight:
    """Return the insight on a method that failed, went over the top, or passed another's error."""
    methods = (milestone.method,)
    values = {"t": milestone.t}
    if milestone.other:
        return Insight("errors cross", (milestone.method, milestone.other), values)
    if milestone.kind == "failed":
        return Insight("failed", methods, values)
    if not conserved:
        ratio = math.exp(min(milestone.energy_error, 700.0))
        return Insight("over the top with true", methods, values | {"ratio": ratio})
    if abs(milestone.energy_error) < UNCHANGED:
        return Insight("over the top", methods, values)
    return Insight("over the top with", methods, values | {"ratio": 1 + milestone.energy_error})


def bounded(source: Source, hidden: Collection[str] = ()) -> Insight | None:
    """Return the insight on the bounded methods, if there are any."""
    judged = zip(source.scene.cast, source.judgements, strict=True)
    found = [(m, j) for m, j in judged if j.verdict == "bounded" and m.key not in hidden]
    if not found:
        return None
    period = source.exact.period or math.tau / source.scene.w0  # the unit of Judgement.periods
    seconds = min(judgement.periods for _, judgement in found) * period
    return Insight("bounded", tuple(method for method, _ in found), {"seconds": seconds})


def irregular(method: Method, judgement: Judgement, error: float) -> Insight | None:
    """Return the insight on a chaotic, wandering or caught method; None for other verdicts."""
    if judgement.verdict == "caught":
        return Insight("caught", (method,), {"error": error})
    if judgement.verdict not in ("chaotic", "wanders"):
        return None
    if not judgement.lyapunov:
        return Insight(judgement.verdict, (method,))
    return Insight(
        f"{judgement.verdict} at", (method,), {"seconds": math.log(10) / judgement.lyapunov}
    )


def drift(source: Source, index: int) -> Insight | None:
    """Return the insight on a method that is not bounded, as far as that is certain."""
    method = source.scene.cast[index]
    judgement = source.judgements[index]
    error = source.sample.readings[index].energy_error
    if found := irregular(method, judgement, error):
        return found
    conserved = source.scene.equations.energy_error.conserved
    loses = judgement.verdict == "loses"
    if conserved and loses and -error > MAX_RATE_LOSS:
        return Insight("lost", (method,), {"share": -error})
    slope = {"grows": 1, "loses": -1}.get(judgement.verdict, 0) * (judgement.slope or 0)
    if slope <= 0:
        return None
    if judgement.growth and judgement.verdict == "grows":
        return Insight("multiplies", (method,), {"seconds": math.log(10) / judgement.growth})
    unit = "E0" if conserved else "the true energy"
    values = {"rate": slope, "unit": unit, "gains": "loses" if loses else "gains"}
    if ahead := forecast(source, index):
        seconds, other = ahead
        return Insight("will pass", (method, other), values | {"seconds": seconds})
    bands = _bands(source)
    if bands and abs(error) > bands[0][0] > 0:
        other = source.scene.cast[bands[0][1]]
        return Insight("exceeds", (method, other), values | {"ratio": abs(error) / bands[0][0]})
    return Insight("loses" if loses else "gains", (method,), values)


def forecast(source: Source, index: int) -> tuple[float, Method] | None:
    """Return when [s] a steady loss will exceed the smallest maximum that it is still below.

    None unless the slope is certain to a tenth; after a change of h, because the maxima belong
    to another step; where the period depends on the energy, and the rate of loss with it; and
    if the maximum is too large or the time too long.
    """
    judgement = source.judgements[index]
    error = source.sample.readings[index].energy_error
    slope = judgement.slope
    uncertainty = judgement.uncertainty
    if (
        judgement.verdict != "loses"
        or not slope
        or uncertainty is None
        or 10 * uncertainty > abs(slope)
    ):
        return None
    if any(event.kind == "set_h" and event.run == source.sample.run for event in source.events):
        return None
    band, other = next((each for each in _bands(source) if each[0] > abs(error)), (math.inf, 0))
    slow = (source.exact.period or 0.0) > MAX_PERIOD * math.tau / source.scene.w0
    if band > MAX_BAND or slow:
        return None
    seconds = (band - math.copysign(error, error * slope)) / abs(slope)
    return (seconds, source.scene.cast[other]) if seconds < MAX_FORECAST else None


def _bands(source: Source) -> list[tuple[float, int]]:
    """Return the largest energy error of each bounded method, with its index, smallest first."""
    pairs = enumerate(zip(source.sample.readings, source.judgements, strict=True))
    return sorted(
        (reading.max_energy_error, i)
        for i, (reading, judged) in pairs
        if judged.verdict == "bounded"
    )


def _so_far(source: Source, hidden: Collection[str] = ()) -> Insight:
    """Return the largest energy errors of the best and of the worst method."""
    cast = source.scene.cast
    errors = [(reading.max_energy_error, at) for at, reading in enumerate(source.sample.readings)]
    shown = sorted(each for each in errors if cast[each[1]].key not in hidden)
    if not shown:
        return Insight("watch", values={"text": ""})
    least, nearest = shown[0]
    most, furthest = shown[-1]
    if nearest == furthest:
        return Insight("so far alone", (cast[furthest],), {"most": most})
    return Insight("so far", (cast[nearest], cast[furthest]), {"least": least, "most": most})


def _returned(scene: Scene, sample: Sample, hidden: Collection[str] = ()) -> Insight:
    """Return each method's distance from the start: sqrt(dtheta² + (domega/w0)²) [rad]."""
    misses = []
    for method, reading in zip(scene.cast, sample.readings, strict=True):
        if method.key in hidden:
            continue
        speed = (reading.omega - scene.omega) / scene.w0
        miss = math.hypot(reading.theta - scene.theta, speed)
        text = "failed" if reading.diverged_at is not None else f"{miss:.1g}"
        misses.append(f"{method.letter} {text}")
    return Insight("returned", scene.cast, {"misses": ", ".join(misses)})


def return_text(scene: Scene, sample: Sample) -> str:
    """Return the sentence on a run whose time is back at 0."""
    return sentence(_returned(scene, sample))
