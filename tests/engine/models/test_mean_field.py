"""A pendulum with a quantum two-level system: its equations, what it conserves, its splitting."""

import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import RK4, method_of
from pendu_tui.engine.models.mean_field import ACCURACY, STEP, MeanField, strang
from pendu_tui.engine.models.reference import Reference, compose
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import SCENES

MODEL = MeanField(9.81, 2.0, 20.0)
START = MODEL.start(1.0, 0.0)
SPLITTING = method_of("mean_field_splitting")

phases = st.tuples(
    st.floats(-3, 3), st.floats(-5, 5), st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)
)


def field(theta):
    return np.array([math.sin(theta), 0.0, math.cos(theta)])


def slope_of_field(theta):
    return np.array([math.cos(theta), 0.0, -math.sin(theta)])


@given(phase=phases)
def test_the_rates_are_the_equations_of_motion(phase):
    theta, omega, *bloch = phase
    pull = -9.81 * math.sin(theta) - 2.0 * slope_of_field(theta) @ bloch
    expected = [omega, pull, *(20.0 * np.cross(field(theta), bloch))]
    assert MODEL.rates()(phase) == pytest.approx(expected, abs=1e-13)


@given(phase=phases)
def test_the_energy_is_the_pendulums_and_the_expectation_of_the_levels(phase):
    theta, omega, *bloch = phase
    expected = omega**2 / 2 + 9.81 * (1 - math.cos(theta)) + 2.0 * field(theta) @ bloch
    assert MODEL.energy()(phase) == pytest.approx(expected, abs=1e-13)
    assert list(MODEL.observe(phase).extra.values())[:3] == bloch


def test_the_reference_is_as_accurate_as_it_claims_and_keeps_both_invariants():
    exact = MODEL.exact(1.0, 0.0)
    finer = Reference(compose(lambda phase, h: strang(MODEL, phase, h)), START, STEP / 4 / 20)
    energy = MODEL.energy()
    for t in (1.0, 10.0, 60.0):
        phase = finer.at(t)
        assert abs(exact.at(t).theta - phase[0]) < ACCURACY
        assert energy(phase) == pytest.approx(energy(START), rel=1e-11)
        assert MODEL.invariant()(phase) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "h", "frequency", "energy_error", "probability"),
    [
        (RK4, 0.05, 20.0, 4.3e-4, 0.852),
        (RK4, 0.05, 10.0, 4.3e-4, 0.975),
        (RK4, 0.01, 20.0, 1.9e-6, 0.9993),
        (SPLITTING, 0.05, 20.0, 6.9e-3, 1.0),
    ],
)
def test_rk4_keeps_the_energy_better_and_the_splitting_the_probability(
    method, h, frequency, energy_error, probability
):
    largest, left = run(method, MeanField(9.81, 2.0, frequency), h)
    assert largest == pytest.approx(energy_error, rel=0.03)
    assert left == pytest.approx(probability, abs=5e-4)


def run(method, model, h):
    """Return the largest relative energy error of all steps, and the probability at the end."""
    energy = model.energy()
    start = energy(START)
    largest = 0.0
    for phase in islice(method.on(model)(START, h), round(60 / h)):
        largest = max(largest, abs(energy(phase) - start) / start)
    return largest, model.invariant()(phase)


@given(phase=phases, h=st.floats(0.01, 0.3))
def test_the_splitting_keeps_the_poisson_structure(phase, h):
    columns = []
    for nudge in 1e-6 * np.eye(5):
        ahead, behind = (np.array(strang(MODEL, tuple(phase + s * nudge), h)) for s in (1, -1))
        columns.append((ahead - behind) / 2e-6)
    jacobian = np.transpose(columns)
    there = structure(strang(MODEL, phase, h))
    assert jacobian @ structure(phase) @ jacobian.T == pytest.approx(there, abs=1e-6)


def structure(phase):
    """Return the tensor P of y' = P grad H: canonical, and a turn about s for the levels."""
    sx, sy, sz = phase[2:]
    tensor = np.zeros((5, 5))
    tensor[:2, :2] = [[0, 1], [-1, 0]]
    tensor[2:, 2:] = 20.0 / 2.0 * np.array([[0, sz, -sy], [-sz, 0, sx], [sy, -sx, 0]])
    return tensor


def test_a_lockstep_watches_the_probability_at_every_step():
    alone, cut = Lockstep(SCENES["mean-field"]), Lockstep(SCENES["mean-field"])
    alone.advance(1200)
    for _ in range(400):
        cut.advance(3)
        cut.sample()
    errors = [reading.max_invariant_error for reading in alone.sample().readings]
    assert errors == [reading.max_invariant_error for reading in cut.sample().readings]
    rk4, splitting = errors
    assert splitting < 1e-13 < 0.147 < rk4 < 0.149
    assert Lockstep(SCENES["drift"]).sample().readings[0].max_invariant_error is None


@pytest.mark.parametrize("coupling", [2.0, -2.0])
@given(
    theta=st.floats(-3, 3),
    s=st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda s: math.hypot(*s) > 0.1),
)
def test_no_pure_state_has_less_energy_than_the_phase_at_rest(coupling, theta, s):
    model = MeanField(9.81, coupling, 20.0)
    energy, rest = model.energy(), model.rest_phase(theta)
    pure = np.array(s) / np.linalg.norm(s)
    assert math.hypot(*rest[2:]) == pytest.approx(1.0)
    assert energy(rest) <= energy((theta, 0.0, *pure)) + 1e-12


@pytest.mark.parametrize("length", [0.9, 1.2])
def test_the_probability_error_is_what_the_bloch_vector_is_longer_than_1(length):
    seen = MODEL.observe((0.3, 0.0, 0.0, 0.6 * length, -0.8 * length))
    assert seen.extra["probability_error"] == pytest.approx(length - 1)
