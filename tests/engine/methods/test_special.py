"""Measure the methods that belong to one scene: fields of METHODS and notes on cards."""

import math
from fractions import Fraction
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import EXPLICIT_EULER, RK4, VELOCITY_VERLET, learned, method_of
from pendu_tui.engine.methods.implicit import IMPLICIT_MIDPOINT
from pendu_tui.engine.methods.parts import CONFORMAL_VERLET, IMEX_EULER, LAGGED_VERLET, RESPA
from pendu_tui.engine.methods.verlet import (
    HALVING_RICHARDSON,
    HALVING_VERLET,
    POSITION_VERLET,
    VERLET_COMPENSATED,
    VERLET_FLOAT32,
    Compensated,
    Float32,
)
from pendu_tui.engine.models.damped import DampedPendulum
from pendu_tui.engine.models.mean_field import MeanField
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.models.spring import Spring
from pendu_tui.engine.run.loops import PlainLoops, count_evaluations
from pendu_tui.engine.run.tangent import jacobian

PENDULUM, DAMPED, SPRING = Pendulum(9.81), DampedPendulum(9.81, 0.5), Spring(9.81, 100.0)
MEAN_FIELD = MeanField(9.81, 2.0, 20.0)
FORCE = PENDULUM.force()
SPECIAL = [
    *((method, PENDULUM) for method in (HALVING_VERLET, HALVING_RICHARDSON)),
    *((method, PENDULUM) for method in (VERLET_FLOAT32, VERLET_COMPENSATED)),
    *((method, DAMPED) for method in (LAGGED_VERLET, CONFORMAL_VERLET)),
    *((method, SPRING) for method in (RESPA, IMEX_EULER)),
    (method_of("mean_field_splitting"), MEAN_FIELD),
]
SPRUNG = [(method, SPRING) for method in (VELOCITY_VERLET, POSITION_VERLET, IMPLICIT_MIDPOINT)]
RATES = [(method, model) for method in (EXPLICIT_EULER, RK4) for model in (DAMPED, MEAN_FIELD)]
STIFF = Spring(9.81, 2500.0)
STEPS = {1: (8000, 16_000), 2: (100, 141, 200, 283), 3: (80, 113, 160), 4: (100, 140, 200)}


def with_models(cases):
    names = [f"{method.key}-{model.key}" for method, model in cases]
    return pytest.mark.parametrize(("method", "model"), cases, ids=names)


@with_models(SPECIAL + SPRUNG + RATES)
def test_it_has_the_claimed_order(method, model):
    exact, steps, errors = model.exact(1.0, 0.0).at(1.0).theta, STEPS[method.order], []
    for n in steps:
        phase = PlainLoops(method, model).propagate(model.start(1.0, 0.0), 1.0 / n, n)
        errors.append(abs(model.observe(phase).theta - exact))
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(method.order, abs=0.15)


@with_models(SPECIAL[:8])
def test_a_run_evaluates_the_force_as_often_as_claimed(method, model):
    if method.varies:
        counted = count_evaluations(method, model, (2.0, 0.0), 0.2, 300)  # a minute
        assert counted / 300 == pytest.approx(method.force_evaluations, abs=0.5)
        assert count_evaluations(method, model, (0.1, 0.0), 0.05, 10) == 60  # undivided
    else:
        for steps in (1, 2, 10):
            start = model.start(1.0, 0.5)
            assert count_evaluations(method, model, start, 0.05, steps) == method.evaluations(steps)


@with_models(SPECIAL + SPRUNG + RATES)
def test_time_turned_round_leads_back_to_the_start_where_claimed(method, model):
    start = model.start(2.0, 0.3)
    propagate = PlainLoops(method, model).propagate
    turned = np.array([1, -1, 1, -1, 1])[: len(start)]
    back = propagate(tuple((propagate(start, 0.2, 50) * turned).tolist()), 0.2, 50)
    assert (np.abs(back * turned - start).max() < 1e-9) == method.reversible


def flat(phase):
    return np.array(phase).view(float)


@with_models([*SPECIAL[6:8], *SPRUNG, *((method, PENDULUM) for method in learned.FAMILY[2:])])
def test_a_step_keeps_volume_where_claimed(method, model):
    start, columns = np.array(model.start(1.0, 0.5)), []
    for nudge in 1e-6 * np.eye(len(flat(start))):
        off = nudge.view(start.dtype)
        starts = [tuple(each.tolist()) for each in (start + off, start - off)]
        ends = [next(method.on(model)(each, 0.02)) for each in starts]
        columns.append(flat(ends[0]) - flat(ends[1]))
    assert (abs(np.linalg.det(np.array(columns) / 2e-6) - 1) < 1e-6) == method.symplectic


