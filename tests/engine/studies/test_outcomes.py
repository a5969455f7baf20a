import math
from itertools import islice, pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import EXPLICIT_EULER, GENERAL, USUAL_CAST
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.studies.ensemble import plain
from pendu_tui.engine.studies.stability import (
    BAND,
    CHAOTIC,
    ELSEWHERE,
    FATES,
    GROWS,
    HOLDS,
    PARKED,
    WOBBLES,
    first_failure,
    is_lost,
    outcomes,
    wobble,
)

BY_KEY = {method.key: method for method in GENERAL}
FORCE = Pendulum(1.0).force()


def fate(key, theta, z, steps=2000):
    return FATES[outcomes(BY_KEY[key], np.array([theta]), np.array([z]), steps)["fate"][0]]


def failure_of(key, theta, ladder, steps):
    cells = outcomes(BY_KEY[key], np.full(len(ladder), theta), ladder, steps)
    failure = first_failure(ladder, cells)
    return failure and (failure.z, failure.reason)


@given(
    st.sampled_from(GENERAL),
    st.lists(st.tuples(st.floats(0.01, 3.14), st.floats(0.01, 3.5)), min_size=1, max_size=30),
    st.integers(1, 60),
)
def test_each_swing_of_an_ensemble_agrees_with_a_plain_loop(method, swings, steps):
    # NumPy's sine, not libm's: an ulp would be chaos later
    force, value = Pendulum(1.0).force(np.sin), Pendulum(1.0).energy(np.sin)
    cells = outcomes(method, *np.array(swings).T, steps)
    for cell, (theta, z) in zip(cells, swings, strict=True):
        start = value((theta, 0.0))
        lowest, highest, _ = wobble(method, z)
        survived, worst, expected = 0, 0.0, "holds"
        for phase in islice(method.phases(force, (np.array([theta]), np.zeros(1)), z), steps):
            now = float(value(phase)[0])
            worst = max(worst, abs(now - start) / start)
            if abs(phase[0]) > math.pi:
                expected = "over the top"
            elif not method.symplectic and now > (1 + BAND) * highest * start:
                expected = "grows"
            elif not method.symplectic and now < (1 - BAND) * lowest * start:
                expected = "loses"
            if expected != "holds":
                break
            survived += 1
        if method.symplectic and expected == "holds":
            assert cell["fate"] in (HOLDS, WOBBLES, ELSEWHERE, CHAOTIC)
        else:
            assert FATES[cell["fate"]] == expected
        assert (cell["steps"], cell["error"]) == (survived, worst)


def test_swings_are_lost_by_hundreds_and_few_ensembles_are_made(monkeypatch):
    """Numba never frees what a generator holds that has not ended."""
    begun = []

    def counting(method, model):
        watch = plain(method, model)
        return lambda phase, h, *others: begun.append(len(h)) or watch(phase, h, *others)

    monkeypatch.setattr("pendu_tui.engine.studies.stability.plain", counting)
    cells = outcomes(EXPLICIT_EULER, np.linspace(0.5, 3, 500), np.full(500, 0.02), 4000)
    assert len(np.unique(cells["steps"])) > 200
    assert begun[0] == 500
    assert all(after < (1 - PARKED) * before for before, after in pairwise(begun))


@pytest.mark.parametrize("key", ["symplectic_euler", "velocity_verlet"])
@pytest.mark.parametrize("theta", [0.01, 1.0, 2.0, 2.8])
def test_symplectic_methods_hold_every_swing_at_small_steps(key, theta):
    ladder = np.linspace(0.05, 0.6, 12)
    assert not is_lost(outcomes(BY_KEY[key], np.full(12, theta), ladder, 2000)).any()


@pytest.mark.parametrize("theta", [0.01, 0.05])
@pytest.mark.parametrize("method", USUAL_CAST[1:], ids=lambda method: method.key)
def test_small_swings_are_held_no_longer_at_the_linear_limit(method, theta):
    # RK4's growth sets in slowly above its limit, and its decay below is no failure in 60 steps.
    ladder, steps, fate = np.linspace(1.9, 3, 111), 500, ELSEWHERE
    if not method.symplectic:
        steps, fate = 60, GROWS
    cells = outcomes(method, np.full(111, theta), ladder, steps)
    first = ladder[np.flatnonzero(cells["fate"] == fate)[0]]
    assert method.linear_limit <= first < method.linear_limit + 0.05


@pytest.mark.parametrize(
    ("theta", "z", "steps", "expected"),
    [
        (0.5, 1.3, 2000, "holds"),
        (0.5, 1.43, 2000, "holds, wobbling"),  # beside z = 2 sin(pi/4) 10 % wider, and back
        (0.5, 1.6, 2000, "holds"),
        (0.518, 2.092, 10_000, "holds elsewhere"),  # beyond its linear limit, as in the scene
        (0.1, 2.02, 10_000, "holds elsewhere"),
    ],
)
def test_velocity_verlet_wobbles_at_a_resonance_and_is_held_elsewhere_beyond_its_limit(
    theta, z, steps, expected
):
    assert fate("velocity_verlet", theta, z, steps) == expected


@pytest.mark.parametrize(("steps", "limit"), [(100, 1.38), (10_000, 1.23)])
def test_the_limit_moves_with_the_steps_that_it_rests_on(steps, limit):
    first, _ = failure_of("velocity_verlet", 2.0, np.arange(1.0, 1.5, 0.01), steps)
    assert first == pytest.approx(limit)


@pytest.mark.parametrize(
    ("key", "theta", "expected", "reason"),
    [
        ("explicit_euler", 1.0, 0.0071, "grows"),
        ("explicit_euler", 2.0, 0.0103, "over the top"),
        ("symplectic_euler", 0.1, 2.13, "over the top"),
        ("symplectic_euler", 1.0, 1.64, "over the top"),
        ("velocity_verlet", 0.1, 2.08, "chaotic"),
        ("velocity_verlet", 0.5, 2.17, "over the top"),
        ("velocity_verlet", 0.7, 2.19, "chaotic"),
        ("velocity_verlet", 1.0, 1.53, "chaotic"),
        ("velocity_verlet", 3.0, 0.66, "over the top"),
        ("rk4", 1.0, 0.437, "loses"),
    ],
)
def test_methods_fail_each_in_its_way(key, theta, expected, reason):
    ladder = expected * np.linspace(0.8, 1.05, 51)
    z, found = failure_of(key, theta, ladder, 10_000)
    assert found == reason
    assert z == pytest.approx(expected, rel=0.012)
