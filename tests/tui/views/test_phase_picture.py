"""The phase portrait as pictures made of text."""

import math

import numpy as np
import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.portrait import (
    PhasePoint,
    Portrait,
    method_points,
    phase_picture,
)
from pendu_tui.tui.views.viewport import Viewport
from tests.tui.drawn import places

DRIFT = SCENES["drift"]
SMALL = Viewport.portrait(46, 15, DRIFT)
PORTRAIT = Portrait.of(SMALL, DRIFT.equations)
PLAIN = phase_picture(PORTRAIT, [])


def test_what_is_not_a_number_is_not_drawn():
    nowhere = PhasePoint(math.nan, math.nan, 0, "e", ring=(np.full(3, math.nan), np.zeros(3)))
    assert phase_picture(PORTRAIT, [nowhere]) == PLAIN


@pytest.mark.parametrize(("z", "joined"), [(0.25, False), (0.35, True), (0.95, True), (1.1, False)])
def test_steps_are_joined_that_are_neither_close_nor_far_apart(z, joined):
    live = Live(DRIFT.altered(h=z / DRIFT.w0))
    points = method_points(live, live.sample, Shown(), None)
    assert {point.chords > 0 for point in points} == {joined}


def ring_around(theta: float, radius: float):
    angle = np.linspace(0, math.tau, 64, endpoint=False)
    ring = theta + radius * np.cos(angle), DRIFT.w0 * radius * np.sin(angle)
    return phase_picture(PORTRAIT, [PhasePoint(math.nan, math.nan, 3, "r", ring=ring)])


def test_a_ring_is_closed_and_over_the_top_it_does_not_cross_the_picture():
    picture = ring_around(1.0, 0.5)
    for row in range(int(SMALL.y(1.2)) // 4, int(SMALL.y(-1.2)) // 4 + 1):
        columns = [column for column, at in places(picture, 3) if at == row]
        assert min(columns) < SMALL.x(0.8) / 2 < SMALL.x(1.2) / 2 < max(columns)
    columns = {column for column, _ in places(ring_around(math.pi, 0.5), 3)}
    assert {column < 8 for column in columns} == {True, False}
    assert not any(8 <= column <= 37 for column in columns)
