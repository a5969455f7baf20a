"""Stiffness: what each method does to a bob on a stiff spring, by h times the spring's frequency."""

import math

import numpy as np
import pytest

from engine.methods import RK4, VELOCITY_VERLET
from engine.methods.implicit import IMPLICIT_MIDPOINT
from engine.methods.stiff import IMEX_EULER, RESPA, respa
from engine.methods.verlet import POSITION_VERLET, velocity_verlet
from engine.models.spring import Spring
from engine.run.loops import PlainLoops, count_evaluations

SPRING = Spring(9.81, 2500.0)
SOFT = Spring(9.81, 100.0)
START = SPRING.start(1.0, 0.0)


@pytest.mark.parametrize("stiffness", [400.0, 2500.0, 1e4])
@pytest.mark.parametrize(
    ("method", "holds", "fails"), [(VELOCITY_VERLET, 1.95, 2.05), (RK4, 2.80, 2.85)]
)
def test_verlet_and_rk4_fail_at_their_linear_limits(method, holds, fails, stiffness):
    model = Spring(9.81, stiffness)
    reference = model.reference(1.0, 0.0)
    for z, kept in ((holds, True), (fails, False)):
        h = z / math.sqrt(stiffness)
        done, _, _, low, high = PlainLoops(method, model).advance(
            model.start(1.0, 0.0), h, round(30 / h), 1e300
        )
        error = max(abs(reference.error(low)), abs(reference.error(high)))
        assert (done == round(30 / h) and error < 1) == kept


def test_respa_at_a_golden_part_of_the_period_is_no_better_than_at_a_rational_one():
    def largest_error(h):
        done, _, _, low, high = PlainLoops(RESPA, SPRING).advance(START, h, round(30 / h), 1e300)
        return (
            max(map(abs, map(SPRING.reference(1.0, 0.0).error, (low, high)))) if done else math.inf
        )

    errors = {share: largest_error(share * math.tau / 50) for share in (0.5, 0.618, 0.99)}
    assert errors[0.5] < errors[0.618] < 1 < 10 < errors[0.99]


def test_respa_with_one_inner_step_is_verlet_but_for_rounding():
    one = respa(velocity_verlet, 1)
    phase = START
    for _ in range(500):
        phase = next(one(SPRING.parts(), phase, 0.01))
    expected = PlainLoops(VELOCITY_VERLET, SPRING).travel(START, 0.01, 500)
    assert phase == pytest.approx(expected, abs=1e-11)
    assert phase != expected


def test_imex_euler_is_stable_however_stiff_the_spring_and_stops_the_swing_as_well():
    stiff = Spring(9.81, 1e14)
    done, (z, w), *_ = PlainLoops(IMEX_EULER, stiff).advance(
        stiff.start(1.0, 0.0), 0.02, 1500, 100.0
    )
    assert done == 1500
    assert z == pytest.approx(-1j, abs=0.02)
    assert abs(w) < 0.2
    left = [
        1
        + SPRING.reference(1.0, 0.0).error(
            SPRING.energy()(PlainLoops(IMEX_EULER, SPRING).travel(START, 0.02, n))
        )
        for n in (50, 500)
    ]
    assert left == pytest.approx([0.52, 0.065], abs=0.01)  # after 1 and 10 s


@pytest.mark.parametrize("method", [RESPA, IMPLICIT_MIDPOINT, IMEX_EULER], ids=lambda m: m.key)
def test_on_a_softer_spring_it_has_the_claimed_order(method):
    """IMEX Euler on the stiff one has it only where h is far below what anybody would take."""
    exact, errors = SOFT.place(1.0, 0.0, 0.5), []
    steps = (8000, 11_300, 16_000) if method.order == 1 else (200, 283, 400)
    for n in steps:
        z, _ = PlainLoops(method, SOFT).travel(SOFT.start(1.0, 0.0), 0.5 / n, n)
        errors.append(abs(z - exact[0]))
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(method.order, abs=0.1)


def determinant(method):
    """Of the derivative of a step in the plane, by central differences: four numbers, so no complex step."""
    z, w = 0.8 - 0.6j, 1.0 + 0.5j
    columns = []
    for dz, dw in ((1, 0), (1j, 0), (0, 1), (0, 1j)):
        ends = [
            next(method.on(SPRING)((z + s * 1e-6 * dz, w + s * 1e-6 * dw), 0.02)) for s in (1, -1)
        ]
        (za, wa), (zb, wb) = ends
        columns.append([(za - zb).real, (za - zb).imag, (wa - wb).real, (wa - wb).imag])
    return float(np.linalg.det(np.array(columns) / 2e-6))


@pytest.mark.parametrize(
    "method",
    [RESPA, IMPLICIT_MIDPOINT, IMEX_EULER, VELOCITY_VERLET, POSITION_VERLET],
    ids=lambda m: m.key,
)
def test_volume_is_kept_and_time_turned_back_where_claimed(method):
    assert (abs(determinant(method) - 1) < 1e-6) == method.symplectic
    travel = PlainLoops(method, SPRING).travel
    z, w = travel(START, 0.02, 50)
    z, w = travel((z, -w), 0.02, 50)
    assert (abs(z - START[0]) + abs(w + START[1]) < 1e-10) == method.reversible


@pytest.mark.parametrize("method", [RESPA, IMPLICIT_MIDPOINT, IMEX_EULER], ids=lambda m: m.key)
def test_a_step_asks_for_the_fast_force_as_often_as_claimed(method):
    for steps in (1, 2, 5):
        claimed = steps if method is IMPLICIT_MIDPOINT else method.evaluations(steps)
        assert count_evaluations(method, SPRING, START, 0.02, steps) == claimed
