"""What an undo took back, in a sentence."""

from typing import NamedTuple, Self

from engine.run.stepping import Stepping
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.words.numbers import factor, seconds

_NAMES = {
    "hidden": "the methods shown",
    "exact": "the exact motion",
    "overlay": "one pivot or one pane each",
    "trails": "trails",
    "quantity": "the quantity of the chart",
    "log": "log or linear",
    "seconds": "the window of the chart",
    "stretch": "the zoom of the chart",
}


class State(NamedTuple):
    """What an undo may change."""

    run: int
    scene: str
    t: float  # s, simulated
    stepping: Stepping
    speed: float
    shown: Shown

    @classmethod
    def of(cls, source: Source, shown: Shown) -> Self:
        sample = source.sample
        return cls(sample.run, source.scene.name, sample.t, source.stepping, source.playhead.speed, shown)


def undone(before: State, after: State) -> str:
    """What has changed from one state to the other, by an undo."""
    if after.run != before.run and after.stepping == before.stepping:
        return f"Undone: back to {after.scene} at {seconds(after.t)}"
    if after.stepping != before.stepping:
        h, cost = f"h {after.stepping.h:.4g} s", "equal cost" if after.stepping.equal_cost else "equal steps"
        what = cost if after.stepping.equal_cost != before.stepping.equal_cost else h
        return f"Undone: {what} again" if after.run == before.run else f"Undone: back to {after.scene}, {what}"
    if after.speed != before.speed:
        return f"Undone: {factor(after.speed)}× again"
    changed = [name for name in _NAMES if getattr(before.shown, name) != getattr(after.shown, name)]
    return f"Undone: {', '.join(_NAMES[name] for name in changed) or 'nothing has changed'}"
