"""Cards show what METHODS and SCENES hold, and nothing else."""

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.words.cards import (
    GLOSSARY,
    HEADS,
    glossary,
    head_text,
    method_card,
    scene_card,
)


def test_cards_as_they_are_stored(snapshot):
    keys = ("explicit_euler", "forest_ruth", "backward_euler", "halving_verlet")
    cards = [method_card(each) for each in METHODS if each.key in keys]
    scene = SCENES["damped"].altered(gravity=5.0)
    scenes = (scene, SCENES["halving"], SCENES["mean-field"])
    cards += [*map(scene_card, scenes), glossary()]
    cards += [f"{head}: {head_text(f'{head} [m]')}" for head in HEADS if head not in GLOSSARY]
    snapshot("cards.txt", "\n\n".join(cards))
