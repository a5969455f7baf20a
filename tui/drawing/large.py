"""Thick lines and large digits, to be seen from the back of the room."""

import numpy as np
from numpy.typing import NDArray

from tui.drawing.canvas import Picture

HEIGHT = 3  # rows of large digits
_BRAILLE = 0x2800
_ORDER = (0, 3, 1, 4, 2, 5, 6, 7)  # the bit of each dot of a cell, row by row

_FONT = {  # five rows of three pixels each
    " ": (0, 0, 0, 0, 0),
    "+": (0, 2, 7, 2, 0),
    "-": (0, 0, 7, 0, 0),
    ".": (0, 0, 0, 0, 2),
    "0": (7, 5, 5, 5, 7),
    "1": (2, 6, 2, 2, 7),
    "2": (7, 1, 7, 4, 7),
    "3": (7, 1, 7, 1, 7),
    "4": (5, 5, 7, 1, 1),
    "5": (7, 4, 7, 1, 7),
    "6": (7, 4, 7, 5, 7),
    "7": (7, 1, 1, 2, 2),
    "8": (7, 5, 7, 5, 7),
    "9": (7, 5, 7, 1, 7),
    "e": (0, 7, 7, 4, 7),
}


def large(text: str) -> list[str]:
    """A number as three rows of half blocks, four columns a character."""
    rows = []
    for y in range(0, 2 * HEIGHT, 2):
        cells = [(*_FONT[character], 0)[y : y + 2] for character in text]
        rows.append("".join(_pixels(upper, lower) for upper, lower in cells).rstrip())
    return rows


def _pixels(upper: int, lower: int) -> str:
    return "".join(" ▀▄█"[(upper >> bit & 1) + 2 * (lower >> bit & 1)] for bit in (2, 1, 0)) + " "


def thick(picture: Picture) -> Picture:
    """The picture with every dot also to the right of itself and below; words stay as they are."""
    codes, owners = picture.characters, picture.owners
    drawable = (codes == ord(" ")) | ((codes >= _BRAILLE) & (codes < _BRAILLE + 256))
    dots = _dots(np.where(drawable & (codes != ord(" ")), codes - _BRAILLE, 0))
    wide = dots | np.pad(dots, ((0, 0), (1, 0)))[:, :-1]
    grown = wide | np.pad(wide, ((1, 0), (0, 0)))[:-1]
    bits = _bits(grown)
    inked = drawable & (bits > 0)
    new = inked & (codes == ord(" "))
    for down, right in ((1, 1), (1, 0), (0, 1)):  # whose dot it is: the one from the left before those from above
        before = np.pad(picture.owners, ((down, 0), (right, 0)), "edge")[: len(owners), : owners.shape[1]]
        drawn = np.pad(_bits(dots) > 0, ((down, 0), (right, 0)))[: len(owners), : owners.shape[1]]
        owners = np.where(new & drawn, before, owners)
    return Picture(np.where(inked, bits + np.uint32(_BRAILLE), codes).astype(np.uint32), owners.astype(np.int8))


def _dots(bits: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """The braille bits of cells -> four rows and two columns of dots for each."""
    rows, columns = bits.shape
    cells = np.stack([bits >> bit & 1 for bit in _ORDER], axis=-1).astype(bool)
    return cells.reshape(rows, columns, 4, 2).transpose(0, 2, 1, 3).reshape(4 * rows, 2 * columns)


def _bits(dots: NDArray[np.bool_]) -> NDArray[np.uint32]:
    rows, columns = dots.shape[0] // 4, dots.shape[1] // 2
    cells = dots.reshape(rows, 4, columns, 2).transpose(0, 2, 1, 3).reshape(rows, columns, 8)
    bits: NDArray[np.uint32] = (cells << np.array(_ORDER, np.uint32)).sum(axis=-1, dtype=np.uint32)
    return bits
