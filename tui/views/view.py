"""View: what fills the screen between the status line and the key line."""

from typing import ClassVar

from textual.containers import Container
from textual.reactive import var

from engine.run.lockstep import Sample
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.keys import Key


class View(Container):
    """A view gets these from the screen, and hands them on to its widgets with data_bind."""

    KEYS: ClassVar[tuple[Key, ...]] = ()
    """What the help says besides the screen's keys."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    """Every frame, 30 a second."""
    sample_10hz: var[Sample | None] = var(None)
    """The sample as often as people can read it, 10 times a second."""
    sample_5hz: var[Sample | None] = var(None)
    """The sample as often as a chart is worth building, 5 times a second."""
    shown: var[Shown] = var(Shown())
