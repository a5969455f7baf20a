"""Host: the parts of the app that a screen uses."""

from typing import Protocol


class Host(Protocol):
    """The app, as its screens see it."""

    fps: int
