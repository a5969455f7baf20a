"""Random keys, clicks, drags, pastes, dialogs and terminal sizes in labs of every scene."""

import asyncio
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from traceback import print_exception
from typing import Any
from unittest.mock import patch

from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.screens.app import PenduApp
from tests.tui.harness import on_stage
from tests.tui.monkey import SIZE, play_on_stage, small_studies, wild_presses, wild_stage

LIMITS = {"early_ends": 0, "unfinished": 0, "not_verified": 0}
SITTING = 500  # events in one lab
BATCH = 5  # events at once


async def play(scene: Scene, library: Path, seed: int) -> bool:
    """Play in a lab of a scene; return whether it still runs afterwards."""
    async with on_stage(wild_stage(library, scene), SIZE) as theatre:
        theatre.app.error_console.quiet = True
        try:
            async with asyncio.timeout(600):
                await play_on_stage(theatre, wild_presses(SITTING, seed), seed, BATCH)
            return theatre.app.is_running
        finally:
            theatre.source.close()


def sitting(scene: Scene, seed: int) -> Counter[str]:
    """Return the outcomes of one lab and its recordings."""
    with TemporaryDirectory() as folder:
        library = Path(folder) / "library"
        library.mkdir()
        runs = False
        try:
            with small_studies(library):
                runs = asyncio.run(play(scene, library, seed))
        except (Exception, asyncio.CancelledError) as error:
            print_exception(error, limit=-8)
        recordings = list(library.glob("*.mcap"))
        return Counter(
            early_ends=not runs,
            recordings=len(recordings),
            not_verified=sum(not verify(path).identical for path in recordings),
            unfinished=len(list(library.glob("*.part"))),
        )


def measure(share: float) -> dict[str, Any]:
    scenes = list(SCENES.values())
    counts = Counter(dict.fromkeys(LIMITS, 0))
    sittings = round(60 * share)
    with patch.object(PenduApp, "exit", lambda self: None):  # the monkey also presses `quit`
        for number in range(sittings):
            counts.update(sitting(scenes[number % len(scenes)], seed=1 + number * SITTING))
    return {"events": sittings * SITTING, **counts}
