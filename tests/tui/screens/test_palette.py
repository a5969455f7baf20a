"""The palette finds everything, and what it finds works."""

import asyncio

import pytest
from textual.command import CommandList

from engine.methods import METHODS, VELOCITY_VERLET
from engine.scenes import SCENES
from recordings.library import GOLDEN
from recordings.recorder import LiveRecorder
from tests.tui.harness import Theatre, lab, on_stage
from tui.drawing.palette import PALETTES
from tui.playback.live import Live
from tui.screens.launch import open_replay, replay_screen
from tui.screens.live import LiveScreen
from tui.screens.palette import KEY_WIDTH, Entry, entries, line
from tui.words.cards import method_card
from tui.words.command_line import command

DRIFT = GOLDEN / "drift.mcap"


async def found(theatre: Theatre, words: str) -> None:
    """Type words into the palette and take the first that it finds."""
    await theatre.press("ctrl+p", *["space" if letter == " " else letter for letter in words])
    options = theatre.app.screen.query_one(CommandList)
    async with asyncio.timeout(20):
        while not (options.option_count and words in str(options.get_option_at_index(0).prompt)):
            await theatre.pilot.pause(0.02)
    await theatre.press("enter")
    await theatre.pilot.pause(0.1)


async def test_it_has_themes_and_scenes_first_then_keys_with_their_letters_and_all_else():
    async with lab() as theatre:
        listed = list(entries(theatre.stage))
        texts = [entry.text for entry in listed]
        first = len(PALETTES) + len(SCENES)
        assert texts[: len(PALETTES)] == [f"theme {name}" for name in PALETTES]
        assert all(text.startswith("scene ") for text in texts[len(PALETTES) : first])
        keys = {entry.text: entry.key for entry in listed[first:]}
        assert (keys["larger step h"], keys["smaller step h"]) == ("+", "-")
        assert {
            "view: Phase space",
            "chart: zoom out",
            "copy the command for this moment",
        } <= keys.keys()
        assert {f"method {method.label}" for method in METHODS} <= keys.keys()
        assert len(texts) == len(set(texts))


async def test_a_key_that_textuals_palette_stumbles_over_closes_it_and_not_the_lab(monkeypatch):
    def stumble(self):
        raise KeyError(0)

    monkeypatch.setattr(CommandList, "action_page_down", stumble)
    async with lab() as theatre:
        await theatre.press("ctrl+p", "pagedown")
        await theatre.pilot.pause(0.1)
        assert theatre.app.is_running
        assert theatre.app.screen is theatre.stage


@pytest.mark.parametrize("width", [40, 72, 100])
def test_an_entry_is_one_line_with_its_key_in_the_last_column(width):
    for text in ("short", "long " * 40):
        drawn = line(Entry(text, "", "ctrl+p"), width)
        assert len(drawn) == width
        assert drawn.endswith("ctrl+p".rjust(KEY_WIDTH))


async def test_a_scene_a_theme_a_key_and_a_card_can_be_chosen():
    async with lab(size=(100, 30)) as theatre:
        await found(theatre, "scene crossover")
        assert theatre.source.scene == SCENES["crossover"]
        assert not theatre.source.playhead.paused
        await found(theatre, "theme light")
        assert theatre.app.theme == "light"
        await found(theatre, "double speed")
        assert theatre.source.playhead.speed == 2 * SCENES["crossover"].speed
        await found(theatre, "method Velocity Verlet")
        assert theatre.app.screen.text == method_card(VELOCITY_VERLET)


async def test_what_has_no_key_lies_there():
    async with lab(size=(100, 30)) as theatre:
        await theatre.press("greater_than_sign")
        await found(theatre, "normal speed")
        assert theatre.source.playhead.speed == 1
        await found(theatre, "copy the command")
        assert theatre.app.clipboard == command(theatre.source) == "pendu-tui live --scene drift"


async def test_a_recording_is_replayed_and_the_lab_before_it_is_finished(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    (tmp_path / "earlier.mcap").write_bytes(DRIFT.read_bytes())
    live = Live(SCENES["spin"], clock=lambda: 0.0)
    live.record(LiveRecorder(tmp_path / "now.mcap"))
    async with on_stage(lambda clock: LiveScreen(live, clock), (100, 30)) as theatre:
        theatre.app.open_replay = lambda path: replay_screen(open_replay(path), no_record=True)
        await theatre.run(1)
        await found(theatre, "replay earlier")
        assert theatre.source.kind == "REPLAY"
        assert theatre.source.recording.path.name == "earlier.mcap"
        assert (tmp_path / "now.mcap").exists()
        assert [stage.source.kind for stage in theatre.app.source_screens] == ["LIVE", "REPLAY"]
        assert not [entry for entry in entries(theatre.stage) if entry.text.startswith("scene ")]
        theatre.source.close()


async def test_a_file_that_is_no_recording_changes_nothing(tmp_path):
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(b"nothing")
    async with lab(size=(100, 30)) as theatre:
        theatre.app.open_replay = lambda path: replay_screen(open_replay(path), no_record=True)
        theatre.stage.action_replay(str(broken))
        await theatre.pilot.pause()
        assert theatre.source.kind == "LIVE"
