"""Count dots in a wrong ink and methods that vanish, on the lab's screen in ten scenes.

A dot is wrong if its cell has an ink in which the dot was not set.  A method vanishes from a column
of a pane where it has dots but no cell has its ink; `kept` is the least share of its columns.
"""

import asyncio
from collections import Counter, defaultdict
from collections.abc import Iterable
from typing import Any
from weakref import WeakKeyDictionary

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.drawing.picture import FAINT, Picture
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.harness import lab

LIMITS = {"wrong": 0}
SCENES_SHOWN = (
    *("drift", "crossover", "linear", "near-separatrix", "learned"),
    *("stiff-limit", "precision", "halving", "mean-field", "damped"),
)
SIZES = ((60, 16), (80, 24), (120, 40), (200, 60))
SECONDS = 18.0
BITS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))  # of braille

Truth = dict[tuple[int, int], set[int]]
"""The inks in which a dot was set."""


TRUTH: WeakKeyDictionary[Canvas, Truth] = WeakKeyDictionary()
DRAWN: list[tuple[Picture, Truth]] = []
"""The last pictures, and who set their dots."""


def observe() -> None:
    """Let every canvas remember who sets its dots."""
    begin = Canvas.__init__
    copy = Canvas.copy
    points = Canvas.points
    scatter = Canvas.scatter
    picture = Canvas.picture
    known = Canvas.dots

    def note(canvas: Canvas, dots: Iterable[tuple[float, float]], ink: int) -> None:
        for x, y in dots:
            if 0 <= x < canvas.width and 0 <= y < canvas.height:
                TRUTH[canvas][int(x), int(y)].add(ink)

    def begun(canvas: Canvas, columns: int, rows: int) -> None:
        begin(canvas, columns, rows)
        TRUTH[canvas] = defaultdict(set)

    def copied(canvas: Canvas) -> Canvas:
        other = copy(canvas)
        TRUTH[other] = defaultdict(set, {dot: {*inks} for dot, inks in TRUTH[canvas].items()})
        return other

    def with_points(canvas: Canvas, some: Iterable[tuple[float, float]], ink: int) -> None:
        dots = [*some]
        points(canvas, dots, ink)
        note(canvas, dots, ink)

    def with_scatter(canvas: Canvas, x: Any, y: Any, *inks: int) -> None:
        scatter(canvas, x, y, *inks)
        for place, ink in enumerate(inks):
            right = x.reshape(-1, len(inks))[:, place]
            note(canvas, zip(right, y.reshape(-1, len(inks))[:, place], strict=True), ink)

    def with_dots(canvas: Canvas, some: Iterable[tuple[int, int]], ink: int) -> None:
        dots = [*some]
        known(canvas, dots, ink)
        for cell, bit in dots:
            row, column = divmod(cell, canvas.columns)
            if bit:
                right, down = BITS[bit.bit_length() - 1]
                TRUTH[canvas][2 * column + right, 4 * row + down].add(ink)

    def pictured(canvas: Canvas) -> Picture:
        shown = picture(canvas)
        DRAWN.append((shown, TRUTH[canvas]))
        return shown

    changes = (begun, copied, with_points, with_scatter, with_dots, pictured)
    names = ("__init__", "copy", "points", "scatter", "dots", "picture")
    for name, change in zip(names, changes, strict=True):
        setattr(Canvas, name, change)


def counted(picture: Picture, truth: Truth) -> tuple[int, int, list[float]]:
    """Return the dots in a wrong ink, all dots of methods, and each method's share of columns."""
    wrong = 0
    dots = 0
    shown: set[tuple[int, int]] = set()  # columns and inks
    for row, pieces in enumerate(picture.rows):
        cells = ((character, ink) for text, ink in pieces for character in text)
        for column, (character, ink) in enumerate(cells):
            assert isinstance(ink, int)
            if character != " ":
                shown.add((column, ink))
            for bit, (right, down) in enumerate(BITS):
                if "⠀" < character <= "⣿" and (ord(character) - 0x2800) >> bit & 1:
                    owners = truth[2 * column + right, 4 * row + down]
                    if max(owners) >= 0:
                        dots += 1
                        wrong += ink not in owners
    data = {(x // 2, ink) for (x, _), inks in truth.items() for ink in inks if 0 <= ink < FAINT}
    columns = Counter(ink for _, ink in data)
    kept = Counter(ink for _, ink in data & shown)
    return wrong, dots, [kept[ink] / columns[ink] for ink in columns]


async def of_screen(scene: str, size: tuple[int, int]) -> dict[str, Any]:
    async with lab(SCENES[scene], size) as theatre:
        await theatre.run(SECONDS)
        shown = [pane for pane in theatre.stage.query(CellWidget) if pane.drawable]
        panes = [(isinstance(pane, TimeChart), pane._picture.rows) for pane in shown]
    charts = []
    others = []
    for picture, truth in reversed(DRAWN):
        for pane in panes:
            is_chart, rows = pane
            if rows and tuple(rows[: len(picture.rows)]) == tuple(picture.rows):
                (charts if is_chart else others).append(counted(picture, truth))
                panes.remove(pane)
                break
    DRAWN.clear()
    return {
        "wrong": sum(wrong for wrong, _, _ in charts + others),
        "dots": sum(dots for _, dots, _ in charts + others),
        "kept": round(min([share for *_, shares in charts for share in shares], default=1.0), 2),
        "vanished": sum(not share for *_, shares in charts + others for share in shares),
    }


def measure(share: float) -> dict[str, Any]:
    observe()
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
