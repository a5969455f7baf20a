"""Every scene runs in every view: no fault, no number that is none, and a sentence in place of what it cannot have."""

import re

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.views import VIEWS, following
from pendu_tui.tui.views.accuracy import AccuracyPane
from pendu_tui.tui.views.stability import StabilityPane
from pendu_tui.tui.views.view import Pane
from tests.tui.harness import key_of, lab

pytestmark = pytest.mark.other_process  # what is computed is left again at once
STIFF = SCENES["stiff-slow"]


def words(theatre):
    return "\n".join(pane.text for pane in theatre.stage.query(Pane) if pane.drawable)


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.usefixtures("uncomputed")
async def test_every_scene_has_words_without_nan_in_every_view_before_anything_is_computed(view):
    async with lab() as theatre:
        await theatre.press(key_of(view))
        assert following(view) == [*VIEWS, "lab"][1 + [*VIEWS].index(view)]
        await theatre.run(0.2)
        assert (" 10000" in words(theatre)) == (view == "stability")  # steps of its map
        for scene in SCENES.values():
            theatre.source.start(scene)
            await theatre.run(1)
            assert not re.search(r"\b(nan|inf)\b", shown := words(theatre))
            assert shown
            titles = [str(pane.border_title) for pane in theatre.stage.query(Pane)]
            title = f"{VIEWS[view]} ({key_of(view).upper()})"
            assert view == "lab" or any(each.startswith(title) for each in titles)


@pytest.mark.parametrize(
    ("view", "pane"), [("accuracy", AccuracyPane), ("stability", StabilityPane)]
)
async def test_a_view_that_a_scene_cannot_have_says_why_until_there_is_a_pendulum(view, pane):
    async with lab(STIFF) as theatre:
        await theatre.press(key_of(view))
        await theatre.run(0.2)
        assert " ".join(theatre.text(pane).split()) == STIFF.why_not_mapped
        assert theatre.pane(pane).settled
        await theatre.press("right", "enter", "tab")
        await theatre.click(pane, 12, 4)
        assert theatre.scene == STIFF
        theatre.source.start(SCENES["gentle"])
        await theatre.run(0.5)
        assert "Maps and studies are for" not in theatre.text(pane)
