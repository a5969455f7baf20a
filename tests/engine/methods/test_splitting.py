"""Splittings: what their cards say."""

import math
from functools import cache
from itertools import islice

import pytest

from engine.methods import METHODS, VELOCITY_VERLET
from engine.methods.splitting import (
    FAMILY,
    FOREST_RUTH,
    composition,
    splitting,
)
from engine.models.pendulum import Pendulum
from engine.run.loops import PlainLoops
from engine.run.stepping import Stepping

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


def position_extended(force, phase, h):
    """PEFRL.  Omelyan, Mryglod & Folk, Comput. Phys. Commun. 146 (2002) 188."""
    xi, lam, chi = 0.17861789584480907, -0.21234183106260540, -0.066264582669818496
    theta, omega = phase
    while True:
        theta = theta + xi * h * omega
        for kick, drift in zip(
            (0.5 - lam, lam, lam, 0.5 - lam), (chi, 1 - 2 * (chi + xi), chi, xi), strict=True
        ):
            omega = omega + kick * h * force(theta)
            theta = theta + drift * h * omega
        yield theta, omega


def composed(*half):
    weights = (*half, *half[-2::-1])
    return len(weights), composition(*weights)


S = 1 / (4 - 4 ** (1 / 3))
LEFT_OUT = {
    "PEFRL": (4, position_extended),
    # Phys. Lett. A 146 (1990) 319
    "Suzuki 4": composed(S, S, 1 - 4 * S),
    # Phys. Lett. A 150 (1990) 262
    "Yoshida 6": composed(0.78451361047755726382, 0.23557321335935813368, -1.1776799841788710, 1.3151863206839112),
    # Math. Comput. 66 (1997) 1089
    "Kahan-Li 6": composed(
        0.39216144400731413928, 0.33259913678935943860, -0.7062461725576394, 0.08221359629355080, 0.7985440939934800
    ),
    "Kahan-Li 8": composed(
        0.13020248308889008, 0.56116298177510838, -0.38947496264484729, 0.15884190655515560, -0.39590389413323758,
        0.18453964097831571, 0.25837438768632205, 0.29501172360931030, -0.60550853383003451,
    ),
}  # fmt: skip
HERE = {method.key: (method.force_evaluations, method.phases) for method in METHODS}
EXACT = [MODEL.exact(2.0, 0.0).at(t + 1.0).theta for t in range(100)]


def reaches(name, target, cost):
    """Whether so many evaluations follow a swing from 2 rad for 100 s, compared at 100 times."""
    evaluations, phases = (HERE | LEFT_OUT)[name]
    every = cost // evaluations // 100
    run = islice(phases(MODEL.force(), (2.0, 0.0), 1 / every), every - 1, None, every)
    return all(abs(theta - right) <= target for right, (theta, _) in zip(EXACT, run, strict=False))


@pytest.mark.parametrize(
    ("name", "target", "cost"),
    [
        ("blanes_moan_4", 1e-3, 3000),
        ("blanes_moan_4", 1e-6, 7800),
        ("blanes_moan_4", 1e-9, 36_000),
        ("blanes_moan_6", 1e-9, 26_400),
        ("rk4", 1e-3, 15_600),
        ("rk4", 1e-6, 59_000),
        ("rk4", 1e-9, 190_000),
        ("Kahan-Li 8", 1e-9, 30_600),
    ],
)
def test_accuracy_costs_as_much_as_the_cards_say(name, target, cost):
    assert reaches(name, target, cost)
    assert not reaches(name, target, round(0.93 * cost))


@pytest.mark.parametrize(("target", "cost"), [(1e-3, 4000), (1e-6, 13_600), (1e-9, 30_600)])
def test_those_left_out_are_beaten_at_every_accuracy(target, cost):
    """No size of their steps reaches it at a smaller cost; one of them does at this one."""
    assert any(reaches(name, target, cost) for name in LEFT_OUT)
    for name, (evaluations, _) in LEFT_OUT.items():
        dearest = (cost - 1) // (100 * evaluations)
        steps = {max(1, round(dearest * 0.97**n)) for n in range(30)}
        assert not any(reaches(name, target, 100 * every * evaluations) for every in steps), name
