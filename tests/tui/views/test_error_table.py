"""The table of the lab: its rows as text, and the meaning of its heads under the pointer."""

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.tui.drawing.picture import GOOD, QUIET, TEXT, WARN
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.error_table import COLUMNS, ErrorTable, extra_columns, table
from pendu_tui.tui.words.cards import head_text
from tests.tui.harness import after
from tests.tui.harness import lab as on_screen


def rows(live: Live, width: int, shown: Shown | None = None) -> list[str]:
    lines = table(live, live.sample, shown or Shown(), width)
    return ["".join(words for words, _ in row).rstrip() for row in lines]


def lab(seconds: float = 12.0) -> Live:
    return after(DEFAULT_SCENE, seconds)


def test_the_verdict_comes_first_and_at_80_columns_omega_and_what_methods_cost_are_left_out():
    live = lab()
    assert all(len(line) <= width - 1 for width in range(60, 201) for line in rows(live, width))
    head, euler, _, _, rk4 = rows(live, 80)
    assert [head, euler, rk4] == [
        " method               verdict        dE/E0 largest    per s  th.err       theta",
        " 1 e Explicit Euler   + grows     +6.3e+00 6.6e+00 +5.5e-01 3.0e+01     -30.528",
        " 4 r RK4              - loses     -3.6e-05 3.6e-05 -2.9e-06 3.1e-05      -0.778",
    ]


def test_red_is_for_failures_alone_and_signs_stand_for_colours():
    def verdicts(live):
        shown = table(live, live.sample, Shown(), 80)[1:]
        return [(words.strip(), ink) for _, (words, ink), *_ in shown]

    live = lab(20.0)
    words = (("+ grows", TEXT), ("= bounded", GOOD), ("= bounded", GOOD), ("- loses", TEXT))
    assert verdicts(live) == [*words]
    *others, rk4 = live.sample.readings
    readings = (*others, rk4._replace(diverged_at=0.8))
    live.history.sample = live.sample._replace(readings=readings)
    assert verdicts(live) == [*words[:3], ("! failed", WARN)]
    assert [ink for words, ink in verdicts(lab(1.0))] == [QUIET] * 4


def test_hidden_methods_are_not_in_the_table():
    lines = rows(lab(1.0), 80, Shown(hidden=frozenset({"explicit_euler", "velocity_verlet"})))
    assert [line[1] for line in lines] == ["m", "2", "4"]


def test_while_the_pendulum_is_held_there_is_no_run_and_no_error():
    for line in rows(lab(), 120, Shown(held=1.0))[1:]:
        assert line[22:].split()[:5] == ["held", *"----"]


def test_after_a_change_of_h_the_largest_error_and_the_theta_error_count_from_it():
    live = lab()
    live.change(Stepping(0.01))
    at_change = live.sample
    live.step(400)
    head, _, _, verlet, rk4 = rows(live, 120)
    assert head.startswith(" since h 0.01 s ")
    largest = float(verlet.split()[-6])
    theta_error = float(verlet.split()[-4])
    assert largest < at_change.readings[2].max_energy_error / 2  # 5.7e-3, with h = 0.05
    before, now = (
        each.readings[2].theta - live.exact.at(each.t).theta for each in (at_change, live.sample)
    )
    assert theta_error == pytest.approx(abs(now - before), rel=0.05)
    assert float(rk4.split()[-4]) < 1e-4


async def test_a_head_under_the_pointer_says_what_it_means():
    async with on_screen() as theatre:
        shown = theatre.stage.query_one(ErrorTable)
        head = theatre.text(ErrorTable).splitlines()[0]
        for start, words in (
            ("theta", "angle from"),
            ("dE/E0", "error"),
            ("verdict", "long run"),
        ):
            await theatre.pilot.hover(ErrorTable, offset=(head.rindex(start) + 1, 0))
            assert words in str(shown.tooltip)
        first, second = shown._head[:2]
        for at, name in ((len(first) - 1, first), (len(first), second)):
            await theatre.pilot.hover(ErrorTable, offset=(at, 0))
            assert shown.tooltip == head_text(name.strip())
        await theatre.pilot.hover(ErrorTable, offset=(head.index("verdict"), 2))
        assert shown.tooltip is None


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *extra_columns(SCENES["stiff-limit"].equations)):
        assert head_text(column.head.narrow) == head_text(column.head.wide) is not None
