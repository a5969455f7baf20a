import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.scenes import SCENES
from tests.tui.drawing.test_canvas import dots
from tests.tui.drawn import cells, inks, size
from tests.tui.harness import lab, player, recorded
from tui.drawing.palette import EXACT, FAINT, FRAME
from tui.views.lab.pendulums import Bob, Pendulum, pendulum_picture

ANGLE = st.integers(1, 10_000).map(
    lambda number: number * 0.6180339887
)  # never a tie between two dots


def picture(columns, rows, *bobs):
    return pendulum_picture(columns, rows, bobs)


def test_a_pendulum_at_one_radian_that_came_from_the_other_side():
    assert picture(16, 8, Bob(1.0, 0, trail=np.linspace(-1, 1, 60))).text == (
        "\n\n\n       ⢀⡀\n       ⠈⠉⠢⢄\n  ⡀        ⠉⠢⣤⣄\n  ⠑⢄⡀      ⢀⡠⠋⠉\n    ⠉⠓⠲⠤⠤⠖⠚⠉"
    )


def test_four_that_coincide_show_their_letters_side_by_side():
    assert picture(16, 8, *(Bob(-2.0, index, letter="esvr"[index]) for index in range(4))).text == (
        "\n\ne s⣤v r\n  ⠈⠋⠑⠒⠤⣀⡀\n       ⠈⠁\n\n\n"
    )


@given(ANGLE)
def test_left_is_the_mirror_image_of_right_and_up_of_down(theta):
    """So the pivot is exactly in the middle, for odd and even panes."""
    for columns, rows in ((16, 8), (17, 9)):
        right, left, up = (
            dots(picture(columns, rows, Bob(angle, 0)))
            for angle in (theta, -theta, math.pi - theta)
        )
        assert left == {(2 * columns - 1 - x, y) for x, y in right}
        assert up == {(x, 4 * rows - 1 - y) for x, y in right}


def test_a_full_turn_is_a_circle_because_both_directions_have_one_scale():
    found = dots(picture(30, 10, Bob(0.0, 0, trail=np.linspace(0, 2 * math.pi, 1000))))
    x, y = ([dot[axis] for dot in found] for axis in (0, 1))
    assert max(x) - min(x) == pytest.approx(
        max(y) - min(y), abs=2
    )  # the bob stands out at the bottom
    assert max(x) + min(x) == 2 * 30 - 1
    assert min(y) == pytest.approx(0, abs=2)  # the pane is used


def test_trails_are_faint_and_bobs_lie_in_front_of_them():
    drawn = picture(16, 8, Bob(0.5, 0, trail=[0.5, 3.0]), Bob(2.0, 1, trail=[2.0, 0.4]))
    assert inks(drawn) == {0, 1, 0 + FAINT, FRAME}
    assert inks(picture(16, 8, Bob(0.5, EXACT, trail=[0.5, 3.0], ghost=True))) == {EXACT, FRAME}


@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 40), st.integers(1, 20))
def test_any_angle_fits_any_pane(theta, columns, rows):
    drawn = picture(
        columns,
        rows,
        Bob(theta, 0, trail=[theta, math.nan], letter="e"),
        Bob(theta, 1, diverged=True),
    )
    assert size(drawn) == (columns, rows)


def test_a_bob_on_a_spring_hangs_at_the_end_of_its_rod():
    assert picture(16, 8, Bob(0.7, 2, letter="p", length=0.6)).text == (
        "\n\n\n       ⢀⡀\n       ⠈⠑⣤⡀\n         ⠛⠃p\n\n"
    )
    assert picture(16, 8, Bob(0.7, 2, letter="p", length=1.08)).text == (
        "\n\n\n       ⢀⡀\n       ⠈⠑⡄\n         ⠈⢢⣤\n          ⠈⠉p\n"
    )


def test_a_bob_on_a_spring_is_as_far_from_the_pivot_as_its_rod_is_long():
    def lowest(length):
        return max(row for row, _ in cells(picture(40, 20, Bob(0.0, 2, length=length))))

    assert lowest(0.5) < lowest(0.9) < lowest(1.08)
    assert lowest(1e300) <= 20


async def grabbed(theatre, *moves, wait=0.3):
    """Drag the first pendulum's bob over these cells of its pane, wait, and let it go."""
    pane = theatre.stage.query(Pendulum).first()
    await theatre.pilot.mouse_down(pane, offset=(12, 9))
    for move in moves:
        await theatre.pilot.hover(pane, offset=move)
    await theatre.pilot.pause(wait)
    held = theatre.stage.held
    table = theatre.text("ErrorTable")
    await theatre.pilot.mouse_up(pane, offset=moves[-1])
    await theatre.pilot.pause()
    return held, table


async def test_a_bob_is_dragged_and_starts_at_rest_where_it_is_let_go_as_one_step_of_undo():
    async with lab() as theatre:
        await theatre.run(2)
        before = theatre.source.sample
        held, table = await grabbed(theatre, (16, 9), (20, 2))
        assert held == pytest.approx(2.1, abs=0.4)
        assert table.count(f"{held:+.3f}") == 4
        scene = theatre.source.scene
        assert (scene.theta, scene.omega) == (held, 0.0)
        assert [event.kind for event in theatre.source.events] == ["start", "start"]
        assert theatre.stage.held is None
        await theatre.press("u")
        assert theatre.source.scene == SCENES["drift"]
        assert theatre.source.sample.step == before.step


async def test_a_thrown_bob_has_the_speed_of_the_pointer():
    async with lab() as theatre:
        await theatre.run(1)
        theatre.source.set_speed(2.0)
        pane = theatre.stage.query(Pendulum).first()
        pane.throw([(0.0, 0.0), (1.0, 0.5), (1.05, 0.6)], 1.06)
        await theatre.pilot.pause()
        assert theatre.source.scene.theta == 0.6
        assert theatre.source.scene.omega == 1.0  # 2 rad in a second of the clock, at 2×


async def test_less_than_three_columns_is_a_click_that_shows_the_method_alone():
    async with lab() as theatre:
        await grabbed(theatre, (13, 9), (14, 9))
        assert theatre.stage.shown.places(theatre.source.scene.cast) == [0]
        assert theatre.source.sample.run == 1
        await grabbed(theatre, (13, 9))
        assert not theatre.stage.shown.hidden


async def test_a_bob_of_a_recording_cannot_be_grabbed_and_a_sentence_says_so(tmp_path):
    async with player(recorded(tmp_path / "a.mcap", 2.0)) as theatre:
        pane = theatre.stage.query(Pendulum).first()
        await theatre.pilot.mouse_down(pane, offset=(12, 9))
        await theatre.pilot.hover(pane, offset=(20, 4))
        await theatre.pilot.mouse_up(pane, offset=(20, 4))
        await theatre.pilot.pause()
        (notice,) = theatre.app._notifications
        assert "cannot be changed" in notice.message
        assert not theatre.stage.shown.hidden


async def test_small_swings_are_enlarged_and_say_so_and_o_shows_them_as_they_are():
    async with lab(SCENES["gentle"]) as theatre:
        await theatre.run(1)
        titles = [str(pane.border_title) for pane in theatre.stage.query(Pendulum) if pane.drawable]
        assert all(title.endswith("×6") for title in titles[1:])
        await theatre.press("o")
        assert "×" not in str(theatre.stage.query(Pendulum).first().border_title)
