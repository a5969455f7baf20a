"""The palette finds everything, and what it finds works."""

import asyncio
import re

import pytest
from textual.command import CommandList
from textual.widgets import Input

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.cli.scene import read_scenes
from pendu_tui.tui.drawing.picture import PALETTES
from pendu_tui.tui.screens.palette import LabCommands, entries
from pendu_tui.tui.terminal.options import CHARACTER_SETS
from tests.tui.harness import Theatre, lab


async def found(theatre: Theatre, words: str) -> None:
    """Type words into the palette and take the first that it finds."""
    await theatre.press("ctrl+p")
    theatre.app.screen.query_one(Input).value = words
    options = theatre.app.screen.query_one(CommandList)
    async with asyncio.timeout(20):
        while not (options.option_count and words in str(options.get_option_at_index(0).prompt)):
            await theatre.pilot.pause(0.02)
    await theatre.press("enter")
    await theatre.pilot.pause(0.1)


async def test_it_has_themes_pixels_and_scenes_first_then_keys_and_all_else():
    async with lab() as theatre:
        listed = list(entries(theatre.stage))
        texts = [entry.text for entry in listed]
        first = [f"theme {name}" for name in PALETTES]
        first += [f"pixels {name}" for name in CHARACTER_SETS]
        first += [f"scene {name}" for name in SCENES]
        assert texts[: len(first)] == first
        assert {entry.about for entry in listed} >= {scene.watch for scene in SCENES.values()}
        keys = {entry.text: entry.key for entry in listed[len(first) :]}
        assert (keys["larger step h"], keys["smaller step h"]) == ("+", "-")
        assert {"view: Phase space", "save what I see as a scene file"} <= keys.keys()
        assert len(texts) == len(set(texts))


@pytest.mark.parametrize(
    ("stumbles", "keys"),
    [
        ("action_page_down", ["ctrl+p", "pagedown"]),
        ("clear_options", ["ctrl+p", "t"]),  # in the worker that searches
    ],
)
async def test_where_textuals_palette_stumbles_it_is_closed_and_not_the_lab(
    monkeypatch, stumbles, keys
):
    def stumble(self):
        raise KeyError(0)

    monkeypatch.setattr(CommandList, stumbles, stumble)
    async with lab() as theatre:
        await theatre.press(*keys)
        async with asyncio.timeout(20):
            while theatre.app.screen is not theatre.stage:
                await theatre.pilot.pause(0.02)
        assert theatre.app.is_running


@pytest.mark.parametrize("width", [60, 100])
async def test_an_entry_is_one_line_with_its_key_in_the_last_column(width):
    async with lab(size=(width + 8, 30)) as theatre:
        texts = [hit.text async for hit in LabCommands(theatre.stage).discover()]
        assert {len(text) for text in texts} == {width}
        assert any(text.endswith("   ctrl+p") for text in texts)


async def test_words_are_found_by_their_beginnings_in_names_and_sentences():
    async with lab() as theatre:

        async def hits(query):
            return [hit.text.split()[1] async for hit in LabCommands(theatre.stage).search(query)]

        assert await hits("scene prob") == ["mean-field"]  # "of the probability is gone"
        assert "crossover" not in await hits("hold")  # as letters, it has them
        assert await hits("HALF block") == []
        assert (await hits("pixels half")) == ["half"]


async def test_pixels_are_switched_on_the_running_screen():
    async with lab(size=(100, 30)) as theatre:
        await theatre.run(1)
        assert "⣿" in theatre.app.export_screenshot()
        await found(theatre, "pixels half")
        await theatre.pilot.pause()
        assert not re.search("[⠁-⣿]", theatre.app.export_screenshot())


async def test_a_scene_a_theme_a_key_and_what_has_no_key_can_be_chosen(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    async with lab(size=(100, 30)) as theatre:
        await found(theatre, "scene crossover")
        assert theatre.source.scene == SCENES["crossover"]
        assert not theatre.source.playhead.paused
        await found(theatre, "theme light")
        assert theatre.app.theme == "light"
        await found(theatre, "double speed")
        assert theatre.source.playhead.speed == 2 * SCENES["crossover"].speed
        await theatre.press("e", "1", "-")
        await found(theatre, "save what I see")
        (scene,) = read_scenes(tmp_path / "scene.toml").values()
        assert (scene.h, scene.cast) == (0.1, SCENES["crossover"].cast)
        front = [scene.cast[place].key for place in theatre.stage.shown.places(scene.cast)]
        assert (scene.shot.quantity, [*scene.shot.front]) == ("theta_error", front)
        assert len(front) < len(scene.cast)
