"""EventList: what was done and what happened, the newest last."""

from textual import events

from engine.methods import Cast
from engine.run.lockstep import Sample
from tui.drawing.palette import QUIET, TEXT, ink_of
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.messages import Asked
from tui.views.view import Pane
from tui.words.events import EventLine, event_lines, numbered
from tui.words.insight import short_name


def line_ink(line: EventLine, cast: Cast) -> int:
    """Return the ink of a line; a milestone has its method's."""
    if line.method is not None:
        return ink_of(line.method, cast)
    return TEXT if line.kind == "mark" else QUIET


class EventList(Pane):
    """As many of the last events as there is room for."""

    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E)"
        self._listed: list[EventLine] = []
        self._listed_for: object = None
        self._words = Picture()

    def picture(self, source: Source, sample: Sample) -> Picture:
        listed_for = (
            [*source.events],
            [*source.later_marks],
            [*source.milestones],
            sample.run,
            self.room,
        )
        if listed_for != self._listed_for:  # to put them into words takes long
            self._listed_for = listed_for
            lines = event_lines(source)
            last = [*zip(lines, numbered(lines), strict=True)][-self.room.height :]
            self._listed = [line for line, _ in last]
            self._words = Picture(
                [[(self._fitted(text, line), line_ink(line, self.cast))] for line, text in last]
            )
        return self._words

    def _fitted(self, text: str, line: EventLine) -> str:
        """A text; where it is too long, methods go by their letters, or it ends in …."""
        width = self.room.width
        for method in self.cast if line.method and len(text) > width else ():
            text = text.replace(short_name(method), method.letter)
        return text if len(text) <= width else f"{text[: width - 1]}…"

    def on_click(self, event: events.Click) -> None:
        """Go to an event, or list them all."""
        offset = event.get_content_offset(self)
        if offset is not None and offset.y < len(self._listed):
            line = self._listed[offset.y]
            self.post_message(Asked(f"go_to({line.run}, {line.step})"))
        else:
            self.post_message(Asked("events"))
