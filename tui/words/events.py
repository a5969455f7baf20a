"""The list of events: the user's inputs and the methods' milestones, with their simulated times."""

import math
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from engine.methods import Method
from engine.run.judgement import Milestone, Verdict
from recordings.events import Event
from tui.playback.source import Source
from tui.words.insight import short_name
from tui.words.numbers import start, two_digits

VERDICTS: dict[Verdict, str] = {
    "bounded": "stays bounded",
    "loses": "loses energy",
    "grows": "gains energy",
    "chaotic": "turns chaotic",
    "caught": "is caught",
    "wanders": "wanders",
    "failed": "failed",
    "too early": "is undecided again",
}


class EventLine(NamedTuple):
    """A line of the list."""

    run: int
    step: int
    t: float  # s, simulated
    text: str
    kind: Literal["change", "mark", "milestone"]
    method: Method | None = None  # of a milestone

    def __str__(self) -> str:
        return f"{self.t:7.2f} {self.text}" if abs(self.t) < 1e4 else f"{self.t:7.1e} {self.text}"


def event_lines(source: Source) -> list[EventLine]:
    """Return starts, changes and marks of all runs, and the milestones of this one; earliest first.

    Pauses and speeds are not listed: they change no number.
    """
    run = source.sample.run
    conserved = source.scene.equations.energy_error.conserved
    milestones = [
        EventLine(run, m.step, m.t, milestone_text(m, conserved), "milestone", m.method)
        for m in source.milestones
    ]
    # stable: inputs first
    return sorted([*_inputs(source), *milestones], key=lambda line: line[:2])


def numbered(lines: Sequence[EventLine]) -> list[str]:
    """The lines, where there are several runs each with the number of its own."""
    several = len({line.run for line in lines}) > 1
    return [f"{line.run:2} {line}" if several else str(line) for line in lines]


def _inputs(source: Source) -> Iterator[EventLine]:
    marks = 0
    backwards = False
    for event in [*source.events, *source.later_marks]:
        where = event.run, event.step, event.t
        if event.kind == "mark":
            marks += 1
            yield EventLine(
                *where, f"mark {marks}" + (f": {event.text}" if event.text else ""), "mark"
            )
        elif event.kind in ("start", "set_h"):
            yield EventLine(*where, change_text(event, backwards), "change")
            backwards = event.h is not None and event.h < 0


def change_text(event: Event, was_backwards: bool = False) -> str:
    """A start, or a change of the step size, after which time may run forwards again."""
    if event.scene is not None:
        scene = event.scene
        name = start(scene.theta, scene.omega) if scene.name == "custom" else scene.name
        return f"start {name}, h {scene.h:.4g} s"
    assert event.h is not None
    way = "time reversed, " if event.h < 0 else "time forwards again, " if was_backwards else ""
    return f"{way}h {abs(event.h):.4g} s{', equal cost' if event.equal_cost else ''}"


def milestone_text(milestone: Milestone, conserved: bool = True) -> str:
    """What a method does."""
    name = short_name(milestone.method)
    if milestone.kind == "over the top":
        unit = "E0" if conserved else "E(t)"
        error = (
            milestone.energy_error if conserved else math.expm1(min(milestone.energy_error, 700.0))
        )
        energy = (
            f"{two_digits(1 + error)} {unit}"
            if not 1e-4 < abs(error) < 0.1
            else f"{100 * error:+.2g} %"
        )
        return f"{name} over the top, {energy}"
    if milestone.other:
        other = short_name(milestone.other)
        return f"{name}'s error {'passes' if len(name + other) < 22 else '>'} {other}'s"
    return f"{name} {VERDICTS['failed' if milestone.kind == 'failed' else milestone.verdict]}"
