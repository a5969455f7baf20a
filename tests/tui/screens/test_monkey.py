"""Hundreds of random events over all views, live and replay."""

import itertools
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from pendu_tui.recordings.files import new_path
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from tests.tui.harness import on_stage
from tests.tui.monkey import ESC, LOOK, SIZE, play_on_stage, small_studies, wild_presses, wild_stage

pytestmark = [pytest.mark.other_process, pytest.mark.slow]  # what is computed is left again at once

SEED = int(os.environ.get("PENDU_MONKEY", "1"))


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Path]:
    folder = tmp_path / "library"
    folder.mkdir()
    with small_studies(folder):
        yield folder


@pytest.mark.parametrize("command", ["live", "replay"])
async def test_random_events_do_no_harm_and_the_recordings_verify(
    tmp_path, library, monkeypatch, command
):
    monkeypatch.setattr(PenduApp, "exit", lambda self: None)  # it finds `quit`, too

    def replayed(clock: Callable[[], float]) -> LabScreen:
        path = Path(shutil.copy(resolve("drift"), tmp_path))  # marks are kept beside it
        replay = Replay(Recording.open(path), clock=itertools.count(0.0, LOOK).__next__)
        screen = LabScreen(replay, clock)
        screen.record = lambda live: live.record(LiveRecorder(new_path(library)))
        return screen

    make = {"live": wild_stage(library), "replay": replayed}[command]
    events = [*wild_presses(80, SEED), ESC, ESC, "f", *wild_presses(80, SEED + 1)]
    async with on_stage(make, SIZE) as theatre:
        await play_on_stage(theatre, events, SEED)
        assert theatre.app.is_running
    paths = list(library.glob("*.[mp]*"))
    assert paths
    for path in paths:
        assert path.suffix == ".mcap"
        assert verify(path).identical
