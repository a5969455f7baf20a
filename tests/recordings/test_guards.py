"""The gates of the pytest plugin on right and broken integrators."""

from contextlib import contextmanager
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from pendu_tui.recordings.pytest import EnergyDrift, MethodProperties

SEEDS = 20


def kicks(second=0.5, dropped=None):
    """Return velocity Verlet with another second kick, which each `dropped`-th step lacks."""

    def step(force, phase, h):
        q, p = phase
        count = 0
        while True:
            count += 1
            p = p + 0.5 * h * force(q)
            q = q + h * p
            if dropped is None or count % dropped:
                p = p + second * h * force(q)
            yield q, p

    return step


def stale(force, phase, h):
    """Velocity Verlet whose second kick uses the force of before the drift."""
    q, p = phase
    while True:
        old = force(q)
        p = p + 0.5 * h * old
        q = q + h * p
        p = p + 0.5 * h * old
        yield q, p


RIGHT = kicks()


@contextmanager
def failing(reason=None):
    """Expect a test to fail for a reason, at its own line."""
    with pytest.raises(pytest.fail.Exception, match=reason) as failed:
        yield
    assert failed.traceback.filter(failed)[-1].path == Path(__file__)


@pytest.fixture
def method_gate():
    return MethodProperties([])


@pytest.fixture
def energy_gate():
    return EnergyDrift([])


@pytest.mark.parametrize(
    ("broken", "reason"),
    [
        (stale, "its order is 1.0"),
        (kicks(second=0.0), "no order: its error stays above"),
        (kicks(dropped=40), "begins again after"),
    ],
    ids=["stale", "no second kick", "1 of 40 dropped"],
)
def test_a_broken_method_fails_for_what_is_broken(method_gate, broken, reason):
    with failing(reason):
        method_gate.check(broken, order=2, symplectic=True)


def test_a_right_method_passes_and_each_of_its_properties_is_compared(method_gate):
    assert method_gate.check(RIGHT, order=2.05, symplectic=True, reversible=True)
    assert ("symplectic", True) in method_gate._properties
    for claim in ({"order": 2.2}, {"symplectic": False}, {"reversible": False}):
        with failing():
            method_gate.check(RIGHT, **claim)


def chains(h, seconds, seeds=SEEDS):
    """Simulate chains with cubic and quartic springs; return times and the energies of each.

    The first 50 units of time, in which the chains come to equilibrium, are left out.
    """
    random = np.random.default_rng(2026)
    q = np.zeros((seeds, 16))
    p = random.normal(size=(seeds, 16))

    def stretched(q):
        return np.roll(q, -1, axis=1) - q

    def force(q):
        d = stretched(q)
        pull = d + 0.5 * d**2 + d**3
        return pull - np.roll(pull, 1, axis=1)

    q, p = next(islice(RIGHT(force, (q, p), 0.05), 1000, None))
    energies = []
    steps = round(seconds / h)
    phases = RIGHT(force, (q, p), h)
    for _ in range(steps):
        q, p = next(phases)
        d = stretched(q)
        potential = d**2 / 2 + d**3 / 6 + d**4 / 4
        energies.append((p**2 / 2 + potential).sum(axis=1))
    return h * np.arange(1, steps + 1), np.transpose(energies)


def test_the_order_of_right_runs_passes_for_every_seed(energy_gate):
    powers = []
    simulated = [(h, *chains(h, 60.0)) for h in (0.05, 0.1)]
    for seed in range(SEEDS):
        runs = [(h, times, energies[seed]) for h, times, energies in simulated]
        order = energy_gate.check_order(runs, at_least=1.8)
        powers.append(order.power)
    assert np.mean(powers) == pytest.approx(2, abs=0.05)
    told = [("order", order.power), ("order_uncertainty", order.uncertainty)]
    assert energy_gate._properties[-2:] == told
    energy_gate.check_order(runs, at_least=0.999 * order.highest)
    with failing("not as h"):
        energy_gate.check_order(runs, at_least=1.001 * order.highest)


def test_runs_that_are_too_short_to_tell_fail_and_say_how_long_they_must_be(energy_gate):
    random = np.random.default_rng(5)
    runs = [(h, np.arange(64.0), h**2 * random.normal(size=64)) for h in (0.1, 0.12)]
    with failing(r"cannot tell.* times as long"):
        energy_gate.check_order(runs, at_least=1.8)


@cache
def record(seconds=150.0):
    """Return the times and energies of one chain."""
    times, energies = chains(0.05, seconds, seeds=1)
    return times, energies[0]


def test_a_limit_is_compared_on_both_sides(energy_gate):
    judged = energy_gate.check(*record())
    assert energy_gate._properties == [("verdict", "bounded"), ("slope", judged.slope)]
    for name, value, reason in (
        ("max_error", judged.max_error, "^the error is"),
        ("max_fluctuation", judged.fluctuation, "^the fluctuation is"),
        ("max_drift", judged.bound, "the drift is"),
    ):
        assert energy_gate.check(*record(), **{name: value})
        with failing(reason):
            energy_gate.check(*record(), **{name: 0.999 * value})


def test_a_record_that_cannot_tell_fails_and_says_how_long_it_must_be(energy_gate):
    with failing(r"cannot tell: the drift is .* as long"):
        energy_gate.check(*record(), max_drift=1e-12)
    with failing("cannot tell: the verdict is not bounded"):
        energy_gate.check(*record(seconds=2.0))


def test_a_verdict_that_does_not_exist_fails_beside_one_that_fits(energy_gate):
    with failing("did you mean loses"):
        energy_gate.check([0, 1, 2], [1, 1, 1], verdict=("undecided", "losses"))


def test_several_verdicts_may_pass_and_a_drift_is_compared_with_its_bound(energy_gate):
    times, energies = record()
    drifting = energies * (1 + 0.01 * times)
    with failing(r"the drift is 0\.01, above 0\.005\n"):
        energy_gate.check(times, drifting, "grows", max_drift=0.005)
    with failing(r"the drift is 0\.01, above 0\.005\n"):
        energy_gate.check(times, 2 * energies - drifting, "loses", max_drift=0.005)
    assert energy_gate.check(times, drifting, ["bounded", "grows"]).verdict == "grows"
    with failing("^the verdict is not bounded or loses"):
        energy_gate.check(times, drifting, ["bounded", "loses"])


def test_an_energy_that_is_nan_fails_with_its_time_and_errors_are_divided_by_the_scale(energy_gate):
    times, energies = record()
    once, twice = (energy_gate.check(times, energies, scale=scale) for scale in (1.0, 2.0))
    assert twice.max_error == pytest.approx(once.max_error / 2)
    energies = np.where(times > 100.001, np.nan, energies)
    with failing(r"its numbers end at 100\.05"):
        energy_gate.check(times, energies)
