"""Random keys, clicks, texts, dialogs and sizes in the lab, and what they break: one JSON object.

python tests/bench/monkey.py [EVENTS] [SEED]
"""

import asyncio
import json
import sys
import time
import traceback
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

from textual.pilot import WaitForScreenTimeout

from recordings.verification import verify
from tests.tui.harness import on_stage
from tests.tui.monkey import SIZE, play_on_stage, small_studies, wild_presses, wild_replay, wild_stage
from tui.screens.app import PenduApp
from tui.terminal import fault_log

EVENTS, SITTING, BATCH = 100_000, 2500, 5


async def sitting(folder: Path, events: int, seed: int) -> tuple[bool, int]:
    """Play in a lab; whether it still lives then, and how many recordings there are, all of which verify."""
    library = folder / "library"
    library.mkdir()
    with small_studies(library):
        async with on_stage(wild_stage(library), SIZE) as theatre:
            theatre.app.open_replay = wild_replay(library, lambda: theatre.now)
            try:
                await play_on_stage(theatre, wild_presses(events, seed), seed, BATCH)
                lives = theatre.app.is_running
            except WaitForScreenTimeout:  # 30 s without an answer from some widget
                lives = False
                for task in asyncio.all_tasks():
                    task.print_stack(limit=3)
            theatre.source.close()
    recordings = list(library.glob("*.mcap"))
    assert not list(library.glob("*.part"))
    assert all(verify(path).identical for path in recordings)
    return lives, len(recordings)


def main() -> None:
    """Play, and print."""
    events, seed = (int(text) for text in (*sys.argv[1:], *map(str, (EVENTS, 1)[len(sys.argv) - 1 :])))
    faults, ends, recordings, began = Counter[str](), 0, 0, time.monotonic()

    def told(path: Path, error: BaseException) -> None:
        text = "".join(traceback.format_exception(error))
        if text not in faults:
            print(text, file=sys.stderr)
        faults[text] += 1

    with patch.object(fault_log, "append", told), patch.object(PenduApp, "exit", lambda self: None):
        for first in range(0, events, SITTING):
            with TemporaryDirectory() as folder:
                lives, files = asyncio.run(sitting(Path(folder), min(SITTING, events - first), seed + first))
            ends, recordings = ends + (not lives), recordings + files
            done = {"events": min(first + SITTING, events), "seconds": round(time.monotonic() - began)}
            print(json.dumps({**done, "ends": ends, "faults": len(faults)}), file=sys.stderr, flush=True)
    report = {"benchmark": "monkey", "events": events, "seed": seed, "ends": ends, "faults": len(faults)}
    print(json.dumps({**report, "recordings_that_verify": recordings, "seconds": round(time.monotonic() - began)}))


if __name__ == "__main__":
    main()
