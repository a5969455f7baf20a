"""EventList: what was done and what happened, the newest last."""

from engine.run.lockstep import Sample
from tui.drawing.palette import QUIET, TEXT, series
from tui.playback.source import Source
from tui.views.messages import Asked
from tui.views.view import Pane
from tui.words.events import EventLine, event_lines, numbered


def owner_of(line: EventLine) -> int:
    """A milestone has its method's colour."""
    return series(line.method) if line.method is not None else TEXT if line.kind == "mark" else QUIET


class EventList(Pane):
    """As many of the last events as there is room for."""

    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E)"

    def paint(self, source: Source, sample: Sample) -> None:
        lines = event_lines(source)
        texts = numbered(lines)
        self.show([[(text, owner_of(line))] for line, text in [*zip(lines, texts, strict=True)][-self.room.height :]])

    def on_click(self) -> None:
        """List them all."""
        self.post_message(Asked("app.extra('events')"))
