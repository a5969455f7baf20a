"""The lab without a screen, for screen readers and logs: a sentence per second, and one for each event."""

import time
from collections.abc import Callable

from engine.methods import Cast
from tui.playback.source import Source
from tui.words.describe import description
from tui.words.events import event_lines
from tui.words.findings import short_name
from tui.words.insight import TURN, insight
from tui.words.numbers import seconds

TICK = 1 / 30  # s, as often as the screen would be painted


def plain(
    source: Source,
    say: Callable[[str], object],
    stopped: Callable[[], bool],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
    only: Cast | None = None,
) -> None:
    """Say what runs, then what happens, until `stopped` or the end of the recording; `only` of these methods."""
    for sentence in description(source, only):
        say(sentence)
    began, second, news = clock(), 0, False
    source.tick(began)
    known = set(event_lines(source))
    while not stopped() and not (source.kind == "REPLAY" and source.playhead.paused):
        sleep(TICK)
        source.tick(clock())
        for line in event_lines(source):
            if line not in known and (only is None or line.method is None or line.method in only):
                known.add(line)
                news = True
                say(f"{seconds(line.t)}: {line.text}.")
        if clock() - began >= second + 1:
            second = int(clock() - began)
            lasting = only is None and (news or second % TURN == 0)  # the sentences are about all methods
            say(insight(source) if lasting else numbers(source, only))
            news = False


def numbers(source: Source, only: Cast | None = None) -> str:
    """As "3.00 s: energy errors Explicit Euler +0.4, …"."""
    each = zip(source.scene.cast, source.sample.readings, strict=True)
    shown = [(method, reading) for method, reading in each if only is None or method in only]
    errors = [f"{short_name(method)} {reading.energy_error:+.2g}" for method, reading in shown]
    return f"{seconds(source.sample.t)}: energy errors {', '.join(errors)}."
