"""Pendulums as pictures made of text, and a bob under the mouse."""

import math
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.palette import EXACT, FRAME
from pendu_tui.tui.views.lab.pendulums import TOP, Bob, Pendulum, pendulum_picture
from tests.tui.drawing.test_canvas import dots
from tests.tui.drawn import cells, size
from tests.tui.harness import lab, player, recorded

GOLDEN = Path(__file__).with_name("pendulums.txt")


def picture(columns, rows, *bobs):
    return pendulum_picture(columns, rows, bobs)


def test_pendulums_look_as_they_did(request):
    """Random panes, angles, trails, ghosts and failures; `--snapshot-update` draws them anew."""
    chance, pictures = random.Random(13), []
    for number in range(100):
        columns, rows = chance.randint(5, 26), chance.randint(3, 12)
        count = chance.choice((1, 1, 1, 4))
        bobs = [Bob(chance.uniform(-4, 4), EXACT, ghost=True)] if chance.random() < 0.3 else []
        for index in range(count):
            theta = chance.uniform(-7, 7)
            trail = theta - chance.uniform(0.0, 0.2) * np.arange(chance.choice((0, 15)))[::-1]
            ink, letter = (index, "esvr"[index]) if count > 1 else (chance.randrange(4), "")
            bobs.append(Bob(theta, ink, trail, letter, diverged=chance.random() < 0.1))
        pictures.append(f"{number}: {columns}x{rows}\n{picture(columns, rows, *bobs).text}")
    drawn = "\n".join(pictures)
    if request.config.getoption("--snapshot-update"):
        GOLDEN.write_text(drawn, encoding="utf-8")
    assert drawn == GOLDEN.read_text(encoding="utf-8")


def test_four_that_coincide_show_their_letters_side_by_side():
    drawn = picture(16, 8, *(Bob(-2.0, index, letter="esvr"[index]) for index in range(4)))
    assert "\ne s⣤v r\n" in drawn.text


@given(st.integers(1, 10_000).map(lambda number: number * 0.6180339887))  # never between two dots
def test_left_is_the_mirror_image_of_right_and_up_of_down(theta):
    """So the pivot is exactly in the middle, for odd and even panes."""
    for columns, rows in ((16, 8), (17, 9)):
        right, left, up = (
            dots(picture(columns, rows, Bob(angle, FRAME)))
            for angle in (theta, -theta, math.pi - theta)
        )
        assert left == {(2 * columns - 1 - x, y) for x, y in right}
        assert up == {(x, 4 * rows - 1 - y) for x, y in right}


@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(1, 40), st.integers(1, 20))
def test_any_angle_fits_any_pane(theta, columns, rows):
    bob = Bob(theta, 0, trail=[theta, math.nan], letter="e")
    assert size(picture(columns, rows, bob, Bob(theta, 1, diverged=True))) == (columns, rows)


def test_a_bob_on_a_spring_is_as_far_from_the_pivot_as_its_rod_is_long():
    def lowest(length):
        return max(row for row, _ in cells(picture(40, 20, Bob(0.0, 2, length=length))))

    assert lowest(0.5) < lowest(0.9) < lowest(1.08)
    assert lowest(1e300) <= 20


@pytest.mark.parametrize("angle", [0.13, 1.2, math.pi / 2])
@pytest.mark.parametrize("pane", [(24, 11), (42, 14), (10, 30)])
def test_hung_from_the_top_a_pendulum_within_its_reach_stays_in_its_pane_and_is_no_shorter(
    pane, angle
):
    def length(reach):
        rows = [row for row, _ in cells(pendulum_picture(*pane, [Bob(0.0, 0)], reach))]
        return max(rows) - min(rows)

    for theta in (-angle, angle):
        shown = cells(pendulum_picture(*pane, [Bob(theta, 0)], angle))
        columns = [column for _, column in shown]
        assert min(row for row, _ in shown) * 4 <= TOP
        assert max(columns) - min(columns) + 1 < pane[0]
    assert length(angle) >= length(math.pi)


async def grabbed(theatre, *moves, wait=0.3):
    """Drag the first pendulum's bob over these cells of its pane, wait, and let it go."""
    pane = theatre.stage.query(Pendulum).first()
    await theatre.pilot.mouse_down(pane, offset=(12, 9))
    for move in moves:
        await theatre.pilot.hover(pane, offset=move)
    await theatre.pilot.pause(wait)
    held = getattr(theatre.stage, "held", None)
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
        theatre.source.set_speed(2.0)
        theatre.stage.query(Pendulum).first()._throw([(0.0, 0.0), (1.0, 0.5), (1.05, 0.6)], 1.06)
        await theatre.pilot.pause()
        scene = theatre.source.scene
        assert (scene.theta, scene.omega) == (0.6, 1.0)  # 2 rad in a second of the clock, at 2×


async def test_less_than_three_columns_is_a_click_that_shows_the_method_alone():
    async with lab() as theatre:
        await grabbed(theatre, (13, 9), (14, 9))
        assert theatre.stage.shown.places(theatre.source.scene.cast) == [0]
        assert theatre.source.sample.run == 1
        await grabbed(theatre, (13, 9))
        assert not theatre.stage.shown.hidden


async def test_a_bob_of_a_recording_cannot_be_grabbed_and_a_sentence_says_so(tmp_path):
    async with player(recorded(tmp_path / "a.mcap", 2.0)) as theatre:
        await grabbed(theatre, (20, 4))
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
