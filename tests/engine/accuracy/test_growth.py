"""How the error in theta grows with time."""

import pytest

from pendu_tui.engine.accuracy.growth import duration, growth, growths
from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.phase_space.section import orbit
from pendu_tui.engine.scenes import SCENES, Scene

EXPLICIT, SYMPLECTIC, VERLET, RK4 = USUAL_CAST


@pytest.mark.parametrize(
    ("scene", "method", "power"),
    [
        (Scene(), VERLET, 1),
        (Scene(theta=2.0, h=0.01), VERLET, 1),
        (SCENES["spin"].altered(h=0.01), VERLET, 1),
        (Scene(theta=2.0, h=0.02), RK4, 2),
        (Scene(theta=2.5, h=0.02), RK4, 2),
        (Scene(theta=0.01), RK4, 1),  # where the period does not hang on the energy
        (SCENES["linear"].altered(h=0.05), RK4, 1),
        (SCENES["linear"].altered(h=0.05), VERLET, 1),
        (Scene(), EXPLICIT, None),  # the error is more than a turn by then
        (Scene(h=0.3), VERLET, None),  # and too large after few swings
        (Scene(h=0.02), SYMPLECTIC, None),  # a wobble, and what grows as t
        (Scene(theta=0.0), VERLET, None),  # at rest
        (Scene(h=1e-5), VERLET, None),  # too many steps
        (SCENES["linear"].altered(h=1.9), RK4, None),  # longer than a fourth of the period
    ],
    ids=lambda value: str(getattr(value, "key", "")),
)
def test_symplectic_errors_grow_as_t_and_rk4s_as_t_squared(scene, method, power):
    found = growth(scene, method)
    if power is None:
        assert found.power is None
    else:
        assert found.power == pytest.approx(power, abs=0.15)
        assert found.name == f"{method.label} t^{found.power:.2f}"


def test_the_errors_of_each_period_are_those_of_the_run():
    scene, h = Scene(theta=2.0, h=0.02), 0.02
    exact = scene.exact()
    assert duration(scene) == pytest.approx(100 * exact.period)
    # backwards in time errors are the same
    (found,) = growths(scene.altered(h=1.0, cast=(VERLET,)), (-h,))
    theta, _ = orbit(VERLET, scene.equations, h, (2.0, 0.0), 6000)
    off = [abs(float(theta[k]) - exact.at(h * k).theta) for k in range(6001)]
    for at in (0, 5, 20):
        assert found.times[at] == pytest.approx((at + 0.5) * exact.period)
        begin, end = (int(n * exact.period / h) for n in (at, at + 1))
        assert 0.9 * max(off[begin:end]) < found.errors[at] <= max(off[begin : end + 2])
