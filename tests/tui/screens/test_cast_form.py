"""The list of methods: what it says, what its keys do, and the run that it starts."""

import pytest

from engine.methods import METHODS, USUAL_CAST, method_of
from engine.scenes import MOST_METHODS, SCENES
from tests.tui.harness import lab
from tui.screens.dialogs.cast_form import CastForm, MethodList, method_line, toggled
from tui.views.lab.error_table import ErrorTable

VERLET, RK4 = method_of("velocity_verlet"), method_of("rk4")


def test_a_method_has_a_line_with_its_place_letter_name_order_cost_and_kind():
    lines = [" ".join(method_line(VERLET, (RK4, VERLET)).split()), " ".join(method_line(RK4, (VERLET,)).split())]
    assert lines == [
        "2 v Velocity Verlet order 2 1 force a step symplectic",
        "r RK4 order 4 4 forces a step not symplectic",
    ]


@pytest.mark.parametrize("method", METHODS)
def test_every_line_fits_in_80_columns(method):
    assert len(method_line(method, ())) <= 76


def test_a_method_is_taken_as_the_last_one_and_left_again():
    assert toggled((RK4,), VERLET) == (RK4, VERLET)
    assert toggled((RK4, VERLET), RK4) == (VERLET,)
    full = tuple(USUAL_CAST[:3]) * 2
    assert len(full) == MOST_METHODS
    assert toggled(full, RK4) == full


async def test_enter_starts_a_run_with_the_new_cast_at_the_same_start_and_h_and_u_undoes_it():
    async with lab() as theatre:
        await theatre.run(2)
        await theatre.press("plus")
        await theatre.run(2)
        before = theatre.source.sample
        await theatre.press("M", "space", "down", "space", "enter")
        await theatre.pilot.pause()
        assert theatre.app.screen is theatre.stage
        scene = theatre.source.scene
        assert (scene.cast, scene.theta, scene.h) == ((VERLET, RK4), 1.0, 0.1)
        assert theatre.source.sample.step == 0
        await theatre.run(1)
        assert len(theatre.text(ErrorTable).splitlines()) == 3
        await theatre.press("u")
        assert theatre.source.scene.cast == USUAL_CAST
        assert (theatre.source.sample.step, theatre.source.sample.readings) == (before.step, before.readings)


async def test_esc_changes_nothing_and_without_a_method_nothing_starts():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("M", "space", "escape")
        assert (theatre.app.screen, theatre.source.scene.cast) == (theatre.stage, USUAL_CAST)
        await theatre.press("M")
        form = theatre.app.screen
        for _ in USUAL_CAST:
            await theatre.press("space", "down")
        await theatre.press("enter")
        await theatre.pilot.pause()
        assert isinstance(form, CastForm)
        assert theatre.app.screen is form
        assert form.query_one("#cast").border_subtitle == "At least one method"


async def test_a_click_takes_a_method_or_leaves_it():
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("M")
        await theatre.pilot.click(MethodList, offset=(5, 2))
        assert theatre.app.screen.query_one(MethodList).cast == tuple(each for each in USUAL_CAST if each != VERLET)


async def test_only_methods_for_the_model_of_the_scene_are_listed():
    for name in ("drift", "damped", "stiff-slow"):
        async with lab(SCENES[name]) as theatre:
            await theatre.press("M")
            listed = theatre.app.screen.query_one(MethodList).methods
            assert set(SCENES[name].cast) <= set(listed)
            assert listed == [method for method in METHODS if SCENES[name].model in method.models]


async def test_a_run_has_the_pendulums_and_lines_of_its_own_cast():
    async with lab() as theatre:
        await theatre.press("M", *["space", "down"] * 3, "enter")
        await theatre.run(1)
        shown = [pane for pane in theatre.stage.query("Pendulum") if pane.is_on_screen]
        assert [str(pane.border_title) for pane in shown] == ["1 r RK4"]
