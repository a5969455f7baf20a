"""EventList: what was done and what happened, the newest last."""

from textual.reactive import var

from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.drawing.palette import FRAME, TEXT
from tui.playback.source import Source
from tui.words.events import EventLine, event_lines


def owner_of(line: EventLine) -> int:
    """A milestone has its method's colour."""
    return line.method if line.method is not None else TEXT if line.kind == "mark" else FRAME


class EventList(CellWidget):
    """The last events."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)

    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E: all)"

    def watch_sample(self) -> None:
        """Follow the sample."""
        self.draw()

    def draw(self) -> None:
        """Draw as many lines as there is room for."""
        if self.source is not None and self.drawable:
            lines = event_lines(self.source)[-self.room.height :]
            self.show([[(str(line), owner_of(line))] for line in lines])
