"""Cards show what METHODS and SCENES hold, and nothing else."""

import math

import pytest

from engine.methods import METHODS
from engine.scenes import SCENES
from tui.words.cards import WIDTH, glossary, method_card, scene_card


def words(card: str) -> str:
    """The card on one line."""
    return " ".join(card.split())


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_a_method_card_has_every_claim(method):
    card = words(method_card(method))
    for claim in (
        method.label,
        *method.other_names,
        method.formula,
        method.reference,
        method.used or "",
    ):
        assert words(claim) in card
    assert ("used in" in card) == (method.used is not None)
    assert (
        f"order {method.order}: as a rule, over one swing half of h divides the error by {2**method.order}"
        in card
    )
    assert f"{method.force_evaluations} force evaluation" in card
    assert ("symplectic yes" in card, "reversible yes" in card) == (
        method.symplectic,
        method.reversible,
    )
    limits = {None: "reference", 0.0: "stable at no h", math.inf: "stable at any h"}
    limit = method.linear_limit
    assert (limits.get(limit) or f"stable up to z = h w0 = {limit:.4g}") in card


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_scene_card_has_what_to_watch_and_the_numbers(scene):
    card = words(scene_card(scene))
    assert words(scene.watch) in card
    for number in (scene.omega, scene.length, scene.gravity, scene.h, *scene.parameters.values()):
        assert f"{number:.5g}" in card


def test_lines_fit_the_text_screen():
    for card in (*map(method_card, METHODS), *map(scene_card, SCENES.values())):
        assert max(map(len, card.splitlines())) <= WIDTH


def test_the_glossary_explains_every_sign_of_a_verdict_that_ends_well_or_badly():
    for words in (
        "h ",
        "z ",
        "dE/E0",
        "E/Es",
        "= bounded",
        "+ grows",
        "- loses",
        "! chaotic",
        "too early",
        "colours",
    ):
        assert f"\n  {words}" in glossary()


def test_what_is_often_said_stands_on_the_cards_of_scenes_and_where_there_is_no_closed_form_the_reference():
    for scene in SCENES.values():
        card = words(scene_card(scene))
        assert ("often said" in card) == bool(scene.often_said)
        assert ("right to 1e-10 rad" in card) == (scene.exact().accuracy > 0)
