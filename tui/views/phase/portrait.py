"""The theoretical phase portrait: energy contours, separatrix, regimes and axes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.models.model import Model
from pendu_tui.tui.drawing.axes import nice, number_ticks, theta_ticks
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import EXACT, FAINT, FRAME, QUIET, TEXT
from pendu_tui.tui.views.phase.viewport import Viewport

Dots = tuple[NDArray[np.intp], NDArray[np.intp]]  # x, y
Mask = NDArray[np.bool_]  # (dots down, dots right), or (rows, columns)
Word = tuple[int, int, str, int]  # column, row, text, ink
LABEL = 4  # columns for the numbers along the left edge


@dataclass(frozen=True, slots=True, eq=False)
class Portrait:
    """The static part of the picture, for one viewport."""

    viewport: Viewport
    model: Model
    levels: NDArray[np.float64]  # (dots down, dots right), at the dots' centres
    separatrix: Dots
    ground: Canvas  # the curves
    words: Sequence[Word]

    @classmethod
    @lru_cache(maxsize=2)  # one for the lab's pane, one for F3
    def of(cls, viewport: Viewport, model: Model) -> "Portrait":
        theta = viewport.theta_at(np.arange(2 * viewport.columns) + 0.5)
        omega = viewport.omega_at(np.arange(4 * viewport.rows) + 0.5)[:, None]
        levels = model.level(theta, omega, np.cos)
        separatrix = _dots(_border((levels < 0) & model.has_separatrix, heavy=True))
        words = axes(viewport)
        if model.has_separatrix:
            words += _names(levels, omega)
        ground = Canvas(viewport.columns, viewport.rows)
        ground.scatter(*_dots(_border(_bands(levels))), FRAME)
        ground.scatter(*separatrix, TEXT)
        return cls(viewport, model, levels, separatrix, ground, words)

    def orbit(self, theta: float, omega: float) -> Dots:
        """Return the exact orbit through a state, where orbits are curves of equal energy."""
        if self.model.caption:
            return _dots(np.zeros((0, 0), np.bool_))
        level = self.model.level(theta, omega)
        curve = _border(self.levels < level)
        # two orbits have this energy, one for each direction of rotation
        if self.model.has_separatrix and level < 0:
            rows = self.viewport.omega_at(np.arange(len(curve)) + 0.5)
            curve &= (rows * omega > 0)[:, None]
        return _dots(curve)


def write_words(canvas: Canvas, words: Sequence[Word]) -> None:
    """Write words where they cover no point, ring or orbit; trails show between them."""
    for column, row, text, ink in words:
        below = [canvas.inks_at(at, row) for at in range(column, column + len(text))]
        if any(EXACT <= ink < FAINT for inks in below for ink in inks):
            continue
        for at, character in enumerate(text):
            if character != " " or all(ink < EXACT for ink in below[at]):
                canvas.label(column + at, row, character, ink)


def axes(viewport: Viewport) -> list[Word]:
    """Return numbers along the left edge (rad/s) and the lower one (pi or rad)."""
    columns = viewport.columns
    bottom = viewport.rows - 1
    low = viewport.omega_at(4.0 * bottom)
    high = viewport.omega_at(0.0)
    words: list[Word] = [
        (0, math.floor(viewport.y(omega) / 4), label[:columns], TEXT)
        for omega, label in number_ticks(low, high, max(bottom // 3, 1))
    ]
    # pi may be at the very edge
    left = viewport.theta_at(0.0)
    right = viewport.theta_at(2.0 * columns + 1)
    for theta, label in theta_ticks(left, right, min(columns // 9 + 1, 8), viewport.wrap):
        middle = math.floor((theta - left) / viewport.theta_per_dot / 2)
        begin = max(min(middle - len(label) // 2, columns - len(label)) - 1, 0)
        text = f" {label} " if begin else f"{label} "  # with blanks between it and the curves
        words.append((begin, bottom, text[: columns - begin], TEXT))
    return words


def _bands(levels: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return each dot's energy band: even steps of amplitude, above the separatrix of omega."""
    inside = np.arcsin(np.sqrt(np.clip(levels, 0, 1)))
    spacing = np.where(levels > 0, inside, -np.sqrt(np.maximum(-levels, 0)))
    step = nice(float(np.ptp(spacing)) / 8 or 1.0)  # about eight curves
    return np.floor(spacing / step).astype(np.int64)


def _border(values: NDArray[Any], heavy: bool = False) -> Mask:
    """Return dots that differ from the one to the right or below; `heavy` doubles them."""
    border = np.zeros(values.shape, np.bool_)
    right = values[:, 1:] != values[:, :-1]
    below = values[1:] != values[:-1]
    border[:, :-1] |= right
    border[:-1] |= below
    if heavy:
        border[:, 1:] |= right
        border[1:] |= below
    return border


def _dots(mask: Mask) -> Dots:
    y, x = np.nonzero(mask)
    return x, y


def _names(levels: Any, omega: Any) -> list[Word]:
    spins = levels < 0
    words: list[Word] = []
    regions = (
        (" libration ", ~spins),
        (" rotation ", spins & (omega > 0)),
        (" rotation ", spins & (omega < 0)),
    )
    for text, region in regions:
        inside = _whole_cells(region)
        if not inside.any():
            continue
        column = round(float(np.nonzero(inside)[1].mean())) - len(text) // 2
        free = inside[:-1, max(column, 0) : column + len(text)].sum(axis=1) == len(text)
        rows = np.flatnonzero(free).tolist()
        if rows and column > LABEL:
            words.append((column, rows[len(rows) // 2], text, QUIET))
    beside = ~(_whole_cells(spins) | _whole_cells(~spins))
    for row, cells in enumerate(beside[:-1]):
        end = int(np.flatnonzero(cells)[-1]) + 1 if cells.any() else 0
        if LABEL < end <= len(cells) - len("separatrix"):
            words.append((end, row, "separatrix", TEXT))
            break
    return words


def _whole_cells(dots: Mask) -> Mask:
    """Return the cells that lie in a region with all their dots."""
    rows, columns = dots.shape
    return np.array(dots.reshape(rows // 4, 4, columns // 2, 2).all(axis=(1, 3)))
