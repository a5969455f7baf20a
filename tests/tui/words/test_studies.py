"""Orbits of a method's own map, in words."""

from dataclasses import replace
from fractions import Fraction

import pytest

from pendu_tui.engine.methods import RK4, VELOCITY_VERLET
from pendu_tui.engine.studies.section import OrbitKind
from pendu_tui.tui.words.studies import orbit_words

REGULAR = OrbitKind(4000, True, False, 0.1580611, Fraction(1, 6), False, 0.0018, False, 0.1)
ISLAND = replace(REGULAR, rotation=0.375, fraction=Fraction(3, 8), island=True)
LOST = replace(REGULAR, rotation=None, fraction=None)
HALF = replace(ISLAND, rotation=-0.5, fraction=Fraction(1, 2), spins=True)
MAX = 1e-3  # relative drift of a slow spiral


@pytest.mark.parametrize(
    ("method", "kind", "parts"),
    [
        (VELOCITY_VERLET, REGULAR, ["Regular", "6.3267 steps", "1:6"]),
        (VELOCITY_VERLET, replace(REGULAR, spins=True), ["Regular", "over the top"]),
        (VELOCITY_VERLET, ISLAND, ["islands", "3 turns in every 8 steps", "3:8"]),
        (VELOCITY_VERLET, HALF, ["islands", "1 turn over the top in every 2 steps"]),
        (VELOCITY_VERLET, replace(LOST, chaotic=True, lyapunov=0.2108), ["Chaotic", "e^0.211"]),
        (VELOCITY_VERLET, LOST, ["Undecided in 4000 steps"]),
        (VELOCITY_VERLET, replace(LOST, moves=False), ["equilibrium"]),
        (RK4, replace(LOST, drift=-0.3), ["spirals inwards", "no rotation number"]),
        (RK4, replace(REGULAR, drift=0.3), ["spirals outwards", "6.3267 steps", "1:6"]),
        (RK4, replace(REGULAR, drift=-0.9 * MAX), ["A slow spiral", "6.3267 steps", "1:6"]),
        (RK4, replace(REGULAR, drift=-1.1 * MAX), ["spirals inwards"]),
        (VELOCITY_VERLET, replace(REGULAR, drift=-1.1 * MAX), ["Regular"]),
    ],
)
def test_the_orbit_in_a_sentence(method, kind, parts):
    assert [part for part in parts if part not in orbit_words(method, kind)] == []
