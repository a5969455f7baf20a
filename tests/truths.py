"""The outcomes of runs of a million steps, by start and h·w0, from tests/bench/judging.py."""

import math
from dataclasses import replace
from itertools import groupby
from pathlib import Path

from pendu_tui.engine.methods import GENERAL, Method
from pendu_tui.engine.models.model import COMMON
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import LoopsOf
from pendu_tui.engine.scenes import Scene

LIMITS = {each.name: (each.min, each.max) for each in COMMON if each.name != "h"}
"""Of the numbers that every scene has, but for h, whose limits depend on w0."""

FILE = Path(__file__).parent / "engine/run/truths.txt"

THETAS = (1e-6, 0.01, 0.1, 0.3, 0.5, 0.7, 1, 1.25, 1.47, 1.69, 2, 2.3, 2.5, 2.7, 2.9)
STARTS = {  # theta [rad], omega [rad/s]
    **{f"theta={theta:g}": (theta, 0.0) for theta in THETAS},
    "theta=pi-1e-3": (math.pi - 1e-3, 0.0),
    "theta=pi-1e-5": (math.pi - 1e-5, 0.0),
    **{f"omega={omega:g}": (0.0, omega) for omega in (6.3, 6.5, 8, 10, 31.4, 200)},
}
_Z = """
0.003 0.005 0.01 0.02 0.03 0.05 0.07 0.1 0.13 0.16 0.2 0.25 0.3 0.35 0.4 0.45 0.5 0.56
0.63 0.7 0.8 0.9 1 1.04 1.09 1.125 1.16 1.2 1.3 1.4142 1.44 1.7 1.98 2.02 2.05 2.1
"""
Z = tuple(map(float, _Z.split()))

ALLOWED: dict[str, set[tuple[str, ...]]] = {
    # the verdicts that may follow each other; "undecided" may come before or instead of any
    "b": {("bounded",)},
    # slow chaos, seen late or not at all
    "s": {("bounded",), ("bounded", "chaotic"), ("chaotic",)},
    "c": {("chaotic",)},  # symplectic
    "w": {("chaotic",)},  # not symplectic
    "g": {("grows",)},
    "d": {("loses",)},
    "k": {("grows",), ("loses",)},
    # in a band that holds the start
    "K": {("bounded",), ("grows",), ("loses",)},
    # moves by less than 1e-10, or by little beside its oscillation
    "B": {("bounded",), ("loses",), ("grows",)},
}


def scene_at(start: str, z: float):
    """Return the scene of a cell."""
    theta, omega = STARTS[start]
    return Scene(theta=theta, omega=omega, h=z / Scene().w0)


def truths():
    """Yield method, start, h·w0 and letter of each cell."""
    by_key = {method.key: method for method in GENERAL}
    for line in FILE.read_text().splitlines():
        key, start, letters = line.split()
        for z, letter in zip(Z, letters, strict=True):
            yield by_key[key], start, z, letter


def verdicts(method: Method, scene: Scene, loops: LoopsOf, steps: int):
    """Return the verdicts on a method in order, each with its step and time [periods]."""
    period = scene.exact().period or math.tau / scene.w0
    lockstep = Lockstep(replace(scene, cast=(method,)), loops=loops, judged=True)
    lockstep.advance(steps)
    return [
        (milestone.verdict, milestone.step, milestone.step * scene.h / period)
        for milestone in lockstep.milestones
        if milestone.kind == "verdict"
    ]


def is_true(letter: str, course: list[tuple[str, int, float]]):
    """Return whether the truth allows these verdicts; none are always allowed."""
    words = [verdict for verdict, *_ in course if verdict != "undecided"]
    distinct = tuple(word for word, _ in groupby(words))
    return not distinct or distinct in ALLOWED[letter]
