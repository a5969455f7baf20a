"""Many swings at once are those of single swings."""

import math
from itertools import islice

import numpy as np
import pytest

from pendu_tui.engine.methods import FAMILIES, GENERAL, VELOCITY_VERLET
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run.loops import available
from pendu_tui.engine.studies.ensemble import Watched, compiled, plain

needs_numba = pytest.mark.skipif(not available(), reason="Numba is not installed")
WAYS = [(method, False) for method in GENERAL]
# compiling takes a second a method: one of each family
WAYS += [
    pytest.param(family[0], True, marks=needs_numba)
    for family in FAMILIES.values()
    if family[0].general
]
each_way = pytest.mark.parametrize(
    "fast", [False, pytest.param(True, marks=needs_numba)], ids=["numpy", "numba"]
)
THETA, OMEGA = np.linspace(-2.0, 2.5, 37), np.linspace(1.5, -1.0, 37)
PENDULUM = Pendulum(1.0)


def watched(band=math.inf, which=slice(None)):
    start = PENDULUM.energy(np.sin)((THETA[which], OMEGA[which]))
    band, top, off, worst = (np.full_like(start, value) for value in (band, math.pi, 0.0, 0.0))
    return Watched(start, band, top, off, worst, np.abs(THETA[which]))


def path(method, h, steps, fast, which=slice(None)):
    """The phases after each step: (steps, 2, swings).  A band below 0 stops at each."""
    start = THETA[which], OMEGA[which]
    watch = (compiled if fast else plain)(method, PENDULUM)
    stops = watch(start, np.full(len(start[0]), h), watched(-1.0, which), steps)
    return np.array([np.array(phase) for _, phase in stops])


@needs_numba
def test_compiled_steps_are_freed():
    """Numba 0.68 keeps all that a compiled generator yields: 4 pages a step of these."""
    resource = pytest.importorskip("resource", reason="no count of page faults")
    start, h = (np.full(1024, 0.5), np.zeros(1024)), np.full(1024, 0.1)
    numbers = [np.full(1024, value) for value in (0.5, math.inf, math.inf, 0.0, 0.0, 0.0)]
    watch = compiled(VELOCITY_VERLET, PENDULUM)
    next(watch(start, h, Watched(*numbers), 1000))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    next(watch(start, h, Watched(*numbers), 4000))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before < 4000


@each_way
def test_a_swing_without_limits_does_not_stop_the_others(fast):
    seen, stops = watched(), []
    watch = (compiled if fast else plain)(GENERAL[0], PENDULUM)
    for done, (theta, _) in watch((THETA, OMEGA), np.full(37, 0.2), seen, 100):
        stops.append(done)
        seen.top[np.abs(theta) > seen.top] = math.inf
    over = np.abs(path(GENERAL[0], 0.2, 100, fast)[:, 0]) > math.pi
    assert stops == sorted({*(over.argmax(axis=0)[over.any(axis=0)] + 1).tolist(), 100})


@pytest.mark.parametrize(("method", "fast"), WAYS, ids=lambda value: getattr(value, "key", value))
def test_each_swing_is_the_methods_and_its_extremes_are_kept(method, fast):
    seen, points = watched(), path(method, 0.2, 10, fast)
    expected = islice(method.phases(PENDULUM.force(np.sin), (THETA, OMEGA), 0.2), 10)
    assert points == pytest.approx(np.array([*expected]), rel=0, abs=1e-13)  # rounding
    watch = (compiled if fast else plain)(method, PENDULUM)
    ((done, phase),) = watch((THETA, OMEGA), np.full(37, 0.2), seen, 10)
    assert done == 10
    off = PENDULUM.energy(np.sin)((points[:, 0], points[:, 1])) - seen.start
    width = np.maximum(np.abs(THETA), np.abs(points[:, 0]).max(axis=0))
    found = np.array([*phase, seen.off, seen.worst, seen.width])
    last = [*points[-1], off[-1], np.abs(off).max(axis=0), width]
    assert found == pytest.approx(np.array(last), rel=0, abs=1e-14)


@each_way
def test_it_stops_at_the_step_that_passes_the_top_or_leaves_the_band(fast):
    watch, seen = (compiled if fast else plain)(GENERAL[0], PENDULUM), watched(0.1)
    beyond = np.abs(path(GENERAL[0], 0.2, 100, fast)[:, 0]) > math.pi
    over, _ = next(watch((THETA, OMEGA), np.full(37, 0.2), watched(), 1000))
    assert over == np.flatnonzero(beyond.any(axis=1))[0] + 1
    done, _ = next(watch((THETA, OMEGA), np.full(37, 0.2), seen, 1000))
    assert 0 < done < over
    assert (seen.worst > 0.1).any()
