"""The quick loops are the textbook's loops: not a bit is different."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import METHODS
from engine.models.pendulum import acceleration, energy
from engine.run import loops
from engine.run.inline import NotInlinableError, written_out
from engine.run.loops import plain

each_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
angles = st.floats(-10, 10)
pulls = st.floats(0.01, 100)  # w0²
steps = st.floats(1e-3, 3) | st.floats(-3, -1e-3)
VERLET = next(method for method in METHODS if method.first_same_as_last)


def overflowing(acceleration, phase, h):
    theta, omega = phase
    return theta * theta * theta, omega + h * acceleration(theta)


def with_a_name_of_the_loops(acceleration, phase, h):
    theta, omega = phase
    half = h * acceleration(theta)
    return theta + h * omega, omega + half


def a_pair_at_once(acceleration, phase, h):
    return phase[0] + h * phase[1], phase[1] + h * acceleration(phase[0])


OVERFLOWING = replace(METHODS[0], key="overflowing", step=overflowing)
UNUSUAL = [replace(METHODS[0], step=step) for step in (with_a_name_of_the_loops, a_pair_at_once, lambda a, y, h: y)]


@each_method
@given(w0_squared=pulls, theta=angles, omega=angles, h=steps, n=st.integers(0, 200))
def test_written_out_the_loops_give_the_bits_of_the_loops_with_calls(method, w0_squared, theta, omega, h, n):
    written, phase, limit = plain(method), (theta, omega), 1e6
    force = acceleration(w0_squared)
    assert written.travel(w0_squared, phase, h, n) == loops.travel(method.step, force, phase, h, n)
    expected = loops.advance(method.step, force, w0_squared, phase, h, n, limit)
    assert repr(written.advance(w0_squared, phase, h, n, limit)) == repr(expected)  # repr: nan where n is 0


@each_method
def test_the_extremes_are_those_of_the_energy_at_every_step(method):
    w0_squared, phase, h, n = 9.81, (2.0, -1.0), 0.05, 300
    path = [plain(method).travel(w0_squared, phase, h, steps) for steps in range(1, n + 1)]
    energies = [energy(w0_squared, *point) for point in path]
    expected = (n, path[-1], energies[-1], min(energies), max(energies))
    assert plain(method).advance(w0_squared, phase, h, n, math.inf) == expected


@each_method
def test_a_step_costs_the_force_evaluations_that_the_method_claims(method):
    written, evaluations = written_out(loops.travel, method), 0

    def counting_sin(x):
        nonlocal evaluations
        evaluations += 1
        return math.sin(x)

    written.__globals__["sin"] = counting_sin
    written(9.81, (1.0, 0.0), 0.05, 1000)
    assert evaluations == 1000 * method.force_evaluations + method.first_same_as_last


@pytest.mark.parametrize("method", UNUSUAL)
def test_a_method_not_written_as_in_the_book_is_carried_all_the_same(method):
    with pytest.raises(NotInlinableError):
        written_out(loops.advance, method)
    expected = loops.travel(method.step, acceleration(9.81), (1.0, 0.5), 0.05, 100)
    done, phase, *_ = plain(method).advance(9.81, (1.0, 0.5), 0.05, 100, math.inf)
    assert plain(method).travel(9.81, (1.0, 0.5), 0.05, 100) == expected == phase
    assert done == 100


@given(theta=st.floats(1.01, 1e6), n=st.integers(1, 60))
def test_a_method_that_overflows_is_carried_to_its_last_finite_step(theta, n):
    phase, path = (theta, 0.0), []
    for _ in range(n):
        phase = overflowing(lambda x: -9.81 * math.sin(x) if math.isfinite(x) else math.nan, phase, 0.1)
        if not all(map(math.isfinite, phase)) or not energy(9.81, *phase) < math.inf:
            break
        path.append(phase)
    energies = [energy(9.81, *point) for point in path]
    done, last, value, low, high = plain(OVERFLOWING).advance(9.81, (theta, 0.0), 0.1, n, math.inf)
    assert (done, last) == (len(path), path[-1] if path else (theta, 0.0))
    assert (low, high) == (min(energies, default=math.inf), max(energies, default=-math.inf))
    assert value == energies[-1] if path else math.isnan(value)


@each_method
def test_it_stops_before_the_step_whose_energy_reaches_the_limit(method):
    free = plain(method).advance(9.81, (2.0, 0.0), 0.05, 500, math.inf)
    highest = free[4]
    done, phase, value, _, high = plain(method).advance(9.81, (2.0, 0.0), 0.05, 500, highest)
    assert done < 500
    assert high < highest
    assert energy(9.81, *phase) == value
    assert energy(9.81, *plain(method).travel(9.81, phase, 0.05, 1)) == highest
