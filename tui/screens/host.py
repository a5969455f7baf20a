"""Host: the parts of the app that a screen uses."""

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from textual.screen import Screen


class Host(Protocol):
    """The app, as its screens see it."""

    fps: int
    open_replay: Callable[[Path], Screen[None]] | None
    """Makes the screen for a recording; may raise an exception with a sentence."""
