"""Orbits of a method's map, in words."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import pytest

from pendu_tui.engine.methods import RK4, VELOCITY_VERLET
from pendu_tui.engine.studies.accuracy import REASONS, Cheapest
from pendu_tui.engine.studies.section import OrbitKind
from pendu_tui.tui.words.studies import few, front_words, length, orbit_words, point_words

REGULAR = OrbitKind(4000, True, False, 0.1580611, Fraction(1, 6), False, 0.0018, False, 0.1)
ISLAND = replace(REGULAR, rotation=0.375, fraction=Fraction(3, 8), island=True)
LOST = replace(REGULAR, rotation=None, fraction=None)
HALF = replace(ISLAND, rotation=-0.5, fraction=Fraction(1, 2), spins=True)
TEXTS = {
    (length, 9.994e-4): "999 µs",
    (length, 9.996e-4): "1 ms",
    (length, 1e-3): "1 ms",
    (length, 0.9994): "999 ms",
    (length, 1.0): "1 s",
    (length, 12345): "12345 s",
    (few, 8.333): "8.33",
    (few, 99.94): "99.9",
    (few, 999.6): "1000",
}
MAX = 1e-3  # relative drift of a slow spiral


@pytest.mark.parametrize(
    ("method", "kind", "parts"),
    [
        (VELOCITY_VERLET, REGULAR, ["Regular", "6.3267 steps", "1/6"]),
        (VELOCITY_VERLET, ISLAND, ["islands", "3 turns in every 8 steps", "3:8"]),
        (VELOCITY_VERLET, HALF, ["islands", "1 turn over the top in every 2 steps"]),
        (VELOCITY_VERLET, replace(LOST, chaotic=True, lyapunov=0.2108), ["Chaotic", "e^0.211"]),
        (VELOCITY_VERLET, LOST, ["Undecided in 4000 steps"]),
        (VELOCITY_VERLET, replace(REGULAR, fraction=None), ["Undecided"]),
        (VELOCITY_VERLET, replace(REGULAR, rotation=0.0), ["Undecided"]),
        (RK4, replace(LOST, drift=0.0), ["Undecided"]),
        (VELOCITY_VERLET, replace(REGULAR, spins=True), ["turn over the top, nearest"]),
        (VELOCITY_VERLET, replace(LOST, moves=False), ["equilibrium"]),
        (RK4, replace(LOST, drift=-0.3), ["spirals inwards", "no rotation number"]),
        (RK4, replace(REGULAR, drift=0.3), ["spirals outwards", "6.3267 steps", "1/6"]),
        (RK4, replace(REGULAR, drift=-0.9 * MAX), ["A slow spiral"]),
        (RK4, replace(REGULAR, drift=-1.1 * MAX), ["spirals inwards"]),
        (
            *(VELOCITY_VERLET, replace(REGULAR, drift=-1.1 * MAX, rotation=-REGULAR.rotation)),
            ["Regular: 6.3267 steps a turn, nearest fraction 1/6."],
        ),
    ],
)
def test_the_orbit_in_a_sentence(method, kind, parts):
    assert [part for part in parts if part not in orbit_words(method, kind)] == []


def test_the_front_names_ranges():
    entries = [
        Cheapest(1e-1, VELOCITY_VERLET, 50, 1.21),
        Cheapest(1e-2, VELOCITY_VERLET, 100, 1.21),
        Cheapest(1e-3, VELOCITY_VERLET, 300, 1.19),
        Cheapest(1e-4, RK4, 900, 1.0),
    ]
    assert front_words(entries, "evaluations") == (
        "Cheapest in force evaluations: Velocity Verlet from 1e-1 to 1e-3, RK4 at 1e-4."
    )
    assert front_words(entries[:1], "seconds").startswith("Cheapest in seconds: Velocity")
    assert "No power of ten" in front_words([], "seconds")


def test_a_point_in_a_sentence():
    errors, flaws = {"theta": 2e-3}, {"theta": "rounding"}
    point = SimpleNamespace(method=RK4, h=0.05, z=0.15, steps_per_swing=41.9, errors=errors)
    point.flaws, point.force_evaluations = flaws, 80
    start = "RK4 at h 0.05 s: theta error 2.0e-03"
    end = "for 80 force evaluations (z 0.15, 41.9 steps per small-amplitude period)."
    assert point_words(point, "theta") == f"{start} ({REASONS['rounding']}) {end}"
    flaws["theta"] = None
    assert point_words(point, "theta") == f"{start} {end}"


@pytest.mark.parametrize("call", TEXTS, ids=lambda call: TEXTS[call])
def test_computing_times_and_counts_have_three_digits(call):
    write, number = call
    assert write(number) == TEXTS[call]
