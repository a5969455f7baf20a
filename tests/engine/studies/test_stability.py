"""Which swings a method holds: swing by swing, as grids, by theory, and where there is chaos."""

import math
from dataclasses import replace
from itertools import islice, pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import (
    EXPLICIT_EULER,
    GENERAL,
    RK4,
    SYMPLECTIC_EULER,
    USUAL_CAST,
    VELOCITY_VERLET,
    method_of,
)
from pendu_tui.engine.methods.tangent import at_bottom
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.engine.studies import LOST, stability
from pendu_tui.engine.studies.stability import (
    FATES,
    GREENE_Z,
    HELD,
    HOLDS,
    UNKNOWN,
    Grid,
    amplification,
    amplitude,
    is_chaotic,
    is_lost,
    ladder_of,
    map_of,
    outcomes,
    pieces,
    table,
    watch,
    wobble,
)

SYMPLECTIC = (SYMPLECTIC_EULER, VELOCITY_VERLET)  # those of the standard map
UNIT = Pendulum(1.0)  # so that h is z


@given(
    st.sampled_from(GENERAL),
    st.lists(st.tuples(st.floats(0.01, 3.14), st.floats(0.01, 3.5)), min_size=1, max_size=30),
    st.integers(1, 60),
)
def test_each_swing_of_an_ensemble_agrees_with_a_plain_loop(method, swings, steps):
    # NumPy's sine, not libm's: an ulp would be chaos later
    force, value = UNIT.force(np.sin), UNIT.energy(np.sin)
    cells = outcomes(method, *np.array(swings).T, steps)
    for cell, (theta, z) in zip(cells, swings, strict=True):
        start = value((theta, 0.0))
        lowest, highest, _ = wobble(method, z)
        survived, worst, expected = 0, 0.0, "holds"
        for phase in islice(method.phases(force, (np.array([theta]), np.zeros(1)), z), steps):
            now = float(value(phase)[0])
            worst = max(worst, abs(now - start) / start)
            if abs(phase[0]) > math.pi:
                expected = "over the top"
            elif not method.symplectic and now > 1.5 * highest * start:
                expected = "grows"
            elif not method.symplectic and now < 0.5 * lowest * start:
                expected = "loses"
            if expected != "holds":
                break
            survived += 1
        if method.symplectic and expected == "holds":
            assert FATES[cell["fate"]] in ("chaotic", *(FATES[fate] for fate in HELD))
        else:
            assert FATES[cell["fate"]] == expected
        assert (cell["steps"], cell["error"]) == (survived, worst)
    assert "50 %" in LOST


def test_swings_are_lost_by_hundreds_and_the_others_go_on_in_few_ensembles(monkeypatch):
    sizes = []

    def counting(method, phase, h, *others):
        sizes.append(len(h))
        return watch(method, phase, h, *others)

    monkeypatch.setattr(stability, "watch", counting)
    outcomes(EXPLICIT_EULER, np.linspace(0.5, 3, 500), np.full(500, 0.02), 4000)
    assert len(sizes) > 5
    assert 0.8 < max(after / before for before, after in pairwise(sizes)) < 7 / 8


@pytest.mark.parametrize(
    ("theta", "z", "expected"),
    [
        (0.5, 1.3, "holds"),
        (0.5, 1.43, "holds, but wider"),  # beside z = 2 sin(pi/4) 10 % wider, and back
        (0.73, 2.092, "holds off-centre"),  # beyond its linear limit, from one of two places
    ],
)
def test_velocity_verlet_wobbles_at_a_resonance_and_is_held_elsewhere_beyond_its_limit(
    theta, z, expected
):
    cells = outcomes(VELOCITY_VERLET, np.array([theta]), np.array([z]), 2000)
    assert FATES[cells["fate"][0]] == expected
    wide = outcomes(SYMPLECTIC_EULER, np.array([0.5]), np.ones(1), 100)
    assert wide["fate"] == HOLDS


