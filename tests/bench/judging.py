"""The verdicts against runs of a million steps and against each other, and what judging costs."""

import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from engine.methods import GENERAL, Method
from engine.run.compiled import compiled
from engine.run.judge import Judge
from engine.run.lockstep import Lockstep
from engine.scenes import SCENES, Scene
from tests.truths import is_true, scene_at, truths, verdicts, watch

LIMITS = {
    "wrong": 0,  # cells of the truth table
    "median_wait": 8.1,  # periods
    "contradictions": 0,  # of `run` and the same energies without their method
    "judging_evaluations": 0.02,  # over those of simulating; tangent maps are counted apart
    "early_trends": 0,  # of symplectic runs of 10 and 30 s
    "million_lines": 2.0,  # s
}
SECONDS = 120.0  # of each scene
SAMPLES = 4000
READ = "import numpy, sys; numpy.loadtxt(sys.argv[1], delimiter=',', skiprows=1, usecols=(0, 1))"


def truth_table(share: float) -> dict[str, Any]:
    """Return how many cells of tests/truths.py are judged wrong or not at all, and the waits."""
    wrong = []
    waits = []
    undecided = 0
    cells = list(truths())[:: round(1 / share)]
    for method, start, z, letter in cells:
        scene = scene_at(start, z)
        given = verdicts(method, scene, compiled, watch(scene))
        if not given:
            undecided += 1
        elif not is_true(letter, given):
            wrong.append((method.key, start, z, letter, given))
        elif z <= 0.9:
            waits.append(given[0][2])
    return {
        "cells": len(cells),
        "wrong": len(wrong),
        "wrong_cells": wrong,
        "undecided": undecided,
        "median_wait": float(np.median(waits)),
        "longest_waits": float(np.percentile(waits, 99)),
    }


def contradictions() -> list[tuple[str, str, str, str]]:
    """Return where `run` and its energies alone get verdicts that differ and are not too early."""
    found = []
    for scene in SCENES.values():
        lockstep = Lockstep(scene, judged=True)
        steps = round(SECONDS / scene.h)
        every = max(1, steps // SAMPLES)
        samples = [lockstep.sample()]
        while lockstep.step < steps:
            lockstep.advance(min(every, steps - lockstep.step))
            samples.append(lockstep.sample())
        name = "energy" if scene.equations.energy_error.conserved else "energy_error"
        for index, judgement in enumerate(lockstep.judgements):
            readings = [sample.readings[index] for sample in samples]
            readings = [each for each in readings if each.diverged_at is None]
            times = np.abs([sample.t for sample in samples[: len(readings)]])
            energies = np.array([getattr(each, name) for each in readings])
            failed = len(readings) < len(samples)
            alone = Judge.read(times, energies, failed=failed).verdict
            both = (judgement.verdict, alone)
            if judgement.verdict != alone and "too early" not in both:
                found.append((scene.name, scene.cast[index].key, *both))
    return found


def counting(method: Method, calls: list[int]) -> Method:
    """Return the method with its real and its complex force evaluations counted."""

    def phases(force: Callable[[Any], Any], phase: Any, h: float) -> Any:
        def counted(theta: Any) -> Any:
            calls[isinstance(theta, complex)] += 1
            return force(theta)

        return method.phases(counted, phase, h)

    return replace(method, phases=phases)


def evaluations(name: str) -> float:
    """Return real force evaluations for judging over those for simulating."""
    counts = []
    for judged in (False, True):
        calls = [0, 0]
        cast = tuple(counting(method, calls) for method in SCENES[name].cast)
        scene = SCENES[name].with_cast(cast)
        Lockstep(scene, judged=judged).advance(round(SECONDS / scene.h))
        counts.append(calls[0])
    alone, judged_too = counts
    return (judged_too - alone) / alone


def early_trends() -> int:
    """Return how many ordinary symplectic runs of 10 and 30 s have a trend."""
    cast = tuple(method for method in GENERAL if method.symplectic)
    shown = 0
    for theta in np.linspace(0.2, 2.9, 16):
        for z in (0.03, 0.08, 0.16, 0.3):
            for seconds in (10.0, 30.0):
                scene = Scene(theta=float(theta), h=z / Scene().w0, cast=cast)
                lockstep = Lockstep(scene, judged=True)
                lockstep.advance(round(seconds / scene.h))
                shown += sum(judgement.slope is not None for judgement in lockstep.judgements)
    return shown


def million_lines() -> dict[str, float]:
    """Return the seconds of `judge` for 10⁶ lines, and those of numpy.loadtxt."""
    energies = 1 + 1e-3 * np.random.default_rng(3).standard_normal(10**6)
    program = str(Path(sys.executable).with_name("pendu-tui"))
    found = {}
    with TemporaryDirectory() as folder:
        file = f"{folder}/energies.csv"
        table = np.column_stack([np.arange(10**6) * 0.01, energies])
        np.savetxt(file, table, delimiter=",", header="t,total", comments="")
        for name, command in (
            ("million_lines", [program, "judge", file, "--time", "t", "--energy", "total"]),
            ("loadtxt", [sys.executable, "-c", READ, file]),
        ):
            began = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            found[name] = round(time.perf_counter() - began, 2)
    return found


def measure(share: float) -> dict[str, Any]:
    where = contradictions()
    costs = {name: evaluations(name) for name in ("drift", "near-separatrix", "crossover")}
    return {
        **truth_table(share),
        "contradictions": len(where),
        "contradicting": where,
        "judging_evaluations": max(costs.values()),
        "early_trends": early_trends(),
        **million_lines(),
    }
