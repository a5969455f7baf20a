"""One pendulum with a lane for each method, its letters, and a bob under the mouse."""

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from textual.geometry import Size

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import MAX_METHODS, SCENES
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.error_table import ErrorTable
from pendu_tui.tui.views.stage import Bob, Lens, Look, Stage, lanes, stage_picture
from tests.tui.drawn import cells, size
from tests.tui.harness import lab

LETTERS = "esvrmp"
ANGLES = st.floats(-1e9, 1e9)
SMALL = (20, 6)  # columns and rows of the stage on the smallest screen


def letters(drawn):
    return sorted(each for each, _ in cells(drawn).values() if each.isalpha())


@given(
    st.integers(SMALL[0], 80),
    st.integers(4, 50),  # six methods leave four rows of the smallest screen
    st.lists(st.tuples(ANGLES, st.floats(0.0, 1e9)), min_size=1, max_size=MAX_METHODS),
    st.floats(0.1, math.pi),
    st.booleans(),
)
@example(*SMALL, [(0.0, math.inf)], 1.0, False)
def test_each_letter_stands_once_on_the_stage_wherever_the_bobs_are(
    columns, rows, bobs, widest, rigid
):
    """Coinciding bobs and those of springs that flew off have theirs, too."""
    drawn = stage_picture(
        columns,
        rows,
        [
            Bob(theta, ink, LETTERS[ink], length=1.0 if rigid else length)
            for ink, (theta, length) in enumerate(bobs)
        ],
        Look(widest, rigid=rigid),
    )
    assert letters(drawn) == sorted(LETTERS[: len(bobs)])
    assert size(drawn) == (columns, rows)


@given(st.floats(-100, 100), st.floats(1e-6, 0.3), st.integers(2, 8))
def test_a_lens_enlarges_small_angles_and_keeps_turns_order_and_the_top(theta, half, times):
    half = min(half, 0.8 / times)
    lens = Lens(half, times)
    assert lens(half / 2) == pytest.approx(times * half / 2)
    assert lens(theta + math.tau) == pytest.approx(lens(theta) + math.tau, abs=1e-6)
    assert lens(-theta) == -lens(theta)
    assert lens(math.inf) == math.inf
    assert lens(math.pi) == pytest.approx(math.pi)
    assert lens(theta + 0.01) > lens(theta)


@pytest.mark.parametrize(
    ("room", "half", "times"),
    [((20, 6), 0.099, 8), ((43, 22), 0.25, 2), ((43, 22), 0.26, 1), ((20, 30), 0.099, 4)],
)
def test_small_swings_are_enlarged_to_23_to_46_degrees_as_the_stage_is_wide(room, half, times):
    stage = Stage()
    stage.room = Size(*room)
    assert stage._lens(half).times == times
    stage.shown = Shown(theta=half)  # of a shot
    assert stage._lens(3.0).times == times
    for stage.shown in (Shown(overview=True), Shown(held=half)):
        assert stage._lens(half).times == 1
    live = stage.source = Live(SCENES["gentle"].altered(theta=0.05))
    stage.shown = Shown(theta=half)
    stage.picture(live, live.sample)
    (bob, *_), look = stage._drawn
    angles = look.exact, look.amplitude, bob.theta
    assert angles == pytest.approx([0.05 * times] * 3)


