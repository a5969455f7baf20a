"""The lab in plain text: its description, its events, and what happens in it, sentence by sentence.

For readers who cannot see the screen, and for logs.
"""

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import Literal, NamedTuple

from pendu_tui.engine.methods import Method
from pendu_tui.engine.run.verdicts import BOUNDED, FAILED, VERDICTS, Milestone
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.playback.lesson import Lesson
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words.insight import energy_ratio, lasting, short_name
from pendu_tui.tui.words.numbers import about, factor, seconds, start, two_digits

READING = 6.0  # s, to read a sentence, or to find an answer


def description(source: Source, stands_still: bool = False) -> list[str]:
    """Describe the run, its methods and the recording."""
    scene = source.scene
    kind = "The lab" if source.kind == "LIVE" else "The replay"
    state = f"runs at {factor(source.playhead.speed)}× speed and is"
    if source.playhead.paused or stands_still:
        state = "is paused"
    at = f'{seconds(source.sample.t)} of run {source.sample.run} of the scene "{scene.name}"'
    began = start(scene.theta, scene.omega).replace("°", "°,")
    if source.exact.period is not None:
        cycle = "one turn takes" if source.exact.regime == "rotation" else "the period is"
        began += f"; {cycle} {about(source.exact.period)}"
    h = source.stepping.h
    step = f"{abs(h):.4g} s, z = {abs(h) * scene.equations.fastest:.3g}"
    if source.stepping.equal_cost:
        step += "; at equal cost, the cheaper methods split it"
    if h < 0:
        step += "; time runs backwards"
    lines = [
        f"{kind} {state} at {at}.",
        f"The pendulum is {scene.length:.4g} m long and started at {began}.",
        f"The step size is {step}.",
    ]
    if source.failure:
        lines.append(f"The run has stopped: {source.failure}")
    if source.ghost:
        lines.append(f"{source.ghost.label.capitalize()}.")
    methods = [method_sentence(source, index) for index in range(len(scene.cast))]
    return [*lines, *methods, _recording(source)]


def method_sentence(source: Source, index: int) -> str:
    """Say what is known of a method, else its error and what its verdict lacks."""
    method = source.scene.cast[index]
    reading = source.sample.readings[index]
    judgement = source.judgements[index]
    others = {each.key for each in source.scene.cast} - {method.key}
    found = [each.text for each in lasting(source, others) if each.kind != "watch"]
    if not found:
        return f"{method.label} has an energy error of {reading.energy_error:+.2g}; {judgement}."
    if judgement.verdict == BOUNDED:
        found.append(f"Its largest energy error is {reading.max_energy_error:.2g}.")
    return " ".join(found)


def _recording(source: Source) -> str:
    status = source.recording_status
    if status is None:
        return "Not recording."
    if status.failed:
        return f"Not recording: {status.failed}"
    if source.kind == "LIVE":
        return f"Recorded so far: {seconds(status.seconds)} in {status.name}."
    return f"The recording {status.name} is {seconds(status.seconds)} long."


def tell(
    source: Source,
    emit: Callable[[str], object],
    stopped: Callable[[], bool],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
    lesson: Lesson | None = None,
) -> None:
    """Emit the description and each event, until `stopped` or the end of a recording.

    A lesson continues by itself, after time to read it.
    """
    if lesson is not None and isinstance(source, Live):
        lesson.begin(source, 0)
    for text in description(source):
        emit(text)
    known = set(event_lines(source))
    told: tuple[str, ...] = ()
    while not stopped() and not (source.kind == "REPLAY" and source.playhead.paused):
        before = source.sample
        source.tick(clock())
        if source.failure:
            raise UserError(source.failure)
        for line in event_lines(source):
            if line not in known:
                known.add(line)
                emit(f"{seconds(line.t)}: {line.text}.")
        if lesson is not None and isinstance(source, Live):
            lesson.follow(source, before)
            if lesson.text != told:
                told = lesson.text
                next_at = clock() + READING
                emit(" ".join([f"{lesson.title}.", *told]))
            is_moving = lesson.stage == "watching" and lesson.shot.moment is not None
            if not is_moving and clock() >= next_at and not lesson.forward(source):
                return
        sleep(1 / 30)


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
    h = 0.0
    for event in source.events:
        place = (event.run, event.step, event.t)
        if event.kind == "mark":
            marks += 1
            text = f"mark {marks}: {event.text or ''}".removesuffix(": ")
            yield EventLine(*place, text, "mark")
        elif event.scene is not None:
            scene = event.scene
            h = scene.h
            name = scene.name
            if name == "custom":
                name = start(scene.theta, scene.omega)
            yield EventLine(*place, f"start {name}, h {h:.4g} s", "change")
        elif event.h is not None:
            text = f"h {abs(event.h):.4g} s"
            if event.equal_cost:
                text = f"max {text}, equal cost"
            if event.h < 0:
                text = f"time runs backwards, {text}"
            elif h < 0:
                text = f"time runs forwards, {text}"
            h = event.h
            yield EventLine(*place, text, "change")


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
