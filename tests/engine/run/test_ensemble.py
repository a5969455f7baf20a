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
from engine.run.ensemble import Watched, compiled, plain, section, sharing, sine

needs_numba = pytest.mark.skipif(not available(), reason="Numba is not installed")
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)
each_way = pytest.mark.parametrize("fast", [False, pytest.param(True, marks=needs_numba)], ids=["numpy", "numba"])
THETA, OMEGA = np.linspace(-2.0, 2.5, 37), np.linspace(1.5, -1.0, 37)
PENDULUM = Pendulum(1.0)


def watched(model: Model, h: np.ndarray, band: float) -> Watched:
    start = model.energy(np.sin)((THETA, OMEGA))
    return Watched(start, np.full(37, band), np.full(37, math.pi), np.zeros(37), np.zeros(37), np.abs(THETA))


@given(st.floats(-1e4, 1e4))
def test_the_sine_is_right_to_four_ulp_of_one(x: float) -> None:
    assert sine(x) == pytest.approx(math.sin(x), rel=0, abs=4.5e-16)


@each_method
@pytest.mark.parametrize("model", [Pendulum(1.0), LinearOscillator(1.0)], ids=lambda model: model.key)
def test_in_numpy_each_swing_is_the_one_that_swings_alone(method: Method, model: Model) -> None:
    points = section(method, model, (THETA, OMEGA), 0.1, 5, every=3)
    for which in (0, 17, 36):
        alone = islice(method.phases(model.force(np.sin), (THETA[which], OMEGA[which]), 0.1), 2, None, 3)
        assert [tuple(point[:, which]) for point in points] == list(islice(alone, 5))


@needs_numba
@each_method
@pytest.mark.parametrize("model", [Pendulum(1.0), LinearOscillator(1.0)], ids=lambda model: model.key)
def test_compiled_ensembles_are_numpys_but_for_rounding(method: Method, model: Model) -> None:
    both = [section(method, model, (THETA, OMEGA), 0.1, 20, every=2, fast=fast) for fast in (False, True)]
    assert both[0] == pytest.approx(both[1], rel=0, abs=1e-13)  # 40 steps' rounding


@each_way
def test_no_swing_depends_on_the_others(fast: bool) -> None:
    together = section(VELOCITY_VERLET, PENDULUM, (THETA, OMEGA), 0.3, 50, fast=fast)
    for part in (slice(0, 1), slice(5, 30), slice(30, 37)):
        alone = section(VELOCITY_VERLET, PENDULUM, (THETA[part], OMEGA[part]), 0.3, 50, fast=fast)
        assert alone.tobytes() == np.ascontiguousarray(together[:, :, part]).tobytes()


@needs_numba
def test_compiled_steps_are_freed() -> None:
    """In a compiled loop Numba 0.68 keeps all that a generator yields, which makes 4 pages a step of these."""
    many, h = (np.full(1024, 0.5), np.zeros(1024)), np.full(1024, 0.1)
    seen = Watched(many[0], *(np.full(1024, math.inf) for _ in range(2)), *(np.zeros(1024) for _ in range(3)))
    watch = compiled(VELOCITY_VERLET, PENDULUM).watch
    next(watch(many, h, seen, 1000))
    before = getrusage(RUSAGE_SELF).ru_minflt
    next(watch(many, h, seen, 4000))
    assert getrusage(RUSAGE_SELF).ru_minflt - before < 4000


@each_way
def test_a_swing_that_is_no_longer_looked_at_does_not_stop_the_others(fast: bool) -> None:
    seen, h = watched(PENDULUM, np.full(37, 0.2), math.inf), np.full(37, 0.2)
    stops = []
    for done, phase in (compiled if fast else plain)(GENERAL[0], PENDULUM).watch((THETA, OMEGA), h, seen, 100):
        stops.append(done)
        seen.top[np.abs(phase[0]) > seen.top] = math.inf
    points = section(GENERAL[0], PENDULUM, (THETA, OMEGA), 0.2, 100, fast=fast)
    over = np.abs(points[:, 0]) > math.pi
    assert stops == sorted({*(over.argmax(axis=0)[over.any(axis=0)] + 1).tolist(), 100})


def test_force_and_energy_that_share_a_sine_are_those_of_the_pendulum() -> None:
    theta, omega = np.concatenate([np.linspace(-9.4, 9.4, 1001), [0.0, 1e-8, 3.14, -3.1415]]), np.linspace(-2, 2, 1005)
    force, energy = sharing(9.81)
    room = 1e-14 + 1e-14 / np.abs(np.cos(theta / 2))
    assert (np.abs(force(theta) - Pendulum(9.81).force(np.sin)(theta)) < room).all()
    assert energy((theta, omega)) == pytest.approx(Pendulum(9.81).energy(np.sin)((theta, omega)), rel=1e-14)


def test_it_is_the_sine_of_the_angles_at_hand_and_not_of_those_before() -> None:
    force, energy = sharing(1.0)
    for theta in (np.array([0.5]), np.array([1.0]), np.array([0.5])):
        assert force(theta) == pytest.approx(-np.sin(theta))
        assert energy((theta, np.zeros(1))) == pytest.approx(1 - np.cos(theta))


@each_way
@each_method
def test_what_is_watched_is_the_largest_of_each_step(method: Method, fast: bool) -> None:
    h = np.full(37, 0.2)
    seen = watched(PENDULUM, h, math.inf)
    points = section(method, PENDULUM, (THETA, OMEGA), 0.2, 10, fast=fast)
    ((done, phase),) = (compiled if fast else plain)(method, PENDULUM).watch((THETA, OMEGA), h, seen, 10)
    assert done == 10
    assert np.array(phase) == pytest.approx(points[-1], rel=0, abs=1e-14)
    off = PENDULUM.energy(np.sin)((points[:, 0], points[:, 1])) - seen.start
    assert seen.off == pytest.approx(off[-1], rel=0, abs=1e-14)
    assert seen.worst == pytest.approx(np.abs(off).max(axis=0), rel=0, abs=1e-14)
    width = np.maximum(np.abs(THETA), np.abs(points[:, 0]).max(axis=0))
    assert seen.width == pytest.approx(width, rel=0, abs=1e-14)


@each_way
def test_it_stops_at_the_step_that_passes_the_top_or_leaves_the_band(fast: bool) -> None:
    watch, h = (compiled if fast else plain)(GENERAL[0], PENDULUM).watch, np.full(37, 0.2)
    points = section(GENERAL[0], PENDULUM, (THETA, OMEGA), 0.2, 100, fast=fast)
    over = int(np.flatnonzero((np.abs(points[:, 0]) > math.pi).any(axis=1))[0]) + 1
    done, _ = next(watch((THETA, OMEGA), h, watched(PENDULUM, h, math.inf), 1000))
    assert done == over
    seen = watched(PENDULUM, h, 0.1)
    done, _ = next(watch((THETA, OMEGA), h, seen, 1000))
    assert 0 < done < over
    assert (seen.worst > 0.1).any()
