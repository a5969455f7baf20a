"""Compare the verdicts with runs of a million steps and with each other."""

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pendu_tui.engine.methods import GENERAL, Cast, Method
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import LoopsOf, compiled
from pendu_tui.engine.run.record import judge_record
from pendu_tui.engine.run.verdicts import BOUNDED, CHAOTIC, UNDECIDED, Judgement
from pendu_tui.engine.scenes import SCENES, Scene
from tests.truths import ALLOWED, is_true, scene_at, truths, verdicts, watch
from tests.tui.command_line import PENDU

LIMITS = {
    "wrong": 0,  # cells of the truth table
    "median_wait": 8.1,  # periods
    "wrong_runs": 0,  # of 400 methods, at five lengths
    "contradictions": 0,  # between `run` and the same energies alone
    "million_lines_ratio": 3.0,
}
SECONDS = 120.0  # of each scene
SAMPLES = 4000
SEED = 926421  # drawn after the last change of a rule or level
LOAD = "import numpy, sys; numpy.loadtxt(sys.argv[1], delimiter=',', skiprows=1)"
LENGTHS = (300, 1000, 3000, 10_000, 30_000)  # steps


def truth_table(share: float) -> dict[str, Any]:
    """Return which cells of tests/truths.py are judged wrong or not at all, and how late."""
    wrong = []
    waits = []
    undecided = 0
    for method, start, z, truth in list(truths())[:: round(1 / share)]:
        scene = scene_at(start, z)
        course = verdicts(method, scene, compiled, watch(scene))
        if not course:
            undecided += 1
        elif not is_true(truth, course):
            wrong.append((method.key, start, z, truth, course))
        elif z <= 0.9:
            waits.append(course[0][2])
    return {
        "wrong": len(wrong),
        "wrong_cells": wrong,
        "undecided": undecided,
        "median_wait": float(np.median(waits)),
    }


def random_scene(random: np.random.Generator, max_z: float, cast: Cast) -> Scene:
    theta = float(random.uniform(0.05, 3.1))
    z = float(np.exp(random.uniform(math.log(0.01), math.log(max_z))))
    return Scene(theta=theta, h=z / Scene().w0, cast=cast)


def runs(share: float) -> dict[str, Any]:
    """Return what becomes of random runs of methods that are not symplectic, at five lengths."""
    from tests.bench.truths import letter  # Numba

    random = np.random.default_rng(SEED)
    cast = [method for method in GENERAL if not method.symplectic]
    wrong = []
    leaving = 0
    for number in range(round(400 * share)):
        method = cast[number % len(cast)]
        spins = float(random.uniform() < 0.2) * float(random.uniform(7, 30))
        scene = replace(random_scene(random, 2.5, (method,)), omega=spins)
        truth = letter(method, scene)
        allowed = {"undecided", "failed"}.union(*ALLOWED[truth])
        if truth in "gdkw":
            leaving += 1
            allowed.discard("bounded")
        lockstep = Lockstep(scene, loops=compiled, judged=True)
        for steps in LENGTHS:
            lockstep.advance(steps - lockstep.step)
            verdict = lockstep.judgements[0].verdict
            if verdict not in allowed:
                wrong.append((method.key, scene.numbers, truth, steps, verdict))
    return {"wrong_runs": len(wrong), "which": wrong, "leaving": leaving}


def contradictions(share: float) -> Iterator[tuple[Any, ...]]:
    """Yield where the judgements of a run and of its energies alone exclude each other."""
    random = np.random.default_rng(SEED)
    methods = np.array(GENERAL, dtype=object)
    scenes = list(SCENES.values())
    for _ in range(round(200 * share)):
        scenes.append(random_scene(random, 2.0, tuple(random.choice(methods, 3, replace=False))))
    for scene in scenes:
        for method, of_run, alone in judgements(scene, SECONDS):
            if exclude(of_run, alone):
                words = (of_run.verdict, alone.verdict, of_run.slope, alone.bound)
                yield scene.name, scene.numbers, method.key, *words


def judgements(
    scene: Scene, seconds: float, loops: LoopsOf = compiled
) -> Iterator[tuple[Method, Judgement, Judgement]]:
    """Yield each method with the judgements of its run and of the run's energies alone."""
    lockstep = Lockstep(scene, loops=loops, judged=True)
    steps = round(seconds / scene.h)
    every = max(1, steps // SAMPLES)
    samples = [lockstep.sample()]
    while lockstep.step < steps:
        lockstep.advance(min(every, steps - lockstep.step))
        samples.append(lockstep.sample())
    name = "energy" if scene.equations.conserves_energy else "energy_error"
    for index, of_run in enumerate(lockstep.judgements):
        readings = [sample.readings[index] for sample in samples]
        readings = [reading for reading in readings if reading.diverged_at is None]
        times = np.abs([sample.t for sample in samples[: len(readings)]])
        energies = np.array([getattr(reading, name) for reading in readings])
        unit = energies[0] if name == "energy" else 1.0
        failed = len(readings) < len(samples)
        yield scene.cast[index], of_run, judge_record(times, energies / unit, failed=failed)


def exclude(of_run: Judgement, alone: Judgement) -> bool:
    """Return whether words or slopes of the same energies exclude each other.

    Slopes do if that of the run is outside a bounded record's bound by three uncertainties; words
    do not where one judges what rests and the other the way there.
    """
    words = {of_run.verdict, alone.verdict} - {UNDECIDED, CHAOTIC}
    if len(words) == 2 and not (of_run.rests or alone.rests):
        return True
    if alone.verdict != BOUNDED or of_run.slope is None:
        return False
    assert alone.bound is not None
    assert of_run.uncertainty is not None
    return abs(of_run.slope) > alone.bound + 3 * of_run.uncertainty


def million_lines_ratio() -> float:
    """Return the time of `judge` for 10⁶ lines over that of NumPy to read them."""
    energies = 1 + 1e-3 * np.random.default_rng(3).standard_normal(10**6)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "energies.csv"
        table = np.column_stack([np.arange(10**6) * 0.01, energies])
        np.savetxt(file, table, delimiter=",", header="t,total", comments="")
        judge = [*PENDU, "judge", file, "--time", "t", "--energy", "total"]
        load = [sys.executable, "-c", LOAD, file]
        return round(processor_seconds(judge) / processor_seconds(load), 2)


def processor_seconds(command: list[Any]) -> float:
    """Run a command."""
    before = os.times()[2:4]
    subprocess.run(command, check=True, capture_output=True)
    return sum(os.times()[2:4]) - sum(before)


def measure(share: float) -> dict[str, Any]:
    contradicting = list(contradictions(share))
    return {
        **truth_table(share),
        **runs(share),
        "contradictions": len(contradicting),
        "contradicting": contradicting,
        "million_lines_ratio": million_lines_ratio(),
    }
