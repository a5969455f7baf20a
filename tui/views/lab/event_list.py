"""DiaryPane: what was done and what happened, the newest last."""

from textual.reactive import var

from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.playback.source import Source
from tui.words.events import diary


class EventList(CellWidget):
    """The last lines of the diary."""

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
            lines = diary(self.source)[-self.room.height :]
            self.show([[(str(line), line.owner)] for line in lines])
