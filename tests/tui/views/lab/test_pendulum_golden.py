"""200 pendulums that were drawn once stay as they were drawn, to the cell.  `--snapshot-update` draws them anew."""

import random
from pathlib import Path

import numpy as np

from tui.drawing.canvas import Picture
from tui.drawing.palette import EXACT, FAINT, FRAME, NOBODY
from tui.views.lab.pendulums import Bob, pendulum_sketch

GOLDEN = Path(__file__).with_name("pendulums.txt")
OWNERS = {NOBODY: " ", FRAME: "+", EXACT: "x"} | dict(enumerate("0123")) | dict(enumerate("abcd", FAINT))


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
            owner, letter = (index, "esvr"[index]) if count > 1 else (chance.randrange(4), "")
            bobs.append(Bob(theta, owner, trail, letter, diverged=chance.random() < 0.1))
        picture = Picture.of_sketch(pendulum_sketch(columns, rows, bobs))
        pictures.append(f"{number}: {columns}x{rows}\n{as_text(picture)}")
    return pictures


def as_text(picture: Picture) -> str:
    """Characters, and whose they are."""
    rows = zip(picture.characters.tolist(), picture.owners.tolist(), strict=True)
    lines = (f"{''.join(map(chr, codes))}|{''.join(OWNERS[owner] for owner in owners)}" for codes, owners in rows)
    return "".join(f"{line.rstrip()}\n" for line in lines)


def test_pendulums_look_as_they_did(request):
    pictures = "".join(drawn())
    if request.config.getoption("--snapshot-update"):
        GOLDEN.write_text(pictures, encoding="utf-8")
    assert pictures == GOLDEN.read_text(encoding="utf-8")
