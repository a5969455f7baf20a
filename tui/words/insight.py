"""What to notice, a sentence at a time: from measured events and verdicts only."""

import math

from engine.methods import METHODS
from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.scenes import Scene
from tui.playback.source import Source
from tui.words.findings import failed, leaving, over_the_top, so_far, staying

WATCH = 8.0  # s of the clock during which a run's beginning says what to watch
FRESH = 6.0  # s of the clock for which something is news
RESTING = "Nothing moves: the pendulum started at rest where no force acts on it."
TURN = 8.0  # s of the clock for which one of the lasting sentences stays


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
    return sentences[int(sample.step * abs(source.stepping.h) / (TURN * pace)) % len(sentences)]


def _news(source: Source, seconds: float) -> str:
    """What has happened within the last simulated seconds; failures come first, then tops, then verdicts."""
    sample, kinds = source.sample, ("failed", "over the top", "verdict")
    recent = [each for each in source.milestones if (sample.step - each.step) * abs(source.stepping.h) < seconds]
    newest = sorted(recent, key=lambda each: (-kinds.index(each.kind), each.step))
    return next(filter(None, (_told(source, each) for each in reversed(newest))), "")


def _told(source: Source, milestone: Milestone) -> str:
    if milestone.kind == "failed":
        return failed(milestone)
    if milestone.kind == "over the top":
        return over_the_top(milestone)
    return staying(source) if milestone.verdict == "bounded" else leaving(source, milestone.index)


def lasting(source: Source) -> list[str]:
    """What is known of the run by now, what matters most first; at least one sentence."""
    happened = {(each.kind, each.index): each for each in source.milestones}
    failures = [failed(each) for (kind, _), each in happened.items() if kind == "failed"]
    tops = [
        over_the_top(each)
        for (kind, index), each in happened.items()
        if kind == "over the top" and ("failed", index) not in happened
    ]
    moves = [leaving(source, index) for index in range(len(METHODS)) if not happened.keys() & _gone(index)]
    known = list(filter(None, [*failures, *tops, staying(source), *moves]))
    return [*known, *filter(None, [_watch(source)])] if known else [so_far(source)]


def _watch(source: Source) -> str:
    """What the scene says to watch, as long as its step size is in force."""
    return source.scene.watch if source.stepping.h == source.scene.h else ""


def _gone(index: int) -> set[tuple[str, int]]:
    return {("failed", index), ("over the top", index)}


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
