"""InsightLine: a sentence about what to notice now."""

import textwrap
from functools import lru_cache

from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT, WARN
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.insight import insight_text


@lru_cache(maxsize=8)  # a sentence stays for many seconds
def fitted(text: str, width: int, height: int) -> list[str]:
    """Return the text on `height` lines; where it does not fit it ends in …."""
    return textwrap.wrap(text, max(width, 2), max_lines=max(height, 1), placeholder=" …")


class InsightLine(Pane):
    """What to watch in the scene, and the sentence; trouble with the recording comes first."""

    def picture(self, source: Source, sample: Sample) -> Picture:
        status = source.recording_status
        ink = TEXT
        if status is not None and status.failed:
            text = f"Not recording: {status.failed}"
            ink = WARN
        else:
            text = insight_text(source, self.shown.hidden)
        watch = source.scene.watch
        if self.room.height < 2 or not watch:
            lines = fitted(text, self.room.width - 2, self.room.height)
            return Picture([[(f" {line}", ink)] for line in lines])
        rest = "" if text == watch else text
        lines = fitted(watch, self.room.width - 2, 1) + fitted(rest, self.room.width - 2, 1)
        return Picture(
            [[(f" {line}", each)] for line, each in zip(lines, (TEXT, ink), strict=False)]
        )
