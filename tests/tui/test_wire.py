"""A wire that carries less than is sent is found out, and then nothing waits in it."""

import math

import pytest

from tui.wire import SYSTEMS, Wire

FRAME, FPS = 3000, 30  # bytes, 1/s


class Line:
    """A terminal that takes `rate` bytes a second, of which the system holds some back."""

    def __init__(self, rate: float) -> None:
        self.rate, self.held, self.now = rate, 0.0, 0.0
        self.wire = Wire()
        self.frames = 0

    def run(self, seconds: float) -> float:
        """The longest delay meanwhile, in s, of what is sent every frame that the wire allows."""
        longest = 0.0
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.held = max(0.0, self.held - self.rate / FPS)
            if not self.wire.is_busy(self.held > SYSTEMS, self.now):
                self.wire.send(FRAME)
                self.held += FRAME
                self.frames += 1
            longest = max(longest, self.held / self.rate)
        return longest


def test_a_fast_line_gets_every_frame():
    line = Line(math.inf)
    line.run(10)
    assert line.frames == 10 * FPS
    assert line.wire.rate == math.inf


@pytest.mark.parametrize("rate", [16_000, 64_000])
def test_what_a_slow_line_holds_back_is_sent_less_often_and_comes_earlier(rate):
    line = Line(rate)
    assert line.run(10) > SYSTEMS / rate  # until it is found out
    line.frames = 0
    delays = [line.run(1) for _ in range(10)]
    assert sorted(delays)[5] < 0.7 * SYSTEMS / rate
    assert line.frames * FRAME > 0.6 * 10 * rate


def test_a_line_that_has_become_better_is_used_again():
    line = Line(32_000)
    line.run(10)
    line.rate, line.frames = math.inf, 0
    line.run(60)
    line.frames = 0
    line.run(1)
    assert line.frames == FPS


def test_a_line_that_stands_still_is_not_given_up():
    line = Line(math.inf)
    line.run(2)
    line.wire.send(100)
    assert all(line.wire.is_busy(True, line.now + n / FPS) for n in range(1000))  # Ctrl+S
    assert line.wire.rate > 0.5 * FRAME * FPS
    assert not line.wire.is_busy(False, line.now + 1000)


def test_a_while_that_was_not_lived_says_nothing_of_the_line():
    line = Line(math.inf)
    line.run(2)
    line.now += 60  # Ctrl+Z
    assert line.wire.is_busy(True, line.now)
    assert line.wire.rate == math.inf
