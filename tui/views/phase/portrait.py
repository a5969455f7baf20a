"""The theoretical portrait: curves of equal energy, the separatrix, the regimes' names and the axes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.models.pendulum import separatrix_margin
from tui.drawing.axes import nice, omega_ticks, theta_ticks
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, FAINT, FRAME, QUIET, TEXT
from tui.views.phase.viewport import Viewport

Dots = tuple[NDArray[np.intp], NDArray[np.intp]]  # x, y
Cells = NDArray[np.bool_]  # (rows, columns)
Word = tuple[int, int, str, int]  # column, row, text, ink
_CURVES = 8  # about so many energies are in view


@dataclass(frozen=True, slots=True, eq=False)
class Portrait:
    """The part that does not move, for one viewport: computed once, drawn in each frame."""

    viewport: Viewport
    w0: float
    model: str  # its key
    margin: NDArray[np.float64]  # (dots down, dots right), at the dots' centres
    curves: Dots
    separatrix: Dots
    ground: Canvas  # with both
    words: tuple[Word, ...]

    @classmethod
    @lru_cache(maxsize=2)  # for the lab's pane and the view's
    def of(cls, viewport: Viewport, w0: float, model: str = "pendulum") -> "Portrait":
        """Draw the portrait of all pendulums with natural frequency w0 [rad/s], or of another model.

        Of the linear oscillator it has ellipses, with friction curves that the motion crosses, and of a bob in the
        plane, whose phase space has four dimensions, none.
        """
        x, y = np.arange(2 * viewport.columns) + 0.5, np.arange(4 * viewport.rows) + 0.5
        omega = viewport.omega_at(y)[:, None]
        field = _field(model, w0, viewport.theta_at(x), omega)
        curves, separatrix = _border(_level(field)), np.zeros(field.shape, np.bool_)
        if model == "pendulum":
            separatrix = _border(field < 0, heavy=True)
            words = _words(viewport, curves, separatrix, field, omega)
        else:
            words = tuple(axes(viewport))
        shown = _dots(curves), _dots(separatrix)
        ground = Canvas(viewport.columns, viewport.rows)
        ground.scatter(*shown[0], FRAME)
        ground.scatter(*shown[1], TEXT)
        return cls(viewport, w0, model, field, *shown, ground, words)

    def write_words(self, canvas: Canvas) -> None:
        write_words(canvas, self.words)

    def orbit(self, theta: float, omega: float) -> Dots:
        """The exact orbit through a state, where it is a curve of equal energy."""
        if self.model not in ("pendulum", "linear"):
            return np.zeros(0, np.intp), np.zeros(0, np.intp)
        value = _field(self.model, self.w0, theta, omega)
        curve = _border(self.margin < value)
        if (
            value < 0 and self.model == "pendulum"
        ):  # the same energy belongs to two orbits, one for each sense of rotation
            rows = self.viewport.omega_at(np.arange(len(curve)) + 0.5)
            curve &= (rows > 0)[:, None] if omega > 0 else (rows < 0)[:, None]
        return _dots(curve)


def write_words(canvas: Canvas, words: Sequence[Word]) -> None:
    """Write words, except those that would cover part of a point, a ring or an orbit; a blank covers no trail."""
    for column, row, text, ink in words:
        below = [canvas.ink_at(at, row) for at in range(column, column + len(text))]
        if any(EXACT <= one < FAINT for one in below):
            continue
        for at, character in enumerate(text):
            if character != " " or below[at] < EXACT:
                canvas.label(column + at, row, character, ink)


def _field(model: str, w0: float, theta: Any, omega: Any) -> Any:
    """What is equal along a curve: 1 - E/E_separatrix, or of the linear oscillator less than 0, too."""
    if model == "spring":
        return 0 * (theta + omega)
    if model == "linear":
        return -(theta * theta + omega * omega / w0**2) / 4
    return separatrix_margin(w0, theta, omega, np.cos)


def _level(field: NDArray[np.float64]) -> NDArray[np.int64]:
    """The band of energy of each dot: evenly spaced in amplitude, for rotations in their smallest omega."""
    spacing = np.where(field > 0, np.arcsin(np.sqrt(np.clip(field, 0, 1))), -np.sqrt(np.maximum(-field, 0)))
    step = nice(float(spacing.max() - spacing.min()) / _CURVES or 1.0)
    return np.floor(spacing / step).astype(np.int64)


def _border(values: NDArray[Any], heavy: bool = False) -> NDArray[np.bool_]:
    """Dots whose value differs from that of the dot to the right or below; heavy: also those beyond."""
    border = np.zeros(values.shape, np.bool_)
    right, below = values[:, 1:] != values[:, :-1], values[1:] != values[:-1]
    border[:, :-1] |= right
    border[:-1] |= below
    if heavy:
        border[:, 1:] |= right
        border[1:] |= below
    return border


def _dots(mask: NDArray[np.bool_]) -> Dots:
    y, x = np.nonzero(mask)
    return x, y


def _cells(dots: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Dots as (rows, columns, 8): the dots of each cell."""
    rows, columns = dots.shape[0] // 4, dots.shape[1] // 2
    return dots.reshape(rows, 4, columns, 2).swapaxes(1, 2).reshape(rows, columns, 8)


