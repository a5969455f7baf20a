"""Sections against direct iteration, rotation numbers against theory, and known chaos."""

import math
from fractions import Fraction

import numpy as np
import pytest

from pendu_tui.engine.methods import GENERAL, USUAL_CAST, method_of
from pendu_tui.engine.methods.tangent import Stretching
from pendu_tui.engine.models.pendulum import LinearOscillator, Pendulum
from pendu_tui.engine.studies import section
from pendu_tui.engine.studies.section import (
    iterate,
    kind_of,
    nearest_fraction,
    orbit,
    pieces,
    rotation_number,
    spread,
)

UNIT = Pendulum(1.0)  # so that h is z
EXPLICIT, SYMPLECTIC, VERLET, RK4 = USUAL_CAST


def kind(method, theta, z, steps=4000, omega=0.0):
    return kind_of(method, UNIT, z, orbit(method, UNIT, z, (theta, omega), steps))


@pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)
def test_a_section_and_an_orbit_are_direct_iteration_bit_for_bit(method):
    model, starts = Pendulum(9.81), spread(7, (-math.pi, math.pi), (-6.0, 6.0))
    for found, force, start, h in (
        (iterate(method, model, 0.3, starts, 40), model.force(np.sin), starts, 0.3),
        (orbit(method, model, 0.1, (2.0, 0.5), 40), model.force(), (2.0, 0.5), 0.1),
    ):
        phase = start
        for theta, omega in zip(*found, strict=True):
            assert np.array_equal((theta, omega), phase)
            phase = method.step(force, phase, h)


def test_however_a_section_is_cut_its_bits_are_the_same():
    starts = spread(60, (-math.pi, math.pi), (-2.6, 2.6))
    parts = list(pieces(VERLET, UNIT, 1.0, starts, 50))
    assert [part[0].shape for part in parts] == [(51, 25), (51, 25), (51, 10)]
    whole = iterate(VERLET, UNIT, 1.0, starts, 50)
    assert np.array_equal(np.concatenate([np.array(part) for part in parts], axis=2), whole)


@pytest.mark.parametrize("z", [0.05, 0.77, 1.95])
def test_small_swings_and_any_of_the_oscillator_turn_by_twice_the_arcsine_of_half_z(z):
    expected, model = 2 * math.asin(z / 2) / math.tau, LinearOscillator(1.0)
    assert kind(SYMPLECTIC, 1e-4, z).rotation == pytest.approx(expected, abs=1e-7)
    found = kind_of(VERLET, model, z, orbit(VERLET, model, z, (10.0, 0.1), 3000))
    assert (found.spins, found.rotation) == (False, pytest.approx(expected, abs=1e-7))


def test_a_swing_that_starts_turns_away_turns_as_fast():
    here, away = (kind(VERLET, 1.0 + turns * math.tau, 0.3) for turns in (0, 3))
    assert away.rotation == pytest.approx(here.rotation, rel=1e-6)


@pytest.mark.parametrize(
    ("key", "theta", "z", "fraction"),
    [
        ("symplectic_euler", 0.5, 1.44, Fraction(1, 4)),
        ("velocity_verlet", 1.25, 1.09, Fraction(1, 6)),
        ("velocity_verlet", 1.47, 1.125, Fraction(1, 6)),
        # beyond the linear limit: caught by a 2-cycle
        ("velocity_verlet", 0.3, 2.05, Fraction(1, 2)),
    ],
)
def test_islands_turn_by_exactly_their_fraction(key, theta, z, fraction):
    found = kind(method_of(key), theta, z)
    assert found.rotation == pytest.approx(float(fraction), abs=1e-9)
    assert (found.fraction, found.island, found.chaotic) == (fraction, True, False)


@pytest.mark.parametrize(
    ("radius", "turned", "q", "off", "island"),
    [
        *((2e-9, 6.8, 1, 0, True), (2e-9, 5.8, 1, 0, False), (5e-10, 6.8, 1, 0, False)),
        *((2e-9, 6.8, 12, 0.09, True), (2e-9, 6.8, 13, 0.09, False)),
        *((2e-9, 6.8, 6, 0.11, False), (2e-9, 6.8, 6, -0.11, False)),
    ],
)
def test_every_qth_point_of_an_island_winds_around_a_centre(radius, turned, q, off, island):
    angle = np.linspace(1, 1 + turned, 4000)
    points = 2 + radius * np.cos(angle), radius * np.sin(angle)
    assert section._is_island(points, 1 / q + off / 4000, Fraction(1, q), False) == island


@pytest.mark.parametrize("turns", [Fraction(1, 2), -Fraction(1, 2), Fraction(2)])
def test_orbits_caught_by_a_step_of_half_a_turn_or_two_are_an_island(turns):
    spun = kind(SYMPLECTIC, 0.1, 0.5, omega=turns * math.tau / 0.5)
    assert (spun.spins, spun.fraction, spun.island) == (True, abs(turns), True)


