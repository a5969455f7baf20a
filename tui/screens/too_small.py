"""TooSmall: the message on a terminal that is too small for everything else."""

from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture
from tui.terminal.options import SMALLEST


class TooSmall(CellWidget):
    """Says the size there is and the size it takes; the keys still work."""

    def draw(self) -> None:
        columns, rows = self.room
        needed = "x".join(map(str, SMALLEST))
        text = (
            f"Terminal too small: {columns}x{rows}, need {needed}. Enlarge it, or press q to quit."
        )
        self.show(Picture.of_text(text, columns, rows, TEXT))
