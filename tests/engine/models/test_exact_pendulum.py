"""The closed form against mpmath at 50 digits and against the laws of motion."""

import math

import mpmath as mp
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pendu_tui.engine.models.model import State
from pendu_tui.engine.scenes import SCENES, Scene
from tests.truths import LIMITS

W0 = math.sqrt(9.81)
JUST = 2 * W0  # rad/s; at the bottom, the speed of the separatrix

STARTS = {
    "at the default": (1.0, 0.0),
    "tiny": (1e-8, 0.0),
    "hardly there": (1e-200, 0.0),
    "outwards": (1.0, 3.0),
    "back through the bottom": (-1.0, -3.0),
    "a micro-radian from upright": (math.pi - 1e-6, 0.0),
    "a pico-radian from upright": (math.pi - 1e-12, 0.0),
    "at math.pi, which is not pi": (math.pi, 0.0),
    "just below the separatrix": (1.0, JUST * math.cos(0.5) * (1 - 1e-9)),
    "just below it, falling back": (2.0, -JUST * math.cos(1.0) * (1 - 1e-13)),
    "just above it, falling back": (2.0, -JUST * math.cos(1.0) * (1 + 1e-13)),
    "within rounding of it": (0.0, JUST),
    "rotation backwards": (3.0, -8.0),
    "fast": (0.5, 100.0),
    "swinging many turns up": (1e6, 1.0),
    "spinning many turns down": (-1e6, -9.0),
}


def reference(scene, t):
    theta, omega, w0 = mp.mpf(scene.theta), mp.mpf(scene.omega), mp.sqrt(mp.mpf(scene.w0_squared))
    turns = 2 * mp.pi * mp.nint(theta / (2 * mp.pi))
    half = (theta - turns) / 2
    k2 = mp.sin(half) ** 2 + (omega / (2 * w0)) ** 2
    k = mp.sqrt(k2)
    if k2 < 1:
        u = w0 * t + mp.ellipf(mp.atan2(mp.sin(half), omega / (2 * w0)), k2)
        sn, cn, dn = (mp.ellipfun(name, u, m=k2) for name in ("sn", "cn", "dn"))
        return turns + 2 * mp.atan2(k * sn, dn), 2 * w0 * k * cn
    direction = mp.sign(omega)
    u = k * w0 * t + mp.ellipf(direction * half, 1 / k2)
    turn = 2 * mp.ellipk(1 / k2)
    done = mp.nint(u / turn)
    sn, cn, dn = (mp.ellipfun(name, u - done * turn, m=1 / k2) for name in ("sn", "cn", "dn"))
    return turns + direction * 2 * (mp.atan2(sn, cn) + done * mp.pi), direction * 2 * w0 * k * dn


def assert_exact(scene, t):
    with mp.workdps(50):
        theta, omega = reference(scene, t)
        state = scene.exact().at(t)
        # 1e-12 is the contract; beyond a turn it is relative, as the float that holds theta is.
        assert abs(state.theta - theta) <= 1e-12 * max(1.0, abs(state.theta))
        assert abs(state.omega - omega) <= 1e-12 * max(scene.w0, abs(state.omega))


@pytest.mark.parametrize("start", STARTS.values(), ids=STARTS)
def test_the_swing_is_exact_to_1e_12_forwards_and_backwards(start):
    scene = Scene(theta=start[0], omega=start[1])
    for t in (-100 / W0, -3.3, 0.0, 0.1, 1.234, 7.7, 20.0, 100 / W0):
        assert_exact(scene, t)


@settings(max_examples=60)
@given(
    theta=st.floats(-10, 10),
    omega=st.floats(-20, 20),
    phase=st.floats(-100, 100),
    gravity=st.sampled_from([1.62, 9.81, 24.79]),
)
def test_the_swing_is_exact_from_any_start(theta, omega, phase, gravity):
    scene = Scene(theta=theta, omega=omega, gravity=gravity)
    if scene.exact().regime in ("libration", "rotation"):
        assert_exact(scene, phase / scene.w0)


def test_the_closed_form_solves_the_equation_of_motion_itself():
    """Against a Taylor integration of theta'' = -w0² sin theta, without any elliptic function."""

    def rates(_, phase):
        return [phase[1], -mp.mpf(9.81) * mp.sin(phase[0])]

    solution = mp.odefun(rates, 0, (0.0, 7.0), tol=mp.mpf("1e-15"))
    found = Scene(theta=0.0, omega=7.0).exact().at(2.0)
    assert found == pytest.approx([float(value) for value in solution(2)], abs=1e-13)


def test_each_start_has_its_regime():
    starts = [(1.0, 0.0), (math.pi, 0.0), (0.0, 8.0), (0.0, 0.0)]
    motions = [Scene(theta=theta, omega=omega).exact() for theta, omega in starts]
    regimes = ["libration", "libration", "rotation", "equilibrium"]
    assert [exact.regime for exact in motions] == regimes
    assert motions[-1].period is None
    assert motions[-1].at(1e5) == State(0.0, 0.0)


def test_the_separatrix_climbs_forever():
    exact = Scene(theta=0.0, omega=-2.0, gravity=1.0).exact()  # w0 = 1: the one start exactly on it
    assert (exact.regime, exact.period) == ("separatrix", None)
    for t in (-3.0, 0.5, 3.0):
        gudermann = -2 * math.atan(math.sinh(t)), -2 / math.cosh(t)
        assert exact.at(t) == pytest.approx(gudermann, abs=1e-15)  # a few roundings
    assert exact.at(1e5) == State(-math.pi, 0.0)


@pytest.mark.parametrize(
    "scene", [s for s in SCENES.values() if s.model == "pendulum"], ids=lambda s: s.name
)
def test_after_its_period_it_is_back(scene):
    exact = scene.exact()
    theta, omega = exact.at(exact.period)
    turn = math.tau if exact.regime == "rotation" else 0.0
    # 1e-12: the roundings of one period, as for any other time.
    assert (theta - turn, omega) == pytest.approx((scene.theta, scene.omega), abs=1e-12)


@given(**{name: st.floats(*limits) for name, limits in LIMITS.items()}, t=st.floats(-1e5, 1e5))
def test_no_legal_start_gives_anything_but_finite_numbers(t, **start):
    scene = Scene(**start, h=0.1 * math.sqrt(start["length"] / start["gravity"]))
    assert all(map(math.isfinite, scene.exact().at(t)))
