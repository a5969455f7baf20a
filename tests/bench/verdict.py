"""The verdict against the truth on all of tests/truths.py, and how long it waits: one JSON object.  Needs Numba.

    python tests/bench/verdict.py [METHOD...]

A cell is wrong if its verdicts, in turn, are none that the truth allows; undecided if it gets none while it is
watched.  Waits are in periods where h·w0 is up to 0.9 and a period has eight steps or more, and else in steps.
"""

import json
import math
import sys
import time

from engine.methods import USUAL_CAST
from engine.run.compiled import compiled
from engine.run.judge import Judge
from engine.run.judgement import LookPoint
from engine.scenes import Scene
from tests.truths import is_true, scene_at, truths, verdicts, watch


def microseconds_per_look(z: float) -> float:
    """What a look costs, once the bins have begun to merge [µs]."""
    scene = Scene(h=z / Scene().w0)
    judge = Judge(h=scene.h, period=2.0, method=USUAL_CAST[2], model=scene.equations)
    best = math.inf
    for k in range(8):
        began = time.perf_counter()
        for step in range(k * 2000, (k + 1) * 2000):
            judge.look(LookPoint(step, error=0.0, low=0.0, high=1.0, theta=1.0, omega=1.0))
        best = min(best, time.perf_counter() - began)
    return best / 2000 * 1e6


def main() -> None:
    """Judge every cell and print what went wrong."""
    keys = sys.argv[1:] or [method.key for method in USUAL_CAST]
    wrong, undecided, periods, steps, cells = [], [], [], [], 0
    for method, start, z, letter in truths():
        if method.key not in keys:
            continue
        scene, cells = scene_at(start, z), cells + 1
        given = verdicts(method, scene, compiled, watch(scene))
        cell = {"method": method.key, "start": start, "z": z, "truth": letter, "verdicts": given}
        if not given:
            undecided.append(cell)
        elif not is_true(letter, given):
            wrong.append(cell)
        elif z <= 0.9 and (scene.exact().period or math.inf) >= 8 * scene.h:
            periods.append(given[0][2])
        else:
            steps.append(given[0][1])
    report = {"cells": cells, "wrong": wrong, "undecided": undecided, "pass": not wrong}
    for name, waits in (("periods", sorted(periods)), ("steps", sorted(steps))):
        report |= {
            f"{name}_until_verdict_{q}": waits[q * (len(waits) - 1) // 100]
            for q in (50, 90, 99)
            if waits
        }
    report["microseconds_per_look"] = {z: microseconds_per_look(z) for z in (0.1, 1.0)}
    print(json.dumps({"bench": "verdict", **report}, indent=1))


if __name__ == "__main__":
    main()
