"""EventList: what was done and what happened, the newest last."""

from engine.run.lockstep import Sample
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.events import diary


class EventList(Pane):
    """As many of the last lines as there is room for."""

    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E: all)"

    def paint(self, source: Source, sample: Sample) -> None:
        lines = diary(source)[-self.room.height :]
        self.show([[(str(line), line.owner)] for line in lines])
