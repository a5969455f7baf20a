"""The phase portrait of a method's own map, in the view."""

import pytest
from textual import events

from pendu_tui.engine.scenes import SCENES, Line, Scene
from pendu_tui.tui.views.phase import SectionPane
from pendu_tui.tui.views.viewport import LEFT
from tests.tui.harness import lab, until

SCENE = Scene(theta=1.25, h=0.348011)  # at the 1:6 resonance of velocity Verlet


@pytest.fixture(autouse=True)
def _few_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pendu_tui.tui.views.phase.STARTS", 30)


async def section_of(theatre, *keys: str) -> SectionPane:
    """The pane with a section that is complete, after these keys."""
    await theatre.press("f3", *keys)
    await theatre.run(0.2)
    pane = theatre.pane(SectionPane)
    await until(theatre.pilot, lambda: pane.shown.section and pane.settled)
    pane.draw()
    return pane


@pytest.mark.parametrize("size", [(60, 16), (120, 40)])
async def test_x_shows_the_own_map_of_velocity_verlet_and_the_portrait_again(size):
    async with lab(SCENE, size=size) as theatre:
        pane = await section_of(theatre, "x")
        assert pane.border_title == "Own map of Velocity Verlet: h 0.348011 s, z 1.09"
        words = "start: A chain of islands: 1 turn in every 6 steps, 1:6."
        assert pane.text.splitlines()[-1] == words
        assert pane._section.result._near.any()  # other orbits, too
        await theatre.pilot.hover(pane, offset=(LEFT + 2, 2))
        words = pane.text.splitlines()[-1]
        assert words.startswith("{:g}, {:g}: ".format(*pane.pointer))
        assert "islands" not in words
        pane._orbits = 15
        pane.draw()
        assert str(pane.border_title).endswith(", computing 50%")
        assert not pane.settled
        await theatre.press("f2")
        assert pane.settled  # out of sight
        await theatre.press("f3")
        await theatre.press("n")
        pane.draw()
        own = theatre.source.stepping.own[2]
        assert own < theatre.source.stepping.h
        assert f"h {own:g} s" in str(pane.border_title)
        await theatre.stage.start(stiff := SCENES["stiff-slow"])
        await theatre.pilot.pause()
        assert " ".join(pane.text.split()) == stiff.why_not_mapped
        assert pane.settled
        await theatre.press("x")
        assert str(pane.border_title).startswith("Phase space")
        await theatre.press("u", "u", "x")
        assert "E/Es" in pane.text
        half = pane.viewport.up[1]
        for quantity, size in (("omega", 3), ("theta_error", 1)):
            pane.shown = pane.shown._replace(line=Line(quantity, -2 * half, "fence"))
            assert pane.viewport.up[1] == pytest.approx(size * half, rel=0.2)


async def test_a_key_that_comes_at_once_after_that_of_a_view_reaches_its_pane():
    async with lab(SCENE) as theatre:
        for key in ("f3", "x"):
            theatre.app.post_message(events.Key(key, None))
        await until(theatre.pilot, lambda: theatre.stage.shown.section)
