import math
from dataclasses import replace

import numpy as np
import pytest

from pendu_tui.engine.methods import GENERAL, USUAL_CAST
from pendu_tui.engine.run.loops import available
from pendu_tui.engine.scenes import Scene
from pendu_tui.engine.studies.stability import (
    HOLDS,
    UNKNOWN,
    Grid,
    amplitude,
    ladder_of,
    map_of,
    outcomes,
    pieces,
)

needs_numba = pytest.mark.skipif(not available(), reason="Numba is not installed")
each_way = pytest.mark.parametrize(
    "fast", [False, pytest.param(True, marks=needs_numba)], ids=["numpy", "numba"]
)
GRID = Grid(np.linspace(0.1, 3.1, 7), np.linspace(0.1, 3, 13), 200, USUAL_CAST[2:])
MAP = map_of(Scene(), None, None, 10_000)


def test_the_axes_of_cells_are_z_method_and_amplitude():
    cells = GRID.cells()
    assert cells.shape == GRID.shape == (13, 2, 7)
    alone = outcomes(USUAL_CAST[2], GRID.theta[5:6], GRID.z[4:5], 200)
    assert cells[4, 0, 5] == alone[0]
    assert 0 < (cells["fate"] == HOLDS).sum() < cells.size
    assert (GRID.unknown()["fate"] == UNKNOWN).all()


@each_way
@pytest.mark.parametrize("width", [1, 5, None])
def test_the_cells_are_the_same_bit_for_bit_however_the_grid_is_cut(width, fast):
    grid = replace(GRID, fast=fast)
    whole = grid.unknown()
    for part in grid.parts(width):
        whole[part.z, part.method] = part.cells()
    assert len(grid.parts(width)) == 2 * -(-13 // (width or 13))
    assert whole.tobytes() == grid.cells().tobytes()


@needs_numba
def test_all_parts_of_a_large_map_are_compiled_and_none_of_a_small_one():
    for grid, fast in ((MAP, True), (GRID, False), (replace(GRID, fast=True), True)):
        assert {part.grid.compiled for part in grid.parts()} == {fast} == {grid.compiled}


def test_a_map_computed_in_pieces_is_not_compiled():
    piece = next(pieces(MAP, [50]))
    plain = replace(MAP, z=MAP.z[piece.part.z], methods=USUAL_CAST[:1], steps=50, fast=False)
    assert piece.cells.tobytes() == plain.cells()[:, 0].tobytes()


@pytest.mark.parametrize("cast", [USUAL_CAST, GENERAL])
def test_the_default_map_reaches_beyond_every_limit(cast):
    grid = map_of(Scene(cast=cast), None, None, 100)
    assert grid.shape == (200, len(cast), 100)
    limits = [method.linear_limit for method in cast if method.linear_limit < np.inf]
    assert max(limits) < grid.z[-1] < 3.5
    assert grid.z[-1] == pytest.approx(3.5 if max(limits) > 3 else 3.0, abs=0.01)
    assert 0 < grid.theta[0] < grid.theta[-1] < np.pi


@pytest.mark.parametrize(
    ("theta", "omega", "expected"),
    [
        (-0.7, 0.0, 0.7),
        (0.0, 2 * Scene().w0 * math.sin(0.6), 1.2),
        (0.0, 1.999 * Scene().w0, 3.0784),  # 2 asin(0.9995)
        (0.0, 2.001 * Scene().w0, None),
        (0.0, 0.0, None),
    ],
)
def test_an_amplitude_is_that_of_the_exact_swing(theta, omega, expected):
    assert amplitude(Scene(theta=theta, omega=omega)) == pytest.approx(expected, abs=1e-4)


def test_a_ladder_has_the_scenes_own_step_and_amplitude():
    own = ladder_of(Scene(theta=1.02, h=0.123), None, None, 100)
    assert own.theta.tolist() == [0.1, 0.5, 1.0, 1.02, 2.0, 3.0]
    assert Scene(h=0.123).z in own.z
    near = ladder_of(Scene(theta=1.005), None, [0.1, 0.2], 100)
    assert near.theta.tolist() == [0.1, 0.5, 1.005, 2.0, 3.0]
    assert near.z.tolist() == sorted([0.1, 0.2, Scene().z])
