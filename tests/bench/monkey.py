"""Random keys, clicks, drags, pastes, dialogs and sizes in labs of every scene: one JSON object.

python tests/bench/monkey.py [--events N] [--seed N]
"""

import argparse
import asyncio
import json
import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from traceback import extract_tb, print_exception
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).parents[2]))

from engine.scenes import SCENES, Scene
from recordings.verification import verify
from tests.tui.harness import on_stage
from tests.tui.monkey import (
    SIZE,
    play_on_stage,
    small_studies,
    wild_presses,
    wild_stage,
)
from tui.screens.app import PenduApp

SITTING, BATCH = 500, 5  # events


async def play(scene: Scene, library: Path, events: int, seed: int) -> bool:
    """Play in a lab of a scene; returns whether it still runs then."""
    async with on_stage(wild_stage(library, scene), SIZE) as theatre:
        theatre.app.error_console.quiet = True
        try:
            async with asyncio.timeout(600):
                await play_on_stage(theatre, wild_presses(events, seed), seed, BATCH)
            return theatre.app.is_running
        finally:
            theatre.source.close()


def sitting(scene: Scene, events: int, seed: int) -> Counter[str]:
    """Return what becomes of one lab and its recordings."""
    with TemporaryDirectory() as folder:
        library = Path(folder) / "library"
        library.mkdir()
        try:
            with small_studies(library):
                ended = not asyncio.run(play(scene, library, events, seed))
            counts = Counter(events=events, early_ends=ended)
        except Exception as error:
            place = extract_tb(error.__traceback__)[-1]
            name = f"{type(error).__name__} {Path(place.filename).name}:{place.lineno} seed {seed}"
            print_exception(error, limit=-8)
            counts = Counter({"events": events, "early_ends": 1, name: 1})
        recordings = list(library.glob("*.mcap"))
        unfinished = list(library.glob("*.part"))
        verified = sum(verify(path).identical for path in recordings)
        return counts + Counter(
            recordings=len(recordings), verified=verified, unfinished=len(unfinished)
        )


def main() -> None:
    """Play, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--events", type=int, default=30_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    began = time.monotonic()
    scenes = list(SCENES.values())
    counts: Counter[str] = Counter()
    with patch.object(PenduApp, "exit", lambda self: None):  # it finds `quit`, too
        for number, first in enumerate(range(0, options.events, SITTING)):
            scene = scenes[number % len(scenes)]
            counts += sitting(scene, min(SITTING, options.events - first), options.seed + first)
    seconds = round(time.monotonic() - began)
    print(json.dumps({"bench": "monkey", "seed": options.seed, "seconds": seconds, **counts}))


if __name__ == "__main__":
    main()
