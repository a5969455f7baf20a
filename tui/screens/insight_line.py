"""InsightLine: what to notice, in a sentence, and at first a hint or two."""

import textwrap

from textual.reactive import var

from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT, WARN
from tui.playback.source import Source
from tui.words.insight import hint, insight


def fitted(text: str, width: int, height: int) -> list[str]:
    """The text on `height` lines; where it does not fit it ends in …."""
    return textwrap.wrap(text, max(width, 2), max_lines=max(height, 1), placeholder=" …")


class InsightLine(CellWidget):
    """The sentence; trouble with the recording comes before everything else."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)

    def __init__(self) -> None:
        super().__init__()
        self._began: float | None = None  # s, the clock

    def watch_sample(self) -> None:
        """Follow the sample."""
        self.draw()

    def draw(self) -> None:
        """Draw the sentence."""
        if self.source is None or not self.drawable:
            return
        recording_status = self.source.recording_status
        if recording_status is not None and recording_status.failed:
            text, owner = f"Nothing is being recorded: {recording_status.failed}", WARN
        else:
            text, owner = self._hint(self.source) or insight(self.source), TEXT
        self.show([[(f" {line}", owner)] for line in fitted(text, self.room.width - 2, self.room.height)])

    def _hint(self, source: Source) -> str:
        """The hint that is due in a lab that has been on screen for a while."""
        now = source.playhead.seen
        if now is None or source.kind != "LIVE":
            return ""
        self._began = now if self._began is None else self._began
        return hint(now - self._began, source.events)
