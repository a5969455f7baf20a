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

LIMITS = {"wrong": 0}
SCENES_SHOWN = (
    *("drift", "crossover", "linear", "near-separatrix", "learned"),
    *("stiff-limit", "precision", "halving", "mean-field", "damped"),
)
SIZES = ((60, 16), (80, 24), (120, 40), (200, 60))
SECONDS = 18.0

Layers = dict[int, list[bytes]]
"""The dots that were set in each ink, shown or not: a byte for each cell, by row."""

DRAWN: list[tuple[Picture, Layers]] = []
draw = Canvas.picture


def observed(canvas: Canvas) -> Picture:
    """Draw a canvas and remember who set its dots."""
    picture = draw(canvas)
    starts = range(0, canvas.columns * canvas.rows, canvas.columns)
    layers = {
        ink: [bytes(layer[start : start + canvas.columns]) for start in starts]
        for ink, layer in canvas._layers.items()
    }
    DRAWN.append((picture, layers))
    return picture


def counted(picture: Picture, layers: Layers) -> tuple[int, int, list[float]]:
    """Return the dots in a wrong ink, all dots of methods, and each method's share of columns."""
    wrong = 0
    dots = 0
    shown = {(column, ink) for (_, column), (_, ink) in cells(picture).items()}
    for (row, column), (character, ink) in cells(picture).items():
        if not "⠀" < character <= "⣿":
            continue
        for bit in _BITS:
            owners = [each for each, layer in layers.items() if layer[row][column] & bit]
            if ord(character) & bit and max(owners) >= 0:
                dots += 1
                wrong += ink not in owners
    data = {
        (column, ink)
        for ink, layer in layers.items()
        if 0 <= ink < FAINT
        for row in layer
        for column, bits in enumerate(row)
        if bits
    }
    columns = Counter(ink for _, ink in data)
    kept = Counter(ink for _, ink in data & shown)
    return wrong, dots, [kept[ink] / columns[ink] for ink in columns]


async def of_screen(scene: str, size: tuple[int, int]) -> dict[str, Any]:
    DRAWN.clear()
    async with lab(SCENES[scene], size) as theatre:
        await theatre.run(SECONDS)
        shown = [pane for pane in theatre.stage.query(CellWidget) if pane.drawable]
        panes = [(isinstance(pane, TimeChart), pane._picture.rows) for pane in shown]
    found = []
    in_charts = [1.0]
    for is_chart, rows in panes:
        fields = [[tuple(row[left:]) for row in rows] for left in (0, 2)]  # 2: inside axes
        drawn = [
            each
            for each in DRAWN
            if rows and [*each[0].rows] in [field[: len(each[0].rows)] for field in fields]
        ]
        for last in drawn[-1:]:
            found.append(counted(*last))
            in_charts += found[-1][2] * is_chart
    return {
        "wrong": sum(wrong for wrong, _, _ in found),
        "dots": sum(dots for _, dots, _ in found),
        "kept": round(min(in_charts), 2),
        "vanished": sum(not share for *_, shares in found for share in shares),
    }


def measure(share: float) -> dict[str, Any]:
    Canvas.picture = observed
    sizes = SIZES[: max(round(share * len(SIZES)), 1)]
    table = {
        f"{scene} {size[0]}x{size[1]}": asyncio.run(of_screen(scene, size))
        for scene in SCENES_SHOWN
        for size in sizes
    }
    return {
        **table,
        "wrong": sum(row["wrong"] for row in table.values()),
        "kept_less_than_half": sum(row["kept"] < 0.5 for row in table.values()),
    }