@pytest.mark.parametrize(
    ("key", "theta", "expected", "reason", "steps"),
    [
        ("explicit_euler", 1.0, 0.0071, "grows", 10_000),
        ("explicit_euler", 2.0, 0.0103, "over the top", 10_000),
        ("symplectic_euler", 1.0, 1.64, "over the top", 10_000),
        ("velocity_verlet", 0.7, 2.19, "chaotic", 10_000),
        ("velocity_verlet", 2.0, 1.38, "over the top", 100),
        ("velocity_verlet", 2.0, 1.23, "over the top", 10_000),  # more steps find lower limits
        ("velocity_verlet", 3.0, 0.66, "over the top", 10_000),
        ("rk4", 1.0, 0.437, "loses", 10_000),
    ],
)
def test_methods_fail_each_in_its_way(key, theta, expected, reason, steps):
    ladder = expected * np.linspace(0.8, 1.05, 51)
    grid = Grid(np.array([theta]), ladder, steps, (method_of(key),))
    cells = grid.cells()
    (row,) = table(Scene(length=9.81, h=ladder[7]), grid, cells)
    assert (row.method.key, row.theta, row.here, row.reason) == (key, theta, cells[7], reason)
    assert row.z == pytest.approx(expected, rel=0.012)
    assert row.steps == cells["steps"][ladder == row.z]


GRID = Grid(np.linspace(0.1, 3.1, 7), np.linspace(0.1, 3, 13), 200, USUAL_CAST[2:])


