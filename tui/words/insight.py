"""The insight of the moment: a sentence on what was measured, or a slope that continues."""

import math
import re
from collections.abc import Collection
from typing import NamedTuple

from pendu_tui.engine.methods import USUAL_CAST, Cast, Method
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import change_before
from pendu_tui.engine.run.verdicts import (
    BOUNDED,
    CHAOTIC,
    FAILED,
    GROWS,
    LOSES,
    Judgement,
    Milestone,
)
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.drawing.picture import Row, ink_of
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words.numbers import about, seconds, two_digits

FRESH = 6.0  # s of the clock during which a milestone is news
TURN = 8.0  # s for each of the lasting insights
UNCHANGED = 0.05  # a smaller change of the energy is not worth mentioning
MAX_BAND = 0.2  # of the energy; larger losses change the rate of loss
MAX_PERIOD = 2.0  # small swings; near the separatrix the rate of loss depends on the energy
PRIORITY = (FAILED, "over the top", "errors cross", "verdict")
IRREGULAR = (CHAOTIC, "rests")
"""Kinds that are also worth stating of a method that went over the top."""


class Insight(NamedTuple):
    """A fact about the run: its kind, and the sentence."""

    kind: str
    text: str = ""


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
    longer_first = sorted(map(re.escape, names), reverse=True)
    pieces = re.split(rf"\b({'|'.join(longer_first)})\b", text, flags=re.IGNORECASE)
    inks = {name.lower(): ink_of(method, cast) for name, method in names.items()}
    return [(piece, inks.get(piece.lower(), ink)) for piece in pieces if piece]


def insight(source: Source, hidden: Collection[str] = ()) -> Insight:
    """Choose equilibrium, the scene's moment, the return to t = 0, news, or a lasting insight.

    Methods with `hidden` keys are not mentioned.
    """
    step = source.sample.step
    h = abs(source.stepping.h)
    pace = abs(source.playhead.speed)
    shot = source.scene.shot
    if source.exact.regime == "equilibrium":
        return Insight("at rest", "Nothing moves: the pendulum started at rest in equilibrium.")
    is_moment = shot.moment is not None and step == round(shot.moment / h)
    is_page = source.playhead.paused and source.stepping.h == source.scene.h
    if is_moment and is_page and shot.sentence:
        return Insight("watch", shot.sentence)
    if source.is_back:
        return _returned(source.scene, source.sample, hidden)
    if found := _news(source, step - FRESH * pace / h, hidden):
        return found
    known = lasting(source, hidden) or [Insight("nothing")]
    return known[int(step * h / (TURN * pace)) % len(known)]


def _returned(scene: Scene, sample: Sample, hidden: Collection[str]) -> Insight:
    """Return each method's distance from the start: sqrt(dtheta² + (domega/w0)²) [rad]."""
    misses = []
    for method, reading in zip(scene.cast, sample.readings, strict=True):
        speed = (reading.omega - scene.omega) / scene.w0
        miss = f"{math.hypot(reading.theta - scene.theta, speed):.1g}"
        if reading.diverged_at is not None:
            miss = FAILED
        if method.key not in hidden:
            misses.append(f"{method.letter} {miss}")
    text = f"Back at 0, off by [rad]: {', '.join(misses)}."
    return Insight("returned", text)


def _news(source: Source, since: float, hidden: Collection[str]) -> Insight | None:
    """Return the insight on the latest milestone since a step, by PRIORITY."""
    recent = [
        each for each in source.milestones if each.step > since and each.method.key not in hidden
    ]
    for milestone in sorted(recent, key=lambda each: (PRIORITY.index(each.kind), -each.step)):
        if milestone.kind != "verdict":
            return milestone_insight(milestone, source.scene.equations.conserves_energy)
        found = drift(source, source.scene.cast.index(milestone.method))
        if milestone.verdict == BOUNDED:
            found = bounded(source, hidden)
        if found:
            return found
    return None


def watched(source: Source, hidden: Collection[str]) -> str:
    """Return the scene's own sentence; "" if its step has changed or it names a hidden method."""
    scene = source.scene
    named = any(method.key in hidden and short_name(method) in scene.watch for method in scene.cast)
    return "" if source.stepping.h != scene.h or named else scene.watch


def lasting(source: Source, hidden: Collection[str] = ()) -> list[Insight]:
    """Return all insights on the methods shown, the most important first."""
    ended = {
        each.method: each
        for each in source.milestones
        if each.kind in ("over the top", FAILED) and each.method.key not in hidden
    }
    first = sorted(ended.values(), key=lambda each: (each.kind != FAILED, each.step))
    conserved = source.scene.equations.conserves_energy
    found = [milestone_insight(each, conserved) for each in first]
    if staying := bounded(source, hidden):
        found.append(staying)
    for index, method in enumerate(source.scene.cast):
        own = drift(source, index)
        if own and method.key not in hidden and (method not in ended or own.kind in IRREGULAR):
            found.append(own)
    watch = watched(source, hidden)
    is_outdated = any(short_name(method) in source.scene.watch for method in ended)
    if watch and not is_outdated:
        found.append(Insight("watch", watch))
    return found


