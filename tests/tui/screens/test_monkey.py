"""Hundreds of random keys and clicks over all views, live and replay; tests/bench/monkey.py presses more of them."""

import itertools
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from recordings.recorder import LiveRecorder
from recordings.recording import Recording
from recordings.verification import verify
from tests.tui.harness import on_stage
from tests.tui.monkey import (
    LOOK,
    SIZE,
    play_on_stage,
    presses,
    small_studies,
    wild_presses,
    wild_stage,
)
from tui.cli.options import resolve
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.screens.app import PenduApp
from tui.screens.base import SourceScreen
from tui.screens.live import LiveScreen
from tui.screens.replay import ReplayScreen

pytestmark = [pytest.mark.other_process, pytest.mark.slow]  # what is computed is left again at once

PRESSES, WILD = 200, 120
SEED = int(os.environ.get("PENDU_MONKEY", "1"))


def all_verify(library: Path) -> int:
    """How many recordings there are; all of them are finished, and the same bits come out again."""
    recordings = list(library.glob("*.[mp]*"))
    for path in recordings:
        assert path.suffix == ".mcap"
        assert verify(path).identical
    return len(recordings)


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Path]:
    folder = tmp_path / "library"
    folder.mkdir()
    with small_studies(folder):
        yield folder


async def test_random_keys_and_clicks_do_no_harm_and_the_recording_verifies(tmp_path, library):
    def recorded(live: Live) -> Live:
        live.record(LiveRecorder(library / f"{live.sample.step}.mcap"))
        return live

    def make(clock: Callable[[], float]) -> SourceScreen:
        looks = itertools.count(0.0, LOOK).__next__
        path = Path(shutil.copy(resolve("drift"), tmp_path))  # marks are kept beside it
        replay = Replay(Recording.open(path), clock=looks)
        return ReplayScreen(replay, lambda live: LiveScreen(recorded(live), clock), clock)

    async with on_stage(make, SIZE) as theatre:
        await play_on_stage(theatre, presses(PRESSES, SEED), SEED)
        assert theatre.stage.source.kind == "LIVE"
        theatre.source.close()
    assert all_verify(library) == 1


async def test_dialogs_the_palette_pasted_garbage_and_all_sizes_do_no_harm_either(
    library, monkeypatch
):
    monkeypatch.setattr(PenduApp, "exit", lambda self: None)  # it finds `quit`, too
    async with on_stage(wild_stage(library), SIZE) as theatre:
        await play_on_stage(theatre, wild_presses(WILD, SEED), SEED)
        assert theatre.app.is_running
        theatre.source.close()
        recorded = [
            each.source.recorder
            for each in theatre.app.source_screens
            if each.source.kind == "LIVE"
        ]
    assert all_verify(library) == len(recorded)
