"""Cards show what METHODS and SCENES hold, and nothing else."""

import math

import pytest

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.words.cards import WIDTH, glossary, method_card, scene_card


def words(card: str) -> str:
    """The card on one line, which fits the text screen."""
    assert max(map(len, card.splitlines())) <= WIDTH
    return " ".join(card.split())


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_a_method_card_has_every_claim(method):
    card = words(method_card(method))
    claims = [method.label, *method.other_names, method.formula, method.reference]
    claims += [method.used or "", f"{method.force_evaluations} force evaluation"]
    claims.append(f"half of h divides the error by {2**method.order}")
    limits = {None: "reference", 0.0: "stable at no h", math.inf: "stable at any h"}
    limit = method.linear_limit
    claims.append(limits.get(limit) or f"stable up to z = h w0 = {limit:.4g}")
    for claim in claims:
        assert " ".join(claim.split()) in card
    assert ("symplectic yes" in card) == method.symplectic
    assert ("reversible yes" in card) == method.reversible


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_scene_card_has_what_to_watch_and_the_numbers(scene):
    card = words(scene_card(scene))
    assert " ".join(scene.watch.split()) in card
    for number in (scene.omega, scene.length, scene.gravity, scene.h, *scene.parameters.values()):
        assert f"{number:.5g}" in card
    assert ("often said" in card) == bool(scene.often_said)
    # where there is no closed form
    assert ("right to 1e-10 rad" in card) == (scene.exact().accuracy > 0)


def test_the_glossary_explains_every_verdict():
    heads = glossary()
    assert all(f" {word} " in heads for word in (*VERDICTS, "h", "z", "dE/E0", "E/Es", "colours"))
