import os
import time
from collections.abc import Iterator

import numpy as np

from engine.stability.grid import Grid, pieces
from tui.views.background import elsewhere

GRID = Grid(np.array([0.5, 1.5, 2.5]), np.linspace(0.2, 3, 14), 100)


def own_id() -> Iterator[int]:
    yield os.getpid()


def forever() -> Iterator[int]:
    yield os.getpid()
    while True:
        time.sleep(60)


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_it_is_another_process_that_computes():
    with elsewhere(own_id) as found:
        assert list(found) != [os.getpid()]


def test_the_pieces_of_a_map_from_elsewhere_are_the_map():
    cells = GRID.unknown()
    with elsewhere(pieces, GRID, (10, 100), 5) as found:
        for piece in found:
            cells[piece.z, piece.method] = piece.cells
    assert cells.tobytes() == GRID.cells().tobytes()


def test_a_first_picture_is_whole_before_the_lasting_one_begins():
    progress = [(piece.steps, piece.done) for piece in pieces(GRID, (10, 100), 5)]
    assert progress == sorted(progress)
    assert [done for steps, done in progress if steps == 10][-1] == 1


def test_who_leaves_early_leaves_no_process_behind():
    with elsewhere(forever) as found:
        process = next(found)
        assert is_alive(process)
    assert not is_alive(process)
