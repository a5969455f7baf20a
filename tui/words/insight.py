"""The insight of the moment: `insight` chooses one with its numbers, SENTENCES has the words.

Insights state what was measured; a forecast extrapolates a measured slope.
"""

import math
import re
import string
from collections.abc import Callable, Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from pendu_tui.engine.methods import USUAL_CAST, Cast, Method
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import SteppingChange
from pendu_tui.engine.run.verdicts import (
    BOUNDED,
    CHAOTIC,
    FAILED,
    LEAVES,
    LOSES,
    VERDICTS,
    Judgement,
    Milestone,
)
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.drawing.picture import Row, ink_of
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words.numbers import about, seconds, two_digits

SENTENCES = {
    **{each.word: each.sentence for each in VERDICTS.values()},
    "at rest": "Nothing moves: the pendulum started at rest in equilibrium.",
    "returned": "Back at t = 0; off in angle and speed [rad]: {misses}.",
    "watch": "{text}",
    "new step": "h is {h:.4g} s now; r starts again with it, the old run dimmed below.",
    "over the top": "{0} went over the top at {t:seconds}{energy}.",
    "errors cross": "{0}'s error passed {1}'s at {t:seconds}: smaller at first, it kept growing.",
    "rests": "{0} has settled at an energy error of about {error:+.3g}.",
    "lost": "{0} has lost {share:percent} of its energy.",
    "multiplies": "{0}'s energy grows tenfold every {seconds:about}.",
    "will pass": (
        "{0} loses {rate:share} of E0 per s; its error will pass {1}'s in {seconds:about}."
    ),
    "so far": "Largest energy error so far: {errors}.",
}

WATCH = 8.0  # s of the clock for the scene's own sentence, at the beginning of a run
FRESH = 6.0  # s of the clock during which a milestone is news
TURN = 8.0  # s of the clock for each of the lasting insights
UNCHANGED = 0.05  # a smaller change of the energy is not worth mentioning
MAX_BAND = 0.2  # of the energy; larger losses change the rate of loss
MAX_PERIOD = 2.0  # small swings; near the separatrix the rate of loss depends on the energy
PRIORITY = (FAILED, "over the top", "errors cross", "verdict")
IRREGULAR = (CHAOTIC, "rests")
"""Kinds that are also worth stating of a method that went over the top."""


def _share(value: float) -> str:
    if 1e-6 <= value < 10:
        return f"{two_digits(100 * value)} %"
    return two_digits(value)


FORMATS: dict[str, Callable[[Any], str]] = {
    "about": about,
    "seconds": seconds,
    "share": _share,
    "percent": lambda value: "all" if value > 1 - 1e-6 else f"{100 * value:.4g} %",
    "tenfold": lambda value: f"tenfold every {about(value)}" if value else "exponentially",
}
"""Formats of SENTENCES, in addition to Python's."""


class Insight(NamedTuple):
    """A fact about the run: its kind (a key of SENTENCES), methods and numbers."""

    kind: str
    methods: tuple[Method, ...] = ()
    values: Mapping[str, Any] = MappingProxyType({})


