"""What judging costs and how it agrees with itself: one JSON object.

    python tests/bench/judging.py [SECONDS]

`agreement`: the verdicts of `run` against those of the same energies judged without their method, on every scene with
each of its methods for 120 s.  They contradict each other if they differ and neither is `too early`.
`evaluations`: real force evaluations of judged runs beyond those of the same runs alone, over the latter; tangent maps
take complex numbers and are counted apart.  `early_trends`: trends of symplectic methods on runs of 10 and 30 s.
"""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from engine.methods import GENERAL, Method
from engine.run.judge import Judge
from engine.run.lockstep import Lockstep
from engine.scenes import SCENES, Scene

SECONDS = 120.0
SAMPLES = 4000


def agreement(seconds: float) -> dict[str, Any]:
    """Return how often the verdicts agree, and where they do not."""
    cells, differ, contradict = 0, [], []
    for scene in SCENES.values():
        lockstep = Lockstep(scene, judged=True)
        steps = round(seconds / scene.h)
        every = max(1, steps // SAMPLES)
        samples = [lockstep.sample()]
        while lockstep.step < steps:
            lockstep.advance(min(every, steps - lockstep.step))
            samples.append(lockstep.sample())
        for index, (method, judgement) in enumerate(
            zip(scene.cast, lockstep.judgements, strict=True)
        ):
            readings = [sample.readings[index] for sample in samples]
            conserved = scene.equations.energy_error.conserved
            energies = np.array(
                [
                    each.energy if conserved else each.energy_error
                    for each in readings
                    if each.diverged_at is None
                ]
            )
            times = np.array([abs(sample.t) for sample in samples[: len(energies)]])
            failed = len(energies) < len(samples)
            alone = Judge.read(times, energies, failed=failed).verdict
            cells += 1
            if alone != judgement.verdict:
                where = (scene.name, method.key, judgement.verdict, alone)
                differ.append(where)
                if "too early" not in where:
                    contradict.append(where)
    return {"cells": cells, "differ": len(differ), "contradict": contradict}


def counting(method: Method, calls: list[int]) -> Method:
    """Return the method with its real and its complex force evaluations counted."""

    def phases(force: Callable[[Any], Any], phase: Any, h: float) -> Any:
        def counted(theta: Any) -> Any:
            calls[isinstance(theta, complex)] += 1
            return force(theta)

        return method.phases(counted, phase, h)

    return replace(method, phases=phases)


def evaluations(name: str, seconds: float) -> dict[str, float]:
    """Return force evaluations for judging over those for simulating."""
    counts = []
    for judged in (False, True):
        calls = [0, 0]
        scene = SCENES[name].with_cast(
            tuple(counting(method, calls) for method in SCENES[name].cast)
        )
        Lockstep(scene, judged=judged).advance(round(seconds / scene.h))
        counts.append(calls)
    (alone, _), (judged_too, tangents) = counts
    return {"judging": (judged_too - alone) / alone, "tangent_maps": tangents / alone}


def early_trends() -> dict[str, int]:
    """Return how many ordinary symplectic runs have a trend."""
    cast = tuple(method for method in GENERAL if method.symplectic)
    runs = shown = 0
    for theta in np.linspace(0.2, 2.9, 16):
        for z in (0.03, 0.08, 0.16, 0.3):
            for seconds in (10.0, 30.0):
                scene = Scene(theta=float(theta), h=z / Scene().w0, cast=cast)
                lockstep = Lockstep(scene, judged=True)
                lockstep.advance(round(seconds / scene.h))
                runs += len(cast)
                shown += sum(judgement.slope is not None for judgement in lockstep.judgements)
    return {"runs": runs, "shown": shown}


def main() -> None:
    """Measure and print."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else SECONDS
    report = {
        "agreement": agreement(seconds),
        "evaluations": {
            name: evaluations(name, seconds) for name in ("drift", "near-separatrix", "crossover")
        },
        "early_trends": early_trends(),
    }
    print(json.dumps({"bench": "judging", **report}, indent=1))


if __name__ == "__main__":
    main()
