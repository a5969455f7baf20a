"""What to notice, a sentence at a time, from measured events and verdicts only; and hints in the first minute."""

import math
from collections.abc import Iterable

from engine.methods import METHODS
from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.scenes import Scene
from recordings.events import Event, EventKind
from tui.playback.source import Source
from tui.words.findings import ending, endings, leaving, so_far, staying

WATCH = 8.0  # s of the clock during which a run's beginning says what to watch
FRESH = 6.0  # s of the clock for which something is news
TURN = 8.0  # s of the clock for which one of the lasting sentences stays
RESTING = "Nothing moves: the pendulum started at rest where no force acts on it."

HINT_SHOWN = 6.0  # s
HINTS: tuple[tuple[float, EventKind, str], ...] = (
    (24.0, "pause", "Press space to pause; . and , then go step by step."),
    (38.0, "set_h", "Press + for a larger step: who still keeps the energy?"),
    (52.0, "start", "Click anywhere in phase space (F3) to start from there."),
)
"""When, in s since the lab is on screen; the event that shows that it is known already; and the hint."""


def hint(seconds: float, events: Iterable[Event]) -> str:
    """The hint that is due; "" if none is."""
    for begin, kind, text in HINTS:
        if begin <= seconds < begin + HINT_SHOWN:
            known = any(event.kind == kind and (kind != "start" or event.run > 1) for event in events)
            return "" if known else text
    return ""


def insight(source: Source) -> str:
    """The sentence: nothing moves, time is back at its start, news, what to watch, or what is known, in turn."""
    sample, scene, returned = source.sample, source.scene, source.history.returned
    if source.exact.regime == "equilibrium":
        return RESTING
    if returned is not None and abs(sample.t) < WATCH:
        return return_text(scene, returned)
    pace = abs(source.playhead.speed)
    if text := _news(source, FRESH * pace):
        return text
    if abs(sample.t) < WATCH * pace and (text := _watch(source)):
        return text
    sentences = lasting(source)
    return sentences[int(sample.step * abs(source.h) / (TURN * pace)) % len(sentences)]


def _news(source: Source, seconds: float) -> str:
    """The newest of the last simulated seconds; failures come first, then ways over the top, then verdicts."""
    kinds = ("verdict", "over the top", "failed")
    recent = [each for each in source.milestones if (source.sample.step - each.step) * abs(source.h) < seconds]
    newest = sorted(recent, key=lambda each: (kinds.index(each.kind), each.step))
    return next(filter(None, (_sentence(source, each) for each in reversed(newest))), "")


def _sentence(source: Source, milestone: Milestone) -> str:
    if milestone.kind != "verdict":
        return ending(milestone)
    return staying(source) if milestone.verdict == "bounded" else leaving(source, milestone.index)


def lasting(source: Source) -> list[str]:
    """What is known of the run by now, what matters most first; at least one sentence."""
    ended = endings(source)
    ends = sorted(ended.values(), key=lambda each: (each.kind != "failed", each.step))
    moves = [leaving(source, index) for index in range(len(METHODS)) if index not in ended]
    known = list(filter(None, [*map(ending, ends), staying(source), *moves]))
    return [*known, *filter(None, [_watch(source)])] if known else [so_far(source)]


def _watch(source: Source) -> str:
    """What the scene says to watch, as long as its step size is in force."""
    return source.scene.watch if source.h == source.scene.h else ""


def return_text(scene: Scene, sample: Sample) -> str:
    """How far each method is from its start, where time has run back to it: sqrt(dtheta² + (domega/w0)²)."""
    misses = [
        "failed"
        if reading.diverged_at is not None
        else f"{math.hypot(reading.theta - scene.theta, (reading.omega - scene.omega) / scene.w0):.2g}"
        for reading in sample.readings
    ]
    each = ", ".join(f"{method.letter} {miss}" for method, miss in zip(METHODS, misses, strict=True))
    return f"Back at t = 0, the start is missed by {each} rad."
