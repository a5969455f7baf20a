"""EventList: the user's changes and what happened, the newest last."""

from textual import events

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.palette import QUIET, TEXT, ink_of
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.insight import short_name
from pendu_tui.tui.words.plain_text import EventLine, event_lines, numbered


class EventList(Pane):
    def __init__(self) -> None:
        super().__init__()
        self.border_title = "Events (E)"
        self._listed: list[EventLine] = []

    def picture(self, source: Source, sample: Sample) -> Picture:
        lines = event_lines(source, self.shown.hidden)
        texts = numbered(lines)[-self.room.height :]
        self._listed = lines[-self.room.height :]
        pairs = zip(self._listed, texts, strict=True)
        return Picture([[(self._fitted(text, line), self._ink(line))] for line, text in pairs])

    def _ink(self, line: EventLine) -> int:
        if line.method is not None:
            return ink_of(line.method, self.cast)
        return {"mark": TEXT}.get(line.kind, QUIET)

    def _fitted(self, text: str, line: EventLine) -> str:
        """Shorten a text to fit: letters for the methods' names, then … at the end."""
        width = self.room.width
        if line.method and len(text) > width:
            for method in self.cast:
                text = text.replace(short_name(method), method.letter)
        if len(text) > width:
            text = f"{text[: width - 1]}…"
        return text

    async def on_click(self, event: events.Click) -> None:
        offset = event.get_content_offset(self)
        if offset is not None and offset.y < len(self._listed):
            line = self._listed[offset.y]
            await self.run_action(f"screen.go_to({line.run}, {line.step})")
        else:
            await self.run_action("screen.events")
