"""The closed form as the floor of speed against accuracy: what it costs to show the exact motion."""

from collections.abc import Callable
from importlib import import_module
from types import CellType, FunctionType
from typing import Any

import numpy as np

from engine.accuracy.study import COMPARISONS, Clock
from engine.accuracy.taylor import Floats
from engine.accuracy.timing import shortest
from engine.models.exact_pendulum import Motion
from engine.run.compiled import available
from engine.scenes import Scene

RUNS = 20  # in a row, as one is short


def closed_form_seconds(scene: Scene, time: float, clock: Clock, fast: bool = True) -> float:
    """Seconds of the exact motion at COMPARISONS + 1 times; `fast`: compiled where Numba is installed.

    A floor for runs of some hundred steps and more; it does not depend on the time that is simulated.
    """
    motion, times = scene.exact().at, np.linspace(0, time, COMPARISONS + 1)
    at_all: Callable[[Any, Floats], Any] = at_times
    if fast and available():
        motion = compiled_motion(motion)
        at_all = import_module("numba").njit(at_times)
    return shortest(lambda: at_all(motion, times), RUNS, clock)[0]


def at_times(motion: Motion, times: Floats) -> Floats:
    """Theta [rad] at each of the times [s]."""
    theta = np.empty(times.size)
    for i in range(times.size):
        theta[i] = motion(times[i])[0]
    return theta


def compiled_motion(motion: Motion) -> Any:
    """Compile an exact motion by Numba, the functions in its closure first; the last digit may differ.

    Numba accepts only numbers, tuples and compiled functions in a closure.
    """

    def kept(value: Any) -> Any:
        return compiled_motion(value) if callable(value) else tuple(value) if isinstance(value, list) else value

    cells = tuple(CellType(kept(cell.cell_contents)) for cell in motion.__closure__ or ())
    name, defaults = motion.__name__, motion.__defaults__
    return import_module("numba").njit(FunctionType(motion.__code__, motion.__globals__, name, defaults, cells))