@pytest.mark.parametrize("width", [5, None])
def test_the_cells_are_the_same_bit_for_bit_however_the_grid_is_cut(width):
    whole = GRID.unknown()
    whole["steps"] = 10**9  # of the longest study
    assert (whole["fate"] == UNKNOWN).all()
    assert not is_lost(whole).any()
    for part in GRID.parts(width):
        whole[part.z, part.method] = part.cells()
    assert len(GRID.parts(width)) == 2 * -(-13 // (width or 13))
    assert whole.tobytes() == GRID.cells().tobytes()
    assert whole.shape == GRID.shape == (13, 2, 7)  # z, method, amplitude
    assert 0 < (whole["fate"] == HOLDS).sum() < whole.size
    assert whole[4, 0, 5] == outcomes(USUAL_CAST[2], GRID.theta[5:6], GRID.z[4:5], 200)[0]
    computed = list(pieces(GRID, [50, 200]))
    assert computed[-1].cells.tobytes() == whole[computed[-1].part.z, 1].tobytes()
    assert [piece.part.grid.steps for piece in computed] == 4 * [50] + 4 * [200]
    assert [piece.done for piece in computed] == 2 * [0.25, 0.5, 0.75, 1]  # 10 z and 3


def test_a_part_has_so_many_swings_that_its_arrays_fit_into_the_cache():
    for swings, parts in ((1366, [2] * 6 + [1]), (5000, [1] * 13)):
        wide = replace(GRID, theta=np.ones(swings))
        assert [part.grid.shape[0] for part in wide.parts()][::2] == parts


@pytest.mark.parametrize("cast", [USUAL_CAST, GENERAL])
def test_the_default_map_reaches_beyond_every_limit(cast):
    grid = map_of(Scene(cast=cast), None, None, 100)
    assert grid.shape == (200, len(cast), 100)
    limits = [method.linear_limit for method in cast if method.linear_limit < np.inf]
    assert max(limits) < grid.z[-1] < 3.5
    assert grid.z[-1] == pytest.approx(3.5 if max(limits) > 3 else 3.0, abs=0.01)
    assert grid.theta[[0, -1]] == pytest.approx([np.pi / 200, np.pi * 199 / 200])


@pytest.mark.parametrize(
    ("theta", "omega", "expected"),
    [
        (-0.7, 0.0, 0.7),
        (4.0, 0.0, math.tau - 4),
        (0.0, 2 * Scene().w0 * math.sin(0.6), 1.2),
        (2 * math.asin(0.3), 0.8 * Scene().w0, math.pi / 3),
        (0.0, 1.999 * Scene().w0, 3.0784),  # 2 asin(0.9995)
        (0.0, 2.001 * Scene().w0, None),
        (0.0, 0.0, None),
    ],
)
def test_an_amplitude_is_that_of_the_exact_swing(theta, omega, expected):
    assert amplitude(Scene(theta=theta, omega=omega)) == pytest.approx(expected, abs=1e-4)
    assert amplitude(Scene(theta=-3.1)) == 3.1  # to the last bit


def test_a_ladder_has_the_scenes_own_step_and_amplitude():
    own = ladder_of(Scene(theta=1.02, h=0.123), None, None, 100)
    assert own.theta.tolist() == [0.1, 0.5, 1.0, 1.02, 2.0, 3.0]
    assert Scene(h=0.123).z in own.z
    assert (own.z[0], own.z[-1]) == pytest.approx((1e-3, 3.2))
    assert np.max(own.z[1:] / own.z[:-1]) == pytest.approx(1.01, abs=1e-4)
    near = ladder_of(Scene(theta=-1.005), None, [0.1, 0.2], 100)
    assert near.theta.tolist() == [0.1, 0.5, 1.005, 2.0, 3.0]
    assert near.z.tolist() == sorted([0.1, 0.2, Scene().z])


@given(z=st.floats(1e-6, 3))
def test_the_amplification_is_the_textbooks_and_the_largest_eigenvalue(z):
    textbook = {EXPLICIT_EULER: 1 + z**2, RK4: 1 - z**6 / 72 + z**8 / 576}
    for method, square in textbook.items():
        assert amplification(method, z) == pytest.approx(math.sqrt(square), rel=1e-12)
    for method in GENERAL:
        radius = abs(np.linalg.eigvals(np.reshape(at_bottom(method, z), (2, 2)))).max()
        assert amplification(method, z) == pytest.approx(radius, rel=1e-6)  # where two meet


@given(z=st.floats(0.05, 1.9), beyond=st.floats(2.001, 1000))
def test_the_wobble_has_a_closed_form_and_none_without_an_ellipse(z, beyond):
    assert wobble(VELOCITY_VERLET, z) == pytest.approx((1 - z**2 / 4, 1, 1), rel=1e-12)
    expected = (1 / (1 + z / 2), 1 / (1 - z / 2), 1 / math.sqrt(1 - z**2 / 4))
    assert wobble(SYMPLECTIC_EULER, z) == pytest.approx(expected, rel=1e-12)
    for method in (EXPLICIT_EULER, RK4):
        assert wobble(method, z)[:2] == pytest.approx((1.0, 1.0), abs=1e-9)
    for method, edge in product(SYMPLECTIC, (2.0, beyond)):
        assert wobble(method, edge) == (0.0, 1.0, 1.0)


def largest_omega(scene, method, steps, enough=math.inf):
    """Largest |omega|·h on the way, up to the first that is `enough`."""
    phases = method.phases(scene.equations.force(), (scene.theta, scene.omega), scene.h)
    largest = 0.0
    for _, omega in islice(phases, steps):
        largest = max(largest, abs(omega) * scene.h)
        if largest >= enough:
            break
    return largest


@pytest.mark.parametrize("method", SYMPLECTIC, ids=str)
def test_chaos_fenced_stays_below_pi_over_h_and_chaos_loose_does_not(method):
    fenced, loose = SCENES["chaos-fenced"], SCENES["chaos-loose"]
    squares = fenced.z**2, GREENE_Z**2, loose.z**2
    assert squares == pytest.approx((0.95, 0.971635, 1.1), rel=1e-12)
    assert is_chaotic(method, fenced.theta, fenced.z, 10_000)
    # A million steps reach 0.91 pi and 0.79 pi; the fence is an invariant curve.
    assert largest_omega(fenced, method, 100_000) < math.pi
    # It takes 14 000 and 33 000 steps here; other roundings of sin give other orbits.
    assert largest_omega(loose, method, 1_000_000, enough=2 * math.pi) >= 2 * math.pi


@pytest.mark.parametrize(
    ("theta", "z", "chaotic"),
    [
        *((theta, z, False) for theta, z in ((0.5, 1.43), (1.0, 0.3), (0.1, 1.9))),
        (math.pi - 1e-12, 0.2, False),
        *((theta, z, True) for theta, z in ((1.0, 1.535), (2.0, 1.38), (3.0, 0.67))),
    ],
)
def test_chaotic_swings_are_called_chaotic_and_regular_ones_not(theta, z, chaotic):
    assert is_chaotic(VELOCITY_VERLET, theta, z, 10_000) == chaotic
