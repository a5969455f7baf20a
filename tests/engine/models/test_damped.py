"""The pendulum with friction, and the reference that stands in for a closed form."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.models.damped import ACCURACY, STEP, DampedPendulum
from pendu_tui.engine.models.pendulum import Pendulum, exact_pendulum
from pendu_tui.engine.models.reference import Reference, compose_verlet
from pendu_tui.engine.scenes import Scene

TIMES = [0.37 * n for n in range(163)]  # a minute


@pytest.mark.parametrize("friction", [0.05, 1.0, 20.0])
def test_the_reference_is_as_accurate_as_it_says(friction):
    model = DampedPendulum(9.81, friction)
    exact, step = model.exact(2.0, 0.0), STEP / 2 / max(model.w0, friction)
    assert exact.accuracy == ACCURACY
    finer = Reference(compose_verlet(model.force(), friction), (2.0, 0.0), step)
    # Of order 8, the reference's own error is 256 times that of the finer one.
    assert max(abs(exact.at(t).theta - finer.at(t)[0]) for t in TIMES) < ACCURACY / 2


def test_without_friction_the_reference_is_the_closed_form():
    model, exact = Pendulum(9.81), exact_pendulum(9.81, 2.0, 0.0)
    reference = Reference(compose_verlet(model.force()), (2.0, 0.0), STEP / model.w0)
    assert max(abs(exact.at(t).theta - reference.at(t)[0]) for t in TIMES) < ACCURACY


def test_it_does_not_matter_which_times_are_asked_for_first():
    def reference():
        return Reference(compose_verlet(DampedPendulum(9.81, 0.1).force(), 0.1), (2.0, 0.0), 0.016)

    together = reference()
    for t in (37.5, 0.0, -20.0, 3.7, 60.0, -0.016, 59.99):
        assert together.at(t) == reference().at(t)


@given(t=st.floats(0, 40))
def test_it_loses_energy_by_gamma_omega_squared(t):
    model = DampedPendulum(9.81, 0.2)
    true, omega = model.reference(2.0, 0.0).true, model.exact(2.0, 0.0).at(t).omega
    # 1e-6: the third derivative, times 1e-9
    assert (true(t + 1e-4) - true(t - 1e-4)) / 2e-4 == pytest.approx(-0.2 * omega**2, abs=1e-6)


def test_an_error_is_the_logarithm_of_the_energy_over_the_true_one():
    reference = DampedPendulum(9.81, 0.2).reference(2.0, 0.0)
    true = reference.true(30.0)
    assert reference.error(true * math.e, 30.0) == pytest.approx(1)
    assert reference.error(0.0, 30.0) == pytest.approx(math.log(reference.least / true))
    # of an energy that is hardly a number, and far back in time, there are still numbers
    assert DampedPendulum(9.81, 0.1).reference(1e-157, 0.0).error(0.0, 30.0) == 0
    assert math.isfinite(DampedPendulum(9.81, 20.0).reference(2.0, 0.0).error(10.0, -1000.0))


def test_energy_decides_the_regime_and_there_is_no_period():
    model = DampedPendulum(9.81, 0.05)
    regimes = {start: model.exact(*start) for start in ((2.0, 0.0), (0.0, 8.0), (0.0, 0.0))}
    assert [exact.regime for exact in regimes.values()] == ["libration", "rotation", "equilibrium"]
    assert {exact.period for exact in regimes.values()} == {None}


def test_friction_is_for_the_model_that_has_it_and_within_limits():
    damped = Scene(model="damped", parameters={"friction": 0.1}, cast=())
    assert damped.equations == DampedPendulum(9.81, 0.1)
    assert damped.fields()["friction"] == 0.1
    with pytest.raises(InputError, match=r"^the model pendulum has no friction; "):
        Scene(parameters={"friction": 0.1})
    with pytest.raises(
        InputError, match=r"^friction = -1 s⁻¹ is out of range; use 0 to 100 s⁻¹\.$"
    ):
        replace(damped, parameters={"friction": -1.0})
    slow = replace(damped, length=1e4, gravity=1.0, h=1.0)  # far above w0
    with pytest.raises(InputError, match=r"^friction = 2 s⁻¹ is out of range; use 0 to 1 s⁻¹\.$"):
        replace(slow, parameters={"friction": 2.0})


@pytest.mark.parametrize(("share", "regime"), [(0.999, "libration"), (1.001, "rotation")])
def test_it_rotates_as_long_as_its_energy_is_beyond_the_separatrix(share, regime):
    omega = 2 * math.sqrt(9.81 * share)
    assert DampedPendulum(9.81, 0.1).exact(0.0, omega).regime == regime
    assert DampedPendulum(9.81, 0.1).exact(0.0, 0.0).regime == "equilibrium"


def test_an_area_shrinks_by_exp_of_minus_gamma_t():
    assert DampedPendulum(9.81, 0.5).area_share(4.0) == pytest.approx(math.exp(-2.0))
    assert Pendulum(9.81).area_share(4.0) == 1.0
