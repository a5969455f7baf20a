"""Recordings: MCAP in and out.

    samples, events --format--> messages --recorder--> file --reader--> chunks --recording--> any moment

- What a file holds: `events`; `fields`, the one table of names and units; `format`, messages to bytes and back;
  `arithmetic`, what the bits of a run depend on besides its inputs.
- Writing: `recorder` writes one file, `live_recorder` goes on when the disk fails, `headless` runs without a
  screen, `files` gives a finished file its name.
- Reading: `reader` finds the intact chunks, with mcap; `recording` gives any moment, with events and runs.
- Using: `verification` re-simulates each run; `recovery` salvages what is intact; `diff` compares two.
- Files: `library` (the folder, the names, and who is using a file), `errors`.

Data: `golden/` has the bundled recordings, `viewers/` a layout for Foxglove.

The library is `verify`, which re-simulates a recording, and `Recording`, any moment of one.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from recordings.recording import Recording
    from recordings.verification import verify

__all__ = ["Recording", "verify"]
_HOMES = {"Recording": "recording", "verify": "verification"}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"recordings.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
