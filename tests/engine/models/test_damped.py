"""The pendulum with friction, and the reference that stands in for a closed form."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.methods import RK4
from engine.models.damped import ACCURACY, STEP, DampedPendulum
from engine.models.pendulum import Pendulum, exact_pendulum
from engine.models.reference import Reference, compose_verlet
from engine.scenes import Scene, SceneError

TIMES = [0.37 * n for n in range(163)]  # a minute


@pytest.mark.parametrize("friction", [0.05, 0.2, 1.0, 20.0])
def test_the_reference_is_as_accurate_as_it_says(friction):
    model = DampedPendulum(9.81, friction)
    exact = model.exact(2.0, 0.0)
    assert exact.accuracy == ACCURACY
    finer = Reference(
        compose_verlet(model.force(), friction), (2.0, 0.0), STEP / 2 / max(model.w0, friction)
    )
    # Of order 8, the reference's own error is 256 times that of the finer one.
    assert max(abs(exact.at(t).theta - finer.at(t)[0]) for t in TIMES) < ACCURACY / 2


def test_without_friction_the_reference_is_the_closed_form():
    model, exact = Pendulum(9.81), exact_pendulum(9.81, 2.0, 0.0)
    reference = Reference(compose_verlet(model.force()), (2.0, 0.0), STEP / model.w0)
    assert max(abs(exact.at(t).theta - reference.at(t)[0]) for t in TIMES) < ACCURACY


@settings(max_examples=20)
@given(times=st.lists(st.floats(-20, 60), min_size=1, max_size=12))
def test_it_does_not_matter_which_times_are_asked_for_first(times):
    model = DampedPendulum(9.81, 0.1)
    one = Reference(compose_verlet(model.force(), 0.1), (2.0, 0.0), 0.016)
    for t in times:
        other = Reference(compose_verlet(model.force(), 0.1), (2.0, 0.0), 0.016)
        assert one.at(t) == other.at(t)


@given(t=st.floats(0, 40))
def test_it_loses_energy_by_gamma_omega_squared(t):
    model = DampedPendulum(9.81, 0.2)
    true, exact = model.reference(2.0, 0.0).true, model.exact(2.0, 0.0)
    assert true is not None
    slope = (true(t + 1e-4) - true(t - 1e-4)) / 2e-4
    assert slope == pytest.approx(
        -0.2 * exact.at(t).omega ** 2, abs=1e-6
    )  # the third derivative, times 1e-9


def test_an_error_is_the_logarithm_of_the_energy_over_the_true_one():
    reference = DampedPendulum(9.81, 0.2).reference(2.0, 0.0)
    assert reference.true is not None
    assert reference.error(reference.true(30.0) * math.e, 30.0) == pytest.approx(1)
    assert reference.error(0.0, 30.0) == pytest.approx(
        math.log(reference.least / reference.true(30.0))
    )


def test_it_swings_when_it_cannot_go_over_the_top_turns_when_it_may_and_has_no_period():
    model = DampedPendulum(9.81, 0.05)
    regimes = {start: model.exact(*start) for start in ((2.0, 0.0), (0.0, 8.0), (0.0, 0.0))}
    assert [exact.regime for exact in regimes.values()] == ["libration", "rotation", "equilibrium"]
    assert {exact.period for exact in regimes.values()} == {None}


def test_far_back_in_time_where_it_was_infinitely_fast_there_are_still_numbers():
    reference = DampedPendulum(9.81, 20.0).reference(2.0, 0.0)
    assert math.isfinite(reference.error(10.0, -1000.0))


def test_friction_is_for_the_model_that_has_it_and_within_limits():
    with pytest.raises(SceneError, match=r"^the model pendulum has no friction; "):
        Scene(parameters={"friction": 0.1})
    with pytest.raises(
        SceneError, match=r"^friction = -1 s⁻¹ is out of range; use 0 to 100 s⁻¹\.$"
    ):
        Scene(model="damped", parameters={"friction": -1.0}, cast=())
    scene = Scene(model="damped", parameters={"friction": 0.1}, cast=())
    assert scene.equations == DampedPendulum(9.81, 0.1)
    assert scene.fields()["friction"] == 0.1
    assert "friction" not in Scene().fields()
    assert "stiffness" not in scene.fields()


def test_friction_far_above_w0_is_refused_with_what_is_not():
    with pytest.raises(SceneError, match=r"^friction = 2 s⁻¹ is out of range; use 0 to 1 s⁻¹\.$"):
        Scene(
            model="damped",
            parameters={"friction": 2.0},
            length=1e4,
            gravity=1.0,
            h=1.0,
            cast=(RK4,),
        )