def _windows(cells: NDArray[np.bool_], length: int) -> NDArray[np.bool_]:
    """Where `length` cells in a row all are true, by the first of them."""
    if cells.shape[1] < length:
        return np.zeros((len(cells), 0), np.bool_)
    windows: Cells = np.all(np.lib.stride_tricks.sliding_window_view(cells, length, axis=1), axis=2)
    return windows


def _nearest(places: NDArray[np.bool_], row: float, column: float) -> tuple[int, int] | None:
    """The true place nearest to a point, a row counting as two columns."""
    rows, columns = np.nonzero(places)
    if not len(rows):
        return None
    best = int(np.argmin(4 * (rows - row) ** 2 + (columns - column) ** 2))
    return int(rows[best]), int(columns[best])


def _words(
    viewport: Viewport,
    curves: NDArray[np.bool_],
    separatrix: NDArray[np.bool_],
    field: NDArray[np.float64],
    omega: NDArray[np.float64],
) -> tuple[Word, ...]:
    """The axes' numbers and the names of the regimes, each where it has room."""
    words = axes(viewport)
    bare: Cells = ~np.any(_cells(separatrix), axis=2)
    free = bare.copy()
    for word in words:
        _take(free, word)
    blank = free & ~np.any(_cells(curves), axis=2)
    regimes = {"libration": field > 0, "rotation": (field < 0) & (omega > 0), " rotation": (field < 0) & (omega < 0)}
    for name, region in regimes.items():
        cells: Cells = np.all(_cells(region), axis=2)
        for word in _inside(name.strip(), cells, [cells & blank, cells & free]):
            _take(free, word)
            words.append(word)
    return (*words, *_beside("separatrix", ~bare, free))


def _take(free: NDArray[np.bool_], word: Word) -> None:
    """A word's cells, and one on both sides, are no longer free."""
    column, row, text, _ = word
    free[row, max(column - 1, 0) : column + len(text) + 1] = False


def _inside(name: str, region: NDArray[np.bool_], preferred: Sequence[NDArray[np.bool_]]) -> list[Word]:
    """The name as near to the middle of its region as it fits, with a blank cell on both sides."""
    if not region.any():
        return []
    rows, columns = np.nonzero(region)
    middle = rows.mean(), columns.mean() - len(name) / 2 - 1
    for cells in preferred:
        if (place := _nearest(_windows(cells, len(name) + 2), *middle)) is not None:
            return [(place[1], place[0], f" {name} ", QUIET)]
    return []


def _beside(name: str, curve: NDArray[np.bool_], free: NDArray[np.bool_]) -> list[Word]:
    """The name to the right of a curve."""
    places = _windows(free, len(name) + 1)[:, 1:]
    place = _nearest(curve[:, : places.shape[1]] & places, 0.3 * len(curve), 0.6 * curve.shape[1])
    return [] if place is None else [(place[1] + 1, place[0], name, TEXT)]


def axes(viewport: Viewport) -> list[Word]:
    """Numbers along the left edge (rad/s) and the lower one (pi or rad)."""
    columns, bottom = viewport.columns, viewport.rows - 1
    low, high = viewport.omega_at(4.0 * bottom), viewport.omega_at(0.0)
    words: list[Word] = [
        (0, math.floor(viewport.y(omega) / 4), label[:columns], TEXT)
        for omega, label in omega_ticks(low, high, max(bottom // 3, 1))
    ]
    left, right = viewport.theta_at(0.0), viewport.theta_at(2.0 * columns + 1)  # pi may be at the very edge
    for theta, label in theta_ticks(left, right, min(columns // 9 + 1, 8), viewport.wrap):
        column = math.floor((theta - left) / viewport.theta_per_dot / 2) - len(label) // 2
        begin = max(min(column, columns - len(label)), 0)
        text = f" {label} " if begin else f"{label} "  # with blanks between it and the curves
        words.append((max(begin - 1, 0), bottom, text[: columns - max(begin - 1, 0)], TEXT))
    return words
