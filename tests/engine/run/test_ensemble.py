"""Many swings at once: NumPy's are single swings to the bit, compiled ones nearly, and none knows of the others."""

import math
from itertools import islice
from resource import RUSAGE_SELF, getrusage

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import GENERAL, VELOCITY_VERLET, Method
from engine.models import LinearOscillator, Pendulum
from engine.models.model import Model
from engine.run.compiled import available
from engine.run.ensemble import Watched, compiled, plain, sine

needs_numba = pytest.mark.skipif(not available(), reason="Numba is not installed")
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)
each_way = pytest.mark.parametrize("fast", [False, pytest.param(True, marks=needs_numba)], ids=["numpy", "numba"])
THETA, OMEGA = np.linspace(-2.0, 2.5, 37), np.linspace(1.5, -1.0, 37)
PENDULUM = Pendulum(1.0)


def watched(model: Model, band: float = math.inf, which: slice = slice(None)) -> Watched:
    start = model.energy(np.sin)((THETA[which], OMEGA[which]))
    return Watched(start, np.full_like(start, band), np.zeros_like(start), np.zeros_like(start), np.abs(THETA[which]))


def path(method: Method, model: Model, h: float, steps: int, fast: bool = False, which: slice = slice(None)):
    """The phases after each step: (steps, 2, swings)."""
    watch, phase = (compiled if fast else plain)(method, model), (THETA[which], OMEGA[which])
    points = []
    for _ in range(steps):
        _, phase = watch(phase, np.full(len(phase[0]), h), watched(model, which=which), 1)
        points.append(phase)
    return np.array(points)


@given(st.floats(-1e4, 1e4))
def test_the_sine_is_right_to_four_ulp_of_one(x: float) -> None:
    assert sine(x) == pytest.approx(math.sin(x), rel=0, abs=4.5e-16)


@each_method
@pytest.mark.parametrize("model", [Pendulum(1.0), LinearOscillator(1.0)], ids=lambda model: model.key)
def test_in_numpy_each_swing_is_the_one_that_swings_alone(method: Method, model: Model) -> None:
    points = path(method, model, 0.1, 15)
    for which in (0, 17, 36):
        alone = islice(method.phases(model.force(np.sin), (THETA[which], OMEGA[which]), 0.1), 15)
        assert [tuple(point[:, which]) for point in points] == list(alone)


@needs_numba
@each_method
def test_compiled_ensembles_are_numpys_but_for_rounding(method: Method) -> None:
    both = [path(method, PENDULUM, 0.1, 40, fast) for fast in (False, True)]
    assert both[0] == pytest.approx(both[1], rel=0, abs=1e-13)  # 40 steps' rounding


@each_way
def test_no_swing_depends_on_the_others(fast: bool) -> None:
    together = path(VELOCITY_VERLET, PENDULUM, 0.3, 50, fast)
    for part in (slice(0, 1), slice(5, 30), slice(30, 37)):
        assert np.array_equal(path(VELOCITY_VERLET, PENDULUM, 0.3, 50, fast, part), together[:, :, part])


@needs_numba
def test_compiled_steps_are_freed() -> None:
    """In a compiled loop Numba 0.68 keeps all that a generator yields, which makes 4 pages a step of these."""
    many, h = (np.full(1024, 0.5), np.zeros(1024)), np.full(1024, 0.1)
    seen = Watched(many[0], np.full(1024, math.inf), *(np.zeros(1024) for _ in range(3)))
    watch = compiled(VELOCITY_VERLET, PENDULUM)
    watch(many, h, seen, 1000)
    before = getrusage(RUSAGE_SELF).ru_minflt
    watch(many, h, seen, 4000)
    assert getrusage(RUSAGE_SELF).ru_minflt - before < 4000


@each_way
@each_method
def test_a_watched_ensemble_keeps_the_largest_error_and_angle(method: Method, fast: bool) -> None:
    seen, points = watched(PENDULUM), path(method, PENDULUM, 0.1, 10, fast)
    done, phase = (compiled if fast else plain)(method, PENDULUM)((THETA, OMEGA), np.full(37, 0.1), seen, 10)
    assert done == 10
    assert np.array_equal(phase, points[-1])
    off = PENDULUM.energy(np.sin)((points[:, 0], points[:, 1])) - seen.start
    assert seen.off == pytest.approx(off[-1], rel=0, abs=1e-14)
    assert seen.worst == pytest.approx(np.abs(off).max(axis=0), rel=0, abs=1e-14)
    assert np.array_equal(seen.width, np.maximum(np.abs(THETA), np.abs(points[:, 0]).max(axis=0)))


@each_way
def test_it_stops_at_the_step_that_passes_the_top_or_leaves_the_band(fast: bool) -> None:
    watch, h = (compiled if fast else plain)(GENERAL[0], PENDULUM), np.full(37, 0.2)
    points = path(GENERAL[0], PENDULUM, 0.2, 100, fast)
    over = int(np.flatnonzero((np.abs(points[:, 0]) > math.pi).any(axis=1))[0]) + 1
    done, _ = watch((THETA, OMEGA), h, watched(PENDULUM), 1000)
    assert done == over
    seen = watched(PENDULUM, 0.1)
    done, _ = watch((THETA, OMEGA), h, seen, 1000)
    assert 0 < done < over
    assert (seen.worst > 0.1).any()
