"""What holds for every model, and what each promises besides."""

import math
from dataclasses import replace
from operator import ne

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import angle, number, seconds, start_angle
from pendu_tui.engine.models import MODELS, NUMBERS, Model, Pendulum
from pendu_tui.engine.models.damped import DampedPendulum
from pendu_tui.engine.models.mean_field import MeanField
from pendu_tui.engine.models.model import ACCURACY, Reference, _reference
from pendu_tui.engine.models.spring import Spring
from pendu_tui.engine.quantities import ENERGY_ERROR
from tests.models import EQUATIONS, EXAMPLES

each_model = pytest.mark.parametrize("model", EQUATIONS, ids=EXAMPLES)
angles, speeds = st.floats(-3.1, 3.1), st.floats(-5, 5)
DAMPED, SPRING = DampedPendulum(9.81, 0.2), Spring(9.81, 2500.0)
MEAN_FIELD = MeanField(9.81, 2.0, 20.0)


def test_every_model_has_a_scene_and_no_two_a_number_of_the_same_name():
    assert EXAMPLES.keys() == MODELS.keys()
    names = [number.name for model in MODELS.values() for number in model.parameters]
    assert len(names) == len(set(names))
    variables = [each for model in EQUATIONS for each in model.variables]
    assert all(each.unit or each.about for each in variables)  # which viewers show
    assert [each.name for each in variables if each.relative] == ["spring_energy"]
    assert DAMPED.error.label == "ln(E/E_true)"


def test_the_numbers_of_a_scene_have_the_units_of_its_equations_and_limits():
    known = [
        ("theta", "rad", -1e9, 1e9, 1, start_angle, ", or 115deg", "RAD|DEGdeg", math.inf),
        ("omega", "rad/s", -1e9, 1e9, 0, angle, ", or 90deg/s", "RAD_S", math.inf),
        ("length", "m", 1e-6, 1e6, 1, number, "", "M", math.inf),
        ("gravity", "m/s²", 1e-6, 1e6, 9.81, number, "", "M_S2", math.inf),
        ("h", "s", 0, math.inf, 0.05, seconds, ", the step size", "S", math.inf),
        ("friction", "s⁻¹", 0, 100, 0, number, "", "NUMBER", 100),
        ("stiffness", "s⁻²", 1, 1e18, 0, number, "", "NUMBER", math.inf),
        ("coupling", "s⁻²", -1e6, 1e6, 2, number, "", "NUMBER", math.inf),
        ("level_frequency", "s⁻¹", 1e-3, 1e4, 20, number, "", "NUMBER", 1000),
    ]
    found = [(each.name, each.unit, *each[3:]) for each in NUMBERS.values()]
    assert [each for each in found if each in known] == known
    assert all(f"in {each.unit}" in each.about for each in NUMBERS.values())


@pytest.mark.parametrize(
    ("key", "facts"),
    [
        ("pendulum", "-w0² sin theta; force parts; force; w0; 0"),
        ("linear", "-w0² theta; force parts; force; w0; 0"),
        ("damped", "-w0² sin theta - gamma omega; parts rates; force; w0; 2"),
        (
            "spring",
            "-k (1 - 1/|q|) q - i w0², q = x + iy; parts force; fast solve; omega_s; 3; "
            "spring energy (1 at t = 0)",
        ),
        (
            "mean_field",
            "-w0² sin theta - kappa b'·s, s' = nu b × s; parts rates; force; nu; 3; "
            "length of the Bloch vector - 1",
        ),
    ],
)
def test_a_model_says_what_methods_and_charts_take_of_it(key, facts):
    model = EXAMPLES[key].equations
    why_not = sum(map(bool, (model.caption, model.without_force, model.without_ring)))
    own = [each.chart.title for each in model.charted()[1:-3]]
    law = model.equation.split("'' = ", 1)[1]
    taken = " ".join(model.offers), " ".join(model.counted_parts), model.frequency_symbol
    assert "; ".join((law, *taken, str(why_not), *own)) == facts
    assert (model.level(1.0, 2.0) == 0) == (why_not == 3)


