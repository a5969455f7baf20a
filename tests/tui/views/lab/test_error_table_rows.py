"""The table of the lab, as a picture made of text."""

import re

import pytest

from engine.run.stepping import Stepping
from engine.scenes import DEFAULT_SCENE, SCENES
from tests.tui.harness import after
from tui.drawing.palette import GOOD, WARN
from tui.playback.live import Live
from tui.playback.shown import Shown
from tui.views.lab.error_table import table


def rows(live: Live, width: int, shown: Shown | None = None) -> str:
    return "\n".join(text(row) for row in table(live, live.sample, shown or Shown(), width))


def lab(seconds: float = 12.0) -> Live:
    return after(DEFAULT_SCENE, seconds)


def text(row) -> str:
    return "".join(words for words, _ in row).rstrip()


def test_the_table_at_80_columns_leaves_out_omega_and_what_methods_cost():
    assert rows(lab(), 80) == (
        "method                     theta    dE/E0 largest    per s   verdict  th.err\n"
        "1 e Explicit Euler      -5 turns +6.3e+00 6.6e+00 +5.4e-01   + grows 3.0e+01\n"
        "2 s Symplectic Euler      -0.719 -6.8e-02 7.9e-02        - too early 5.9e-02\n"
        "3 v Velocity Verlet       -0.758 -1.7e-03 5.7e-03        - too early 2.0e-02\n"
        "4 r RK4                   -0.778 -3.6e-05 3.6e-05 -2.9e-06   - loses 3.1e-05"
    )


@pytest.mark.parametrize("width", [60, 80, 100, 120, 200])
def test_of_a_bob_that_is_gone_the_table_has_length_and_spring_and_is_no_wider(width):
    lines = rows(after(SCENES["stiff-limit"], 2.0), width).splitlines()
    assert all(len(line) <= width for line in lines)
    assert re.search("length +spring", lines[0])
    assert re.search(r" 2(\.2)?e\+22 +4\.(7|67)e\+47", lines[1])


def test_a_wide_table_shows_an_angle_beyond_a_turn_as_turns_and_the_rest():
    assert "-5 turns +0.89" in rows(lab(), 120)


def test_a_verdict_has_a_colour_and_a_sign():
    live = lab(20.0)
    shown = table(live, live.sample, Shown(), 80)
    verdicts = ("+ grows", "= bounded", "- loses")
    found = {
        words.strip(): owner
        for row in shown[1:]
        for words, owner in row
        if words.strip() in verdicts
    }
    assert found == {"+ grows": WARN, "= bounded": GOOD, "- loses": WARN}


def test_a_wide_table_has_units_and_more_digits():
    head, *_, last = rows(lab(), 130).splitlines()
    heads = [part.strip() for part in re.split("  +", head)]
    assert heads[1:5] == ["theta [rad]", "omega [rad/s]", "dE/E0", "largest"]
    assert heads[5:] == ["trend per s", "verdict", "theta error", "evals/step"]
    assert last.split() == [
        "4",
        "r",
        "RK4",
        "-0.77844",
        "+1.83535",
        *["-3.6e-05", "3.6e-05", "-2.9e-06", "-", "loses", "3.1e-05", "4"],
    ]


def test_every_table_is_rectangular_and_fits():
    live = lab(0.5)
    for width in range(60, 201):
        (length,) = {len(line) for line in rows(live, width).splitlines()}
        assert length <= width


def test_hidden_methods_are_not_in_the_table_and_failed_ones_are_called_so():
    live = lab(1.0)
    readings = live.sample.readings
    live.history.sample = live.sample._replace(
        readings=(*readings[:3], readings[3]._replace(diverged_at=0.8))
    )
    lines = rows(
        live, 80, Shown(hidden=frozenset({"explicit_euler", "velocity_verlet"}))
    ).splitlines()
    assert [line[0] for line in lines] == ["m", "2", "4"]
    assert "failed" in lines[2]


def test_after_a_change_of_h_the_largest_error_and_the_theta_error_count_from_it():
    live = lab()
    live.set_stepping(Stepping(0.01))
    at_change = live.sample
    live.step(400)
    head, _, _, verlet, rk4 = rows(live, 120).splitlines()
    assert head.startswith("since h 0.01 s ")
    largest, theta_error = float(verlet.split()[5]), float(verlet.split()[-2])
    assert largest < at_change.readings[2].max_energy_error / 2  # 5.7e-3, with h = 0.05
    before, now = (
        each.readings[2].theta - live.exact.at(each.t).theta for each in (at_change, live.sample)
    )
    assert theta_error == pytest.approx(abs(now - before), rel=0.05)
    assert float(rk4.split()[-2]) < 1e-4
