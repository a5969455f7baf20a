"""TooSmall: the message on a terminal that is too small for everything else."""

from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.terminal.options import SMALLEST


class TooSmall(CellWidget):
    """Says the size there is and the size it takes; the keys still work."""

    def draw(self) -> None:
        from tui.drawing.canvas import Picture  # brings NumPy, which a lab on screen does not wait for

        columns, rows = self.room
        needed = "x".join(map(str, SMALLEST))
        text = f"Terminal too small: {columns}x{rows}, need {needed}. Enlarge it, or press q to quit."
        self.show_picture(Picture.of_text(text, columns, rows, TEXT))
