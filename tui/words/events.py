"""The diary of a sitting: what was done, and what the methods did, with the simulated times."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from engine.run.observer import Milestone
from recordings.events import Event
from tui.drawing.palette import FRAME, TEXT
from tui.playback.source import Source
from tui.words.findings import short, times


class Line(NamedTuple):
    """A line of the diary."""

    run: int
    step: int
    t: float  # s, simulated
    text: str
    owner: int  # whose colour it has

    def __str__(self) -> str:
        return f"{self.t:7.2f} {self.text}" if abs(self.t) < 1e4 else f"{self.t:7.1e} {self.text}"


def diary(source: Source) -> list[Line]:
    """Starts, changes and marks of all runs, and what happened in the one on screen; earliest first.

    Pauses and speeds are no part of the diary: they change no number.
    """
    run = source.sample.run
    happened = [Line(run, each.step, each.t, happening_text(each), each.index) for each in source.milestones]
    return sorted([*_done(source), *happened], key=lambda line: line[:2])  # stable: first what was done


def _done(source: Source) -> Iterator[Line]:
    marks = 0
    for event in [*source.events, *source.later_marks]:
        if event.kind == "mark":
            marks += 1
            yield _line(event, f"mark {marks}" + (f": {event.text}" if event.text else ""), TEXT)
        elif event.kind in ("start", "set_h"):
            yield _line(event, change_text(event), FRAME)


def _line(event: Event, text: str, owner: int) -> Line:
    return Line(event.run, event.step, event.t, text, owner)


def change_text(event: Event) -> str:
    """A start, or a change of the step size."""
    if event.scene is not None:
        scene = event.scene
        numbers = f"{math.degrees(scene.theta):.4g}° {scene.omega:.4g} rad/s"
        return f"start {numbers if scene.name == 'custom' else scene.name}, h {scene.h:.4g} s"
    assert event.h is not None
    backwards, equal = "time backwards, " if event.h < 0 else "", ", equal cost" if event.equal_cost else ""
    return f"{backwards}h {abs(event.h):.4g} s{equal}"


def happening_text(milestone: Milestone) -> str:
    """What a method did."""
    name = short(milestone.method)
    match milestone.kind:
        case "over the top":
            return f"{name} over the top, {times(1 + milestone.energy_error)} E0"
        case "failed":
            return f"{name} failed"
        case "verdict":
            return f"{name}: {milestone.verdict}"
