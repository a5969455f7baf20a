"""The forms take what is typed and chosen, and say what is wrong."""

import math
from dataclasses import replace

from textual.widgets import Label

from pendu_tui.engine.methods import METHODS, USUAL_CAST
from pendu_tui.engine.scenes import DEFAULT_SCENE, MAX_METHODS, SCENES
from pendu_tui.tui.terminal.options import SMALLEST
from tests.tui.harness import lab


async def test_the_start_form_takes_radians_and_degrees_and_starts_with_enter():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press(
            "b", "i", *"115deg ", "down", *"-2", *["down"] * 4, "up", *"0.01", "enter"
        )
        scene = theatre.scene
        assert (scene.theta, scene.omega, scene.h) == (math.radians(115), -2.0, 0.01)
        assert theatre.source.stepping.h == 0.01  # a new run is no reversed one
        assert theatre.stage.shown.theta is None  # phase space fits it
        assert (scene.length, scene.gravity, theatre.sample.step) == (1.0, 9.81, 0)


async def test_it_has_the_parameters_of_the_model_and_starts_nothing_that_is_wrong():
    async with lab(SCENES["stiff-slow"]) as theatre:
        await theatre.press("i")
        form = theatre.app.screen
        fields = [field.id for field in form.query("Input")]
        assert fields == ["theta", "omega", "length", "gravity", "h", "stiffness"]

        async def enter(name, value):
            form.query_one(f"#{name}").value = value
            await theatre.pilot.pause()
            await theatre.press("enter")

        verdict = form.query_one("#verdict", Label)
        calm = verdict.styles.color
        for name, value in (("stiffness", "0.5"), ("theta", "[abc]"), ("theta", "")):
            before = form.query_one(f"#{name}").value
            await enter(name, value)
            assert theatre.app.screen is form
            assert verdict.styles.color != calm
            assert name in str(verdict.content)
            assert value in str(verdict.visual)
            form.query_one(f"#{name}").value = before
            await theatre.pilot.pause()
            assert verdict.styles.color == calm
        await enter("stiffness", "400")
        assert theatre.scene == SCENES["stiff-slow"].altered(stiffness=400.0)


async def test_names_and_units_are_whole_on_the_smallest_screen():
    async with lab(SCENES["mean-field"], SMALLEST) as theatre:
        await theatre.press("i")
        for label in theatre.app.screen.query("Horizontal Label").results(Label):
            room = label.size.width - (not label.has_class("unit"))  # a value follows
            assert len(str(label.content)) <= room


async def test_methods_are_taken_by_keys_and_clicks_in_the_order_that_is_chosen():
    own = replace(USUAL_CAST[3], key="own")
    async with lab(DEFAULT_SCENE.with_cast((*USUAL_CAST, own)), (100, 40)) as theatre:
        for key in ("q", "M"):
            await theatre.press("M", key)
            assert theatre.app.screen is theatre.stage
        await theatre.press("plus", "M")
        form = theatre.app.screen
        known = [*METHODS]
        assert form._methods == [*(each for each in known if "pendulum" in each.models), own]

        async def click(row):
            await theatre.click("#cast", 10, row + 1)

        for row in range(4, 9):
            await click(row)
        assert len(form.cast) == MAX_METHODS  # no more than fit
        assert str(MAX_METHODS) in theatre.notices[0]
        for row in range(10):
            if known[row] in form.cast:
                await click(row)
        await theatre.press("end", "space")
        assert not form.cast
        await theatre.press("enter")
        assert theatre.app.screen is form  # not without a method
        assert "at least one" in theatre.notices[0]
        await click(3)
        await theatre.press("home", "space", "down", "space", "space", "enter")
        assert theatre.scene.cast == (known[3], known[0])
        assert theatre.scene.h == 0.1
