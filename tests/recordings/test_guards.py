"""The gates of the pytest plugin on right and broken integrators."""

from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from pendu_tui.recordings.pytest import EnergyDrift, MethodProperties
from tests.bench.foreign import correlated


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
def energy_gate():
    return EnergyDrift([])


@pytest.mark.parametrize(
    ("broken", "reason"),
    [
        (stale, r"^stale: its order is 1\.0"),
        (kicks(second=0.0), "no order: its error stays above"),
        (kicks(second=0.5001), r"order 0\.006"),
        (kicks(dropped=40), "when restarted after"),
    ],
)
def test_a_broken_method_fails_for_what_is_broken(broken, reason):
    with failing(reason):
        MethodProperties([]).check(broken, order=2, symplectic=True)


def test_a_right_method_passes_and_each_of_its_properties_is_compared():
    method_gate = MethodProperties([])
    assert method_gate.check(RIGHT, order=2.05, symplectic=True)
    assert ("symplectic", True) in method_gate._properties
    for name, claim, has in (
        ("order", 2.2, "its order is 2"),
        ("symplectic", False, "symplectic is True, not False"),
        ("reversible", False, "reversible is True, not False"),
    ):
        with failing(f"^step: {has}"):
            method_gate.check(RIGHT, **{name: claim})


def swings(step):
    """Return the runs of a method at two step sizes: a swing from 1 rad."""
    for h in (0.05, 0.1):
        q, p = np.array([*islice(step(lambda q: -np.sin(q), (1.0, 0.0), h), 3000)]).T
        yield h, h * np.arange(3000), p**2 / 2 + 1 - np.cos(q)


def test_the_order_of_a_fluctuation_sees_a_forgotten_half_kick_but_not_a_slight_one(energy_gate):
    slight = [*swings(kicks(second=0.5001))]
    energy_gate.check_order(slight, at_least=1.8)
    energy_gate.check(*slight[0][1:], max_error=1e-3)
    forgotten = [*swings(kicks(second=0.0))]
    with failing(r"as h\^\(0\."):
        energy_gate.check_order(forgotten, at_least=1.8)
    with failing("the error is"):
        energy_gate.check(*forgotten[0][1:], max_error=1e-3)


def run(h, seed=0, count=1200):
    """Return the times and energies of a run whose error, of h², is remembered for five steps."""
    times = h * np.arange(count)
    return times, 10 + h**2 * correlated(
        count, count / 5, np.random.default_rng([seed, round(1e3 * h)])
    )


def test_the_order_of_right_runs_passes_for_every_seed(energy_gate):
    powers = []
    for seed in range(20):
        runs = [(h, *run(h, seed)) for h in (0.05, 0.1)]
        order = energy_gate.check_order(runs, at_least=1.8)
        powers.append(order.power)
    assert np.mean(powers) == pytest.approx(2, abs=0.05)
    told = [("order", order.power), ("order_uncertainty", order.uncertainty)]
    assert energy_gate._properties[-2:] == told
    energy_gate.check_order(runs, at_least=0.999 * order.highest)
    for limit in (1.001 * order.highest, np.nan):
        with failing(rf"as h\^{limit:g}:"):
            energy_gate.check_order(runs, at_least=limit)


def record(count=3000):
    return run(0.05, count=count)


def test_what_is_too_short_to_tell_fails_and_says_how_long_it_must_be(energy_gate):
    random = np.random.default_rng(5)
    runs = [(h, np.arange(64.0), h**2 * random.normal(size=64)) for h in (0.1, 0.12)]
    with failing(r"cannot tell.* times as long"):
        energy_gate.check_order(runs, at_least=1.8)
    with failing("too few"):
        energy_gate.check_order([(0.1, [0], [1])], at_least=1.8)
    with failing(r"cannot tell: the drift is .* as long"):
        energy_gate.check(*record(), max_drift=1e-12)
    with failing("cannot tell: the verdict is not bounded"):
        energy_gate.check(*record(40))


def test_a_limit_is_compared_on_both_sides(energy_gate):
    judged = energy_gate.check(*record())
    assert energy_gate._properties == [("verdict", "bounded"), ("slope", judged.slope)]
    for name, value, reason in (
        ("max_error", judged.max_error, "^the error is {}, more than {:g}\n"),
        ("max_fluctuation", judged.fluctuation, "^the fluctuation is {}, more than {:g}\n"),
        ("max_drift", judged.bound, "the drift is"),
    ):
        assert energy_gate.check(*record(), **{name: value})
        with failing(reason.format(value, 0.99 * value)):
            energy_gate.check(*record(), **{name: 0.99 * value})


def test_several_verdicts_may_pass_and_a_drift_is_compared_with_its_bound(energy_gate):
    times, energies = record()
    drifting = energies * (1 + 0.01 * times)
    with failing(r"the drift is 0\.01, above 0\.005\n"):
        energy_gate.check(times, drifting, "grows", max_drift=0.005)
    with failing(r"the drift is 0\.01, above 0\.005\n"):
        energy_gate.check(times, 2 * energies - drifting, "loses", max_drift=0.005)
    assert energy_gate.check(times, drifting, ["bounded", "grows"]).verdict == "grows"
    with failing("did you mean loses"):
        energy_gate.check(times, drifting, verdict=("grows", "losses"))
    with failing("^the verdict is not bounded or loses; the error is"):
        energy_gate.check(times, drifting, ["bounded", "loses"], max_error=0.0)


def test_an_energy_that_is_nan_fails_with_its_time_and_errors_are_divided_by_the_scale(energy_gate):
    times, energies = record()
    once, twice = (energy_gate.check(times, energies, scale=scale) for scale in (1.0, 2.0))
    assert twice.max_error == pytest.approx(once.max_error / 2)
    energies = np.where(times > 100.001, np.nan, energies)
    with failing(r"is None, more than 1\n(?s:.*)the energies break down at 100\.05"):
        energy_gate.check(times, energies, "failed", max_fluctuation=1.0)
