"""The verdict against the truth, all scenes x methods x h of a stated grid: one JSON object.  Needs Numba.

The truth comes from a run of 5000 periods (50 000 beyond h·w0 = 1), of which each period's lowest and
highest energy error are looked at, with hindsight and none of the verdict's own reasoning.  In the last
tenth of the run,
- `grows` or `loses`: the middle lies outside the band of the first eight periods by more than that
  band's width, or the error no longer comes back to within 5 % of the late band's width of 0;
- `bounded`: neither.

Then a Trend is fed with the run's first periods, 30 samples a second as the lab does.  It is wrong if the
first verdict it gives is not the truth, and it flickers if it gives a second one.

The grid's one rotation is the scene `spin`, a turn a second; faster ones, and those that beat with their
steps, stand in tests/engine/run/test_verdict.py.  The chaos scenes are left out: whether an orbit in a chaotic
sea stays is known from the sea's fences, not from its past.
"""

import json
import math
import time
from itertools import groupby
from statistics import median

from engine.methods import METHODS
from engine.models.exact_pendulum import ExactMotion
from engine.run.compiled import compiled
from engine.run.lockstep import Lockstep
from engine.run.verdict import Trend
from engine.scenes import SCENES, Scene

Z = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.63, 0.8)  # h·w0
GRID = [
    *((name, z) for name in ("drift", "gentle", "large-swing", "near-separatrix", "spin") for z in Z),
    *(("gentle", z) for z in (1.0, 1.2, 1.5, 1.8, 1.9)),
    *((name, scene.z) for name, scene in SCENES.items() if not name.startswith("chaos")),
]
WATCHED = 600  # periods


def truth(bands: list[tuple[float, float]]) -> str:
    """What a whole run, period by period, shows to have happened."""
    lows, highs = zip(*bands, strict=True)
    early_low, early_high = min(lows[:8]), max(highs[:8])
    early_width = max(early_high - early_low, 1e-12)
    last = len(bands) * 9 // 10
    late_low, late_high = min(lows[last:]), max(highs[last:])
    near = 0.05 * max(late_high - late_low, 1e-12)
    middle = median((low + high) / 2 for low, high in bands[last:])
    if middle > early_high + early_width or late_low > near:
        return "grows"
    if middle < early_low - early_width or late_high < -near:
        return "loses"
    return "bounded"


def truths(scene: Scene, period: float) -> list[str]:
    """The truth about each method."""
    lockstep = Lockstep(scene, loops=compiled)
    bands: list[list[tuple[float, float]]] = [[] for _ in METHODS]
    for _ in range(5000 if scene.z < 1 else 50_000):
        lockstep.advance(max(16, math.ceil(period / scene.h)))
        for band, reading in zip(bands, lockstep.sample().readings, strict=True):
            band.append((reading.energy_error_low, reading.energy_error_high))
    return [truth(band) for band in bands]


def verdicts(scene: Scene, period: float) -> list[list[tuple[str, float]]]:
    """The verdicts that each method's Trend gives in turn, and after how many periods."""
    lockstep = Lockstep(scene, loops=compiled)
    trends = [Trend(period) for _ in METHODS]
    given: list[list[tuple[str, float]]] = [[] for _ in METHODS]
    steps = max(1, round(1 / 30 / scene.h))
    while lockstep.t < WATCHED * period:
        sample = lockstep.sample()
        for trend, reading, list_ in zip(trends, sample.readings, given, strict=True):
            trend.read(sample.t, reading)
            judgement = trend.judgement
            list_.append((judgement.verdict, judgement.periods))
        lockstep.advance(steps)
    return [[next(group) for _, group in groupby(list_, key=lambda pair: pair[0])][1:] for list_ in given]


def microseconds_per_add() -> float:
    """What taking in one sample costs, once the bins have begun to merge: 64 samples a period [µs]."""
    trend, energy_range = Trend(2.0), [math.sin(k * math.pi / 32) ** 2 for k in range(64)]
    best = math.inf
    for k in range(8):
        began = time.perf_counter()
        for step in range(k * 6400, (k + 1) * 6400):
            trend.add(step / 32, energy_range[step % 64])
        best = min(best, time.perf_counter() - began)
    return best / 6400 * 1e6


def main() -> None:
    """Judge every cell of the grid and print what went wrong, and how long it took."""
    wrong, flickers, undecided, waits = [], [], [], []
    for name, z in GRID:
        scene = SCENES[name].altered(h=z / SCENES[name].w0)
        period = ExactMotion(scene).period or math.tau / scene.w0
        for method, true, given in zip(METHODS, truths(scene, period), verdicts(scene, period), strict=True):
            cell = {"scene": name, "z": z, "method": method.key, "truth": true, "verdicts": given}
            if not given:
                undecided.append(cell)
            elif given[0][0] != true:
                wrong.append(cell)
            elif len(given) > 1:
                flickers.append(cell)
            else:
                waits.append(given[0][1])
    waits.sort()
    share = {f"periods_until_verdict_{q}": waits[q * (len(waits) - 1) // 100] for q in (10, 50, 90, 99)}
    counts = {"cells": len(GRID) * len(METHODS), "right": len(waits)}
    report = {"wrong": wrong, "flickers": flickers, "undecided": undecided, "pass": not wrong and not flickers}
    share["microseconds_per_add"] = microseconds_per_add()
    print(json.dumps({"bench": "verdict", **counts, **share, **report}, indent=1))


if __name__ == "__main__":
    main()
