"""TooSmall: the message on a terminal that is too small for everything else."""

from tui.drawing.canvas import Picture
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.terminal.options import SMALLEST


class TooSmall(CellWidget):
    """Says the size there is and the size it takes; the keys still work."""

    def draw(self) -> None:
        columns, rows = self.room
        needed = "x".join(map(str, SMALLEST))
        text = f"This terminal has {columns}x{rows}, pendu needs {needed}. Enlarge it, or q quits."
        self.show_picture(Picture.of_text(text, columns, rows, TEXT))
