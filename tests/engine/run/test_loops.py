"""The loops take the phases of a method until its numbers overflow."""

import math
from dataclasses import replace
from itertools import islice, takewhile

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pendu_tui.engine.methods import GENERAL
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run.loops import PlainLoops

each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)
each_model = pytest.mark.parametrize(
    "model",
    [kind(9.81) for kind in MODELS.values() if not kind.without_force],
    ids=lambda model: model.key,
)
angles = st.floats(-10, 10)
steps = st.floats(1e-3, 3) | st.floats(-3, -1e-3)
PENDULUM = Pendulum(9.81)
energy = PENDULUM.energy()


def overflowing(force, phase, h):
    theta, omega = phase
    while True:
        theta, omega = theta * theta * theta, omega + h * force(theta)
        yield theta, omega


OVERFLOWING = replace(GENERAL[0], key="overflowing", phases=overflowing)


@each_method
@each_model
@given(theta=angles, omega=angles, h=steps, n=st.integers(1, 40))
def test_the_loops_give_the_bits_of_single_steps(method, model, theta, omega, h, n):
    # the linear oscillator overflows after some 60 evaluations
    n = math.ceil(n / method.force_evaluations)
    phase, path = (theta, omega), []
    for _ in range(n):
        path.append(phase := method.step(model.force(), phase, h))
    assume(all(map(math.isfinite, path[-1])))  # a large implicit step may have no solution
    energies = [model.energy()(point) for point in path]
    assert PlainLoops(method, model).propagate((theta, omega), h, n) == path[-1]
    expected = (n, path[-1], energies[-1], min(energies), max(energies))
    assert PlainLoops(method, model).advance((theta, omega), h, n, math.inf) == expected


@given(theta=st.floats(1.01, 1e6), n=st.integers(1, 60))
def test_a_method_that_overflows_is_carried_to_its_last_finite_step(theta, n):
    def force(x):
        return -9.81 * math.sin(x) if math.isfinite(x) else math.nan

    def within(phase):
        return all(map(math.isfinite, phase)) and energy(phase) < math.inf

    path = list(takewhile(within, islice(overflowing(force, (theta, 0.0), 0.1), n)))
    energies = [energy(point) for point in path]
    loops = PlainLoops(OVERFLOWING, PENDULUM)
    done, last, value, low, high = loops.advance((theta, 0.0), 0.1, n, math.inf)
    assert (done, last) == (len(path), [(theta, 0.0), *path][-1])
    assert (low, high) == (min(energies, default=math.inf), max(energies, default=-math.inf))
    assert value == energies[-1] if path else math.isnan(value)


@each_method
def test_it_stops_before_the_step_whose_energy_reaches_the_limit(method):
    loops = PlainLoops(method, PENDULUM)
    *_, highest = loops.advance((2.0, 0.0), 0.05, 500, math.inf)
    done, phase, value, _, high = loops.advance((2.0, 0.0), 0.05, 500, highest)
    assert done < 500
    assert high < highest
    assert done == 0 or energy(phase) == value
    assert energy(loops.propagate(phase, 0.05, 1)) == highest
