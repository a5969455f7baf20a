import math
from itertools import islice

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import SYMPLECTIC_EULER, VELOCITY_VERLET
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.stability import GREENE_Z, is_chaotic, parting

SYMPLECTIC = (SYMPLECTIC_EULER, VELOCITY_VERLET)  # those of the standard map


def largest_omega(scene, method, steps, enough=math.inf):
    """Largest |omega|·h on the way, up to the first that is `enough`."""
    phases = method.phases(scene.equations.force(), (scene.theta, scene.omega), scene.h)
    largest = 0.0
    for _, omega in islice(phases, steps):
        if abs(omega) * scene.h > largest:
            largest = abs(omega) * scene.h
            if largest >= enough:
                break
    return largest


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0.01, 10))
def test_symplectic_euler_is_the_standard_map_with_k_equal_to_z_squared(theta, p, z):
    new_p = p - z**2 * math.sin(theta)
    new_theta, new_omega = SYMPLECTIC_EULER.step(Pendulum(1.0).force(), (theta, p / z), z)
    # Both sides round a handful of sums of numbers up to 150; 1e-12 is some thirty ulp of them.
    assert new_omega * z == pytest.approx(new_p, abs=1e-12)
    assert new_theta == pytest.approx(theta + new_p, abs=1e-12)


def test_the_chaos_scenes_lie_well_on_either_side_of_greenes_threshold():
    fenced, loose = SCENES["chaos-fenced"].z, SCENES["chaos-loose"].z
    assert (fenced**2, loose**2) == pytest.approx((0.95, 1.1), rel=1e-12)
    assert fenced < GREENE_Z < loose


@pytest.mark.parametrize("method", SYMPLECTIC, ids=lambda method: method.key)
def test_chaos_fenced_stays_below_pi_over_h_and_chaos_loose_does_not(method):
    fenced, loose = SCENES["chaos-fenced"], SCENES["chaos-loose"]
    assert is_chaotic(method, fenced.theta, fenced.z)
    # A million steps reach 0.91 pi and 0.79 pi; the fence is an invariant curve.
    assert largest_omega(fenced, method, 200_000) < math.pi
    # It takes 14 000 and 33 000 steps here; other roundings of sin give other orbits.
    assert largest_omega(loose, method, 1_000_000, enough=2 * math.pi) >= 2 * math.pi


@pytest.mark.parametrize("method", SYMPLECTIC, ids=lambda method: method.key)
@pytest.mark.parametrize("k", [20, 100])
def test_far_above_the_threshold_the_lyapunov_exponent_is_ln_half_k(method, k):
    """Chirikov, Phys. Rep. 52 (1979) 263."""
    found = parting(method, 1.0, 0.3, math.sqrt(k), 20_000) / 20_000
    # Twenty starts were within 0.6 % of it; at K = 10 orbits still stick (1.5 %).
    assert found == pytest.approx(math.log(k / 2), rel=0.012)


@pytest.mark.parametrize(
    ("theta", "z", "chaotic"),
    [
        *((theta, z, False) for theta, z in ((0.5, 1.43), (1.0, 0.3), (3.0, 0.3), (0.1, 1.9))),
        *((theta, z, True) for theta, z in ((1.0, 1.535), (2.0, 1.38), (3.0, 0.67))),
    ],
)
def test_chaotic_swings_are_called_chaotic_and_regular_ones_not(theta, z, chaotic):
    assert is_chaotic(VELOCITY_VERLET, theta, z) == chaotic