@pytest.mark.parametrize("method", [HALVING_VERLET, HALVING_RICHARDSON], ids=lambda m: m.key)
@given(theta=st.floats(-1e9, 1e9), omega=st.floats(-1e9, 1e9), h=st.floats(-100, 100))
def test_where_nothing_looks_accurate_a_step_still_ends(method, theta, omega, h):
    count = 0

    def counted(theta):
        nonlocal count
        count += 1
        return FORCE(theta)

    assert all(map(math.isfinite, method.step(counted, (theta, omega), h)))
    assert count <= 6 * (2**11 - 1)


def log_energy_error(method, evaluations):
    """The largest |ln(E/E_true)| of a minute from 2 rad, for so many force evaluations."""
    model, h = DampedPendulum(9.81, 0.05), 60 * method.force_evaluations / evaluations
    reference, energy = model.reference(2.0, 0.0), model.energy()
    phases = enumerate(islice(method.on(model)((2.0, 0.0), h), round(60 / h)), 1)
    return max(abs(reference.error(energy(phase), n * h)) for n, phase in phases)


@pytest.mark.parametrize("friction", [0.05, 0.2])
@pytest.mark.parametrize(("share", "gains"), [(0.95, False), (1.05, True)])
def test_explicit_euler_gains_energy_from_gamma_over_w0_squared_on(friction, share, gains):
    model, h = DampedPendulum(9.81, friction), share * friction / 9.81
    end = PlainLoops(EXPLICIT_EULER, model).propagate((0.1, 0.0), h, round(200 / h))
    assert (model.energy()(end) > model.energy()((0.1, 0.0))) == gains


@pytest.mark.parametrize(
    ("method", "off"),
    [(CONFORMAL_VERLET, 0.0), (RK4, 5e-8), (LAGGED_VERLET, -2.5e-5), (EXPLICIT_EULER, 1.3e-2)],
    ids=lambda value: getattr(value, "key", ""),
)
def test_area_shrinks_by_exp_of_minus_gamma_h_exactly_where_claimed(method, off):
    h, friction = 0.05, 0.2
    determinant = jacobian(method, DampedPendulum(9.81, friction), 1.0, 1.0, h).determinant
    assert determinant / math.exp(-friction * h) - 1 == pytest.approx(off, rel=0.1, abs=1e-14)


def test_conformal_verlet_is_cheaper_at_one_percent_and_rk4_at_a_thousandth():
    verlet, rk4 = (
        [log_energy_error(method, n) for n in (1440, 5760)] for method in (CONFORMAL_VERLET, RK4)
    )
    assert verlet[0] < 1e-2 < rk4[0]
    assert rk4[1] < 1e-4 < 1e-3 / 4 < verlet[1]


ordinary = st.floats(-1e15, 1e15).filter(lambda x: x == 0 or abs(x) > 1e-15)


@given(a=ordinary, b=ordinary)
def test_a_number_of_32_bits_is_numpys_float32(a, b):
    x, y = np.float32(a), np.float32(b)
    assert Float32(a) == x
    assert Float32(a) + Float32(b) == x + y
    assert Float32(a) * Float32(b) == x * y
    assert isinstance(a * Float32(b), Float32)
    with pytest.raises(OverflowError):
        Float32(1e39)


@given(increments=st.lists(st.floats(-1, 1), max_size=50))
def test_a_sum_is_rounded_as_its_increments_are_not_as_itself(increments):
    total, exact = Compensated(1e6), Fraction(10**6)
    for increment in increments:
        total, exact = total + increment, exact + Fraction(increment)
    off = Fraction(float(total)) + Fraction(total.compensation) - exact
    assert abs(off) <= len(increments) * 2.0**-53  # each half a unit in the last place of 1
    assert abs(total.compensation) <= math.ulp(1e6) / 2


def test_imex_euler_is_stable_at_any_stiffness_and_stops_the_swing_too():
    stiffest = Spring(9.81, 1e14)
    z, w = PlainLoops(IMEX_EULER, stiffest).propagate(stiffest.start(1.0, 0.0), 0.02, 1500)
    assert z == pytest.approx(-1j, abs=0.02)
    assert abs(w) < 0.2
    phases = islice(IMEX_EULER.on(STIFF)(STIFF.start(1.0, 0.0), 0.02), 500)
    left = [STIFF.energy()(phase) / STIFF.reference(1.0, 0.0).start for phase in phases]
    assert (left[49], left[499]) == pytest.approx((0.52, 0.065), abs=0.01)  # after 1 and 10 s


def test_a_compensation_goes_on_where_a_run_is_continued():
    propagate = PlainLoops(VERLET_COMPENSATED, PENDULUM).propagate
    whole = propagate((1.0, 0.0), 0.01, 2000)
    assert propagate(propagate((1.0, 0.0), 0.01, 1000), 0.01, 1000) == whole
