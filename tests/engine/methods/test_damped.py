"""Methods with friction: who gains energy, who keeps the order, and whose area shrinks as it should."""

import math
from itertools import islice

import numpy as np
import pytest

from engine.methods import EXPLICIT_EULER, RK4
from engine.methods.damped import CONFORMAL_VERLET, LAGGED_VERLET
from engine.models.damped import DampedPendulum
from engine.run.loops import PlainLoops, count_evaluations
from engine.run.tangent import jacobian

CAST = (EXPLICIT_EULER, LAGGED_VERLET, CONFORMAL_VERLET, RK4)
each_method = pytest.mark.parametrize("method", CAST, ids=lambda m: m.key)


def log_energy_error(method, friction, h, time=60.0):
    """The largest |ln(E/E_true)| from 2 rad."""
    model = DampedPendulum(9.81, friction)
    reference, energy = model.reference(2.0, 0.0), model.energy()
    phases = method.on(model)((2.0, 0.0), h)
    return max(
        abs(reference.error(energy(phase), n * h))
        for n, phase in enumerate(islice(phases, round(time / h)), 1)
    )


@each_method
def test_the_error_falls_with_the_claimed_power_of_h(method):
    model, steps = (
        DampedPendulum(9.81, 0.5),
        {1: (4000, 5600, 8000), 2: (200, 280, 400), 4: (100, 140, 200)}[method.order],
    )
    exact = model.exact(2.0, 0.0).at(2.0)
    errors = [
        abs(PlainLoops(method, model).travel((2.0, 0.0), 2.0 / n, n)[0] - exact.theta)
        for n in steps
    ]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(method.order, abs=0.05 if method.order == 2 else 0.2)


def test_taking_friction_from_the_omega_before_costs_verlet_an_order():
    errors = [
        log_energy_error(method, 0.2, h)
        for method in (LAGGED_VERLET, CONFORMAL_VERLET)
        for h in (0.05, 0.025)
    ]
    assert errors[0] / errors[1] < 2.5  # .058 and .025
    assert errors[2] / errors[3] == pytest.approx(4, abs=0.2)  # .0146 and .0036
    assert errors[3] < errors[1] / 5


@pytest.mark.parametrize("friction", [0.05, 0.2])
def test_explicit_euler_gains_energy_from_gamma_over_w0_squared_on(friction):
    model = DampedPendulum(9.81, friction)
    for share, gains in ((0.95, False), (1.05, True)):
        h = share * friction / 9.81
        theta, omega = PlainLoops(EXPLICIT_EULER, model).travel((0.1, 0.0), h, round(200 / h))
        assert (model.energy()((theta, omega)) > model.energy()((0.1, 0.0))) == gains


@pytest.mark.parametrize(
    ("method", "off"),
    [(CONFORMAL_VERLET, 0.0), (RK4, 5e-8), (LAGGED_VERLET, -2.5e-5), (EXPLICIT_EULER, 1.3e-2)],
    ids=lambda value: getattr(value, "key", ""),
)
def test_area_shrinks_by_exp_of_minus_gamma_h_exactly_where_claimed(method, off):
    h, friction = 0.05, 0.2
    determinant = jacobian(method, DampedPendulum(9.81, friction), 1.0, 1.0, h).determinant
    assert determinant / math.exp(-friction * h) - 1 == pytest.approx(off, rel=0.1, abs=1e-14)


@each_method
def test_a_step_evaluates_the_force_as_often_as_claimed(method):
    for steps in (1, 2, 10):
        assert count_evaluations(
            method, DampedPendulum(9.81, 0.1), (1.0, 0.5), 0.05, steps
        ) == method.evaluations(steps)


@each_method
def test_however_a_run_is_cut_the_bits_are_the_same(method):
    travel = PlainLoops(method, DampedPendulum(9.81, 0.1)).travel
    assert travel(travel((1.0, 0.5), 0.05, 3), 0.05, 4) == travel((1.0, 0.5), 0.05, 7)


def test_conformal_verlet_is_cheapest_at_one_percent_and_rk4_from_a_thousandth_on():
    def error(method, evaluations):
        return log_energy_error(method, 0.05, 60 * method.force_evaluations / evaluations)

    assert error(CONFORMAL_VERLET, 1440) < 1e-2 < error(RK4, 1440)
    assert error(RK4, 5760) < 1e-4 < 1e-3 / 4 < error(CONFORMAL_VERLET, 5760)