class _Words(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        if format_spec in FORMATS:
            return FORMATS[format_spec](value)
        return format(value, format_spec)


def sentence(found: Insight) -> str:
    """Write an insight in words."""
    names = [short_name(method) for method in found.methods]
    *first, last = names or [""]
    joined = f"{', '.join(first)} and {last} stay" if first else f"{last} stays"
    return _Words().format(SENTENCES[found.kind], *names, names=joined, **found.values)


def short_name(method: Method) -> str:
    """Return a usual method's last word if it is unique: "Verlet", but "Symplectic Euler"."""
    last = method.label.split()[-1]
    alone = sum(each.label.endswith(last) for each in USUAL_CAST) == 1
    if alone and method in USUAL_CAST:
        return last
    return method.label


def painted(text: str, cast: Cast, ink: int) -> Row:
    """Return a text in pieces: the names of a cast in the methods' inks, all else in `ink`."""
    names = {name: method for method in cast for name in (method.label, short_name(method))}
    longest_first = sorted(map(re.escape, names), key=len, reverse=True)
    pieces = re.split(rf"\b({'|'.join(longest_first)})\b", text, flags=re.IGNORECASE)
    inks = {name.lower(): ink_of(method, cast) for name, method in names.items()}
    return [(piece, inks.get(piece.lower(), ink)) for piece in pieces if piece]


def insight_text(source: Source, hidden: Collection[str] = ()) -> str:
    """Write the insight of the moment in words."""
    return sentence(insight(source, hidden))


def insight(source: Source, hidden: Collection[str] = ()) -> Insight:
    """Choose equilibrium, the return to t = 0, news, the scene's own, or a lasting insight.

    Methods with `hidden` keys are not mentioned.
    """
    step = source.sample.step
    t = abs(source.sample.t)
    h = abs(source.stepping.h)
    pace = abs(source.playhead.speed)
    shot = source.scene.shot
    if source.exact.regime == "equilibrium":
        return Insight("at rest")
    is_moment = shot.moment is not None and step == round(shot.moment / h)
    if is_moment and shot.sentence and source.stepping.h == source.scene.h:
        return Insight("watch", values={"text": shot.sentence})
    if source.history.returned is not None and t < WATCH:
        return _returned(source.scene, source.history.returned, hidden)
    since = step - FRESH * pace / h
    if source.kind == "LIVE" and _is_new_step(source.changes, since):
        return Insight("new step", values={"h": source.stepping.h})
    if found := _news(source, since, hidden):
        return found
    if t < WATCH * pace and (watch := _watch(source, hidden)):
        return watch
    known = lasting(source, hidden)
    return known[int(step * h / (TURN * pace)) % len(known)]


def _is_new_step(changes: Sequence[SteppingChange], since: float) -> bool:
    sizes = [abs(change.stepping.h) for change in changes[-2:]]
    return changes[-1].step > max(since, 0) and sizes[0] != sizes[-1]


def _news(source: Source, since: float, hidden: Collection[str]) -> Insight | None:
    """Return the insight on the latest milestone since a step, by PRIORITY."""
    recent = [
        each for each in source.milestones if each.step > since and each.method.key not in hidden
    ]
    for milestone in sorted(recent, key=lambda each: (PRIORITY.index(each.kind), -each.step)):
        if milestone.kind != "verdict":
            return milestone_insight(milestone, _is_conserved(source))
        found = drift(source, source.scene.cast.index(milestone.method))
        if milestone.verdict == BOUNDED:
            found = bounded(source, hidden)
        if found:
            return found
    return None


def _watch(source: Source, hidden: Collection[str]) -> Insight | None:
    """Return the scene's own sentence, unless its step or its methods have changed."""
    scene = source.scene
    named = any(method.key in hidden and short_name(method) in scene.watch for method in scene.cast)
    if not scene.watch or source.stepping.h != scene.h or named:
        return None
    return Insight("watch", values={"text": scene.watch})


def lasting(source: Source, hidden: Collection[str] = ()) -> list[Insight]:
    """Return all insights on the methods shown, the most important first; at least one."""
    ended = {at: each for at, each in endings(source).items() if each.method.key not in hidden}
    first = sorted(ended.values(), key=lambda each: (each.kind != FAILED, each.step))
    found = [milestone_insight(each, _is_conserved(source)) for each in first]
    if staying := bounded(source, hidden):
        found.append(staying)
    for index, method in enumerate(source.scene.cast):
        own = drift(source, index)
        if own and method.key not in hidden and (index not in ended or own.kind in IRREGULAR):
            found.append(own)
    if not found:
        return [_so_far(source, hidden)]
    watch = _watch(source, hidden)
    is_outdated = any(short_name(each.method) in source.scene.watch for each in ended.values())
    if watch and not is_outdated:
        found.append(watch)
    return found


def endings(source: Source) -> dict[int, Milestone]:
    """Return the milestones of failed methods and those over the top, by index."""
    ended = [each for each in source.milestones if each.kind in ("over the top", FAILED)]
    ended.sort(key=lambda each: each.kind == FAILED)
    return {source.scene.cast.index(each.method): each for each in ended}


def _is_conserved(source: Source) -> bool:
    return source.scene.equations.conserves_energy


def energy_ratio(milestone: Milestone, conserved: bool) -> float | None:
    """Return a method's energy over the true one; None if they hardly differ."""
    error = milestone.energy_error
    ratio = 1 + error if conserved else math.exp(min(error, 700.0))
    if abs(ratio - 1) > UNCHANGED:
        return ratio
    return None


def milestone_insight(milestone: Milestone, conserved: bool = True) -> Insight:
    """Return the insight on a method that failed, went over the top, or passed another's error."""
    values: dict[str, Any] = {"t": milestone.t}
    if milestone.other:
        return Insight("errors cross", (milestone.method, milestone.other), values)
    if milestone.kind == "over the top":
        energy = ""
        if ratio := energy_ratio(milestone, conserved):
            unit = "its initial energy" if conserved else "the true energy"
            energy = f" with {two_digits(ratio)} times {unit}"
        values |= {"ratio": ratio, "energy": energy}
    return Insight(milestone.kind, (milestone.method,), values)


def bounded(source: Source, hidden: Collection[str] = ()) -> Insight | None:
    """Return the insight on the bounded methods, if there are any."""
    judged = zip(source.scene.cast, source.judgements, strict=True)
    found = {m: j.periods for m, j in judged if j.verdict == BOUNDED and m.key not in hidden}
    if not found:
        return None
    period = source.exact.period or math.tau / source.scene.w0  # the unit of Judgement.periods
    return Insight(BOUNDED, tuple(found), {"seconds": min(found.values()) * period})


def irregular(method: Method, judgement: Judgement, error: float) -> Insight | None:
    """Return the insight on a method that is chaotic or rests elsewhere; None for others."""
    kind = "rests" if judgement.rests else judgement.verdict
    if kind not in IRREGULAR:
        return None
    values = {"error": error, "seconds": None}
    if judgement.lyapunov:
        values["seconds"] = math.log(10) / judgement.lyapunov
    return Insight(kind, (method,), values)


def drift(source: Source, index: int) -> Insight | None:
    """Return the insight on a method that is not bounded, as far as that is certain."""
    method = source.scene.cast[index]
    judgement = source.judgements[index]
    error = source.sample.readings[index].energy_error
    if found := irregular(method, judgement, error):
        return found
    conserved = _is_conserved(source)
    loses = judgement.verdict == LOSES
    if conserved and loses and -error > 0.5:  # the share lost is more telling than the rate
        return Insight("lost", (method,), {"share": -error})
    rate = judgement.slope or 0.0
    if loses:
        rate = -rate
    if judgement.verdict not in LEAVES or rate <= 0:
        return None
    if judgement.growth and not loses:
        return Insight("multiplies", (method,), {"seconds": math.log(10) / judgement.growth})
    unit = "E0" if conserved else "the true energy"
    values = {"rate": rate, "unit": unit}
    if ahead := forecast(source, index):
        seconds, other = ahead
        return Insight("will pass", (method, other), values | {"seconds": seconds})
    return Insight(judgement.verdict, (method,), values)


def forecast(source: Source, index: int) -> tuple[float, Method] | None:
    """Return in what time [s] a steady loss will exceed another method's largest error.

    Returns None unless the slope is certain to a tenth; after a change of h, because the largest
    errors belong to another step; near the separatrix, where the rate of loss changes; and if the
    error is too large or the time too long.
    """
    judgement = source.judgements[index]
    error = source.sample.readings[index].energy_error
    rate = -(judgement.slope or 0.0)
    if judgement.verdict != LOSES or judgement.uncertainty is None:
        return None
    if rate <= 10 * judgement.uncertainty:
        return None
    if any(0 < change.step <= source.sample.step for change in source.changes):
        return None
    bands = _bands(source)
    band, other = next((each for each in bands if each[0] > abs(error)), (math.inf, None))
    slow = (source.exact.period or 0.0) > MAX_PERIOD * math.tau / source.scene.w0
    if other is None or band > MAX_BAND or slow:
        return None
    seconds = (band + error) / rate
    if seconds < 1000 * 86400:
        return seconds, other
    return None


def _bands(source: Source) -> list[tuple[float, Method]]:
    """Return the largest energy error of each bounded method, smallest first."""
    each = zip(source.scene.cast, source.sample.readings, source.judgements, strict=True)
    bands = [(now.max_energy_error, one) for one, now, judged in each if judged.verdict == BOUNDED]
    return sorted(bands, key=lambda band: band[0])


def _so_far(source: Source, hidden: Collection[str] = ()) -> Insight:
    each = zip(source.scene.cast, source.sample.readings, strict=True)
    largest = {one: now.max_energy_error for one, now in each if one.key not in hidden}
    if not largest:
        return Insight("watch", values={"text": ""})
    ends = dict.fromkeys(sorted(largest, key=largest.__getitem__)[:: max(len(largest) - 1, 1)])
    errors = " to ".join(f"{_share(largest[each])} ({short_name(each)})" for each in ends)
    return Insight("so far", tuple(ends), {"errors": errors})


def _returned(scene: Scene, sample: Sample, hidden: Collection[str] = ()) -> Insight:
    """Return each method's distance from the start: sqrt(dtheta² + (domega/w0)²) [rad]."""
    misses = []
    for method, reading in zip(scene.cast, sample.readings, strict=True):
        if method.key not in hidden:
            speed = (reading.omega - scene.omega) / scene.w0
            miss = math.hypot(reading.theta - scene.theta, speed)
            text = f"{miss:.1g}"
            if reading.diverged_at is not None:
                text = "failed"
            misses.append(f"{method.letter} {text}")
    return Insight("returned", scene.cast, {"misses": ", ".join(misses)})
