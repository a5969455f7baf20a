"""The one sentence of the moment, from milestones and verdicts; and hints in the first minute."""

import math
from collections.abc import Collection, Iterable

from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.scenes import Scene
from recordings.events import Event, EventKind
from tui.playback.source import Source
from tui.words.findings import astray, ending, endings, leaving, passing, short_name, so_far, staying

WATCH = 8.0  # s of the clock at the beginning of a run, for the scene's own sentence
FRESH = 6.0  # s of the clock for which a milestone is news
TURN = 8.0  # s of the clock until the next of the lasting sentences
RESTING = "Nothing moves: the pendulum started at rest in equilibrium."

HINT_SHOWN = 6.0  # s
HINTS: tuple[tuple[float, EventKind, str], ...] = (
    (16.0, "start", "New here? T shows the lab in a tour of eight short steps."),
    (24.0, "pause", "Press space to pause, then . or , to step forward or back."),
    (31.0, "start", "? lists the keys: p next scene, M methods, i start values."),
    (38.0, "set_h", "Press + for a larger step: which methods conserve energy?"),
    (52.0, "start", "Click anywhere in phase space (F3) to start from there."),
)
"""Seconds on screen until the hint is due; the event which shows that the user knows it already; the hint."""


def hint(seconds: float, events: Iterable[Event]) -> str:
    """The hint that is due; "" if none is."""
    for begin, kind, text in HINTS:
        if begin <= seconds < begin + HINT_SHOWN:
            known = any(event.kind == kind and (kind != "start" or event.run > 1) for event in events)
            return "" if known else text
    return ""


def insight(source: Source, hidden: Collection[str] = ()) -> str:
    """The sentence: equilibrium, the return to t = 0, news, the scene's own sentence, or the lasting ones in turn.

    It does not mention methods whose keys are `hidden`.
    """
    sample, scene, returned = source.sample, source.scene, source.history.returned
    if source.exact.regime == "equilibrium":
        return RESTING
    if returned is not None and abs(sample.t) < WATCH:
        return return_text(scene, returned)
    pace = abs(source.playhead.speed)
    if text := _news(source, FRESH * pace, hidden):
        return text
    if abs(sample.t) < WATCH * pace and (text := _watch(source, hidden)):
        return text
    sentences = lasting(source, hidden)
    return sentences[int(sample.step * abs(source.stepping.h) / (TURN * pace)) % len(sentences)]


def _news(source: Source, seconds: float, hidden: Collection[str]) -> str:
    """The newest milestone of the last simulated seconds; failures first, over the top, errors that cross, verdicts."""
    kinds = ("verdict", "errors cross", "over the top", "failed")
    since = source.sample.step - seconds / abs(source.stepping.h)
    recent = [each for each in source.milestones if each.step > since and each.method.key not in hidden]
    newest = sorted(recent, key=lambda each: (kinds.index(each.kind), each.step))
    return next(filter(None, (_sentence(source, each, hidden) for each in reversed(newest))), "")


def _sentence(source: Source, milestone: Milestone, hidden: Collection[str]) -> str:
    if milestone.other:
        return passing(milestone, milestone.other)
    if milestone.kind != "verdict":
        return ending(milestone, source.scene.equations.energy_error.conserved)
    index = source.scene.cast.index(milestone.method)
    return staying(source, hidden) if milestone.verdict == "bounded" else leaving(source, index)


def lasting(source: Source, hidden: Collection[str] = ()) -> list[str]:
    """All that is known of the methods that are not hidden, the most important first; at least one sentence."""
    shown = [index for index, method in enumerate(source.scene.cast) if method.key not in hidden]
    ended = {index: each for index, each in endings(source).items() if index in shown}
    ends = sorted(ended.values(), key=lambda each: (each.kind != "failed", each.step))
    over = [ending(each, source.scene.equations.energy_error.conserved) for each in ends]
    cast, judgements, readings = source.scene.cast, source.judgements, source.sample.readings
    moves = [
        astray(short_name(cast[at]), judgements[at], readings[at].energy_error) if at in ended else leaving(source, at)
        for at in shown
    ]
    known = list(filter(None, [*over, staying(source, hidden), *moves]))
    return [*known, *filter(None, [_watch(source, hidden)])] if known else [so_far(source, hidden)]


def _watch(source: Source, hidden: Collection[str]) -> str:
    """The scene's own sentence, which holds for its own step size only; "" where it names a hidden method."""
    scene = source.scene
    named = any(method.key in hidden and short_name(method) in scene.watch for method in scene.cast)
    return scene.watch if source.stepping.h == scene.h and not named else ""


def return_text(scene: Scene, sample: Sample) -> str:
    """Each method's distance from the start when time has run back to it: sqrt(dtheta² + (domega/w0)²)."""
    misses = [
        "failed"
        if reading.diverged_at is not None
        else f"{math.hypot(reading.theta - scene.theta, (reading.omega - scene.omega) / scene.w0):.2g}"
        for reading in sample.readings
    ]
    each = ", ".join(f"{method.letter} {miss}" for method, miss in zip(scene.cast, misses, strict=True))
    return f"Back at t = 0. Missed the start by {each} rad."