def test_a_model_adds_columns_to_readings():
    columns = {}
    for model in EQUATIONS:
        extra = model.observe(model.start(1.0, 0.5)).extra
        columns |= {each.head: (each.wide_head, each.value(extra)) for each in model.extra_columns}
    length = pytest.approx(abs(SPRING.start(1.0, 0.5)[0]))
    energy = pytest.approx(2500 * 0.04**2 / 2, rel=1e-2)
    spring = {"length": ("length", length), "spring": ("spring E", energy)}
    assert columns == spring | {"|s|": ("length |s|", 1.0)}


@each_model
@given(theta=angles, omega=speeds)
def test_a_start_is_seen_at_its_angle_and_angular_velocity(model, theta, omega):
    seen = model.observe(model.start(theta, omega))
    assert seen[:2] == pytest.approx((theta, omega), abs=1e-14)
    assert list(seen.extra) == [each.name for each in model.variables]
    assert model.observe(model.rest_phase(theta))[:2] == pytest.approx((theta, 0), abs=1e-14)


@each_model
def test_a_model_says_what_is_special_about_its_motion(model):
    energy, seen = model.energy(), model.observe(model.start(4.0, 0.5))
    turned = energy(model.start(4.0 - math.tau, 0.5)) == pytest.approx(
        energy(model.start(4.0, 0.5))
    )
    assert model.turns == (turned and seen.theta == 4.0)
    assert model.rigid == (model.length(seen.extra) == 1 == model.exact_length(1.0, 0.0, 0.1))
    differing = sum(map(ne, model.error, ENERGY_ERROR))  # label, head, sentence, chart
    assert differing == 4 * (not model.conserves_energy)
    kept = energy(model.exact_phase(1.0, 0.0, 2.0)) == pytest.approx(energy(model.start(1.0, 0.0)))
    assert model.conserves_energy == kept
    single, double = (model.exact(theta, 0.0).at(0.7).theta for theta in (1.0, 2.0))
    assert model.is_linear == (double == pytest.approx(2 * single))
    assert "force" in model.offers or model.without_force
    assert model.has_separatrix == (model.key == "pendulum")
    assert {*map(type, Pendulum(9.81).observe(np.float32((1, 2)))[:2])} == {float}


def changes(model, phase):
    """The derivative of each number of a phase, by the equations."""
    if "force" in model.offers:
        return phase[1], model.force()(phase[0])
    return model.rates()(phase)


@each_model
def test_the_exact_motion_follows_the_equations_and_is_as_accurate_as_it_says(model):
    step, h = model.exact_step()
    start = model.start(2.0, 0.3)
    energy, invariant = model.energy(), model.invariant() or (lambda phase: 1.0)
    exact, closed = model.exact(2.0, 0.3), type(model).exact is not Model.exact
    assert exact.accuracy == (0 if closed else 1e-10)
    finer = Reference(step, start, h if closed else h / 2)
    for t in (-0.7, 0.05, 1.0, 30.0):
        phase = finer.at(t)
        # of order 8, the reference's own error is 256 times that of the finer one
        assert model.observe(phase).theta == pytest.approx(exact.at(t).theta, abs=ACCURACY / 2)
        slope = np.subtract(finer.at(t + 1e-5), finer.at(t - 1e-5)) / 2e-5
        assert slope == pytest.approx(np.array(changes(model, phase)), rel=1e-5, abs=1e-5)
        assert invariant(phase) == pytest.approx(invariant(start), rel=1e-12)
        if model.conserves_energy:
            assert energy(phase) == pytest.approx(energy(start), rel=1e-11)


