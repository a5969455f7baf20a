"""Words and numbers below the phase portrait."""

import math

import pytest

from pendu_tui.engine.methods import USUAL_CAST, method_of
from pendu_tui.engine.models.model import State
from pendu_tui.engine.phase_space.area import Neighbours
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.phase.portrait import place_text
from pendu_tui.tui.views.phase.view import area_text, fact_rows


def followed(live, steps=200):
    """A ring carried by so many steps."""
    ring = Neighbours(0.1)
    ring.follow(live.scene, live.sample.run, live.sample.step, live.changes, steps)
    return ring


def lines(live, ring=None, width=80):
    return [
        "".join(text for text, _ in row)
        for row in fact_rows(live, Shown(ring=ring is not None), ring, width)
    ]


def test_multiples_of_pi_are_called_so():
    text = "theta pi  omega 0  E/Es 1 - 3.7e-33  libration"
    assert place_text(Scene().equations, State(math.pi, 0.0), 46) == text


@pytest.mark.parametrize(
    ("ratio", "log", "text"),
    [
        (1.0, "+0.000e+00", "1"),
        (1 + 2**-52, "+2.220e-16", "1 + 2.2e-16"),
        (1 - 3e-7, "-3.000e-07", "1 - 3.0e-07"),
        (0.99783850123, "-2.164e-03", "0.997838501"),
        (3.42e12, "+2.886e+01", "3.420e+12"),
        (0.0, "-", "< 1e-308"),
        (math.inf, "-", "> 1e308"),
    ],
)
def test_an_area_has_digits_enough_to_tell_it_from_one(ratio, log, text):
    assert area_text(ratio) == (log, text)


def test_the_table_has_areas_of_the_ring_and_its_delay():
    live = Live(Scene())
    live.step(200)
    text = lines(live, followed(live))
    assert [line.split()[0] for line in text[2:]] == ["1", "2", "3", "4"]
    assert any(area in text[3] for area in ("1 + ", "1 - ", " 1 "))  # symplectic, but for rounding
    assert " 0.99997" in text[5]  # RK4: a loss that four digits would not show
    assert {len(line) for line in text[1:]} == {len(text[1])}
    assert "150 steps behind" in lines(live, followed(live, 50))[0]
    assert [len(line.split()) for line in lines(live)] == [3, 6, 6, 6, 5]  # no ring, no areas


def test_with_friction_conformal_verlet_leaves_the_expected_area_even_after_a_change_of_h():
    live = Live(SCENES["damped"])
    live.step(100)
    live.change(Stepping(0.05, cast=live.scene.cast))
    live.step(100)
    text = lines(live, followed(live))
    left = f"{math.exp(-0.05 * 7.5):.9f}"
    assert text[0] == f" Ring, radius 0.1 rad: the true motion leaves {left} of its area"
    assert [left in line for line in text[2:]] == [False, False, True, False]


def test_a_ring_of_the_run_before_is_not_shown():
    live = Live(Scene())
    live.step(20)
    ring = followed(live)
    live.start(live.scene.with_cast((*USUAL_CAST, method_of("forest_ruth"))))
    live.step(7)
    rows = fact_rows(live, Shown(ring=True), ring, 80)
    assert "7 steps behind" in rows[0][0][0]
    assert [row[1][0].split()[2:] for row in rows[2:]] == 5 * [["-", "-"]]


@pytest.mark.parametrize("width", range(20, 90, 7))
def test_a_number_that_does_not_fit_is_left_out_not_cut_off(width):
    live = Live(Scene())
    live.step(30)
    for whole, row in zip(lines(live), lines(live, width=width), strict=True):
        assert len(row) <= max(width, 22)  # the names stay
        assert whole.startswith(row)
        assert whole[len(row) : len(row) + 1] in ("", " ")
