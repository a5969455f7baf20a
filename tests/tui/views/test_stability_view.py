"""F5: the stability map under mouse and keyboard."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from textual.geometry import Size

from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.stability import UNKNOWN, pieces
from pendu_tui.tui.views.stability import StabilityPane
from tests.tui.harness import until, view_of

VERLET = 2  # in USUAL_CAST


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
        assert pane.here(VERLET) == (live.scene.z, 1.0)
        assert pane.text.count("@") == 4
        piece = next(pieces(pane.grid, (20,)))
        said = "Computing 100 %. ", "Computing 50 %. ", ""
        for steps, done, words in zip((20, 60, 60), (1, 0.5, 1), said, strict=True):
            part = replace(piece.part, grid=replace(piece.part.grid, steps=steps))
            pane.add(replace(piece, part=part, done=done))
            pane.draw()
            assert f"\n{words}Velocity Verlet at h 0.0539 s, 58.1°: held" in pane.text


async def test_enter_starts_with_the_cursors_amplitude_and_step_and_esc_leaves_it():
    async with stability_view() as (pilot, pane, live):
        z, theta = pane.aim(VERLET)
        for step, end in ((-99, (0, 0)), (99, (79, 47))):  # it stays on the map
            pane.action_move(step, step)
            assert pane.cursor == end
        assert pane.text.splitlines()[1].count("@") == 2
        await pilot.press("escape", *["right"] * 7, "up", "enter")
        assert live.scene.z == pytest.approx(pane.grid.z[z + 7], rel=1e-12)
        assert (live.scene.theta, live.scene.omega) == (pane.grid.theta[theta + 1], 0)
        assert pane.cursor is None
        assert pane.aim(VERLET) == (z + 7, theta + 1)
        await pilot.press("u")
        assert live.scene == SCENES["drift"]
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
    async with stability_view(SCENES["verlet-limit-above"], (60, 16)) as (_, pane, _live):
        assert pane.text.startswith("3 v held elsewhere\n")
        pane.room = Size(9, 5)
        pane.draw()
