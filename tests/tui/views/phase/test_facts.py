"""Words and numbers below the phase portrait."""

import math

import pytest

from engine.methods import USUAL_CAST, method_of
from engine.models.model import State
from engine.phase_space.area import Neighbours
from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene
from tui.playback.live import Live
from tui.playback.shown import Shown
from tui.views.phase.facts import area_text, fact_rows, place_text

MODEL = Scene().equations


def test_multiples_of_pi_are_called_so():
    assert (
        place_text(MODEL, State(math.pi, 0.0), 46)
        == "theta pi  omega 0  E/Es 1 - 3.7e-33  libration"
    )
    assert place_text(MODEL, State(-math.pi, 0.5), 46).startswith("theta -pi")


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


def test_the_table_shows_area_ratios_that_differ_from_one_only_by_rounding():
    live, neighbours = Live(Scene()), Neighbours(0.1)
    live.step(200)
    neighbours.follow(live.scene, live.sample.run, live.sample.step, live.changes, 200)
    lines = ["".join(text for text, _ in row) for row in fact_rows(live, Shown(), neighbours, 80)]
    assert [line.split()[0] for line in lines[2:]] == ["1", "2", "3", "4"]
    assert (
        "1 + " in lines[3] or "1 - " in lines[3] or " 1 " in lines[3]
    )  # symplectic Euler, but for rounding
    assert " 0.99997" in lines[5]  # RK4: a loss that four digits would not show
    assert all(len(line) == len(lines[1]) for line in lines[2:])


def test_with_friction_conformal_verlet_leaves_the_expected_area_even_after_a_change_of_h():
    live, neighbours = Live(SCENES["damped"]), Neighbours(0.1)
    live.step(100)
    live.set_stepping(Stepping(0.05, cast=live.scene.cast))
    live.step(100)
    neighbours.follow(live.scene, live.sample.run, live.sample.step, live.changes, 200)
    lines = ["".join(text for text, _ in row) for row in fact_rows(live, Shown(), neighbours, 80)]
    left = f"{math.exp(-0.05 * 7.5):.9f}"
    assert lines[0] == f" Ring, radius 0.1 rad: the true motion leaves {left} of its area"
    assert [left in line for line in lines[2:]] == [False, False, True, False]


def test_the_table_says_when_the_ring_is_behind_or_not_there():
    live, neighbours = Live(Scene()), Neighbours(0.1)
    live.step(200)
    neighbours.follow(live.scene, live.sample.run, live.sample.step, live.changes, 50)
    assert "150 steps behind" in fact_rows(live, Shown(), neighbours, 80)[0][0][0]
    without = fact_rows(live, Shown(), None, 80)
    assert "Press g" in without[0][0][0]
    assert len(without) == 6


def test_a_ring_of_the_run_before_is_not_shown():
    live, neighbours = Live(Scene()), Neighbours(0.1)
    live.step(20)
    neighbours.follow(live.scene, live.sample.run, live.sample.step, live.changes, 50)
    live.start(live.scene.with_cast((*USUAL_CAST, method_of("forest_ruth"))))
    live.step(7)
    rows = fact_rows(live, Shown(), neighbours, 80)
    assert "7 steps behind" in rows[0][0][0]
    assert [row[1][0].split()[:2] for row in rows[2:]] == 5 * [["-", "-"]]


@pytest.mark.parametrize("width", range(20, 90, 7))
def test_a_number_that_does_not_fit_is_left_out_not_cut_off(width):
    live = Live(Scene())
    live.step(30)
    wide = ["".join(text for text, _ in row) for row in fact_rows(live, Shown(), None, 80)]
    rows = ["".join(text for text, _ in row) for row in fact_rows(live, Shown(), None, width)]
    for whole, row in zip(wide[1:], rows[1:], strict=True):
        assert len(row) <= max(width, 22)  # the names stay
        assert whole.startswith(row)
        assert whole[len(row) : len(row) + 1] in ("", " ")