def test_times_come_in_any_order_and_few_steps_are_taken_twice():
    taken = []
    reference = Reference(lambda phase, h: taken.append(h) or phase + h, 0.0, 0.5)
    for t, steps in ((50, 100), (35, 106), (35.5, 107), (0.25, 108), (-40, 188), (-33.25, 191)):
        assert (reference.at(t), len(taken)) == (t, steps)  # one phase in 64 steps is kept


@pytest.mark.parametrize(
    ("model", "omega"),
    [
        (DampedPendulum(9.81, 1.0), 0.0),
        (DampedPendulum(9.81, 100.0), 0.0),
        (DAMPED, -60.0),
        (Spring(9.81, 100.0), 50.0),
        (MeanField(9.81, 200.0, 0.1), 0.0),
        (MeanField(9.81, -2.0, 0.1), -20.0),
    ],
)
def test_the_exact_motion_is_right_at_any_friction_speed_and_coupling(model, omega):
    step, h = model.exact_step()
    finer = Reference(step, model.start(2.0, omega), min(h / 2, 5e-4))
    exact = model.exact(2.0, omega)
    for n in range(20):
        theta = model.observe(finer.at(n / 20)).theta
        assert abs(model.theta_error(exact.at(n / 20).theta, theta)) < ACCURACY / 2


def test_the_exact_motion_takes_no_endless_time():
    assert _reference(DAMPED, 0.0, -1e9)._h > 1e-4


def test_an_error_is_the_logarithm_of_the_energy_over_the_true_one():
    reference = DAMPED.reference(2.0, 0.0)
    true = reference.true(30.0)
    assert true == pytest.approx(DAMPED.energy()(DAMPED.exact(2.0, 0.0).at(30.0)))
    expected = [1, math.log(reference.least / true)]
    assert reference.errors(30.0, true * math.e, 0.0) == pytest.approx(expected)
    assert reference.least == 1e-24 * 9.81
    assert DAMPED.reference(0.0, 0.0)[:2] == (0, 2 * 9.81)
    below = MeanField(9.81, -8.0, 20.0).reference(1.0, 0.0)
    assert below.scale == -below.start > 0
    small = DAMPED.reference(1e-3, 0.0)
    assert small.least == 1e-24 * small.scale < 1e-29
    assert DAMPED.reference(1e-157, 0.0).least == 1e-300
    assert reference.errors(30.0, math.inf)[0] == pytest.approx(math.log(1e300 / true))
    # of an energy that is hardly a number, and far back in time, there are still numbers
    assert DampedPendulum(9.81, 0.1).reference(1e-157, 0.0).errors(30.0, 0.0) == [0]
    assert np.isfinite(DampedPendulum(9.81, 20.0).reference(2.0, 0.0).errors(-1000.0, 10.0)).all()


def test_energy_decides_the_regime_and_with_friction_area_shrinks():
    just = 2 * math.sqrt(9.81)
    bound = math.sqrt(2 * (2 * 9.81 - 2))  # the two levels may help as much as the coupling
    for model, omega, regime in (
        (DAMPED, 0.999 * just, "libration"),
        (DAMPED, 1.001 * just, "rotation"),
        (DAMPED, 0.0, "equilibrium"),
        (MEAN_FIELD, 0.999 * bound, "libration"),
        (MEAN_FIELD, 1.001 * bound, "rotation"),
        (MEAN_FIELD, 0.0, "libration"),
    ):
        exact = model.exact(0.0, omega)
        assert (exact.regime, exact.period) == (regime, None)
    assert DAMPED.area_share(4.0) == pytest.approx(math.exp(-0.8))
    assert Pendulum(9.81).area_share(4.0) == 1.0


