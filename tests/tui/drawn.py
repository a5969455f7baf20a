"""The contents of a picture, or of the whole screen, cell by cell."""

import string
from itertools import chain, count
from typing import Any

from rich.style import Style
from textual.app import App

from pendu_tui.tui.drawing.picture import FAINT, Picture


def cells(picture: Picture) -> dict[tuple[int, int], tuple[str, object]]:
    """Return the character and the ink of each cell (row, column) that is not blank."""
    return {
        (y, x): cell
        for y, row in enumerate(picture.rows)
        for x, cell in enumerate((character, ink) for text, ink in row for character in text)
        if cell[0] != " "
    }


def places(picture: Picture, ink: object) -> set[tuple[int, int]]:
    """Return the (column, row) of all that is in an ink."""
    return {(column, row) for (row, column), (_, used) in cells(picture).items() if used == ink}


def inks(picture: Picture) -> set[object]:
    """Return the inks of all that is not blank."""
    return {ink for _, ink in cells(picture).values()}


def size(picture: Picture) -> tuple[int, int]:
    """Return columns and rows, which are the same in each row."""
    widths = {sum(len(text) for text, _ in row) for row in picture.rows}
    assert len(widths) <= 1
    return max(widths, default=0), len(picture.rows)


def look(picture: Picture) -> str:
    """Write a picture as text, and below it the ink of each cell: 0 is the first method's.

    a is the trail of that method; X, F, T, W, Q, G and N are EXACT, FRAME, TEXT and so on.
    """
    letters = {ink: letter for letter, ink in zip("NGQWTFX", range(-7, 0), strict=True)}
    letters |= {ink: str(ink) for ink in range(10)}
    letters |= {FAINT + ink: "abcdefghij"[ink] for ink in range(10)}
    rows = picture.text.splitlines()
    grid = cells(picture)
    for y, row in enumerate(picture.text.splitlines()):
        own = [grid.get((y, x)) for x in range(len(row))]
        rows.append("".join(letters[cell[1]] if cell else " " for cell in own))
    return "\n".join(rows) + "\n"


def screen(app: App[Any]) -> list[list[tuple[str, Style]]]:
    """Return the rows of cells on the screen, as they are sent to the terminal."""
    return [
        [(each, segment.style or Style()) for segment in strip for each in segment.text]
        for strip in app.screen._compositor.render_strips()
    ]


def looks(app: App[Any]) -> str:
    """Write the screen as text, below it a letter for each cell's style, and the styles."""
    styles: dict[str, str] = {}
    names = chain(string.ascii_letters + string.digits, map(chr, count(0x100)))

    def letter(character: str, style: Style) -> str:
        parts = [style.bgcolor, style.reverse and "reverse"]
        if character != " ":
            parts += [style.color, style.bold and "bold"]
        look = " ".join(getattr(each, "name", each) for each in parts if each)
        return styles[look] if look in styles else styles.setdefault(look, next(names))

    rows = screen(app)
    lines = ["".join(character for character, _ in row) for row in rows]
    lines += ["".join(letter(*cell) for cell in row) for row in rows]
    lines += [f"{name}: {look}" for look, name in styles.items()]
    return "\n".join(line.rstrip() for line in lines) + "\n"
