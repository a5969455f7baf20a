"""What a frame takes, in function calls, after an hour and after eight."""

import sys
from collections.abc import Callable

import pytest

from engine.scenes import DEFAULT_SCENE
from tui.playback.live import Live

FRAMES = 512  # whole rounds of merging old rows of the history
SKIPPED = 256  # s between samples, so that an hour takes a moment


def calls(work: Callable[[], object]) -> int:
    """How many functions were called."""
    count = 0

    def counted(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(counted)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.slow
def test_a_frame_takes_as_much_after_eight_hours_as_after_one():
    now, live, taken = 0.0, Live(DEFAULT_SCENE.altered(h=0.05), clock=lambda: 0.0), []

    def frames() -> None:
        nonlocal now
        for _ in range(FRAMES):
            now += 1 / 30
            live.tick(now)
            live.history.trails(300)
        live.history.window(20.0)
        live.history.window()
        _ = live.judgements, live.milestones

    for hours in (1, 8):
        live.set_speed(SKIPPED * 30.0)
        while live.sample.t < hours * 3600:
            now += 1 / 30
            live.tick(now)
        live.set_speed(1.0)
        frames()  # whose samples are close to each other again
        taken.append(calls(frames))
    assert taken[1] < 1.1 * taken[0]
