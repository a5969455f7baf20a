"""InsightLine: a sentence about what to notice now, and at first a hint or two."""

import textwrap
from functools import lru_cache

from engine.run.lockstep import Sample
from tui.drawing.palette import TEXT, WARN
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.insight import hint, insight


@lru_cache(maxsize=8)  # it stays for many seconds
def fitted(text: str, width: int, height: int) -> list[str]:
    """The text on `height` lines; where it does not fit it ends in …."""
    return textwrap.wrap(text, max(width, 2), max_lines=max(height, 1), placeholder=" …")


class InsightLine(Pane):
    """The sentence; trouble with the recording comes before everything else."""

    _began: float | None = None  # s, the clock

    def paint(self, source: Source, sample: Sample) -> None:
        status = source.recording_status
        if status is not None and status.failed:
            text, owner = f"Not recording: {status.failed}", WARN
        else:
            text, owner = self._hint(source) or insight(source, self.shown.hidden), TEXT
        lines = fitted(text, self.room.width - 2, self.room.height)
        self.show(Picture([[(f" {line}", owner)] for line in lines]))

    def _hint(self, source: Source) -> str:
        """The hint that is due after some time in the lab; none where time that ran backwards is back at 0."""
        now = source.playhead.seen
        if now is None or not self.is_live or source.history.returned is not None:
            return ""
        self._began = now if self._began is None else self._began
        return hint(now - self._began, source.events)
