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


def test_no_word_covers_the_letter_of_a_method():
    for theta in np.linspace(-2, 2, 50):
        assert "#" in phase_picture(PORTRAIT, [PhasePoint(theta, 0, 0, "#")]).text
