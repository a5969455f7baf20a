"""The lab without a screen, for screen readers and logs: a sentence per second, and one for each event."""

import time
from collections.abc import Callable

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
) -> None:
    """Say what runs, then what happens, until `stopped` or the end of the recording."""
    for sentence in description(source):
        say(sentence)
    began, second, news = clock(), 0, False
    source.tick(began)
    known = set(event_lines(source))
    while not stopped() and not (source.kind == "REPLAY" and source.playhead.paused):
        sleep(TICK)
        source.tick(clock())
        for line in event_lines(source):
            if line not in known:
                known.add(line)
                news = True
                say(f"{seconds(line.t)}: {line.text}.")
        if clock() - began >= second + 1:
            second = int(clock() - began)
            say(insight(source) if news or second % TURN == 0 else numbers(source))
            news = False


def numbers(source: Source) -> str:
    """As "3.00 s: energy errors Explicit Euler +0.4, …"."""
    each = zip(source.scene.cast, source.sample.readings, strict=True)
    errors = [f"{short_name(method)} {reading.energy_error:+.2g}" for method, reading in each]
    return f"{seconds(source.sample.t)}: energy errors {', '.join(errors)}."
