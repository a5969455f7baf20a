"""The tour without a screen: its sentences, each question, and after a pause the answer."""

import time
from collections.abc import Callable

from tui.playback.live import Live
from tui.words.numbers import seconds
from tui.words.plain_text import TICK
from tui.words.tour.guide import Guide
from tui.words.tour.steps import STEPS

THINKING, READING = 6.0, 5.0  # s, to find an answer, and to read it


def tell(
    live: Live,
    say: Callable[[str], object],
    stopped: Callable[[], bool],
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
) -> None:
    """Say all steps, until the last or until `stopped`."""
    guide = Guide(live)
    live.tick(clock())

    def wait(until: Callable[[], bool]) -> bool:
        while not (come := until()) and not stopped():
            sleep(TICK)
            live.tick(clock())
        return come and not stopped()

    def wait_for(time: float) -> bool:
        began = clock()
        return wait(lambda: clock() - began >= time)

    for at, step in enumerate(STEPS):
        guide.go(at)
        say(f"{guide.title}. {step.watch}")
        if not wait(guide.follow):
            return
        say(f"{seconds(live.sample.t)}: {step.sentence}")
        say(f"Question: {step.question}")
        if not wait_for(THINKING):
            return
        say(f"Answer: {step.answer}")
        if not wait_for(READING):
            return
    say("That was the tour.")
