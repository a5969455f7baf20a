"""Compare the verdicts with runs of a million steps and with each other."""

import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pendu_tui.engine.methods import GENERAL
from pendu_tui.engine.run.compiled import compiled
from pendu_tui.engine.run.energies import judge_record
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import SCENES, Scene
from tests.truths import is_true, scene_at, truths, verdicts, watch

LIMITS = {
    "wrong": 0,  # cells of the truth table
    "median_wait": 8.1,  # periods
    "contradictions": 0,  # between `run` and the same energies alone
    "early_trends": 0,  # in symplectic runs of 10 and 30 s
    "million_lines": 2.0,  # s
}
SECONDS = 120.0  # of each scene
SAMPLES = 4000


def truth_table(share: float) -> dict[str, Any]:
    """Return which cells of tests/truths.py are judged wrong or not at all, and how late."""
    wrong = []
    waits = []
    undecided = 0
    cells = list(truths())[:: round(1 / share)]
    for method, start, z, letter in cells:
        scene = scene_at(start, z)
        course = verdicts(method, scene, compiled, watch(scene))
        if not course:
            undecided += 1
        elif not is_true(letter, course):
            wrong.append((method.key, start, z, letter, course))
        elif z <= 0.9:
            waits.append(course[0][2])
    return {
        "cells": len(cells),
        "wrong": len(wrong),
        "wrong_cells": wrong,
        "undecided": undecided,
        "median_wait": float(np.median(waits)),
        "longest_waits": float(np.percentile(waits, 99)),
    }


def contradictions() -> list[tuple[str, str, str, str]]:
    """Return where the verdicts on a run and on its energies alone differ, "undecided" apart."""
    different = []
    for scene in SCENES.values():
        lockstep = Lockstep(scene, judged=True)
        steps = round(SECONDS / scene.h)
        every = max(1, steps // SAMPLES)
        samples = [lockstep.sample()]
        while lockstep.step < steps:
            lockstep.advance(min(every, steps - lockstep.step))
            samples.append(lockstep.sample())
        name = "energy" if scene.equations.conserves_energy else "energy_error"
        for index, judgement in enumerate(lockstep.judgements):
            readings = [sample.readings[index] for sample in samples]
            readings = [reading for reading in readings if reading.diverged_at is None]
            times = np.abs([sample.t for sample in samples[: len(readings)]])
            energies = np.array([getattr(reading, name) for reading in readings])
            failed = len(readings) < len(samples)
            alone = judge_record(times, energies, failed=failed).verdict
            both = (judgement.verdict, alone)
            if judgement.verdict != alone and "undecided" not in both:
                different.append((scene.name, scene.cast[index].key, *both))
    return different


def early_trends() -> int:
    """Return how many ordinary symplectic runs of 10 and 30 s have a trend."""
    cast = tuple(method for method in GENERAL if method.symplectic)
    trends = 0
    for theta in np.linspace(0.2, 2.9, 16):
        for z in (0.03, 0.08, 0.16, 0.3):
            for seconds in (10.0, 30.0):
                scene = Scene(theta=float(theta), h=z / Scene().w0, cast=cast)
                lockstep = Lockstep(scene, judged=True)
                lockstep.advance(round(seconds / scene.h))
                trends += sum(judgement.slope is not None for judgement in lockstep.judgements)
    return trends


def million_lines() -> float:
    """Return the seconds of `judge` for 10⁶ lines."""
    energies = 1 + 1e-3 * np.random.default_rng(3).standard_normal(10**6)
    program = str(Path(sys.executable).with_name("pendu-tui"))
    with TemporaryDirectory() as folder:
        file = f"{folder}/energies.csv"
        table = np.column_stack([np.arange(10**6) * 0.01, energies])
        np.savetxt(file, table, delimiter=",", header="t,total", comments="")
        command = [program, "judge", file, "--time", "t", "--energy", "total"]
        began = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        return round(time.perf_counter() - began, 2)


def measure(share: float) -> dict[str, Any]:
    contradicting = contradictions()
    return {
        **truth_table(share),
        "contradictions": len(contradicting),
        "contradicting": contradicting,
        "early_trends": early_trends(),
        "million_lines": million_lines(),
    }
