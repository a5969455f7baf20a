"""Recover: write what is intact of a damaged or unfinished recording as a whole one.

Chunks are kept or dropped as they are; no number is repaired, guessed or changed.
"""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from recordings.errors import DiskError, NameTakenError, RecordingError, printable
from recordings.events import Event
from recordings.files import publish
from recordings.library import PART, alone_with, free_path
from recordings.reader import ShowProgress
from recordings.recorder import Recorder
from recordings.recording import Recording


@dataclass(frozen=True, slots=True)
class Recovery:
    """The result of a recovery."""

    file: str
    out: str  # the recording that was written
    damaged: bool  # more was wrong than that it was not finished
    reason: str | None  # what was wrong, a clause; None if nothing was
    samples_kept: int
    entries_lost: int  # samples and events, as far as the numbers of the others show
    runs_lost: int  # runs whose start was lost


def recover(
    path: Path, out: Path, progress: ShowProgress | None = None, overwrite: bool = False
) -> Recovery:
    """Write what is intact of `path` to `out`, which appears only when it is whole.

    Raises RecordingError if nothing can be saved, DiskError if `out` cannot be written.
    """
    if out.exists() and path.exists() and out.samefile(path):
        raise DiskError("is the recording to recover; choose another name", out)
    with Recording.open(path, check=True, progress=progress) as recording:
        recorder = Recorder(out, None, overwrite)
        try:
            for clock, value in recording.entries():
                if value is None:
                    recorder.note_gap()
                elif isinstance(value, Event):
                    recorder.event(value, clock)
                else:
                    recorder.sample(value, clock)
            if not recorder.samples:
                why = recording.reason or "it has no samples"
                raise RecordingError(f"{printable(str(path))}: {why}.")
            recorder.close()
        finally:
            recorder.abandon(delete=True)
        return Recovery(
            file=str(path),
            out=str(recorder.path),
            damaged=recording.damaged,
            reason=recording.reason,
            samples_kept=recorder.samples,
            entries_lost=recording.entries_lost,
            runs_lost=len(recording.lost_runs),
        )


def rescue(leftover: Path, progress: ShowProgress | None = None) -> str:
    """Make a recording of a leftover, and return a sentence about it.

    The leftover is removed once all of it is in the recording, or if it was empty; otherwise it is
    renamed, so that it is not found again.  Raises OSError if the disk fails.
    """
    with alone_with(leftover):
        if leftover.stat().st_size == 0:
            leftover.unlink()
            return f"An unfinished recording was empty: {printable(str(leftover))}."
        name = leftover.with_name(leftover.name.removesuffix(PART))
        try:
            recovery = recover(leftover, free_path(name), progress)
        except RecordingError as error:
            kept = _put_aside(leftover, ".unreadable")
            return f"An unfinished recording cannot be recovered: {error}{kept}"
        kept = ""
        if recovery.damaged:
            kept = f" {recovery.entries_lost} samples and events are lost."
            kept += _put_aside(leftover, ".damaged")
        else:
            leftover.unlink()
        saved = Path(recovery.out)
        with suppress(NameTakenError):
            publish(saved, name)
            saved = name
        return f"An unfinished recording was recovered: {printable(str(saved))}.{kept}"


def _put_aside(leftover: Path, suffix: str) -> str:
    kept = leftover.rename(free_path(leftover.with_name(leftover.name + suffix)))
    return f" The original is kept as {printable(str(kept))}."
