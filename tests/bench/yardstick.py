"""Compare the lab with Textual alone painting as much; only their ratios hold on other machines.

The real program runs and records on a pseudo-terminal.  Beside it painter.py shows a film of the
same seconds, so that other work of the machine slows both alike.  Keys are timed for one program at
a time.  A frame is a burst of output that redraws a pendulum.
"""

import re
import select
import sys
import time
import timeit
from itertools import pairwise
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from mcap.reader import make_reader

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.recordings.events import simulate
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from tests.bench import painter
from tests.tui.command_line import PENDU
from tests.tui.pty_lab import PtyLab

LIMITS = {
    "processor_ratio": 1.5,
    "frame_p99_ms": 45,
    "key_p95_ms": 50,
    "kilobytes_per_second": 200,
    "first_pendulum_ratio": 1.35,
    "opening_ratio": 0.2,
}
SIZE = (120, 40)
KEYS = 30
LAB = ("live", "--h", str(painter.H))
PAINTER = [sys.executable, "-m", "tests.bench.painter"]
CURSOR = re.compile(rb"\x1b\[(\d+);(\d+)H(?=\x1b\[[\d;]*m)")  # where text follows
PENDULUMS = 47  # columns from the left
BRAILLE = re.compile(rb"\xe2[\xa0-\xa3][\x80-\xbf]")
BURST = 0.004  # s


def drain(*programs: PtyLab, seconds: float) -> None:
    """Read what some programs send in so many seconds."""
    end = time.monotonic() + seconds
    by_terminal = {program.terminal: program for program in programs}
    while time.monotonic() < end:
        for terminal in select.select(list(by_terminal), [], [], 0.01)[0]:
            by_terminal[terminal].read(0.0)


Start = tuple[float, float, int]


def now(program: PtyLab) -> Start:
    """Return the processor time [s], the time [s] and the bytes sent so far."""
    return program.cpu_seconds(), program.now, len(program.output)


def figures(program: PtyLab, start: Start) -> dict[str, float]:
    """Return what a program has used and sent since a start."""
    cpu, began, sent = start
    elapsed = program.now - began
    frames = [began]
    end = 0
    for moment, size in program.reads:
        begin = end
        end += size
        cursors = CURSOR.findall(program.output, begin, end)
        moved = any(int(column) <= PENDULUMS and 1 < int(row) < 30 for row, column in cursors)
        if begin >= sent and moved and moment - frames[-1] > BURST:
            frames.append(moment)
    gaps = sorted(after - before for before, after in pairwise(frames)) or [elapsed]
    return {
        "percent": 100 * (program.cpu_seconds() - cpu) / elapsed,
        "kilobytes_per_second": (len(program.output) - sent) / elapsed / 1000,
        "frame_p99_ms": 1000 * gaps[int(0.99 * len(gaps))],
    }


def key_p95_ms(program: PtyLab) -> float:
    """Return the time from a key to its effect on the screen [ms], exceeded once in twenty."""
    times = []
    keys = [("+", "h 0.02 s"), ("-", "h 0.01 s")] * (KEYS // 2)
    for number, (key, effect) in enumerate(keys):
        program.run(0.1 + number / 300)  # at any moment of a frame
        began = program.now
        program.type(key)
        times.append(1000 * (program.wait_for(effect) - began))
    return sorted(times)[int(0.95 * KEYS)]


def end(program: PtyLab) -> None:
    program.type("q")
    program.end()


def beside_painter() -> dict[str, float]:
    """Return the figures of the lab, and its ratio to Textual alone."""
    with TemporaryDirectory() as folder, PtyLab(*map(str, SIZE), program=PAINTER) as textual:
        textual.wait_for("\x1b[?1049h", 90.0)
        textual.run(2.0)
        with PtyLab(*LAB, PENDU_RECORDINGS=folder) as lab:
            lab.wait_for("REC 2 s")
            drain(lab, textual, seconds=painter.BEGIN - 2.0)
            starts = now(lab), now(textual)
            drain(lab, textual, seconds=painter.SECONDS)
            of_lab, of_textual = map(figures, (lab, textual), starts)
            of_lab["processor_ratio"] = of_lab["percent"] / of_textual["percent"]
            lab.run(0.5)  # reads what has piled up meanwhile
            of_lab["key_p95_ms"] = key_p95_ms(lab)
            end(lab)
            end(textual)
    return of_lab


def first_pendulum_ratio(starts: int) -> float:
    """Return the time to the first pendulum over that to an empty app's first paint."""
    programs = ((BRAILLE, [*PENDU, *LAB, "--no-record"]), ("empty", PAINTER))
    times: list[list[float]] = [[], []]
    for _ in range(starts):
        for (sign, program), found in zip(programs, times, strict=True):
            # let the first start write the bytecode, as users' does
            with PtyLab(program=program, PYTHONDONTWRITEBYTECODE="") as lab:
                found.append(lab.wait_for(sign))
                end(lab)
    pendulums, empty = map(median, times)
    return round(pendulums / empty, 2)


def opening_ratio() -> float:
    """Return the time to open a lab's hour, of 7200 chunks, over that of mcap for its summary."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "a.mcap")
        with Recorder(path) as recorder:
            for _ in simulate(DEFAULT_SCENE, 360.0, recorder.add, sample_every=1):
                recorder.flush()
        cpu = {"timer": time.process_time, "number": 1, "repeat": 15}
        ours = timeit.repeat(lambda: Recording.open(path).close(), **cpu)
        with path.open("rb") as file:
            theirs = timeit.repeat(lambda: make_reader(file).get_summary(), **cpu)
    return round(min(ours) / min(theirs), 2)


def measure(share: float) -> dict[str, Any]:
    rounds = [beside_painter() for _ in range(max(1, round(5 * share)))]
    return {
        **{name: round(median(each[name] for each in rounds), 2) for name in rounds[0]},
        "first_pendulum_ratio": first_pendulum_ratio(max(1, round(9 * share))),
        "opening_ratio": opening_ratio(),
    }
