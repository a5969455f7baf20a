"""200 pendulums that were drawn once stay as they were drawn, to the cell.  `--snapshot-update` draws them anew."""

import random
from pathlib import Path

import numpy as np

from tests.tui.drawn import cells
from tui.drawing.palette import EXACT, FAINT, FRAME
from tui.drawing.picture import Picture
from tui.views.lab.pendulums import Bob, pendulum_picture

GOLDEN = Path(__file__).with_name("pendulums.txt")
INKS = {FRAME: "+", EXACT: "x"} | dict(enumerate("0123")) | dict(enumerate("abcd", FAINT))


def drawn() -> list[str]:
    """Random panes, angles, trails, ghosts and failures."""
    chance, pictures = random.Random(13), []
    for number in range(200):
        columns, rows = chance.randint(5, 26), chance.randint(3, 12)
        count = chance.choice((1, 1, 1, 4))
        bobs = [Bob(chance.uniform(-4, 4), EXACT, ghost=True)] if chance.random() < 0.3 else []
        for index in range(count):
            theta = chance.uniform(-7, 7)
            trail = theta - chance.uniform(0.0, 0.2) * np.arange(chance.choice((0, 15)))[::-1]
            ink, letter = (index, "esvr"[index]) if count > 1 else (chance.randrange(4), "")
            bobs.append(Bob(theta, ink, trail, letter, diverged=chance.random() < 0.1))
        picture = pendulum_picture(columns, rows, bobs)
        pictures.append(f"{number}: {columns}x{rows}\n{as_text(picture, columns, rows)}")
    return pictures


def as_text(picture: Picture, columns: int, rows: int) -> str:
    """Characters and their inks."""
    shown = cells(picture)
    lines = (
        "".join(shown[y, x][0] if (y, x) in shown else " " for x in range(columns))
        + "|"
        + "".join(INKS[shown[y, x][1]] if (y, x) in shown else " " for x in range(columns))
        for y in range(rows)
    )
    return "".join(f"{line.rstrip()}\n" for line in lines)


def test_pendulums_look_as_they_did(request):
    pictures = "".join(drawn())
    if request.config.getoption("--snapshot-update"):
        GOLDEN.write_text(pictures, encoding="utf-8")
    assert pictures == GOLDEN.read_text(encoding="utf-8")