@pytest.mark.parametrize(
    ("theta", "omega", "steps", "chaotic"),
    [
        *((2.3, 0, 160, False), (2.3, 0, 200, True)),  # by e^18.0 and e^25.5
        *((2.3, 2.5, 200, True), (math.pi, 0, 4000, True)),  # over the top, and from there
    ],
)
def test_chaos_separates_neighbours_by_e15_times_the_steps(theta, omega, steps, chaotic):
    found = kind(VERLET, theta, 1.1, steps, omega)
    assert found.chaotic == chaotic
    assert not (chaotic and found.rotation)
    model = LinearOscillator(1.0)
    grown = kind_of(VERLET, model, 2.1, orbit(VERLET, model, 2.1, (1e-7, 0.0), 48))
    assert (grown.chaotic, grown.rotation) == (True, None)  # beyond its limit, of any size


@pytest.mark.parametrize(
    ("theta", "omega", "z", "steps"),
    [
        *((3.0, 0, 0.5, 4000), (math.pi - 1e-10, 0, 0.1, 240), (math.pi, 0, 0.5, 240)),
        *((0.0, 2, 0.5, 240), (1.0, 1e6, 1e-7, 240)),  # there to rounding, and far above
    ],
)
def test_regular_orbits_near_the_top_are_not_called_chaotic(theta, omega, z, steps):
    assert not kind(VERLET, theta, z, steps, omega).chaotic  # up there neighbours part by e^23.5


def test_rk4_ends_at_its_sink_and_explicit_euler_is_not_called_chaotic():
    sunk = kind(RK4, 1.25, 1.09)
    assert sunk.drift == pytest.approx(-1)
    assert sunk.lyapunov < 0
    found = kind(EXPLICIT, 1e-3, 1.0)
    assert (found.rotation, found.chaotic) == (None, False)
    assert found.drift > 1e6


def test_at_rest_and_in_few_steps_nothing_turns():
    rest = kind(VERLET, 0.0, 0.5)
    assert (rest.moves, rest.rotation, rest.fraction, rest.chaotic) == (False, None, None, False)
    assert kind(EXPLICIT, 1.0, 0.3, steps=1).moves  # only omega, at first
    assert kind(EXPLICIT, 0.0, 0.3, steps=1, omega=1.0).moves  # only theta
    for steps in (0, 1, 2, 5):
        found = kind(VERLET, 1.0, 0.3, steps)
        assert (found.steps, found.rotation, found.chaotic) == (steps, None, False)
    angle = 0.13 * math.tau * np.arange(5)  # two steps in each half
    circle = np.cos(angle), -3 * np.sin(angle)
    assert rotation_number(*circle, w0=3.0) == pytest.approx(0.13)
    assert rotation_number(circle[0][1:], circle[1][1:], w0=3.0) is None


def test_an_orbit_ends_where_numbers_stop_being_finite():
    theta, omega = orbit(EXPLICIT, LinearOscillator(1.0), 3.0, (1.0, 0.0), 2000)
    assert 500 < len(theta) < 1000
    assert np.isfinite((theta, omega)).all()
    for steps in (13, len(theta) - 1):
        start = theta[: steps + 1], omega[: steps + 1]
        found = kind_of(EXPLICIT, LinearOscillator(1.0), 3.0, start)
        assert (found.steps, found.lyapunov) == (steps, pytest.approx(math.log(10) / 2))
    apart = Stretching(VERLET, UNIT, 1.1)
    apart.carry((2.3, 0.0), 8)
    assert kind(VERLET, 2.3, 1.1, 8).lyapunov == apart.log / 8


def test_the_nearest_fraction_is_a_small_one():
    rotations = 0.2499, 0.1672, 0.0159, 0.38, 1.0001, 0.0, 0.4167, 0.005
    found = [str(nearest_fraction(rotation)) for rotation in rotations]
    assert found == ["1/4", "1/6", "1/63", "3/8", "1", "0", "5/12", "1/200"]


@pytest.mark.parametrize(("change", "is_known"), [(5e-5, True), (2e-4, False)])
def test_a_rotation_that_changes_by_more_than_a_ten_thousandth_is_none(change, is_known):
    turns = np.repeat([0.13 * (1 + change), 0.13], 1000)
    angle = math.tau * np.concatenate(([0.0], np.cumsum(turns)))
    found = rotation_number(np.cos(angle), -3.0 * np.sin(angle), w0=3.0)  # clockwise
    assert (found is not None) == is_known
    if is_known:
        assert found == pytest.approx(0.13, rel=change)


def test_starts_follow_the_sequence_of_roberts_over_their_rectangle():
    theta, omega = spread(400, (-1.0, 3.0), (2.0, 5.0))
    p = 1.324717957244746  # p³ = p + 1
    n = np.arange(1, 401)
    assert theta == pytest.approx(4 * (n / p % 1) - 1)
    assert omega == pytest.approx(3 * (n / p**2 % 1) + 2)
