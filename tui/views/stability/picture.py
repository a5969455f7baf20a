"""The map of stability in half-blocks: z across, amplitude up.

Without colours its characters still tell held swings, lost ones, and unknown ones apart.
"""

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import groupby

import numpy as np
from numpy.typing import NDArray
from rich.style import Style

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.euler import SYMPLECTIC_EULER
from pendu_tui.engine.methods.verlet import VELOCITY_VERLET
from pendu_tui.engine.stability.chaos import GREENE_Z
from pendu_tui.engine.stability.grid import Grid
from pendu_tui.engine.stability.outcomes import HELD, UNKNOWN, Cells
from pendu_tui.tui.drawing.axes import number_ticks
from pendu_tui.tui.drawing.palette import NOBODY, Palette, ink_of, inks, mark, mixed
from pendu_tui.tui.drawing.picture import Ink, Row

LIMIT, THRESHOLD, CATCHING, HERE, LOST = "│", "┊", "•", "@", "╱"
MARGIN = 4  # for the labels of the amplitudes
SHADES = 16  # of lost swings, by when; and as many of held ones, by error

Scores = NDArray[np.float64]
Cell = tuple[str, Ink]


def scores(cells: Cells, steps: int) -> Scores:
    """Return a score per swing: -1 unknown, 0 to 1 lost, later; 1 to 2 held, better.

    Both parts are logarithmic, in steps survived and in the largest energy error, down to 1e-12.
    """
    survived = np.log1p(cells["steps"]) / math.log1p(steps)
    digits = -np.log10(np.clip(cells["error"], 1e-12, 1)) / 12
    is_held = np.isin(cells["fate"], HELD)
    return np.select([cells["fate"] == UNKNOWN, is_held], [-1.0, 1 + digits], survived)


def side_by_side(panels: Sequence[Sequence[Row]], across: int) -> list[Row]:
    rows: list[Row] = []
    for first in range(0, len(panels), across):
        for left, *others in zip(*panels[first : first + across], strict=True):
            rows.append([*left, *(cell for row in others for cell in (("  ", NOBODY), *row))])
    return rows


def panel(
    grid: Grid,
    cells: Cells,
    index: int,
    columns: int,
    rows: int,
    palette: Palette,
    *,
    here: tuple[float, float] | None = None,
    w0: float | None = None,
    note: str = "",
) -> list[Row]:
    """Draw one method's panel: its title, `rows` of the map, and the axis.

    `here` is a (z, theta) to mark.  With w0 [1/s] the axis shows h instead of z.
    """
    method = grid.methods[index]
    width = columns - MARGIN
    values = scores(cells[:, index], grid.steps)
    lines = _blocks(worst(values, width, 2 * rows), inks(grid.methods)[index], palette)
    signs = list(theory(method, grid, rows))
    if here:
        signs.append((*here, HERE))
    for z, theta, sign in signs:
        if place := _place(grid, z, theta, width, rows):
            row, column = place
            _, ink = lines[row][column]
            lines[row][column] = sign, ink + Style(color=palette.text, reverse=sign == HERE)
    degrees = _degrees(grid, width, rows)
    map_rows = [
        [(f"{degrees.get(row, ''):>3} ", NOBODY), *_joined(line)] for row, line in enumerate(lines)
    ]
    axis = " " * MARGIN + _axis(grid, width, w0)
    name = f"{'':{MARGIN}}{mark(index, method)} "
    title = f"{name}{method.label}: {note}".rstrip(": ")
    if len(title) > columns:
        title = name + note
    head = (title[:columns].ljust(columns), Style(bold=True))
    return [[head], *map_rows, [(axis, NOBODY)]]


def _blocks(values: Scores, ink: int, palette: Palette) -> list[list[tuple[str, Style]]]:
    """Return half-blocks, two rows of pixels each, hatched with LOST where both are lost."""
    shades = [colour(level / SHADES, ink, palette) for level in range(-SHADES, 2 * SHADES + 1)]
    levels = np.rint((values + 1) * SHADES).astype(int).tolist()

    def cell(up: int, low: int) -> tuple[str, Style]:
        if max(up, low) < SHADES:
            return " ", _style(shades[up], shades[low])
        if max(up, low) < 2 * SHADES:
            return LOST, _style(palette.background, shades[min(up, low)])
        if up < low:
            return "▄", _style(shades[low], shades[up])
        return "▀", _style(shades[up], shades[low])

    pairs = zip(levels[::2], levels[1::2], strict=True)
    return [[cell(up, low) for up, low in zip(*pair, strict=True)] for pair in pairs]


@lru_cache(maxsize=10_000)
def _style(front: str, back: str) -> Style:
    return Style(color=front, bgcolor=back)


