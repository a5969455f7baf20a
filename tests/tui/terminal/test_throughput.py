"""A slow line is detected, and then hardly anything waits in it."""

import math
from collections import deque

import pytest

from tui.terminal.throughput import SYSTEM_BUFFER, Throughput

FRAME, FPS = 3000, 30  # bytes, 1/s


class Line:
    """A terminal that takes `rate` bytes a second; what the system does not hold keeps the writer waiting."""

    def __init__(self, rate: float) -> None:
        self.rate, self.held, self.now = rate, 0.0, 0.0
        self.throughput = Throughput()
        self.writing: deque[tuple[float, int]] = deque()  # since when, bytes
        self.frames = 0

    def run(self, seconds: float) -> float:
        """The longest delay meanwhile, in s, of what is sent every frame that the wire allows."""
        longest = 0.0
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.held = max(0.0, self.held - self.rate / FPS)
            while self.writing and self.held - sum(size for _, size in list(self.writing)[1:]) <= SYSTEM_BUFFER:
                began, size = self.writing.popleft()
                self.throughput.written(size, began, self.now)
                if self.writing:
                    self.writing[0] = self.now, self.writing[0][1]
            self.throughput.tick(self.now)
            if not self.throughput.is_busy:
                self.send(FRAME)
                self.frames += 1
            longest = max(longest, self.held / self.rate)
        return longest

    def send(self, size: int) -> None:
        self.throughput.send(size)
        self.held += size
        if self.held <= SYSTEM_BUFFER:
            self.throughput.written(size, self.now, self.now)
        else:
            self.writing.append((self.now, size))


def test_a_fast_line_gets_every_frame():
    line = Line(math.inf)
    line.run(10)
    assert line.frames == 10 * FPS
    assert line.throughput.rate == math.inf


@pytest.mark.parametrize("rate", [16_000, 64_000])
def test_a_slow_line_gets_fewer_frames_and_each_arrives_earlier(rate):
    line = Line(rate)
    assert line.run(10) > SYSTEM_BUFFER / rate  # until it is found out
    line.frames = 0
    delays = [line.run(1) for _ in range(10)]
    assert sorted(delays)[5] < 0.7 * SYSTEM_BUFFER / rate
    assert line.frames * FRAME > 0.6 * 10 * rate


def test_a_line_that_improved_gets_every_frame_again():
    line = Line(32_000)
    line.run(10)
    line.rate, line.frames = math.inf, 0
    line.run(60)
    line.frames = 0
    line.run(1)
    assert line.frames == FPS


@pytest.mark.parametrize("rate", [16_000, 64_000])
def test_two_large_frames_suffice_to_estimate_the_rate(rate):
    line = Line(rate)
    line.send(60_000)
    line.send(60_000)
    line.run(120_000 / rate)
    assert 0.7 * rate < line.throughput.rate < 1.4 * rate  # more is known at the next wait


@pytest.mark.parametrize(("size", "seconds"), [(100, 33.0), (3000, 0.7), (60_000, 5.0)])
def test_one_stall_does_not_make_a_fast_line_slow(size, seconds):
    line = Line(math.inf)
    line.run(2)
    line.throughput.send(size)
    assert line.throughput.is_busy  # Ctrl+S, or a mouse that selects
    line.throughput.written(size, line.now, line.now + seconds)
    line.now += seconds
    line.frames = 0
    line.run(1)
    assert line.frames == FPS
    assert not line.throughput.is_slow


def test_a_restart_forgets_what_the_last_writer_did_not_write():
    throughput = Throughput()
    throughput.send(3000)
    assert throughput.is_busy
    throughput.restart()
    assert not throughput.is_full
