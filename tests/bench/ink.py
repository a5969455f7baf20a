"""Count dots in a wrong ink and methods that vanish, on the lab's screen in ten scenes.

A dot is wrong if its cell has an ink in which the dot was not set.  A method vanishes from a column
of a pane where it has dots but no cell has its ink; `kept` is the least share of its columns.
"""

import asyncio
from collections import Counter
from typing import Any

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.canvas import _BITS, Canvas
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.drawing.picture import FAINT, Picture
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.drawn import cells
from tests.tui.harness import lab

LIMITS = {"wrong": 0, "vanished": 0, "below_half": 0}
SCENES_SHOWN = (
    *("drift", "crossover", "linear", "near-separatrix", "learned"),
    *("stiff-limit", "precision", "halving", "mean-field", "damped"),
)
SIZES = ((60, 16), (80, 24), (120, 40), (200, 60))
SECONDS = 18.0

DRAWN: list[tuple[Picture, Canvas]] = []
"""The pictures, with the dots that were set in each ink, shown or not."""
draw = Canvas.picture


def observed(canvas: Canvas) -> Picture:
    """Draw a canvas and remember who set its dots."""
    picture = draw(canvas)
    DRAWN.append((picture, canvas.copy()))
    return picture


def counted(picture: Picture, canvas: Canvas) -> tuple[int, int, list[float]]:
    """Return the dots in a wrong ink, all dots of methods, and each method's share of columns."""
    wrong = 0
    dots = 0
    shown = cells(picture)
    for (row, column), (character, ink) in shown.items():
        if not "⠀" < character <= "⣿":
            continue
        place = row * canvas.columns + column
        for bit in _BITS:
            owners = [each for each, layer in canvas._layers.items() if layer[place] & bit]
            if ord(character) & bit and max(owners) >= 0:
                dots += 1
                wrong += ink not in owners
    shares = []
    for ink, layer in canvas._layers.items():
        columns = {place % canvas.columns for place, bits in enumerate(layer) if bits}
        if columns and 0 <= ink < FAINT:
            kept = {column for (_, column), (_, used) in shown.items() if used == ink}
            shares.append(len(columns & kept) / len(columns))
    return wrong, dots, shares


def shows(pane: CellWidget, picture: Picture) -> bool:
    """Return whether a pane shows a picture, alone or inside axes."""
    rows = pane._picture.rows[: len(picture.rows)]
    fields = [[tuple(row[left:]) for row in rows] for left in (0, 2)]
    return bool(rows) and [*picture.rows] in fields


async def of_screen(scene: str, size: tuple[int, int]) -> dict[str, Any]:
    DRAWN.clear()
    found: Counter[str] = Counter()
    in_charts = [1.0]
    async with lab(SCENES[scene], size) as theatre:
        await theatre.run(SECONDS)
        for pane in theatre.stage.query(CellWidget):
            drawn = [each for each in DRAWN if pane.drawable and shows(pane, each[0])]
            for last in drawn[-1:]:
                wrong, dots, shares = counted(*last)
                found.update(wrong=wrong, dots=dots, vanished=shares.count(0.0))
                in_charts += shares * isinstance(pane, TimeChart)
    found["below_half"] = min(in_charts) < 0.5
    return {**found, "kept": round(min(in_charts), 2)}


def measure(share: float) -> dict[str, Any]:
    Canvas.picture = observed
    table = {
        f"{scene} {size[0]}x{size[1]}": asyncio.run(of_screen(scene, size))
        for scene in SCENES_SHOWN
        for size in SIZES[: max(round(share * len(SIZES)), 1)]
    }
    return table | {name: sum(row[name] for row in table.values()) for name in LIMITS}
