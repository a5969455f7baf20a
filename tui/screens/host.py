"""Host: what a screen needs of the app that shows it."""

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from textual.screen import Screen


class Host(Protocol):
    """What the screen needs of the app that shows it."""

    fps: int
    open_replay: Callable[[Path], Screen[None]] | None
    """Makes the screen for a recording; may raise an exception with a sentence."""

    def is_behind(self, urgent: bool = False) -> bool:
        """Whether frames are still on their way, so that the terminal should get no more of them now."""
