"""Random input of keyboard and mouse, the same for the same seed."""

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

from pendu_tui.engine.scenes import DEFAULT_SCENE, Scene
from pendu_tui.engine.studies.accuracy import ladder
from pendu_tui.recordings.files import new_path
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.lab import LabScreen
from tests.tui.conftest import computed_here
from tests.tui.harness import Theatre

SIZE = 120, 40
LARGEST = 300, 90
VIEWS = ["\x1bOQ", "\x1bOR", "\x1bOS", "\x1b[15~"]  # F2 to F5
MOVES = [f"\x1b[{key}" for key in ("A", "B", "C", "D", "H", "F", "5~", "6~")]
KEYS = [*"<>,.[]m1234567tewyzvEdsu?+-piMrnbTPLgx* \r\t", *MOVES]
CALMING = "<<00++rp   "  # else the lab would often be paused, or take long to verify
TYPED = "0123456789.-edg\x7f"
EPISODE = 60  # presses until dialogs are closed
ESC, PALETTE = "\x1b", "\x10"
OVERLAYS = ("?", "i", "d", "E", PALETTE)
GARBAGE = "aeq0.-~\t\r\n\x00\x07\x1b[]{}()\\/%<>|\xa0\u2067é漢🙂\u0301\udc80"
LOOK = 0.004  # s by which the work clock advances when it is read, so that a frame's budget ends
STRIDES = (0.0, 1 / 30, 1 / 30, 0.2)  # s of the clock from one press to the next


def press(chance: random.Random, size: tuple[int, int] = SIZE) -> str:
    """Return the input of a key or the mouse, as a terminal of this size sends it."""

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
    """Yield keys, mouse input, dialogs, palette commands, pasted garbage, text and sizes."""
    chance = random.Random(seed)
    size = SIZE
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
    """Send input, and let the app settle and the clock advance after each `batch`.

    With a batch of 1 nothing depends on the speed of the machine.
    """
    app = theatre.app
    parser = XTermParser()
    chance = random.Random(-seed)
    driver = app._driver
    assert driver is not None
    for number, item in enumerate(what):
        if isinstance(item, tuple):
            driver._size = item
            app.post_message(Resize(Size(*item), Size(*item)))
        elif item == ESC:
            driver.process_message(Key("escape", None))
        else:
            for message in parser.feed(item):
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
    """Let F4 and F5 compute little and in this process; save recordings and pictures in a library."""
    few = ladder(5.0, 0.2, 0.05, 2)
    with ExitStack() as stack:
        stack.enter_context(patch.dict("os.environ", PENDU_RECORDINGS=str(library)))
        for name, value in (
            ("background.computed", computed_here),
            ("accuracy.usual", lambda scene, all: (5.0, few)),
            ("stability.PASSES", (2, 6)),
        ):
            stack.enter_context(patch(f"pendu_tui.tui.views.{name}", value))
        yield


async def still(theatre: Theatre) -> None:
    """Wait until messages and workers are done; charts may be unfinished."""
    await theatre.pilot.pause(0)
    while not all(worker.is_finished for worker in theatre.app.workers):
        await theatre.pilot.pause(0.001)


def wild_stage(
    library: Path, scene: Scene = DEFAULT_SCENE
) -> Callable[[Callable[[], float]], LabScreen]:
    """Return a function that makes a lab recorded in a library."""

    def make(clock: Callable[[], float]) -> LabScreen:
        live = Live(scene, clock=itertools.count(0.0, LOOK).__next__)
        live.record(LiveRecorder(new_path(library)))
        return LabScreen(live, clock)

    return make