def test_the_spring_starts_stretched_by_4_percent_beyond_equilibrium():
    z, w = SPRING.start(1.0, 0.0)
    assert z == pytest.approx(0.8769138657516443 - 0.5630599180095599j, abs=1e-15)
    assert w == 0
    seen = SPRING.observe((1 + 2j, 3 + 4j)).extra
    assert [seen[name] for name in ("x", "y", "vx", "vy")] == [1, 2, 3, 4]
    fast, _, solve = SPRING.parts()
    solution = solve(z, 0.01)
    assert solution == pytest.approx(z + 0.01 * fast(solution))
    assert (solution / z).real > 0  # there is another beyond the pivot
    assert SPRING.spring_energy((z, w)) == pytest.approx(2500 / 2 * 0.04**2)
    assert SPRING.spring_energy(SPRING.start(1.0, 5.0)) == pytest.approx(2, rel=0.03)
    assert SPRING.reference(1.0, 0.0).start == pytest.approx(6.5040, abs=1e-4)


def test_the_true_motion_nearly_keeps_the_springs_energy():
    phases = [SPRING.exact_phase(1.0, 0.0, n / 50) for n in range(150)]
    energies = [SPRING.spring_energy(phase) / 2.0 for phase in phases]  # over that at the start
    assert (min(energies), max(energies)) == pytest.approx((0.988548, 1.020686), abs=1e-6)
    found = [SPRING.length(SPRING.observe(phases[7]).extra), SPRING.exact_length(1.0, 0.0, 0.14)]
    assert found == pytest.approx([1.032987] * 2, rel=1e-6)


@pytest.mark.parametrize(("ratio", "followed"), [(319.0, True), (321.0, False), (1e7, False)])
def test_the_true_motion_of_too_fast_a_spring_is_not_known(ratio, followed):
    exact = Spring(9.81, ratio**2 * 9.81).exact(1.0, 0.0)
    assert math.isfinite(exact.at(0.01).theta) == followed


def test_on_a_spring_an_error_of_theta_is_less_than_half_a_turn():
    assert SPRING.theta_error(3.1, -3.1) == pytest.approx(6.2 - math.tau)
    assert SPRING.theta_error(0.3, 0.1) == pytest.approx(0.2)
    assert DAMPED.theta_error(3.0, -4.0) == 7.0


phases = st.tuples(angles, speeds, *[st.floats(-1, 1)] * 3)


def field(theta):
    return np.array([math.sin(theta), 0.0, math.cos(theta)])


@given(phase=phases)
def test_the_mean_field_has_the_equations_and_the_energy_of_its_docstring(phase):
    theta, omega, *bloch = phase
    pull = -9.81 * math.sin(theta) - 2.0 * field(theta + math.pi / 2) @ bloch
    expected = [omega, pull, *(20.0 * np.cross(field(theta), bloch))]
    assert MEAN_FIELD.rates()(phase) == pytest.approx(expected, abs=1e-13)
    energy = omega**2 / 2 + 9.81 * (1 - math.cos(theta)) + 2.0 * field(theta) @ bloch
    assert MEAN_FIELD.energy()(phase) == pytest.approx(energy, abs=1e-13)
    seen = MEAN_FIELD.observe(phase).extra
    length = np.linalg.norm(bloch)
    assert list(seen.values()) == pytest.approx([*bloch, length - 1])
    assert MEAN_FIELD.extra_columns[0].value(seen) == pytest.approx(length)
    assert MEAN_FIELD.start(theta, omega) == (theta, omega, 1, 0, 0)


def test_the_fastest_motion_may_be_the_swing():
    for model, fastest in ((SPRING, 50), (MEAN_FIELD, 20)):
        assert (model.fastest, replace(model, w0_squared=1e6).fastest) == (fastest, 1000)


@pytest.mark.parametrize("coupling", [2.0, -2.0])
@given(theta=angles, s=st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda s: math.hypot(*s) > 0.1))
def test_no_pure_state_has_less_energy_than_the_phase_at_rest(coupling, theta, s):
    model = MeanField(9.81, coupling, 20.0)
    energy, rest = model.energy(), model.rest_phase(theta)
    assert math.hypot(*rest[2:]) == pytest.approx(1.0)
    assert energy(rest) <= energy((theta, 0.0, *(np.array(s) / np.linalg.norm(s)))) + 1e-12