def energy_ratio(milestone: Milestone, conserved: bool) -> float | None:
    """Return a method's energy over the true one; None if they hardly differ."""
    error = milestone.energy_error
    ratio = 1 + error
    if not conserved:
        ratio = math.exp(min(error, 700.0))
    if abs(ratio - 1) > UNCHANGED:
        return ratio
    return None


def milestone_insight(milestone: Milestone, conserved: bool) -> Insight:
    """Return the insight on a method that failed, went over the top, or passed another's error."""
    name = short_name(milestone.method)
    at = seconds(milestone.t)
    text = f"{name} failed at {at}: its computation has broken down."
    if milestone.other:
        other = short_name(milestone.other)
        text = f"{name}'s error passed {other}'s at {at}: smaller at first, it kept growing."
    elif milestone.kind == "over the top":
        energy = ""
        if ratio := energy_ratio(milestone, conserved):
            unit = "its initial energy" if conserved else "the true energy"
            energy = f" with {two_digits(ratio)} times {unit}"
        text = f"{name} went over the top at {at}{energy}."
    return Insight(milestone.kind, text)


def bounded(source: Source, hidden: Collection[str] = ()) -> Insight | None:
    """Return the insight on the bounded methods, if there are any."""
    judged = zip(source.scene.cast, source.judgements, strict=True)
    found = [m for m, j in judged if j.verdict == BOUNDED and m.key not in hidden]
    if not found:
        return None
    *others, last = map(short_name, found)
    names = f"{last} has"
    if others:
        names = f"{', '.join(others)} and {last} have"
    change = change_before(source.changes, source.sample.step)  # judging began there
    return Insight(BOUNDED, f"{names} stayed bounded for {about(abs(source.sample.t - change.t))}.")


def irregular(method: Method, judgement: Judgement, error: float) -> Insight | None:
    """Return the insight on a method that is chaotic or rests elsewhere; None for others."""
    name = short_name(method)
    if judgement.rests:
        text = f"{name} has settled at an energy error of about {error:+.3g}."
        return Insight("rests", text)
    if judgement.verdict != CHAOTIC:
        return None
    pace = "exponentially"
    if judgement.lyapunov:
        pace = f"tenfold every {about(math.log(10) / judgement.lyapunov)}"
    return Insight(CHAOTIC, f"{name}'s motion is chaotic: nearby orbits diverge {pace}.")


def drift(source: Source, index: int) -> Insight | None:
    """Return the insight on a method that is not bounded, as far as that is certain."""
    method = source.scene.cast[index]
    judgement = source.judgements[index]
    verdict = judgement.verdict
    error = source.sample.readings[index].energy_error
    name = short_name(method)
    if found := irregular(method, judgement, error):
        return found
    conserved = source.scene.equations.conserves_energy
    if verdict == LOSES and conserved and error < -0.5:  # more telling than the rate
        return Insight("lost", f"{name} has lost {_share(-error)} of its energy.")
    rate = judgement.slope or 0.0
    if verdict == LOSES:
        rate = -rate
    if verdict not in (GROWS, LOSES) or rate <= 0:
        return None
    if conserved and rate >= 10:  # no percentage that means anything
        ratio = two_digits(1 + error)
        return Insight("multiplied", f"{name} has {ratio} times its initial energy.")
    unit = "of E0 per s" if conserved else "per s on the true energy"
    verb = "gains" if verdict == GROWS else "loses"
    text = f"{name} {verb} {_share(rate)} {unit}"
    if ahead := forecast(source, index):
        wait, other = ahead
        passing = f"its error will pass {short_name(other)}'s in {about(wait)}"
        return Insight("will pass", f"{text}; {passing}.")
    return Insight(verdict, f"{text}.")


def _share(value: float) -> str:
    if 1e-6 <= value < 10:
        return f"{two_digits(100 * value)} %"
    return two_digits(value)


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
    has_changed = any(0 < change.step <= source.sample.step for change in source.changes)
    is_slow = (source.exact.period or 0.0) > MAX_PERIOD * math.tau / source.scene.w0
    if rate <= 10 * judgement.uncertainty or has_changed or is_slow:
        return None
    bands = {
        reading.max_energy_error: method
        for method, reading, judged in zip(
            source.scene.cast, source.sample.readings, source.judgements, strict=True
        )
        if judged.verdict == BOUNDED and reading.max_energy_error > abs(error)
    }
    band = min(bands, default=math.inf)
    wait = (band + error) / rate
    if band <= MAX_BAND and wait < 1000 * 86400:
        return wait, bands[band]
    return None
