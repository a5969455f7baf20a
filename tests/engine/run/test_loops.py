"""Loops take the phases of a method until its numbers overflow, with the same bits compiled."""

import math
from dataclasses import replace
from itertools import islice, takewhile

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pendu_tui.engine.methods import GENERAL, RK4, TAYLOR_20, VELOCITY_VERLET, method_of
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run import loops as loops_module
from pendu_tui.engine.run.loops import (
    CompiledLoops,
    PlainLoops,
    TieredLoops,
    compiled,
    count_evaluations,
)
from tests.models import EQUATIONS, EXAMPLES
from tests.own_methods import VERLET, load

each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)
each_model = pytest.mark.parametrize(
    "model",
    [model for model in EQUATIONS if not model.without_force],
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
    phase = (theta, omega)
    path = []
    for _ in range(n):
        phase = method.step(model.force(), phase, h)
        path.append(phase)
    assume(all(map(math.isfinite, phase)))  # a large implicit step may have no solution
    energies = [model.energy()(point) for point in path]
    loops = PlainLoops(method, model)
    assert loops.propagate((theta, omega), h, n) == phase
    expected = (n, phase, energies[-1], min(energies), max(energies))
    assert loops.advance((theta, omega), h, n, math.inf) == expected


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


def test_a_run_goes_on_from_where_it_is_with_the_step_that_it_is_given():
    loops = PlainLoops(RK4, PENDULUM)
    first = loops.advance((2.0, 0.0), 0.05, 3, math.inf)
    assert loops.advance(first.phase, 0.05, 4, math.inf).phase == loops.propagate(
        (2.0, 0.0), 0.05, 7
    )
    for phase, h in ((first.phase, 0.05), (first.phase, -0.1), ((1.0, 0.0), -0.1)):
        assert loops.advance(phase, h, 2, math.inf).phase == loops.propagate(phase, h, 2)
    again = loops.advance((1.0, 0.0), 0.05, 2, math.inf).phase
    assert loops.advance(again, 0.1, 2, math.inf).phase == loops.propagate(again, 0.1, 2)


@pytest.mark.parametrize(
    ("key", "model", "evaluations"),
    [("imex_euler", "spring", 30), ("respa", "spring", 330), ("rk4", "pendulum", 120)],
)
def test_evaluations_of_the_force_or_of_each_counted_part_are_added_up(key, model, evaluations):
    model = EXAMPLES[model].equations
    start = model.start(1.0, 0.5)
    assert count_evaluations(method_of(key), model, start, 0.01, 30) == evaluations


@each_method
def test_compiled_steps_have_the_same_bits_and_free_their_memory(method):
    fast = compiled(method, PENDULUM)
    slow = PlainLoops(method, PENDULUM)
    assert fast is not slow
    start = ((2.5, 0.3), 0.05, 5000, math.inf)
    assert fast.advance(*start) == slow.advance(*start)

    resource = pytest.importorskip("resource", reason="no count of page faults")

    def faults(runs):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
        for _ in range(runs):
            fast.propagate((1.0, 0.0), 0.01, 2)
        return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

    faults(1000)
    assert faults(20_000) < 200  # pages; a list of BM4's in each run would fill 1000


@each_model
@pytest.mark.parametrize("method", [VELOCITY_VERLET, RK4, OVERFLOWING], ids=lambda each: each.key)
@pytest.mark.parametrize("h", [0.001, -0.02, 3.0])
def test_compiled_and_plain_agree_on_any_model_at_any_step(method, model, h):
    start = ((math.radians(179.9), -0.2), h, 500)
    fast = compiled(method, model)
    slow = PlainLoops(method, model)
    found = fast.advance(*start, 1e9)
    assert repr(found) == repr(slow.advance(*start, 1e9))  # repr: nan where no step was taken
    if found[0] == 500:
        assert fast.propagate(*start) == slow.propagate(*start)


@pytest.mark.parametrize(("ahead", "compiled_steps"), [(0, [4]), (3, [2, 4])])
def test_it_pays_from_a_number_of_steps_done_or_known_to_lie_ahead(
    ahead, compiled_steps, monkeypatch
):
    monkeypatch.setattr(loops_module, "COMPILED_FROM", 3)
    plain, compiled_loops, used = PlainLoops(RK4, PENDULUM), compiled(RK4, PENDULUM), []

    def propagate(*start):
        used.append(start[-1])
        return compiled_loops.propagate(*start)

    # asked for at each call until they are there
    offers = iter([None, CompiledLoops(propagate=propagate, advance=compiled_loops.advance)])
    loops = TieredLoops(RK4, PENDULUM, lambda method, model: next(offers), ahead)
    for n in (1, 2, 4):
        start = ((2.0, 0.0), 0.05, n)
        assert loops.propagate(*start) == plain.propagate(*start)
        assert loops.advance(*start, math.inf) == plain.advance(*start, math.inf)
    assert used == compiled_steps


def test_only_what_numba_can_take_is_compiled_and_has_the_same_bits():
    damped = EXAMPLES["damped"].equations
    plain = [(load(VERLET), PENDULUM), (RK4, damped), (method_of("verlet_compensated"), PENDULUM)]
    assert all(isinstance(compiled(*each), PlainLoops) for each in plain)
    loops = compiled(TAYLOR_20, PENDULUM)
    assert not isinstance(loops, PlainLoops)
    start = ((2.0, 0.5), 0.1, 20)
    assert loops.propagate(*start) == PlainLoops(TAYLOR_20, PENDULUM).propagate(*start)


def test_where_the_compiled_sine_differs_plain_loops_are_used(monkeypatch):
    class OtherSine:
        """Numba where one of 20,000 sines is a bit off."""

        @staticmethod
        def njit(function):
            def sine(x):
                right = function(x)
                return math.nextafter(right, 2.0) if round(1000 * x) == 19_999 else right

            return sine

    monkeypatch.setattr(loops_module, "_same_sine", loops_module._same_sine.__wrapped__)
    monkeypatch.setattr(loops_module, "_compiled", loops_module._compiled.__wrapped__)
    assert not isinstance(compiled(GENERAL[0], PENDULUM), PlainLoops)
    monkeypatch.setattr(loops_module, "import_module", lambda name: OtherSine)
    assert isinstance(compiled(GENERAL[0], PENDULUM), PlainLoops)
