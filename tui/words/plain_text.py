"""The lab and its tour without a screen, for screen readers and logs."""

import time
from collections.abc import Callable

from engine.methods import Cast
from tui.cli.errors import UserError
from tui.playback.live import Live
from tui.playback.source import Source
from tui.words.describe import description
from tui.words.events import event_lines
from tui.words.insight import TURN, insight_text, short_name
from tui.words.numbers import seconds
from tui.words.tour import STEPS, Tour

TICK = 1 / 30  # s, as often as the screen would be painted
THINKING = 6.0  # s, to find an answer
READING = 5.0  # s, to read it


def print_run(
    source: Source,
    emit: Callable[[str], object],
    stopped: Callable[[], bool],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
    only: Cast | None = None,
) -> None:
    """Emit a sentence a second and one for each event until `stopped` or the end of a recording.

    `only`: of these methods.
    """
    for sentence in description(source, only):
        emit(sentence)
    began = clock()
    second = 0
    has_news = False
    source.tick(began)
    emitted = set(event_lines(source))
    while not stopped() and not (source.kind == "REPLAY" and source.playhead.paused):
        sleep(TICK)
        source.tick(clock())
        if source.failure:
            raise UserError(source.failure)
        for line in event_lines(source):
            if line not in emitted and (only is None or line.method is None or line.method in only):
                emitted.add(line)
                has_news = True
                emit(f"{seconds(line.t)}: {line.text}.")
        if clock() - began >= second + 1:
            second = int(clock() - began)
            explain = only is None and (has_news or second % TURN == 0)  # about all methods
            emit(insight_text(source) if explain else numbers(source, only))
            has_news = False


def numbers(source: Source, only: Cast | None = None) -> str:
    """Return as "3.00 s: energy errors Explicit Euler +0.4, …"."""
    each = zip(source.scene.cast, source.sample.readings, strict=True)
    shown = [(method, reading) for method, reading in each if only is None or method in only]
    errors = [f"{short_name(method)} {reading.energy_error:+.2g}" for method, reading in shown]
    return f"{seconds(source.sample.t)}: energy errors {', '.join(errors)}."


def print_tour(
    live: Live,
    emit: Callable[[str], object],
    stopped: Callable[[], bool],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
) -> None:
    """Emit the shots: question and, after a pause, truth, until the last or until `stopped`."""
    tour = Tour(live)
    live.tick(clock())

    def wait_until(come: Callable[[], bool]) -> None:
        while not stopped() and not come():
            sleep(TICK)
            live.tick(clock())

    def pause(time: float) -> None:
        end = clock() + time
        wait_until(lambda: clock() >= end)

    for index, step in enumerate(STEPS):
        tour.begin(index)
        emit(f"{tour.title}. {step.watch}")
        wait_until(tour.follow)
        if stopped():
            return
        emit(f"{seconds(live.sample.t)}: {step.happened}")
        emit(f"Question: {step.question}  1: {step.answers[0]}  2: {step.answers[1]}")
        pause(THINKING)
        if stopped():
            return
        emit(f"Answer: {step.right + 1}. {step.truth}")
        pause(READING)
    if not stopped():
        emit("That was the tour.")
