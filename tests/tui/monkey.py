"""A monkey at the keyboard and the mouse: random, and the same for the same seed."""

import itertools
import random
import string
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest.mock import patch

from textual._xterm_parser import XTermParser
from textual.events import Key, Resize
from textual.geometry import Size

from engine.accuracy.study import ladder
from engine.scenes import DEFAULT_SCENE, Scene
from recordings.library import new_path
from recordings.recorder import LiveRecorder
from tests.tui.conftest import computed_here
from tests.tui.harness import Theatre
from tui.playback.live import Live
from tui.screens.live import LiveScreen

SIZE = 120, 40
LARGEST = 300, 90
VIEWS = ["\x1bOQ", "\x1bOR", "\x1bOS", "\x1b[15~"]  # F2 to F5
MOVES = [f"\x1b[{key}" for key in ("A", "B", "C", "D", "H", "F", "5~", "6~")]
KEYS = [*"<>,.[]m1234567tewyzvEdsu?+-piMrnbTPLgx* \r\t", *MOVES]
CALMING = "<<00++rp   "  # else the lab would stand still, or take long to verify
TYPED = "0123456789.-edg\x7f"
EPISODE = 60  # presses until what lies over the lab is closed
ESC, PALETTE = "\x1b", "\x10"
OVERLAYS = ("?", "i", "d", "E", PALETTE)
GARBAGE = "aeq0.-~\t\r\n\x00\x07\x1b[]{}()\\/%<>|\xa0\u2067é漢🙂\u0301\udc80"
LOOK = 0.004  # s that seem to pass between two looks at the clock, so that a frame's budget ends
STRIDES = (0.0, 1 / 30, 1 / 30, 0.2)  # s of the clock from one press to the next, on a stage


def press(chance: random.Random, size: tuple[int, int] = SIZE) -> str:
    """A key or something with the mouse, as a terminal of this size sends it."""

    def mouse(button: int, end: str) -> str:
        column = chance.randint(1, size[0])
        row = chance.randint(1, max(size[1] - 1, 1))  # not the key line: Quit would end it all
        return f"\x1b[<{button};{column};{row}{end}"

    kinds = {"key": 60, "calm": 8, "view": 5, "text": 5, "click": 15, "drag": 5, "wheel": 2}
    match chance.choices([*kinds], kinds.values())[0]:
        case "key":
            return chance.choice(KEYS)
        case "calm":
            return chance.choice(CALMING)
        case "view":
            return chance.choice(VIEWS)
        case "text":
            return "".join(chance.choices(TYPED, k=4))
        case "click":
            down = mouse(0, "M")
            return down + down[:-1] + "m"
        case "drag":
            button = chance.choice((0, 4, 2))  # left, with shift, right
            return mouse(button, "M") + mouse(button + 32, "M") + mouse(button, "m")
        case _:
            return mouse(chance.choice((64, 65)), "M")


def wild_presses(number: int, seed: int) -> Iterator[str | tuple[int, int]]:
    """Presses, dialogs, the palette and what it offers, pasted garbage, text, and other sizes."""
    chance, size = random.Random(seed), SIZE
    for done in range(number):
        if done % EPISODE == 0:
            yield from (ESC, ESC)
        kinds = {"press": 70, "over": 6, "type": 8, "enter": 4, "paste": 3, "size": 9}
        match chance.choices([*kinds], kinds.values())[0]:
            case "press":
                yield press(chance, size)
            case "over":
                yield chance.choice(OVERLAYS)
            case "type":
                yield chance.choice(string.ascii_lowercase + string.digits + "\x7f. ")
            case "enter":
                yield "\r"
            case "paste":
                garbage = "".join(chance.choices(GARBAGE, k=chance.choice((1, 9, 999))))
                yield f"\x1b[200~{garbage}\x1b[201~"
            case _:
                columns, rows = chance.choice((SIZE, (12, 12), LARGEST, LARGEST))
                size = chance.randint(1, columns), chance.randint(1, rows)
                yield size


async def play_on_stage(
    theatre: Theatre, what: Iterable[str | tuple[int, int]], seed: int, batch: int = 1
) -> None:
    """Let the monkey play where nothing depends on how fast the machine is, if the lab may rest after each press."""
    app, parser, chance = theatre.app, XTermParser(), random.Random(-seed)
    driver = app._driver
    assert driver is not None
    for number, did in enumerate(what):
        if isinstance(did, tuple):
            driver._size = did
            app.post_message(Resize(Size(*did), Size(*did)))
        else:
            for message in [Key("escape", None)] if did == ESC else parser.feed(did):
                driver.process_message(message)
        if number % batch:
            continue
        await still(theatre)
        if stride := chance.choice(STRIDES):
            theatre.now += stride
            theatre.stage.frame()
            await still(theatre)
        if not app.is_running:
            return


@contextmanager
def small_studies(library: Path) -> Iterator[None]:
    """F4 and F5 compute little, and here; recordings and pictures go to the library."""
    few = ladder(5.0, 0.2, 0.05, 2)
    with ExitStack() as stack:
        stack.enter_context(patch.dict("os.environ", PENDU_RECORDINGS=str(library)))
        for name, value in (
            ("background.computed", computed_here),
            ("accuracy.pane.usual", lambda scene, all: (5.0, few)),
            ("stability.pane.PASSES", (2, 6)),
        ):
            stack.enter_context(patch(f"tui.views.{name}", value))
        yield


async def still(theatre: Theatre) -> None:
    """Wait for what was asked for, in other threads, too; but not for charts."""
    await theatre.pilot.pause(0)
    while not all(worker.is_finished for worker in theatre.app.workers):
        await theatre.pilot.pause(0.001)


def wild_stage(
    library: Path, scene: Scene = DEFAULT_SCENE
) -> Callable[[Callable[[], float]], LiveScreen]:
    """Makes a lab that is recorded in a library."""

    def make(clock: Callable[[], float]) -> LiveScreen:
        live = Live(scene, clock=itertools.count(0.0, LOOK).__next__)
        live.record(LiveRecorder(new_path(library)))
        return LiveScreen(live, clock)

    return make
