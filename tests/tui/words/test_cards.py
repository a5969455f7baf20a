"""Cards show what METHODS and SCENES hold, and nothing else."""

import pytest

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.words.cards import WIDTH, glossary, head_text, method_card, scene_card


def words(card: str) -> str:
    """The card on one line, which fits the text screen."""
    assert max(map(len, card.splitlines())) <= WIDTH
    return " ".join(card.split())


def test_cards_as_they_are_stored(snapshot):
    keys = ("explicit_euler", "velocity_verlet", "backward_euler", "halving_verlet")
    cards = [method_card(each) for each in METHODS if each.key in keys]
    scene = SCENES["damped"].altered(gravity=5.0)
    cards += [scene_card(scene), scene_card(SCENES["halving"]), glossary()]
    snapshot("cards.txt", "\n\n".join(cards))


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_scene_card_has_what_to_watch(scene):
    card = words(scene_card(scene))
    assert " ".join(scene.watch.split()) in card
    # where there is no closed form
    assert ("right to 1e-10 rad" in card) == (scene.exact().accuracy > 0)


def test_every_column_of_a_model_is_explained():
    for column in (each for model in MODELS.values() for each in model.extra_columns):
        assert head_text(f"{column.head} [m]") == column.about
