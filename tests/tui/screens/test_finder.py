"""The finder finds everything that can be done, and what it finds works."""

import re

from textual.widgets import Input

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.cli.scene import read_scenes
from pendu_tui.tui.drawing.picture import PALETTES
from pendu_tui.tui.screens.dialogs import Choices
from pendu_tui.tui.terminal.options import CHARACTER_SETS
from tests.tui.drawn import screen
from tests.tui.harness import Theatre, lab, until

SIZE = (100, 30)


async def found(theatre: Theatre, words: str) -> list[str]:
    """Type words into the finder, and return the texts of what it lists."""
    await theatre.press("ctrl+p")
    theatre.app.screen.query_one(Input).value = words
    await theatre.pilot.pause()
    return [entry.text for entry in theatre.app.screen.found]


async def test_it_has_themes_pixels_and_scenes_first_then_keys_each_once():
    async with lab(size=SIZE) as theatre:
        texts = await found(theatre, "")
        first = [f"theme {name}" for name in PALETTES]
        first += [f"pixels {name}" for name in CHARACTER_SETS]
        first += [f"scene {name}" for name in SCENES]
        assert texts[: len(first)] == first
        keys = {entry.text: entry.key for entry in theatre.app.screen.found[len(first) :]}
        assert (keys["larger step h"], keys["view: Phase space"]) == ("+", "F3")
        assert len(texts) == len(set(texts))
        assert "continue a replay live" not in texts
        assert not any("Textual" in text or "Focus" in text for text in texts)


async def test_words_are_found_by_their_beginnings_in_names_and_sentences():
    async with lab(size=SIZE) as theatre:
        await theatre.press("P", "x")
        assert theatre.app.screen.query_one(Input).value == "scene x"
        await theatre.press("escape")
        for words, first, number in (
            ("scene bloch", "scene mean-field", 1),  # a word of what it shows
            ("PIXELS half", "pixels half", 1),
            ("double", "double speed", None),  # before scenes in whose sentences it is
            ("ouble speed", None, 0),
        ):
            texts = await found(theatre, words)
            assert number in (None, len(texts))
            assert first in (None, *texts[:1])
            await theatre.press("ctrl+p")
            assert theatre.app.screen is theatre.stage
        await found(theatre, "larger step")
        row = "".join(cell for cell, _ in screen(theatre.app)[3])
        assert row.startswith("│ larger step h  ")
        assert row.endswith("  + │")


async def test_what_is_found_is_done_by_enter_or_by_a_click(here):

    async def do(words, *keys):
        await found(theatre, words)
        await theatre.press(*keys, "enter")
        assert theatre.app.screen is theatre.stage

    async with lab(size=SIZE) as theatre:
        await do("scene crossover")
        assert theatre.scene == SCENES["crossover"]
        assert not theatre.playhead.paused
        for keys, theme in (("pagedown up", "high-contrast"), ("down down pageup down", "light")):
            await do("theme", *keys.split())
            assert theatre.app.theme == theme
        await found(theatre, "double speed")
        await theatre.click(Choices, 3, 0)
        assert theatre.playhead.speed == 2 * SCENES["crossover"].speed
        await do("pixels half")
        assert not re.search("[⠁-⣿]", theatre.app.export_screenshot())
        await theatre.press("e", "1", "-", "n", "b")
        await do("scene file")
        await until(theatre.pilot, (here / "scene.toml").exists)
        stepping = theatre.source.stepping
        (scene,) = read_scenes(here / "scene.toml").values()
        assert (scene.h, scene.cast) == (stepping.smallest, SCENES["crossover"].cast)
        assert scene.shot == theatre.stage.shown.shot(scene, "lab", equal_cost=True)


async def test_keys_and_clicks_that_are_faster_than_the_list_do_no_harm(monkeypatch):
    async with lab(size=SIZE) as theatre:
        assert not Choices("one").check_action("page_down", ())  # before it is drawn
        await found(theatre, "no such thing")
        await theatre.press("pagedown", "down", "enter")
        choices = theatre.app.screen.query_one(Choices)
        choices.add_options(["one", "two"])
        # the list is emptied between a click and its arrival
        monkeypatch.setattr(type(choices), "option_count", 0)
        await theatre.click(Choices, 3, 0)
        assert theatre.app.screen is not theatre.stage
