"""The list of events: the user's changes and the methods' milestones."""

from collections.abc import Collection, Iterator, Sequence
from typing import Literal, NamedTuple

from pendu_tui.engine.methods import Method
from pendu_tui.engine.run.verdicts import FAILED, VERDICTS, Milestone
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words.insight import energy_ratio, short_name
from pendu_tui.tui.words.numbers import seconds, start, two_digits


class EventLine(NamedTuple):
    """A line of the list."""

    run: int
    step: int
    t: float  # s, simulated
    text: str
    kind: Literal["change", "mark", "milestone"]
    method: Method | None = None  # None for a user's change

    def __str__(self) -> str:
        return f"{seconds(self.t):>7} {self.text}"


def event_lines(source: Source, hidden: Collection[str] = ()) -> list[EventLine]:
    """Return starts, changes and marks of all runs and this run's milestones, in order.

    Those of methods with `hidden` keys are not listed, nor pauses and speeds, because they change
    no number.
    """
    run = source.sample.run
    conserved = source.scene.equations.conserves_energy
    milestones = [
        EventLine(run, each.step, each.t, _milestone(each, conserved), "milestone", each.method)
        for each in source.milestones
        if not {each.method.key, each.other and each.other.key}.intersection(hidden)
    ]
    # sorting is stable, so changes come first
    return sorted([*_inputs(source), *milestones], key=lambda line: line[:2])


def numbered(lines: Sequence[EventLine]) -> list[str]:
    """Return the lines, with the number of the run if there are several."""
    if len({line.run for line in lines}) == 1:
        return [str(line) for line in lines]
    return [f"{line.run:2} {line}" for line in lines]


def _inputs(source: Source) -> Iterator[EventLine]:
    marks = 0
    for event in source.events:
        place = (event.run, event.step, event.t)
        if event.kind == "mark":
            marks += 1
            text = f"mark {marks}: {event.text or ''}".removesuffix(": ")
            yield EventLine(*place, text, "mark")
        elif event.scene is not None:
            scene = event.scene
            name = scene.name
            if name == "custom":
                name = start(scene.theta, scene.omega)
            yield EventLine(*place, f"start {name}, h {scene.h:.4g} s", "change")
        elif event.h is not None:
            parts = [f"h {abs(event.h):.4g} s"]
            if event.h < 0:
                parts.insert(0, "time runs back")
            if event.equal_cost:
                parts.append("equal cost")
            yield EventLine(*place, ", ".join(parts), "change")


def _milestone(milestone: Milestone, conserved: bool) -> str:
    name = short_name(milestone.method)
    if milestone.other:
        return f"{name}'s error > {short_name(milestone.other)}'s"
    if milestone.kind != "over the top":
        word = FAILED if milestone.kind == FAILED else milestone.verdict
        return f"{name}: {VERDICTS[word].sign} {word}".replace(":  ", ": ")
    text = f"{name} over the top"
    if ratio := energy_ratio(milestone, conserved):
        unit = "E0" if conserved else "E(t)"
        text += f", {two_digits(ratio)} {unit}"
    return text
