"""The exact motion in words."""

import math

import pytest

from engine.scenes import Scene
from tui.words.motion import energy_share, motion_text, regime

W0 = Scene().w0
MODEL = Scene().equations


@pytest.mark.parametrize(
    ("theta", "omega", "expected"),
    [
        (0.0, 0.0, "libration"),
        (3.1, 0.0, "libration"),
        (math.pi - 1e-6, 0.0, "libration"),
        (math.pi - 1e-6, 1e-5, "rotation"),
        (0.0, 2.01 * W0, "rotation"),
        (-2.0, -6.0, "rotation"),
        (0.0, 2 * W0, "separatrix"),
    ],
)
def test_the_regime_of_a_state(theta, omega, expected):
    assert regime(MODEL, theta, omega) == expected


def test_the_energy_near_the_separatrix_is_written_as_its_distance_from_it():
    assert energy_share(MODEL, 0.0, W0) == "0.25"
    assert energy_share(MODEL, 0.0, 4 * W0) == "4"
    assert energy_share(MODEL, math.pi - 1e-6, 0.0) == "1 - 2.5e-13"
    assert energy_share(MODEL, math.pi, 2e-6 * W0) == "1 + 1.0e-12"


def test_the_exact_motion_has_its_period():
    assert motion_text(Scene(), Scene().exact()) == "exact period 2.13914 s  E/Es 0.2298  libration"
    assert motion_text(Scene(theta=0.0), Scene(theta=0.0).exact()) == "E/Es 0  equilibrium"
