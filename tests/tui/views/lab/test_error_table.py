"""The table of the lab: its rows as text, and the meaning of its heads under the pointer."""

import re

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.tui.drawing.palette import GOOD, WARN
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.lab.error_table import COLUMNS, ErrorTable, extra_columns, table
from pendu_tui.tui.words.cards import head_text
from tests.tui.harness import after
from tests.tui.harness import lab as on_screen


def rows(live: Live, width: int, shown: Shown | None = None) -> list[str]:
    lines = table(live, live.sample, shown or Shown(), width)
    return ["".join(words for words, _ in row).rstrip() for row in lines]


def lab(seconds: float = 12.0) -> Live:
    return after(DEFAULT_SCENE, seconds)


def test_the_table_at_80_columns_leaves_out_omega_and_what_methods_cost():
    live = lab()
    assert all(len(line) <= width for width in range(60, 201) for line in rows(live, width))
    assert rows(live, 80) == [
        "method                     theta    dE/E0 largest    per s   verdict  th.err",
        "1 e Explicit Euler      -5 turns +6.3e+00 6.6e+00 +5.4e-01   + grows 3.0e+01",
        "2 s Symplectic Euler      -0.719 -6.8e-02 7.9e-02        - undecided 5.9e-02",
        "3 v Velocity Verlet       -0.758 -1.7e-03 5.7e-03        - undecided 2.0e-02",
        "4 r RK4                   -0.778 -3.6e-05 3.6e-05 -2.9e-06   - loses 3.1e-05",
    ]


def test_a_wide_table_has_units_more_digits_and_the_rest_of_an_angle_beyond_a_turn():
    head, euler, *_, last = rows(lab(), 130)
    heads = "theta [rad]|omega [rad/s]|dE/E0|largest|trend per s|verdict|theta error|evals/step"
    assert re.split("  +", head)[1:] == heads.split("|")
    assert "-5 turns +0.89" in euler
    numbers = "-0.77844 +1.83535 -3.6e-05 3.6e-05 -2.9e-06 - loses 3.1e-05 4"
    assert last.split() == ["4", "r", "RK4", *numbers.split()]


@pytest.mark.parametrize("width", [60, 80, 100, 120, 200])
def test_of_a_bob_that_is_gone_the_table_has_length_and_spring_and_is_no_wider(width):
    lines = rows(after(SCENES["stiff-limit"], 2.0), width)
    assert all(len(line) <= width for line in lines)
    assert re.search("length +spring", lines[0])
    assert any(" Implicit midpoint " in line for line in lines)  # in full
    assert re.search(r" 2(\.2)?e\+22 +4\.(7|67)e\+47", lines[1])


def test_a_verdict_has_a_colour_and_a_sign():
    live = lab(20.0)
    shown = {
        words.strip(): ink
        for row in table(live, live.sample, Shown(), 80)[1:]
        for words, ink in row
        if words.strip() in ("+ grows", "= bounded", "- loses")
    }
    assert shown == {"+ grows": WARN, "= bounded": GOOD, "- loses": WARN}


def test_hidden_methods_are_not_in_the_table_and_failed_ones_are_called_so():
    live = lab(1.0)
    *others, rk4 = live.sample.readings
    readings = (*others, rk4._replace(diverged_at=0.8))
    live.history.sample = live.sample._replace(readings=readings)
    lines = rows(live, 80, Shown(hidden=frozenset({"explicit_euler", "velocity_verlet"})))
    assert [line[0] for line in lines] == ["m", "2", "4"]
    assert "failed" in lines[2]


def test_after_a_change_of_h_the_largest_error_and_the_theta_error_count_from_it():
    live = lab()
    live.set_stepping(Stepping(0.01))
    at_change = live.sample
    live.step(400)
    head, _, _, verlet, rk4 = rows(live, 120)
    assert head.startswith("since h 0.01 s ")
    largest = float(verlet.split()[5])
    theta_error = float(verlet.split()[-2])
    assert largest < at_change.readings[2].max_energy_error / 2  # 5.7e-3, with h = 0.05
    before, now = (
        each.readings[2].theta - live.exact.at(each.t).theta for each in (at_change, live.sample)
    )
    assert theta_error == pytest.approx(abs(now - before), rel=0.05)
    assert float(rk4.split()[-2]) < 1e-4


@pytest.mark.parametrize("size", [(80, 24), (160, 50)])
async def test_a_head_under_the_pointer_says_what_it_means(size):
    async with on_screen(size=size) as theatre:
        shown = theatre.stage.query_one(ErrorTable)
        head = theatre.text(ErrorTable).splitlines()[0]
        for start, words in (("theta", "angle from"), ("dE/E0", "error"), ("verdict", "long run")):
            await theatre.pilot.hover(ErrorTable, offset=(head.index(start) + 1, 0))
            assert words in str(shown.tooltip)
        await theatre.pilot.hover(ErrorTable, offset=(head.index("verdict"), 2))
        assert shown.tooltip is None


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *extra_columns(SCENES["stiff-limit"].equations)):
        assert head_text(column.head) == head_text(column.wide_head) is not None
