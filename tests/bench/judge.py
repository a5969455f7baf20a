"""`pendu-tui judge` against the truth, and how long it takes for 10⁶ lines: one JSON object.  Needs Numba.

    python tests/bench/judge.py [STEP_OF_CELLS]

The truth of a cell is that of tests/truths.py, known from a million steps; what is judged is the energies of some
300 periods, sampled 16 times a period (`dense`), every 7 or 13 of these (`7th`, `13th`: fewer than two or three a
period), and at random (`random`).  tests/bench/foreign.py has series of known make.
A verdict is wrong if the truth forbids it; `too early` is never wrong.  The yardstick of the time is numpy.loadtxt.
"""

import json
import math
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from engine.run.compiled import compiled
from engine.run.judge import Judge
from tests.truths import scene_at, truths

PERIODS, SAMPLES_A_PERIOD, LEAST_SAMPLES, LINES = 300, 16, 2048, 10**6
CELLS = {  # a million steps' truth -> what fewer steps, and energies alone, may be called
    "b": {"bounded"},
    "s": {"bounded", "wanders"},
    "c": {"bounded", "wanders", "caught"},  # chaos in a band wanders within it
    "w": {"wanders", "caught", "bounded"},  # until it has left the band it is in
    "g": {"grows"},
    "d": {"loses", "caught"},  # at rest, where nothing is left to lose
    "k": {
        "grows",
        "loses",
        "caught",
        "bounded",
        "wanders",
    },  # the course there is over before the first block is
    "K": {"grows", "loses", "caught", "bounded"},
    "B": {"bounded", "loses", "grows", "caught", "wanders"},  # by rounding, which walks, too
}


def samplings(n: int, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Which of n samples each sampling takes."""
    some = np.sort(random.choice(np.arange(1, n), n // 5, replace=False))
    return {
        "dense": np.arange(n),
        "7th": np.arange(0, n, 7),
        "13th": np.arange(0, n, 13),
        "random": np.r_[0, some],
    }


def of_cells(every: int) -> tuple[dict[str, Counter[str]], list[tuple[object, ...]]]:
    """The verdicts on the engine's energies by sampling and truth, and the wrong ones."""
    table: defaultdict[str, Counter[str]] = defaultdict(Counter)
    wrong: list[tuple[object, ...]] = []
    random = np.random.default_rng(2)
    for method, start, z, letter in list(truths())[::every]:
        scene = scene_at(start, z)
        period = scene.exact().period or math.tau / scene.w0
        stride = max(1, round(period / SAMPLES_A_PERIOD / scene.h))
        reference = scene.equations.reference(scene.theta, scene.omega)
        advance, phase = compiled(method, scene.equations).advance, (scene.theta, scene.omega)
        errors, ended = [0.0], False
        for _ in range(max(LEAST_SAMPLES, round(PERIODS * period / scene.h / stride))):
            done, phase, value, *_ = advance(phase, scene.h, stride, math.inf)
            if ended := done < stride:
                break
            errors.append(reference.error(value))
        energies = 1 + np.array(errors)
        for name, which in samplings(len(energies), random).items():
            times = which * stride * scene.h
            verdict = Judge.read(times, energies[which], failed=ended).verdict
            table[f"{name} {letter}"][verdict] += 1
            if verdict not in CELLS[letter] | {"too early"}:
                wrong.append((name, method.key, start, z, letter, verdict))
    return table, wrong


def seconds(*command: str) -> float:
    """The best of three runs of a process."""
    best = math.inf
    for _ in range(3):
        began = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        best = min(best, time.perf_counter() - began)
    return round(best, 3)


def of_time() -> dict[str, float]:
    """The command on 10⁶ lines, clean and with a gap in each tenth, and the yardstick [s]."""
    random, found = np.random.default_rng(3), {}
    with tempfile.TemporaryDirectory() as folder:
        for name, every in (("clean", 0), ("gaps", 10)):
            file = Path(folder) / f"{name}.csv"
            energies = [f"{value:.12g}" for value in 1 + 1e-3 * random.standard_normal(LINES)]
            rows = (
                f"{i * 0.01:.2f},0.5,0.3,{'' if every and i % every == 0 else energies[i]},1.0\n"
                for i in range(LINES)
            )
            file.write_text("t,kinetic,potential,total,x\n" + "".join(rows))
            program = Path(sys.executable).with_name("pendu-tui")
            found[name] = seconds(
                str(program), "judge", str(file), "--time", "t", "--energy", "total", "--json"
            )
        reading = "import numpy, sys; numpy.loadtxt(sys.argv[1], delimiter=',', skiprows=1, usecols=(0, 3))"
        found["loadtxt"] = seconds(sys.executable, "-c", reading, str(Path(folder) / "clean.csv"))
    return found


def main() -> None:
    """Print the tables."""
    by_truth, wrong_cells = of_cells(int(sys.argv[1]) if sys.argv[1:] else 5)
    total = sum(sum(counter.values()) for counter in by_truth.values())
    report = {
        "cells": {name: dict(counter) for name, counter in sorted(by_truth.items())},
        "cells_wrong": [len(wrong_cells), total],
        "wrong": wrong_cells,
        "seconds_for_a_million_lines": of_time(),
        "reach": {"wrong": 0.01, "seconds": 2.0},
    }
    print(json.dumps({"bench": "judge", **report}, indent=1))


if __name__ == "__main__":
    main()
