"""The lab beside Textual alone painting as much: one JSON object.  Only the ratios travel from machine to machine.

python tests/bench/yardstick.py [lab|phase|replay|paused|start] …    all of them by default

The real program runs on a pseudo-terminal of 120×40 (phase view: 200×60), recording, with everything moving.  The app
in painter.py shows a film of the lab in the same seconds, so that other work of the machine slows both alike.  Keys
are timed for one program at a time.  Processor time is the process's own.
A changed row is a piece of a row that is sent; a frame is a burst of output that redraws a pendulum.
"""

import itertools
import json
import re
import select
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from statistics import mean, median

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.bench import painter as film
from tests.tui.pty_lab import PtyLab

ROUNDS, SECONDS, KEYS, STARTS, MOVES = 5, float(film.SECONDS), 30, 9, 40
LAB = ("live", "--h", "0.01")  # more than one step a frame, so that every frame moves
PAINTER = [sys.executable, str(Path(__file__).with_name("painter.py"))]
SMALL, LARGE, F3 = (120, 40), (200, 60), "\x1bOR"
CURSOR = re.compile(rb"\x1b\[(\d+);(\d+)H(?=\x1b\[[\d;]*m)")  # where something follows
PENDULUMS = 47  # columns from the left
BRAILLE = re.compile(rb"\xe2[\xa0-\xa3][\x80-\xbf]")
BURST = 0.004  # s
REACH = {  # ratios, but for what is named with its unit
    "processor": 1.5,
    "frames_per_second": 29.5,
    "frame_p99_ms": 45,
    "key_p95_ms": 50,
    "kilobytes_per_second": 200,
    "phase_processor": 1.6,
    "phase_kilobytes_per_second": 600,
    "replay_processor": 1.0,
    "paused_percent": 2.0,
    "first_pendulum": 1.4,
}
Figures = dict[str, float]


def lab(folder: str, *, size: tuple[int, int] = SMALL) -> PtyLab:
    """The lab, recording."""
    running = PtyLab(*LAB, size=size, PENDU_RECORDINGS=folder)
    running.wait_for("REC 2 s")
    return running


def painter(size: tuple[int, int] = SMALL, *key: str) -> PtyLab:
    """Textual alone."""
    running = PtyLab(*map(str, size), *key, size=size, program=PAINTER)
    running.wait_for("\x1b[?1049h", 90.0)
    running.run(2.0)
    return running


def drain(programs: Sequence[PtyLab], seconds: float) -> Iterator[tuple[PtyLab, bytes]]:
    """Read what each of some programs sends in a while, piece by piece."""
    end = time.monotonic() + seconds
    terminals = {program.terminal: program for program in programs}
    while (left := end - time.monotonic()) > 0:
        for terminal in select.select(list(terminals), [], [], left)[0]:
            yield terminals[terminal], terminals[terminal].read(0.0)


def watched(*programs: PtyLab) -> list[Figures]:
    """What each takes and sends in the same while."""
    before = [(program.cpu_seconds(), program.now, len(program.output)) for program in programs]
    times: dict[PtyLab, list[float]] = {program: [] for program in programs}
    for program, piece in drain(programs, SECONDS):
        moved = any(
            int(column) <= PENDULUMS and 1 < int(row) < 30 for row, column in CURSOR.findall(piece)
        )
        if moved and program.now - (times[program][-1] if times[program] else 0.0) > BURST:
            times[program].append(program.now)
    return [
        _figures(program, *start, times[program])
        for program, start in zip(programs, before, strict=True)
    ]


def _figures(program: PtyLab, cpu: float, began: float, sent: int, times: list[float]) -> Figures:
    elapsed = program.now - began
    gaps = sorted(after - before for before, after in itertools.pairwise(times)) or [elapsed]
    return {
        "percent": 100 * (program.cpu_seconds() - cpu) / elapsed,
        "changed_rows_per_second": len(CURSOR.findall(program.output, sent)) / elapsed,
        "kilobytes_per_second": (len(program.output) - sent) / elapsed / 1000,
        "frames_per_second": len(times) / elapsed,
        "frame_p99_ms": 1000 * gaps[int(0.99 * len(gaps))],
    }


def key_times(program: PtyLab, pause: float = 0.1) -> list[float]:
    """How long it takes from a key to what it does on the screen, in s."""
    times = []
    for n in range(KEYS):
        program.run(pause + n / 300)  # anywhere in a frame
        key, effect = ("+", "h 0.02 s") if n % 2 == 0 else ("-", "h 0.01 s")
        began = program.now
        program.type(key)
        times.append(program.wait_for(effect) - began)
    return sorted(times)


def drag_times(program: PtyLab) -> list[float]:
    """s from each move of the pointer over phase space to the last byte of the repaint, the lab paused."""
    columns, rows = LARGE
    program.type(f" \x1b[<0;{columns // 2};{rows // 3}M")
    program.run(0.5)
    times = []
    for move in range(MOVES):
        began = last = program.now
        program.type(f"\x1b[<32;{columns // 2 + move % 20};{rows // 3 + move % 7}M")
        while program.read(0.06):
            last = program.reads[-1][0]
        times.append(last - began)
    return sorted(times)


