"""The lab and its lessons as sentences, for readers who cannot see the screen, and for logs."""

import time
from collections.abc import Callable

from pendu_tui.engine.methods import Cast
from pendu_tui.engine.run.verdicts import BOUNDED
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.playback.lesson import Lesson
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.words import insight
from pendu_tui.tui.words.events import event_lines
from pendu_tui.tui.words.numbers import about, seconds, start

READING = 6.0  # s, to read a sentence, or to find an answer


def description(source: Source, only: Cast | None = None) -> list[str]:
    """Describe the run, its methods (or `only` these), and the recording."""
    scene = source.scene
    playhead = source.playhead
    kind = "The lab" if source.kind == "LIVE" else "The replay"
    state = f"runs at {playhead.speed:.4g} times real time and is"
    if playhead.paused:
        state = "is paused"
    elif playhead.speed == 1:
        state = "runs in real time and is"
    at = f'{seconds(source.sample.t)} of run {source.sample.run} of the scene "{scene.name}"'
    motion = ""
    if source.exact.period is not None:
        cycle = "turn" if source.exact.regime == "rotation" else "swing"
        motion = f"; one {cycle} takes {about(source.exact.period)}"
    began = f"{start(scene.theta, scene.omega)}{motion}"
    lines = [
        f"{kind} {state} at {at}.",
        f"The pendulum is {scene.length:.4g} m long and started at {began}.",
        f"The step size is {step_text(source)}.",
    ]
    if source.failure:
        lines.append(f"It stands still: {source.failure}")
    if source.ghost:
        lines.append(f"Under it, {source.ghost.label}.")
    for index, method in enumerate(scene.cast):
        if only is None or method in only:
            lines.append(method_sentence(source, index))
    return [*lines, _recording(source)]


def step_text(source: Source) -> str:
    """Describe the step: "0.2 s, z = 0.626; at equal cost, the cheaper methods split it"."""
    h = source.stepping.h
    text = f"{abs(h):.4g} s, z = {abs(h) * source.scene.equations.fastest:.3g}"
    if source.stepping.equal_cost:
        text += "; at equal cost, the cheaper methods split it"
    if h < 0:
        text += "; time runs backwards"
    return text


def method_sentence(source: Source, index: int) -> str:
    """Say how a method failed or went over the top, else give its verdict or error."""
    method = source.scene.cast[index]
    reading = source.sample.readings[index]
    judgement = source.judgements[index]
    found = [insight.drift(source, index)]
    if milestone := insight.endings(source).get(index):
        conserved = source.scene.equations.conserves_energy
        irregular = insight.irregular(method, judgement, reading.energy_error)
        found = [insight.milestone_insight(milestone, conserved), irregular]
    elif judgement.verdict == BOUNDED:
        error = reading.max_energy_error
        return f"{method.label} stays bounded: its largest energy error is {error:.2g}."
    if sentences := " ".join(insight.sentence(each) for each in found if each):
        return sentences
    return f"{method.label} has an energy error of {reading.energy_error:+.2g}; {judgement}."


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
    only: Cast | None = None,
) -> None:
    """Emit the description and each event, until `stopped` or the end of a recording.

    `only` restricts them to these methods.  A lesson goes on by itself, after time to read it.
    """
    if lesson is not None and isinstance(source, Live):
        lesson.begin(source, 0)
    for sentence in description(source, only):
        emit(sentence)
    source.tick(clock())
    known = set(event_lines(source))
    told: tuple[str, ...] = ()
    while not stopped() and not (source.kind == "REPLAY" and source.playhead.paused):
        before = source.sample
        source.tick(clock())
        if source.failure:
            raise UserError(source.failure)
        for line in event_lines(source):
            if line not in known and (only is None or line.method is None or line.method in only):
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
