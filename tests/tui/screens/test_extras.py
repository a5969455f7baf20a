"""The palette finds everything, and what it finds works."""

import asyncio
from pathlib import Path

import pytest
from textual.actions import parse
from textual.command import CommandList

from engine.methods import METHODS, VELOCITY_VERLET
from engine.scenes import SCENES
from recordings.library import GOLDEN, listing
from recordings.live_recorder import LiveRecorder
from tests.tui.harness import Theatre, lab, on_stage
from tui.drawing.palette import PALETTES
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.extras import EXTRAS, palette_entries
from tui.screens.keys import COMMON, LIVE, REPLAY
from tui.screens.launch import open_replay, replay_screen
from tui.screens.live import LiveScreen
from tui.screens.replay import ReplayScreen
from tui.views import VIEWS
from tui.words.cards import method_card
from tui.words.command_line import command

DRIFT = GOLDEN / "drift.mcap"


async def chosen(theatre: Theatre, title: str) -> None:
    """Do what an entry does."""
    stage = theatre.stage
    entries = {entry.title: entry for entry in palette_entries(stage.KEYS, True, [item.path for item in listing()])}
    stage.call_next(stage.run_action, entries[title].action)
    await theatre.pilot.pause()


async def found(theatre: Theatre, words: str) -> None:
    """Type words into the palette and take the first that it finds."""
    await theatre.press("ctrl+p", *["space" if letter == " " else letter for letter in words])
    options = theatre.app.screen.query_one(CommandList)
    async with asyncio.timeout(20):
        while not (options.option_count and words in str(options.get_option_at_index(0).prompt)):
            await theatre.pilot.pause(0.02)
    await theatre.press("enter")
    await theatre.pilot.pause()


def titles(keys=(*LIVE, *COMMON), live=True, recordings=(DRIFT,)) -> list[str]:
    return [entry.title for entry in palette_entries(keys, live, recordings)]


def test_it_has_every_key_scene_view_method_theme_and_recording():
    all_titles = titles()
    for key in (*LIVE, *COMMON):
        assert (f"{key.does} ({key.shown})" in all_titles) == (key.shown != "ctrl+p" and bool(key.does and key.action))
    for name in SCENES:
        assert f"scene {name}" in all_titles
    for view in VIEWS.values():
        assert any(title.startswith(f"{view.title.lower()} view (F") for title in all_titles)
    for method in METHODS:
        assert f"method {method.label}" in all_titles
    for name in PALETTES:
        assert f"theme {name}" in all_titles
    assert {"replay drift", "copy the command for this moment", "quit (q)"} < set(all_titles)
    assert any("SVG" in title for title in all_titles)


def test_a_replay_cannot_be_given_a_scene():
    assert not [title for title in titles((*REPLAY, *COMMON), live=False) if title.startswith("scene ")]


@pytest.mark.parametrize("stage", [LiveScreen, ReplayScreen])
def test_there_is_an_action_behind_every_entry(stage):
    for entry in palette_entries(stage.KEYS, stage is LiveScreen, [Path("it's here.mcap")]):
        where, action, parameters = parse(entry.action)
        assert hasattr(PenduApp if where == "app" else stage, f"action_{action}")
        assert action != "extra" or parameters[0] in EXTRAS


async def test_a_scene_a_theme_and_a_card_can_be_chosen():
    async with lab(size=(100, 30)) as theatre:
        await found(theatre, "scene crossover")
        assert theatre.source.scene == SCENES["crossover"]
        await chosen(theatre, "theme light")
        assert theatre.app.theme == "light"
        await chosen(theatre, "method Velocity Verlet")
        assert theatre.app.screen.text == method_card(VELOCITY_VERLET)


async def test_the_command_is_copied_and_shown():
    async with lab(SCENES["spin"], size=(100, 30)) as theatre:
        await chosen(theatre, "copy the command for this moment")
        assert theatre.app.clipboard == command(theatre.source) == "pendu-tui live --scene spin"
        assert theatre.app.clipboard in [note.message for note in theatre.app._notifications][-1]


async def test_a_recording_is_replayed_and_the_sitting_before_it_is_finished(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    (tmp_path / "earlier.mcap").write_bytes(DRIFT.read_bytes())
    live = Live(SCENES["spin"], clock=lambda: 0.0)
    live.record(LiveRecorder(tmp_path / "now.mcap"))
    async with on_stage(lambda clock: LiveScreen(live, clock), (100, 30)) as theatre:
        theatre.app.open_replay = lambda path: replay_screen(open_replay(path), no_record=True)
        offered = [command.title for command in theatre.app.get_system_commands(theatre.stage)]
        assert {"replay earlier", "replay drift", "replay spin"} <= set(offered)
        await theatre.run(1)
        await chosen(theatre, "replay earlier")
        assert theatre.source.kind == "REPLAY"
        assert theatre.source.recording.path.name == "earlier.mcap"
        assert (tmp_path / "now.mcap").exists()
        assert f"Recorded: {tmp_path / 'now.mcap'}" in [note.message for note in theatre.app._notifications]
        assert [stage.source.kind for stage in theatre.app.source_screens] == ["LIVE", "REPLAY"]
        theatre.source.close()


async def test_a_file_that_is_no_recording_changes_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    (tmp_path / "broken.mcap").write_bytes(b"nothing")
    async with lab(size=(100, 30)) as theatre:
        theatre.app.open_replay = lambda path: replay_screen(open_replay(path), no_record=True)
        await chosen(theatre, "replay broken")
        assert theatre.source.kind == "LIVE"
        assert "broken.mcap" in [note.message for note in theatre.app._notifications][-1]
