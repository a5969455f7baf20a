"""Compare the verdicts with runs of a million steps and with each other; needs Numba.

python -m tests.bench.judging writes tests/engine/run/truths.txt, in some minutes: the fate of each
method by start and h·w0.

A run of a million steps is judged by its whole course and without the reasoning of the verdicts: by
the lowest and highest energy error in windows that double the run, and for symplectic methods by
the logarithm of the distance between neighbouring orbits.
"""

import cmath
import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from pendu_tui.engine.methods import GENERAL, USUAL_CAST, Cast, Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import LoopsOf, compiled
from pendu_tui.engine.run.record import judge_record
from pendu_tui.engine.run.verdicts import BOUNDED, CHAOTIC, UNDECIDED, Judgement, direction
from pendu_tui.engine.scenes import SCENES, Scene
from tests.truths import ALLOWED, FILE, STARTS, Z, scene_at

LIMITS = {
    "wrong_runs": 0,  # of 400 methods, at five lengths
    "contradictions": 0,  # between `run` and the same energies alone
}
SECONDS = 120.0  # of each scene
SAMPLES = 4000
SEED = 926421  # drawn after the last change of a rule or level
ENDS = np.array([1 << power for power in range(4, 20)] + [3 << 18, 1 << 20])  # of windows, steps
W0 = math.sqrt(9.81)
LENGTHS = (300, 1000, 3000, 10_000, 30_000)  # steps


def random_scene(random: np.random.Generator, max_z: float, cast: Cast) -> Scene:
    theta = float(random.uniform(0.05, 3.1))
    z = float(np.exp(random.uniform(math.log(0.01), math.log(max_z))))
    return Scene(theta=theta, h=z / Scene().w0, cast=cast)


def windows(method: Method, scene: Scene) -> Any:
    """Return the lowest and the highest energy error in each window, nan after an overflow."""
    loops = compiled(method, scene.equations)
    phase = (scene.theta, scene.omega)
    start = scene.equations.energy()(phase)
    rows = np.full((len(ENDS), 2), math.nan)
    for row, (begin, end) in zip(rows, pairwise([0, *ENDS.tolist()]), strict=True):
        advanced = loops.advance(phase, scene.h, end - begin, 1e280 * start)
        if advanced.done < end - begin:
            break
        row[:] = advanced.low, advanced.high
        phase = advanced.phase
    return (rows - start) / start


@cache
def stretched(method: Method) -> Any:
    """Return a loop that finds by what logarithm neighbours have parted at the end of each window.

    The neighbour is the imaginary part of the phase.
    """
    import numba  # which the tests of verdicts need not load

    phases = numba.njit(compilable(method.phases))

    @numba.njit
    def force(theta):  # type: ignore[no-untyped-def]
        return -9.81 * cmath.sin(theta)

    @numba.njit
    def step(theta, omega, h):  # type: ignore[no-untyped-def]
        for phase in phases(force, (theta, omega), h):
            return phase
        return theta, omega

    @numba.njit(nogil=True)
    def run(theta, omega, h, ends):  # type: ignore[no-untyped-def]
        theta = complex(theta, 1e-100)
        omega = complex(omega, 0.0)
        logarithm = 0.0
        found = []
        done = 0
        for end in ends:
            for n in range(done, end):
                theta, omega = step(theta, omega, h)
                if n % 8 == 7:
                    length = math.hypot(theta.imag, omega.imag / W0) * 1e100
                    theta = complex(theta.real, theta.imag / length)
                    omega = complex(omega.real, omega.imag / length)
                    logarithm += math.log(length)
            found.append(logarithm)
            done = end
        return found

    return run


def letter(method: Method, scene: Scene) -> str:
    """Return the letter of a run, a key of tests.truths.ALLOWED."""
    if not method.symplectic:
        return course(scene.z, *windows(method, scene).T)
    found = stretched(method)(scene.theta, scene.omega, scene.h, ENDS)
    if found[-1] < 16:  # neighbours part in proportion to time: ln 10⁶ = 14
        return "b"
    return "s" if found[-1] < 40 or found[ENDS.searchsorted(8192)] < 20 else "c"


def course(z: float, low: Any, high: Any) -> str:
    """Return the letter of the lowest and highest energy errors."""
    if not np.isfinite(high).all():
        return "g"
    thrown = z > 1.5  # then the orbits of explicit Euler jump by many turns
    middle = (low + high) / 2
    width = max(high[16:].max() - low[16:].min(), 1e-13)
    if np.abs(middle).max() < 1e-10:
        return "B"
    if middle[17] < -1 + 1e-6:
        return "d"
    late = slice(14 if thrown else 16, 18)
    ends = np.ptp(low[late]), np.ptp(high[late]), abs(middle[17] - middle[15]) / 2
    if max(ends) < 0.1 * width + 0.01 * abs(middle[17]):
        # a ragged edge may miss the start for a whole window, and come back
        return "K" if low[late].min() <= 0 <= high[late].max() else "k"
    if thrown:
        return "w"
    moves = np.diff(middle[8:])
    if (moves > 0).all() and low[17] > high[13]:
        return "g"
    if (moves < 0).all():
        return "d"
    return "w" if np.ptp(middle[8:]) > np.median((high - low)[8:]) / 4 else "B"


def holds(lockstep: Lockstep) -> bool:
    """Return whether the energy stays on its verdict's side for as long again.

    A thrown bob may rest for 60 000 steps and then wander on.
    """
    later = lockstep.copy()
    later.sample()
    later.advance(lockstep.step)
    (reading,) = later.sample().readings
    sides = map(direction, (reading.energy_error_low, reading.energy_error_high))
    return {*sides} == {lockstep.judgements[0].verdict}


def runs(share: float) -> dict[str, Any]:
    """Return what becomes of random runs of methods that are not symplectic, at five lengths."""
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
            if verdict not in allowed and not (truth == "w" and holds(lockstep)):
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


def measure(share: float) -> dict[str, Any]:
    contradicting = list(contradictions(share))
    return {
        **runs(share),
        "contradictions": len(contradicting),
        "contradicting": contradicting,
    }


def main() -> None:
    """Run the grid and write the file, a line for each method and start."""
    lines = []
    with ThreadPoolExecutor() as executor:
        for method in USUAL_CAST:
            for start in STARTS:
                scenes = [scene_at(start, z) for z in Z]
                letters = executor.map(letter, [method] * len(Z), scenes)
                lines.append(f"{method.key} {start} {''.join(letters)}\n")
                print(lines[-1], end="")
    FILE.write_text("".join(lines))


if __name__ == "__main__":
    main()
