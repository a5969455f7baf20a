"""What views are made of: View fills the screen between the status line and the key line, Pane draws in it."""

from typing import ClassVar

from textual.containers import Container
from textual.reactive import var

from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.keys import Key


class View(Container):
    """A view gets these from the screen, and passes them on to its panes with data_bind."""

    KEYS: ClassVar[tuple[Key, ...]] = ()
    """The keys of its panes, for the help."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    """Every frame."""
    sample_10hz: var[Sample | None] = var(None)
    """The sample as often as people can read it, 10 times a second."""
    sample_5hz: var[Sample | None] = var(None)
    """The sample as often as a chart is worth building, 5 times a second."""
    shown: var[Shown] = var(Shown())


class Pane(CellWidget):
    """Draws a source at one of its samples, again whenever one of the three values changes."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    shown: var[Shown] = var(Shown())

    def watch_source(self) -> None:
        self.draw()

    def watch_sample(self) -> None:
        self.draw()

    def watch_shown(self) -> None:
        self.draw()

    @property
    def is_live(self) -> bool:
        """Whether the source is the lab, where runs can be started, and not a recording."""
        return self.source is not None and self.source.kind == "LIVE"

    def draw(self) -> None:
        if self.source is not None and self.sample is not None and self.drawable:
            self.paint(self.source, self.sample)

    def paint(self, source: Source, sample: Sample) -> None:
        """Show the sample; called when there is one, and room to show it."""
        raise NotImplementedError
