"""Measure what the cards of the splittings say."""

import math
from functools import cache
from itertools import islice

import pytest

from pendu_tui.engine.methods import METHODS, VELOCITY_VERLET, method_of
from pendu_tui.engine.methods.splitting import FAMILY, FOREST_RUTH, composition, splitting
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run.loops import PlainLoops
from pendu_tui.engine.run.stepping import Stepping

MODEL = Pendulum(9.81)


@pytest.mark.parametrize("phases", [splitting((0.5, 0.5), (1.0,)), composition(1.0)])
def test_a_splitting_of_two_half_kicks_is_velocity_verlet_to_the_bit(phases):
    start = MODEL.force(), (2.0, 0.3), 0.05
    verlets = islice(VELOCITY_VERLET.phases(*start), 1000)
    assert list(islice(phases(*start), 1000)) == list(verlets)


@cache
def largest_energy_error(method, h, time=60.0):
    start = MODEL.energy()((1.0, 0.0))
    _, _, _, low, high = PlainLoops(method, MODEL).advance((1.0, 0.0), h, round(time / h), math.inf)
    return max(high - start, start - low) / start


def test_forest_ruth_has_the_weaknesses_on_its_card():
    limits = [method.linear_limit for method in METHODS if method.linear_limit]
    assert FOREST_RUTH.linear_limit == min(limits)
    same_cost = Stepping(0.15, equal_cost=True, cast=(FOREST_RUTH, VELOCITY_VERLET)).own
    ours, verlets = map(largest_energy_error, (FOREST_RUTH, VELOCITY_VERLET), same_cost)
    assert 0.6 < ours / verlets < 1
    places = []
    FOREST_RUTH.step(lambda theta: places.append(theta) or 0.0, (0.0, 1.0), 1.0)
    assert places[2] - places[1] == pytest.approx(-1.7, abs=0.01)


@pytest.mark.parametrize("method", [VELOCITY_VERLET, *FAMILY], ids=lambda method: method.key)
def test_its_energy_does_not_drift(method):
    h = method.linear_limit / 4 / math.sqrt(9.81)
    early, late = (largest_energy_error(method, h, steps * h) for steps in (5_000, 50_000))
    assert late == pytest.approx(early, rel=0.01)


EXACT = [MODEL.exact(2.0, 0.0).at(t + 1.0).theta for t in range(100)]


def reaches(key, target, cost):
    """Whether so many evaluations follow a swing from 2 rad for 100 s, compared at 100 times."""
    method = method_of(key)
    every = cost // method.force_evaluations // 100
    run = islice(method.phases(MODEL.force(), (2.0, 0.0), 1 / every), every - 1, None, every)
    return all(abs(theta - right) <= target for right, (theta, _) in zip(EXACT, run, strict=False))


@pytest.mark.parametrize(
    ("key", "target", "cost"),
    [
        ("blanes_moan_4", 1e-3, 3000),
        ("blanes_moan_4", 1e-6, 7800),
        ("blanes_moan_4", 1e-9, 36_000),
        ("blanes_moan_6", 1e-9, 26_400),
        ("yoshida_6", 1e-3, 7700),
        ("yoshida_6", 1e-6, 23_800),
        ("rk4", 1e-3, 15_600),
        ("rk4", 1e-6, 59_000),
        ("rk4", 1e-9, 190_000),
    ],
)
def test_accuracy_costs_as_much_as_the_cards_say(key, target, cost):
    assert reaches(key, target, cost)
    assert not reaches(key, target, round(0.93 * cost))