def _joined(line: Sequence[tuple[str, Style]]) -> Iterator[Cell]:
    for (text, ink), cells in groupby(line):
        yield text * len(list(cells)), ink


def _degrees(grid: Grid, width: int, rows: int) -> dict[int, int]:
    degrees = {}
    for each in range(0, 180, 45 if rows >= 5 else 90):
        if place := _place(grid, grid.z[0], math.radians(each), width, rows):
            degrees[place[0]] = each
    return degrees


def _axis(grid: Grid, width: int, w0: float | None) -> str:
    symbol = "h"
    if w0 is None:
        symbol, w0 = "z", 1.0
    line = ""
    for value, text in number_ticks(grid.z[0] / w0, grid.z[-1] / w0, max(width // 6, 2)):
        place = _place(grid, value * w0, float(grid.theta[0]), width, 1)
        if place is not None and len(line) <= place[1] <= width - len(text) - 2:
            line = line.ljust(place[1]) + text
    return f"{line} {symbol}".ljust(width)


def theory(method: Method, grid: Grid, rows: int) -> Iterator[tuple[float, float, str]]:
    """Yield theory's (z, theta): the linear limit, Greene's threshold, the catching orbit.

    Greene's threshold belongs to the standard map: symplectic Euler, and velocity Verlet but for
    half a kick. Verlet's catching orbit jumps between q and -q, z² sin q = 4 q.
    """
    count = len(grid.theta)
    middles = (np.arange(rows)[::-1] + 0.5) / rows * count - 0.5
    for theta in np.interp(middles, np.arange(count), grid.theta).tolist():
        if method in (SYMPLECTIC_EULER, VELOCITY_VERLET):
            yield GREENE_Z, theta, THRESHOLD
        if method == VELOCITY_VERLET and theta < math.pi / 2:
            yield math.sqrt(4 * theta / math.sin(theta)), theta, CATCHING
        if method.linear_limit:
            yield method.linear_limit, theta, LIMIT


def worst(values: Scores, columns: int, rows: int) -> Scores:
    """Return the lowest value under each pixel (row, column), so that no failure vanishes."""
    lefts = np.arange(columns) * len(values) // columns
    bottoms = np.arange(rows) * values.shape[1] // rows
    across = np.minimum.reduceat(values, lefts, axis=0)
    return np.minimum.reduceat(across, bottoms, axis=1).T[::-1]


def colour(score: float, ink: int, palette: Palette) -> str:
    """Return the method's colour where held, brighter for smaller errors; else the warning's."""
    if score < 0:
        return palette.background
    if score < 1:
        return mixed(palette.warn, palette.background, 0.9 - 0.5 * score)
    return mixed(palette.colour(ink), palette.background, 0.6 * (2 - score))


def legend(steps: int, palette: Palette, columns: int = 80) -> list[Row]:
    ink = ink_of(VELOCITY_VERLET, ())
    shades = [0.999 * part / 7 for part in range(8)]
    bright = [("▀", _style(*[colour(1 + each, ink, palette)] * 2)) for each in shades]
    dark = [(LOST, _style(palette.background, colour(each, ink, palette))) for each in shades]
    held: list[Cell] = [("held, energy error 1 ", NOBODY), *bright, (" 1e-12   ", NOBODY)]
    lost: list[Cell] = [("lost at step 1 ", NOBODY), *dark, (f" {steps}", NOBODY)]
    lines: list[Cell] = [(f"{LIMIT} linear limit   {THRESHOLD} global chaos above   ", NOBODY)]
    orbit: list[Cell] = [(f"{CATCHING} stable 2-cycle   y: amplitude [°]", NOBODY)]
    if columns >= 80:
        return [held + lost, lines + orbit]
    return [held, lost, lines, orbit]


def place_at(grid: Grid, row: int, column: int, rows: int, columns: int) -> tuple[int, int]:
    """Return the indices (z, theta) of the map's cell nearest to a character's middle."""
    z = int((column + 0.5) / columns * len(grid.z))
    theta = int((rows - row - 0.5) / rows * len(grid.theta))
    return z, theta


def _place(grid: Grid, z: float, theta: float, columns: int, rows: int) -> tuple[int, int] | None:
    """Return (row, column) of the character over (z, theta); None outside the map."""
    if not (grid.z[0] <= z <= grid.z[-1] and grid.theta[0] <= theta <= grid.theta[-1]):
        return None
    across = (np.interp(z, grid.z, np.arange(len(grid.z))) + 0.5) / len(grid.z)
    up = (np.interp(theta, grid.theta, np.arange(len(grid.theta))) + 0.5) / len(grid.theta)
    return min(rows - 1, int((1 - up) * rows)), min(columns - 1, int(across * columns))
