"""Recordings: MCAP files of runs.

Written: samples and events --`format`--> messages --`recorder`--> file.
Read: file --`reader`--> chunks --`recording`--> samples and events of any moment.

The names below are loaded when they are used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pendu_tui.recordings.recording import Recording
    from pendu_tui.recordings.verification import verify

__all__ = ["Recording", "verify"]
_HOMES = {"Recording": "recording", "verify": "verification"}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"pendu_tui.recordings.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
