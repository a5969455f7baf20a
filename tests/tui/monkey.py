"""A monkey at the keyboard and the mouse of the real program: random, and the same for the same seed."""

import random
from contextlib import suppress

from tests.tui.pty_lab import PtyLab
from tui.keys import COMMON, LIVE, REPLAY
from tui.widgets import accuracy, phase, stability

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
    if key.shown not in ("q", "ctrl+z", "ctrl+p", "esc", "arrows", "shift+arrows")
]
CALMING = "<<00++rp   "  # else the lab would soon stand still, or run fast with tiny steps and take long to verify
TYPED = "0123456789.-edg\x7f"
BATCH, EPISODE = 10, 60  # presses at once; and until what lies over the lab is closed
PAUSE = 0.03  # s after a batch
ESCDELAY = "20"  # ms; Textual's name for how long it waits after an escape, which may begin something longer
ESCAPE = 0.05  # s after one


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


def play(pendu: PtyLab, presses: int, seed: int) -> int:
    """Let the monkey play, then quit; returns the exit code."""
    chance = random.Random(seed)
    for number in range(0, presses, BATCH):
        pendu.type("".join(press(chance) for _ in range(BATCH)))
        pendu.run(PAUSE)
        if number % EPISODE == 0:
            if number % (10 * EPISODE) == 0:
                pendu.type("\x10" + "".join(chance.choices("aemnstv ", k=3)))  # the palette finds, but does nothing
                pendu.run(ESCAPE)
            for _ in range(2):
                pendu.type("\x1b")
                pendu.run(ESCAPE)
    for _ in range(20):
        pendu.type("\x1b")
        pendu.run(ESCAPE)
        pendu.type("q")
        with suppress(TimeoutError):
            return pendu.end(1.0)
    raise TimeoutError("it does not quit")
