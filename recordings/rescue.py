"""Rescue: a recording of what a sitting that was killed has left."""

from dataclasses import dataclass
from pathlib import Path

from recordings.errors import RecordingError, printable
from recordings.lock import alone_with
from recordings.names import PART, free_path
from recordings.recover import Recovery, recover
from recordings.scan import ShowProgress


@dataclass(frozen=True, slots=True)
class Rescue:
    """What became of a recording that was left unfinished."""

    leftover: Path
    saved: Path | None  # the recording made of it; None if nothing could be saved
    kept: Path | None  # where the leftover is now; None if all of it is in `saved`, or it was empty
    recovery: Recovery | None
    reason: str | None  # why nothing could be saved, a sentence


def rescue(leftover: Path, progress: ShowProgress | None = None) -> Rescue:
    """Make a recording of a leftover.

    The leftover is removed once all of it is in the recording, or if it was empty; else it stays, renamed so
    that it is not found again.  Raises OSError if the disk does not let us.
    """
    with alone_with(leftover):
        if leftover.stat().st_size == 0:
            leftover.unlink()
            return Rescue(leftover, None, None, None, f"{printable(str(leftover))}: the file is empty.")
        name = leftover.with_name(leftover.name.removesuffix(PART))
        try:
            recovery = recover(leftover, free_path(name), progress)
        except RecordingError as error:
            return Rescue(leftover, None, _put_aside(leftover, ".unreadable"), None, str(error))
        if recovery.damaged:
            return Rescue(leftover, recovery.out, _put_aside(leftover, ".damaged"), recovery, None)
        leftover.unlink()
        saved = recovery.out if name.exists() else recovery.out.rename(name)
        return Rescue(leftover, saved, None, recovery, None)


def _put_aside(path: Path, suffix: str) -> Path:
    return path.rename(free_path(path.with_name(path.name + suffix)))
