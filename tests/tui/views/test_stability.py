"""F5: the stability map, in colours and by its characters alone, under mouse and keyboard."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.geometry import Size

from pendu_tui.engine.methods import RK4, USUAL_CAST
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.stability import (
    CELL,
    CHAOTIC,
    ELSEWHERE,
    GROWS,
    HOLDS,
    LOSES,
    OVER_THE_TOP,
    UNKNOWN,
    Grid,
    pieces,
)
from pendu_tui.tui.drawing.frame import Axis, Frame
from pendu_tui.tui.drawing.picture import PALETTES, Picture
from pendu_tui.tui.views import stability as drawing
from pendu_tui.tui.views.stability import StabilityPane
from tests.tui.harness import until, view_of

VERLET = 2  # in USUAL_CAST
STEPS = 1000
GRID = Grid((np.arange(12) + 0.5) * math.pi / 12, (np.arange(30) + 0.5) / 10, STEPS)


def half_lost() -> np.ndarray:
    """Every method holds below z = 1.5, and above loses a large swing later than a small one."""
    cells = GRID.unknown()
    cells[:15] = np.array((STEPS, 1e-13, HOLDS), CELL)
    cells[15:, :, :6] = np.array((5, 1.0, GROWS), CELL)
    cells[15:, :, 6:] = np.array((500, 1.0, GROWS), CELL)
    return cells


FRAME = Frame(Axis(0.0, 3.0, {1.0: "1", 2.0: "2"}), Axis(0.0, math.pi, {math.pi / 2: "90"}), 30, 6)


def panel(cells, index, **options) -> str:
    values = drawing.scores(cells[:, index], STEPS)
    method = USUAL_CAST[index]
    dark = PALETTES["dark"]
    rows = drawing.panel(FRAME, values, method, index, dark, title=method.label, **options)
    return Picture(rows).text


def test_the_characters_alone_tell_held_from_lost_and_theory_is_where_it_belongs(snapshot):
    here = (0.55, math.radians(75))  # where the catching orbit is at z = 2.328
    striped = half_lost()
    striped[15:20, :, 0::2] = held = striped[0, 0, 0]  # the lower pixel of each row
    striped[20:, :, 1::2] = held
    striped[:5, :, 0::2] = striped[5:10, :, 1::2] = np.array((0, 0.0, UNKNOWN), CELL)
    texts = [panel(half_lost(), 3), panel(half_lost(), 2, here=here), panel(GRID.unknown(), 0)]
    texts += panel(half_lost(), 1), panel(striped, 0)
    snapshot("stability.txt", "\n\n".join(texts) + "\n")


@given(
    st.tuples(st.integers(1, 30), st.integers(1, 20)),
    st.tuples(st.integers(1, 40), st.integers(1, 30)),
    st.randoms(),
)
def test_no_failure_vanishes_however_small_the_picture(shape, size, random):
    values = np.array([[random.random() for _ in range(shape[1])] for _ in range(shape[0])])
    drawn = drawing.worst(values, *size)
    assert drawn.shape == size[::-1]
    assert drawn.min() == values.min()
    assert set(drawn.flat) <= set(values.flat)


def test_scores_go_from_unknown_and_lost_at_once_to_held_exactly():
    ends = [(0, 0.0, UNKNOWN), (0, 1.0, LOSES), (STEPS, 1e-12, HOLDS)]
    assert [*drawing.scores(np.array(ends, CELL), STEPS)] == [-1, 0, 2]


@pytest.mark.parametrize("theme", PALETTES)
@pytest.mark.parametrize("ink", range(10))
def test_colours_of_held_lost_and_unknown_swings_differ_for_every_method(theme: str, ink: int):
    palette = PALETTES[theme]
    held = {drawing.colour(score, ink, palette) for score in (1.0, 1.5, 1.9)}
    lost = {drawing.colour(score, ink, palette) for score in (0.0, 0.5, 0.9)}
    # sixteen colours have no shades of how soon
    assert len(lost) == (3 if palette.warn.startswith("#") else 1)
    assert not held & lost
    assert drawing.colour(-1, ink, palette) not in held | lost


LADDER = Grid(np.array([math.pi / 2]), np.array([0.5, 1.0, 1.5, 2.0, 2.5]), 300, (RK4,))
OUTCOMES = {
    "h": (300, 1e-3, HOLDS),
    "b": (300, 70.0, ELSEWHERE),
    "e": (300, 2e-2, HOLDS),
    "c": (300, 0.2, CHAOTIC),
    "o": (40, 0.9, OVER_THE_TOP),
    "g": (3, 5.0, GROWS),
    "?": (0, 0.0, UNKNOWN),
}


@pytest.mark.parametrize(
    ("outcomes", "z", "sentence"),
    [
        ("hecog", 1, "0.5 s, 90°: held, error 2e-2; lost at h 0.75 s"),
        ("hecog", 2, "0.75 s, 90°: chaotic; held at h 0.5 s"),
        ("hecog", 3, "1 s, 90°: over the top, step 41; held at h 0.5 s"),
        ("hecog", 4, "1.25 s, 90°: grows, step 4; held at h 0.5 s"),
        ("hhhhh", 0, "0.25 s, 90°: held, error 1e-3; held at every h on this map"),
        ("bbbbb", 0, "0.25 s, 90°: held off-centre, error 7e1; held at every h on this map"),
        ("ggggg", 0, "0.25 s, 90°: grows, step 4; lost at every h on this map"),
        ("h????", 0, "0.25 s, 90°: held, error 1e-3; not lost at any h so far"),
        ("?????", 0, "0.25 s, 90°: not computed yet"),
    ],
)
def test_a_verdict_tells_the_outcome_and_the_nearest_cliff(outcomes, z, sentence):
    cells = np.array([OUTCOMES[each] for each in outcomes], CELL).reshape(-1, 1, 1)
    assert drawing.verdict(LADDER, cells, 0, (z, 0), w0=2.0) == f"RK4 at h {sentence}"


@pytest.fixture(autouse=True)
def _few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", (20, 60))


stability_view = partial(view_of, "f5", StabilityPane, lambda pane: pane.settled)


async def test_the_map_fills_in_and_is_the_engines_and_names_the_swing_on_screen():
    async with stability_view() as (_, pane, live):
        assert (pane.cells["fate"] != UNKNOWN).all()
        sixty = type(pane.grid)(pane.grid.theta[:5], pane.grid.z[30:35], 60)
        assert np.array_equal(pane.cells[30:35, :, :5], sixty.cells())
        for text in ("Explicit Euler: grows", "Symplectic Euler: held", "RK4: held", " 0.5 "):
            assert text in pane.text
        live.change(live.stepping.reversed())
        assert pane.here(VERLET) == (live.scene.z, 1.0)
        assert pane.text.count("@") == 4
        piece = next(pieces(pane.grid, (20,)))
        said = "Computing 100 %. ", "Computing 50 %. ", ""
        for steps, done, words in zip((20, 60, 60), (1, 0.5, 1), said, strict=True):
            part = replace(piece.part, grid=replace(piece.part.grid, steps=steps))
            pane.add(replace(piece, part=part, done=done))
            pane.draw()
            assert f"\n{words}Velocity Verlet at h 0.0539 s, 58.1°: held" in pane.text


async def test_a_scene_without_a_map_keeps_the_title_of_the_view():
    scene = SCENES["stiff-slow"]
    async with view_of("f5", StabilityPane, lambda pane: pane.text, scene) as (_, pane, _):
        assert "Stability (F5)" in str(pane.border_title)
        assert "a single angle" in pane.text


async def test_enter_starts_with_the_cursors_amplitude_and_step_and_esc_leaves_it():
    async with stability_view() as (pilot, pane, live):
        z, theta = pane.aim(VERLET)
        for step, end in ((-99, (0, 0)), (99, (79, 47))):  # it stays on the map
            pane.action_move(step, step)
            assert pane.cursor == end
        assert pane.text.splitlines()[1].count("@") == 2
        await pilot.press("escape", *["right"] * 7, "up", "enter")
        await until(pilot, lambda: live.scene != SCENES["drift"])
        assert live.scene.z == pytest.approx(pane.grid.z[z + 7], rel=1e-12)
        assert (live.scene.theta, live.scene.omega) == (pane.grid.theta[theta + 1], 0)
        assert pane.cursor is None
        assert pane.aim(VERLET) == (z + 7, theta + 1)
        await pilot.press("u")
        await until(pilot, lambda: live.scene == SCENES["drift"])
        live.start(SCENES["spin"])  # which has no amplitude
        await until(pilot, lambda: pane.aim(VERLET) is None)
        await pilot.press("right")
        assert pane.cursor == (1, 0)


async def test_a_click_starts_with_what_was_clicked_on():
    async with stability_view() as (pilot, pane, live):
        # RK4's map is below and to the right, behind a panel, a gap and labels, inside a frame
        lowest = max(
            y for y, line in enumerate(pane.text.splitlines()) if line.startswith("   90┤")
        )
        # on a label, beside a map, above, and below one
        for beside in ((4, 1 + lowest), (39, 1 + lowest), (20, 1), (20, 4 + lowest)):
            await pilot.hover(StabilityPane, offset=beside)
            assert pane.pointer is None
        await pilot.hover(StabilityPane, offset=(1 + 7, 2))
        assert "Explicit Euler at h 0.0419 s, 159°: over the top" in pane.text
        await pilot.press("right")
        await pilot.click(StabilityPane, offset=(1 + 38 + 2 + 6 + 16, 1 + lowest))
        assert pane.cursor is None
        assert live.scene.z == pytest.approx(1.5, abs=0.1)
        assert live.scene.theta == pytest.approx(math.pi / 2, abs=0.45)
        assert "RK4 at h" in pane.text


async def test_tab_goes_through_the_methods_and_hidden_ones_leave_their_panels_to_the_others():
    async with stability_view() as (pilot, pane, _):
        for label in ("RK4 at", "Explicit Euler at", "Symplectic Euler at", "Velocity Verlet at"):
            await pilot.press("tab")
            assert label in pane.text
        await pilot.press("3")
        await pilot.pause(0.3)
        assert "Explicit Euler at" in pane.text  # the first that is shown
        await pilot.hover(StabilityPane, offset=(70, 14))  # where the fourth was
        await pilot.press("1")
        await pilot.pause(0.3)
        assert "Explicit" not in pane.text
        await pilot.press("2", "4")
        await pilot.pause(0.3)
        assert "4 r" not in pane.text


async def test_a_number_in_a_narrow_title_is_whole_or_left_out():
    async with stability_view(SCENES["verlet-limit-above"], (60, 16)) as (_, pane, live):
        said = drawing.verdict(pane.grid, pane.cells, VERLET, pane.aim(VERLET), live.scene.w0)
        assert said in " ".join(pane.text.split())  # on two rows

        def title(columns: int) -> str:
            pane.room = Size(columns, 5)
            pane.draw()
            return pane.text.splitlines()[0]

        title(9)
        whole = title(118)
        short = whole.replace("Velocity Verlet: ", "")
        columns = [2 * len(each) + more for each in (whole, short) for more in (2, 1)]
        assert [*map(title, columns)] == [whole, short, short, "3 v held off-centre"]
