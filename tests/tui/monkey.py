"""A monkey at the keyboard and the mouse: random, and the same for the same seed."""

import random
from collections.abc import Iterator
from contextlib import suppress

from textual._xterm_parser import XTermParser
from textual.events import Key

from tests.tui.harness import Theatre
from tests.tui.pty_lab import PtyLab
from tui.screens.keys import COMMON, LIVE, REPLAY
from tui.views.accuracy import pane as accuracy
from tui.views.phase import pane as phase
from tui.views.stability import pane as stability

SIZE = COLUMNS, ROWS = 120, 40  # the key line is last, where a click on Quit would end it all
SENT = {  # what a terminal sends for keys that are no characters
    "left": "\x1b[D",
    "right": "\x1b[C",
    "up": "\x1b[A",
    "down": "\x1b[B",
    "shift+left": "\x1b[1;2D",
    "shift+right": "\x1b[1;2C",
    "shift+up": "\x1b[1;2A",
    "shift+down": "\x1b[1;2B",
    "home": "\x1b[H",
    "end": "\x1b[F",
    "pgup": "\x1b[5~",
    "pgdn": "\x1b[6~",
    "enter": "\r",
    "tab": "\t",
    "space": " ",
}
VIEWS = ["\x1bOQ", "\x1bOR", "\x1bOS", "\x1b[15~"]  # F2 to F5
KEYS = [
    SENT.get(key.shown or key.names, key.shown or key.names)
    for key in (*COMMON, *LIVE, *REPLAY, *phase.KEYS, *stability.KEYS, *accuracy.KEYS)
    if key.shown not in ("q", "ctrl+z", "ctrl+p", "f", "esc", "arrows", "shift+arrows")
]
CALMING = "<<00++rp   "  # else the lab would soon stand still, or run fast with tiny steps and take long to verify
TYPED = "0123456789.-edg\x7f"
BATCH, EPISODE = 10, 60  # presses at once; and until what lies over the lab is closed
PAUSE = 0.03  # s after a batch
ESCDELAY = "20"  # ms; Textual's name for how long it waits after an escape, which may begin something longer
ESC, PALETTE = "\x1b", "\x10"
ESCAPE = 0.15  # s after one; Textual looks every 0.1 s whether there is more to come
STRIDES = (0.0, 1 / 30, 1 / 30, 0.2)  # s of the clock from one press to the next, on a stage


def press(chance: random.Random) -> str:
    """A key or something with the mouse, as a terminal sends it."""

    def mouse(button: int, end: str) -> str:
        return f"\x1b[<{button};{chance.randint(1, COLUMNS)};{chance.randint(1, ROWS - 1)}{end}"

    match chance.choices(("key", "calm", "view", "text", "click", "drag", "wheel"), (60, 8, 5, 5, 15, 5, 2))[0]:
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


def presses(number: int, seed: int) -> Iterator[str]:
    """All that it does, one after the other; now and then it closes what lies over the lab."""
    chance = random.Random(seed)
    for done in range(number):
        if done % EPISODE == 0:
            if done % (10 * EPISODE) == 0:
                yield PALETTE
                yield "".join(chance.choices("aemnstv ", k=3))  # the palette finds, but does nothing
            yield ESC
            yield ESC
        if done == number // 2:
            yield from (ESC, ESC, "f")  # a replay goes on live
        yield press(chance)


def play(pendu: PtyLab, number: int, seed: int) -> int:
    """Let the monkey play on the real program, then quit; returns the exit code."""
    for done, typed in enumerate(presses(number, seed)):
        pendu.type(typed)
        if typed in (ESC, PALETTE):
            pendu.run(ESCAPE)
        elif done % BATCH == 0:
            pendu.run(PAUSE)
    for _ in range(20):
        pendu.type(ESC)
        pendu.run(ESCAPE)
        pendu.type("q")
        with suppress(TimeoutError):
            return pendu.end(1.0)
    raise TimeoutError("it does not quit")


async def play_on_stage(theatre: Theatre, number: int, seed: int) -> None:
    """Let the monkey play where nothing depends on how fast the machine is."""
    app, parser, chance = theatre.app, XTermParser(), random.Random(-seed)
    driver = app._driver
    assert driver is not None
    for typed in presses(number, seed):
        for message in [Key("escape", None)] if typed == ESC else parser.feed(typed):
            driver.process_message(message)
        await still(theatre)
        if stride := chance.choice(STRIDES):
            theatre.now += stride
            theatre.stage.frame()
            await still(theatre)
        if app._exception is not None:  # leaving the stage raises it
            return


async def still(theatre: Theatre) -> None:
    """Wait for what was asked for, in other threads, too."""
    await theatre.pilot.pause(0)
    while not all(worker.is_finished for worker in theatre.app.workers if worker.group != "chart"):
        await theatre.pilot.pause(0.001)
