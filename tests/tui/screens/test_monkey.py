"""Hundreds of random events over all views, live and replay, the same for the same seed."""

import itertools
import os
import random
import string
from collections.abc import Iterator
from functools import partial

import pytest
from textual._xterm_parser import XTermParser
from textual.events import Key, Resize
from textual.geometry import Size

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.engine.studies.accuracy import ladder
from pendu_tui.recordings.files import new_path
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from tests.tui.harness import on_stage

pytestmark = pytest.mark.slow

SEED = int(os.environ.get("PENDU_MONKEY", "1"))
ESC, FIND = "\x1b", "\x10"
KEYS = [f"\x1b[{key}" for key in ("A", "B", "C", "D", "H", "F", "5~", "6~", "15~")]
KEYS += ["\x1bOQ", "\x1bOR", "\x1bOS", *string.printable, "\x7f", FIND, "\r"]
KEYS += "<<++rp   "  # else the lab would often be paused, or take long to verify
GARBAGE = "aeq0.-~\t\r\n\x00\x07\x1b[]{}()\\/%<>|\xa0\u2067é漢🙂\u0301\udc80"
KINDS = {"key": 75, "click": 12, "drag": 4, "wheel": 2, "paste": 3, "size": 6}
EPISODE = 60  # presses until dialogs are closed
LOOK = 0.004  # s by which the work clock advances when it is read, so that a frame's budget ends
STRIDES = (0.0, 1 / 30, 0.1)  # s of the clock from one frame to the next


def wild_presses(number: int, seed: int) -> Iterator[str | tuple[int, int]]:
    """Yield what a terminal sends, and sizes."""
    chance = random.Random(seed)
    size = (120, 40)

    def mouse(button: int, end: str) -> str:
        return f"\x1b[<{button};{chance.randint(1, size[0])};{chance.randint(1, size[1])}{end}"

    for done in range(number):
        if done % EPISODE == 0:
            yield from (ESC, ESC)
        match chance.choices([*KINDS], KINDS.values())[0]:
            case "click":
                down = mouse(0, "M")
                yield down + down[:-1] + "m"
            case "drag":
                button = chance.choice((0, 4, 2))  # left, with shift, right
                yield mouse(button, "M") + mouse(button + 32, "M") + mouse(button, "m")
            case "wheel":
                yield mouse(chance.choice((64, 65)), "M")
            case "paste":
                garbage = "".join(chance.choices(GARBAGE, k=chance.choice((1, 9, 999))))
                yield f"\x1b[200~{garbage}\x1b[201~"
            case "size":
                size = chance.randint(1, 300), chance.randint(1, 90)
                yield size
            case _:
                yield chance.choice(KEYS)


@pytest.mark.parametrize(
    "source",
    [partial(Live, DEFAULT_SCENE), lambda clock: Replay(Recording.open(resolve("drift")), clock)],
    ids=["live", "replay"],
)
async def test_random_events_do_no_harm_and_the_recordings_verify(here, monkeypatch, source):
    few = ladder(5.0, 0.2, 0.05, 2)
    monkeypatch.setattr("pendu_tui.tui.views.accuracy.usual", lambda scene, all: (5.0, few))
    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", (2, 6))
    monkeypatch.setattr(PenduApp, "exit", lambda self, code=0: None)  # q and ctrl+c are found, too

    def make(clock):
        screen = LabScreen(source(clock=itertools.count(0.0, LOOK).__next__), clock)
        screen.record = lambda live: live.record(LiveRecorder(new_path(here)))
        return screen

    parser = XTermParser()
    strides = random.Random(-SEED)
    async with on_stage(make, (120, 40)) as theatre:
        app = theatre.app
        for sent in [*wild_presses(160, SEED), ESC, ESC, "f"]:
            if isinstance(sent, tuple):
                app._driver._size = sent
                app.post_message(Resize(Size(*sent), Size(*sent)))
            elif sent == ESC:
                app._driver.process_message(Key("escape", None))
            else:
                for message in parser.feed(sent):
                    app._driver.process_message(message)
            for _ in range(2):  # the same on any machine
                await theatre.pilot.pause(0)
                while not all(worker.is_finished for worker in app.workers):
                    await theatre.pilot.pause(0.001)
                theatre.frames(seconds=strides.choice(STRIDES))
        assert app.is_running
    for path in here.glob("*.[mp]*"):
        assert path.suffix == ".mcap"
        assert verify(path).identical
