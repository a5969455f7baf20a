"""The contents of a picture, cell by cell."""

from pendu_tui.tui.drawing.picture import Picture


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
