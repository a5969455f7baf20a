"""Phase space in the lab, and over the whole screen."""

import pytest

from engine.scenes import SCENES, Scene
from tests.tui.harness import Theatre, lab
from tui.drawing.cells import CellWidget
from tui.views.phase.pane import PhasePane

DRIFT = SCENES["drift"]


def shown(theatre: Theatre) -> PhasePane:
    """The phase space on screen."""
    (pane,) = (pane for pane in theatre.stage.query(PhasePane) if pane.drawable)
    return pane


async def test_a_click_in_the_lab_starts_all_four_there_with_the_step_in_force_and_u_takes_it_back():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.pilot.press("plus")
        pane = shown(theatre)
        expected = pane.viewport.at_cell(40, 3)
        await theatre.pilot.click(pane, offset=(41, 4))
        assert (theatre.source.scene.theta, theatre.source.scene.omega, theatre.source.scene.h) == (
            *expected,
            0.1,
        )
        assert all((r.theta, r.omega) == tuple(expected) for r in theatre.source.sample.readings)
        assert theatre.source.sample.step == 0
        await theatre.pilot.press("u")
        assert theatre.source.scene == DRIFT.altered(h=0.05)


@pytest.mark.parametrize("size", [(60, 16), (120, 40)])
async def test_f3_shows_all_of_it_and_the_arrows_are_its_keys(size):
    async with lab(size=size) as theatre:
        await theatre.run(1)
        await theatre.press("f3")
        assert shown(theatre).has_focus
        await theatre.pilot.press("shift+right", "up")
        crosshair = shown(theatre).cursor
        await theatre.pilot.press("enter")
        assert (theatre.source.scene.theta, theatre.source.scene.omega) == tuple(crosshair)
        await theatre.press("f2")
        await theatre.press("f3")
        assert shown(theatre).has_focus


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "scene",
    [
        SCENES["near-separatrix"],
        SCENES["rk4-limit-above"],
        Scene(omega=1e8),
        Scene(theta=1e6, omega=-3.0),
        Scene(h=16.0),
        Scene(theta=0.0),
        Scene(gravity=1e-6),
        Scene(omega=1e9, h=100.0),
    ],
    ids=lambda scene: f"{scene.name} {scene.theta:g} {scene.omega:g} {scene.h:g}",
)
async def test_no_start_is_too_much_for_it(scene):
    async with lab(scene, size=(80, 24)) as theatre:
        await theatre.pilot.press("f3", "5")
        await theatre.run(scene.h * 3 + 1 if scene.h < 10 else 1)
        theatre.source.step(500)
        shown(theatre).action_zoom(0.01)
        theatre.stage.show_now()
        shown(theatre).action_move(3, 2)
        text = shown(theatre).text + theatre.stage.query_one("#facts", CellWidget).text
        assert "libration" in text or "rotation" in text
        assert "nan" not in text
        assert "inf" not in text


async def test_the_ring_catches_up_while_the_lab_is_paused():
    async with lab() as theatre:
        await theatre.run(20)
        await theatre.pilot.press("space")
        await theatre.press("f3", "g")
        for _ in range(100):
            await theatre.pilot.pause(0.02)
            if shown(theatre).settled:
                break
        assert shown(theatre).neighbours.step == theatre.source.sample.step
        theatre.stage.show_now()
        text = theatre.stage.query_one("#facts", CellWidget).text
        assert "behind" not in text
        assert f"{shown(theatre).ring.area_ratios[3]:.9f}" in text


async def test_nothing_is_computed_for_phase_space_that_is_not_shown():
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("f3", "g")
        await theatre.run(1)
        pane = shown(theatre)
        await theatre.press("f2")
        step, text = pane.neighbours.step, pane.text
        await theatre.run(2)
        assert (pane.neighbours.step, pane.text) == (step, text)
        assert not any(other.drawable for other in theatre.stage.query(PhasePane))
        await theatre.press("f3")
        await theatre.run(0.1)
        assert pane.neighbours.step == theatre.source.sample.step


async def test_the_exact_point_comes_with_5_and_drawn_where_the_exact_swing_is():
    async with lab() as theatre:
        await theatre.press("f3")
        await theatre.run(3)
        without = shown(theatre).text
        await theatre.pilot.press("5")
        await theatre.pilot.pause()
        assert "x" not in without.replace("exact", "").replace("separatrix", "")
        assert "x" in shown(theatre).text.replace("exact", "").replace("separatrix", "")