def on_lane(theatre, place):
    """The cell of the stage in which a method's lane is at its lowest."""
    stage = theatre.pane(Stage)
    bobs, look = stage._drawn
    found = lanes(*stage.room, len(bobs), look.widest, look.rigid)
    x, y = found.point(found.radii[place], 0.0)
    return stage, (int(x) // 2 + 1, int(y) // 4 + 1)


async def grabbed(theatre, *moves, start=(12, 9), wait=0.3):
    """Drag the stage over these cells of it, wait, and let it go."""
    stage = theatre.pane(Stage)
    await theatre.pilot.mouse_down(stage, offset=start)
    for move in moves:
        await theatre.pilot.hover(stage, offset=move)
    await theatre.pilot.pause(wait)
    held = theatre.stage.shown.held
    table = theatre.text(ErrorTable)
    await theatre.pilot.mouse_up(stage, offset=moves[-1])
    await theatre.pilot.hover(stage, offset=start)  # with no button down
    await theatre.pilot.pause()
    assert theatre.stage.shown.held is None
    assert theatre.app.mouse_captured is None
    return held, table


async def test_all_are_dragged_together_and_start_at_rest_where_they_are_let_go():
    """As one step of undo."""
    async with lab() as theatre:
        await theatre.run(2)
        before = theatre.sample
        # two dots right of the pivot and two below
        _, table = await grabbed(theatre, (30, 9), (23, 12), start=(22, 12))
        assert table.count("+0.785") == 4
        scene = theatre.scene
        assert (scene.theta, scene.omega) == (0.785, 0.0)
        assert [event.kind for event in theatre.source.events] == ["start", "start"]
        await theatre.press("u")
        assert theatre.scene == SCENES["drift"]
        assert theatre.sample.step == before.step
        for click, drag in (((14, 9), (15, 9)), ((12, 10), (12, 11)), ((12, 9), (60, 9))):
            assert (await grabbed(theatre, click, wait=0))[0] is None
            assert (await grabbed(theatre, drag, wait=0))[0] is not None
        stage = theatre.pane(Stage)
        for columns, below in ((36, "drag: throw it · dotted: exact"), (35, "drag: throw it")):
            stage.room = Size(columns, 20)
            stage.draw()
            assert stage.border_subtitle == below


@pytest.mark.parametrize(("away", "back"), [("f3", "f2"), ("question_mark", "escape")])
async def test_what_covers_a_held_pendulum_lets_it_go(away, back):
    async with lab() as theatre:
        await theatre.pilot.mouse_down(Stage, offset=(12, 9))
        await theatre.pilot.hover(Stage, offset=(20, 9))
        assert theatre.stage.shown.held is not None
        await theatre.press(away, back)
        await theatre.pilot.hover(Stage, offset=(12, 9))
        assert theatre.stage.shown.held is None
        assert theatre.app.mouse_captured is None


async def test_a_thrown_bob_has_the_speed_of_the_pointer():
    fastest = 5 * SCENES["drift"].w0
    async with lab() as theatre:
        theatre.source.set_speed(-2.0)  # of a replay that runs backwards
        for drag, now, theta, omega in (
            ([(0.9, 0.0), (1.0, 0.5), (1.05, 0.6)], 1.06, 0.6, 1.0),  # 2 rad a second, at 2×
            ([(0.0, 0.0), (0.9, 0.4), (1.1, 0.5)], 1.15, 0.5, 0.25),  # a cell at a time
            ([(0.0, 0.0), (0.9, 0.5)], 1.01, 0.5, 0.0),  # the pointer rested
            ([(0.0, 0.0), (1e-4, -1.0)], 0.01, -1.0, -fastest),  # the terminal was late
            ([(0.0, 3.1), (0.05, -3.1)], 0.06, -3.1, 0.83),  # over the top
        ):
            theatre.pane(Stage)._throw(drag, now)
            await theatre.pilot.pause()
            found = theatre.scene.theta, theatre.scene.omega
            assert found == pytest.approx((theta, omega), abs=0.005)


async def test_a_trail_has_gaps_where_steps_are_long_either_way_of_time():
    async with lab() as theatre:
        for h, joins in ((-0.3, True), (-0.33, False)):
            theatre.source.change(Stepping(h))
            theatre.stage.show_now()
            assert theatre.pane(Stage)._drawn[1].joins == joins


async def test_less_than_three_columns_is_a_click_that_shows_the_lanes_method_alone():
    async with lab() as theatre:
        await theatre.run(1)
        for column in (6, 38):  # just beyond the outermost lane
            await theatre.click(Stage, column, 16)
        await theatre.click(Stage, *on_lane(theatre, 2)[1], button=3)
        assert not theatre.stage.shown.hidden
        stage, cell = on_lane(theatre, 2)
        for place, at in ((2, cell), (0, (37, 16))):
            await theatre.click(stage, *at)
            await theatre.run(0.1)
            assert theatre.stage.shown.places(theatre.scene.cast) == [place]
            assert theatre.sample.run == 1
            assert stage.border_title == theatre.scene.cast[place].label
            await theatre.click(stage, *on_lane(theatre, 0)[1])
            await theatre.run(0.1)
            assert not theatre.stage.shown.hidden
        await theatre.press("1", "2", "3", "4")
        await theatre.click(Stage)
        assert stage.places == []
