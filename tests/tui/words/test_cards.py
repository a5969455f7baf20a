"""Cards show what METHODS and SCENES hold, and nothing else."""

import pytest

from engine.methods import METHODS, USUAL_CAST
from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tests.tui.harness import lab, uncomputed
from tui.playback.live import Live
from tui.screens.dialogs.text import help_text
from tui.screens.keys import COMMON, LIVE, REPLAY
from tui.views.accuracy import pane as accuracy
from tui.views.phase import keys as phase
from tui.views.phase.pane import PhasePane
from tui.views.stability import pane as stability
from tui.words.cards import OFTEN_SAID, WIDTH, glossary, method_card, scene_card


def words(card: str) -> str:
    """The card on one line."""
    return " ".join(card.split())


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_a_method_card_has_every_claim(method):
    card = words(method_card(method))
    for claim in (method.label, *method.other_names, method.formula, method.reference, method.used or ""):
        assert words(claim) in card
    assert ("used in" in card) == (method.used is not None)
    assert f"order {method.order}: as a rule, over one swing half of h divides the error by {2**method.order}" in card
    assert f"costs {method.force_evaluations} force evaluation" in card
    assert ("symplectic yes" in card, "reversible yes" in card) == (method.symplectic, method.reversible)
    if method.linear_limit is None:
        assert "stable up to" not in card
        assert "stable at no h" not in card
    else:
        assert (
            f"stable up to z = h w0 = {method.linear_limit:.4g}" if method.linear_limit else "stable at no h"
        ) in card


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_scene_card_has_what_to_watch_and_the_numbers(scene):
    card = words(scene_card(scene))
    assert words(scene.watch) in card
    for number in (scene.omega, scene.length, scene.gravity, scene.h, *scene.parameters.values()):
        assert f"{number:.5g}" in card


def test_a_scene_of_ones_own_has_nothing_to_watch():
    assert "watch" not in scene_card(SCENES["drift"].altered(theta=2.0))


def test_lines_fit_the_text_screen():
    for card in (*map(method_card, METHODS), *map(scene_card, SCENES.values())):
        assert max(map(len, card.splitlines())) <= WIDTH
    for keys in ((*LIVE, *COMMON), (*REPLAY, *COMMON), phase.KEYS, accuracy.KEYS, stability.KEYS):
        assert max(map(len, help_text(keys, Live(SCENES["drift"])).splitlines())) <= WIDTH


def test_the_help_begins_with_the_glossary_and_what_to_watch_and_ends_with_the_methods():
    text = help_text((*LIVE, *COMMON), Live(SCENES["drift"]))
    assert text.startswith(glossary())
    assert text.index(glossary()) < text.index(scene_card(SCENES["drift"])) < text.index("Time\n")
    assert text.endswith(method_card(USUAL_CAST[-1]))
    assert text.index("Time\n") < text.index("Display\n") < text.index(METHODS[0].formula)


def test_the_help_shows_the_current_step_next_to_the_scenes():
    live = Live(SCENES["drift"])
    assert "now" not in words(scene_card(live.scene))
    live.set_stepping(Stepping(-0.4, equal_cost=True))
    text = words(help_text(LIVE, live))
    assert (
        "step h = 0.05 s, z = h·w0 = 0.1566 now h = 0.4 s, z = 1.25; at equal cost, the cheaper methods split it"
        in text
    )
    assert "time runs backwards" in text


async def test_the_help_begins_with_the_keys_of_the_focused_pane(monkeypatch):
    monkeypatch.setattr("tui.views.stability.view.computed", uncomputed)
    async with lab() as theatre:
        for view, pane, first in ((None, None, "Run"), (None, PhasePane, "Phase space"), ("f5", None, "Stability")):
            if view:
                await theatre.press(view)
                await theatre.pilot.pause()
            if pane:
                theatre.stage.query_one(pane).focus()
            await theatre.press("question_mark")
            groups = [part.partition("\n")[0] for part in theatre.app.screen.text.split("\n\n")]
            assert groups[2] == first
            assert {"Run", "Time", "Display", "Program"} < set(groups)
            await theatre.press("escape")


def test_the_glossary_explains_every_sign_of_a_verdict_that_ends_well_or_badly():
    for words in ("h ", "z ", "dE/E0", "E/Es", "= bounded", "+ grows", "- loses", "! chaotic", "too early", "colours"):
        assert f"\n  {words}" in glossary()


def test_what_is_often_said_stands_on_the_cards_of_scenes_and_where_there_is_no_closed_form_the_reference():
    assert set(OFTEN_SAID) <= set(SCENES)
    for name, scene in SCENES.items():
        card = words(scene_card(scene))
        assert ("often said" in card) == (name in OFTEN_SAID)
        assert ("right to 1e-10 rad" in card) == (scene.model in ("damped", "spring"))
