"""TooSmall: what is said on a terminal on which nothing fits."""

from tui.drawing.canvas import Picture
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT


class TooSmall(CellWidget):
    """Have and need.  The keys go on working."""

    def __init__(self, need: tuple[int, int]) -> None:
        super().__init__()
        self._need = need

    def draw(self) -> None:
        """Draw the message."""
        columns, rows = self.room
        need_columns, need_rows = self._need
        text = f"This terminal has {columns}x{rows}, pendu needs {need_columns}x{need_rows}. Enlarge it, or q quits."
        self.show_picture(Picture.of_text(text, columns, rows, TEXT))