def end(program: PtyLab) -> None:
    """Leave."""
    program.type("q")
    program.end()


def of_rounds(rounds: list[Figures]) -> Figures:
    """The mean of some rounds; of what is late, the middle one, as no program is to blame for its neighbours."""
    return {
        name: round((median if name.endswith("_ms") else mean)(each[name] for each in rounds), 2)
        for name in rounds[0]
    }


def beside(one_round: Callable[[], list[Figures]], names: tuple[str, str]) -> dict[str, Figures]:
    """The mean figures of two programs that ran at the same time, and their ratios."""
    rounds = [one_round() for _ in range(ROUNDS)]
    a, b = of_rounds([first for first, _ in rounds]), of_rounds([second for _, second in rounds])
    ratio = {name: round(a[name] / b[name], 2) for name in a if b.get(name)}
    each = [round(first["percent"] / second["percent"], 2) for first, second in rounds]
    return {names[0]: a, names[1]: b, "ratio": ratio | {"processor_each_round": each}}  # type: ignore[dict-item]


def of_lab_and_painter(size: tuple[int, int] = SMALL, *key: str) -> list[Figures]:
    """Those of the lab, perhaps after F3, and of Textual alone painting as much."""
    with (
        tempfile.TemporaryDirectory() as folder,
        painter(size, *key) as textual,
        lab(folder, size=size) as ours,
    ):
        ours.type(F3 if key else "")
        for _ in drain([ours, textual], film.BEGIN - 2.0):
            pass
        textual.type("r")  # the film is of the seconds that the lab is at
        both = watched(ours, textual)
        for program, figures in zip((ours, textual), both, strict=True):
            program.run(0.5)  # what has piled up meanwhile
            times = drag_times(program) if key and program is ours else key_times(program)
            figures[("drag" if key else "key") + "_p95_ms"] = 1000 * times[int(0.95 * len(times))]
            end(program)
        return both


def lab_beside_painter() -> dict[str, Figures]:
    """The lab at 120×40."""
    return beside(of_lab_and_painter, ("lab", "textual_alone"))


def phase_beside_painter() -> dict[str, Figures]:
    """The phase view at 200×60, with ring and trails."""
    return beside(lambda: of_lab_and_painter(LARGE, "f3"), ("phase", "textual_alone"))


def replay_beside_lab() -> dict[str, Figures]:
    """A replay at 1× of what the lab records."""
    with tempfile.TemporaryDirectory() as folder:
        with lab(folder) as program:
            program.run(SECONDS + 5.0)
            end(program)
        (recording,) = Path(folder).glob("*.mcap")

        def of_both() -> list[Figures]:
            with tempfile.TemporaryDirectory() as other, lab(other) as live:
                with PtyLab("replay", str(recording), "--start-at", "2") as replay:
                    replay.wait_for("REPLAY")
                    for _ in drain([replay, live], 2.0):
                        pass
                    both = watched(replay, live)
                    end(replay)
                end(live)
            return both

        return beside(of_both, ("replay", "lab"))


def paused_lab() -> dict[str, Figures]:
    """The lab while nothing moves."""
    with tempfile.TemporaryDirectory() as folder, lab(folder) as program:
        program.type(" ")
        program.run(2.0)
        before = program.wakes()
        (figures,) = watched(program)
        wakes = (program.wakes() - before) / SECONDS
        end(program)
    names = ("percent", "kilobytes_per_second")
    return {
        "paused": {name: round(figures[name], 2) for name in names}
        | {"wakes_per_second": round(wakes, 1)}
    }


def start_beside_empty() -> dict[str, Figures]:
    """From the start of the process to text, and to a pendulum, beside an empty app's first paint [s]."""
    text, pendulum, empty = [], [], []
    for _ in range(STARTS):
        with PtyLab(*LAB, "--no-record") as program:
            text.append(program.wait_for("running"))
            pendulum.append(program.wait_for_match(BRAILLE))
            end(program)
        with PtyLab(program=PAINTER) as program:
            empty.append(program.wait_for("empty"))
            end(program)
    figures = {"text": median(text), "pendulum": median(pendulum), "empty": median(empty)}
    best = {"first_text": min(text) / min(empty), "first_pendulum": min(pendulum) / min(empty)}
    middle = {
        "first_text": figures["text"] / figures["empty"],
        "first_pendulum": figures["pendulum"] / figures["empty"],
    }
    return {
        "median_seconds": {name: round(value, 3) for name, value in figures.items()},
        "ratio": {name: round(value, 2) for name, value in middle.items()},
        "ratio_of_the_best": {name: round(value, 2) for name, value in best.items()},
    }


BENCHES = {
    "lab": lab_beside_painter,
    "phase": phase_beside_painter,
    "replay": replay_beside_lab,
    "paused": paused_lab,
    "start": start_beside_empty,
}

if __name__ == "__main__":
    wanted = sys.argv[1:] or list(BENCHES)
    print(
        json.dumps(
            {"bench": "yardstick", **{name: BENCHES[name]() for name in wanted}, "reach": REACH},
            indent=1,
        )
    )
