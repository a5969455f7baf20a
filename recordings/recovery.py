"""Recover: save the intact chunks of a damaged or unfinished recording as a complete one.

No number is repaired, guessed or changed, but the extremes of the first sample after a gap: the
steps before it are lost.
"""

from pathlib import Path
from typing import Any

from pendu_tui.recordings.errors import RecordingError
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.reader import ShowProgress
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording


def recover(
    path: Path, out: Path, progress: ShowProgress | None = None, overwrite: bool = False
) -> dict[str, Any]:
    """Write what is intact of `path` to `out`, which appears only when it is complete.

    Returns the fields of the report.  `damaged` is False if the recording was only unfinished;
    `runs_lost` counts runs whose start is lost.  Raises RecordingError if nothing can be saved,
    DiskError if `out` cannot be written.
    """
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
                raise RecordingError(f"{path}: {why}.")
            recorder.close()
        finally:
            recorder.abandon(delete=True)
        return {
            "file": str(path),
            "out": str(recorder.path),
            "damaged": recording.damaged,
            "reason": recording.reason,
            "samples_kept": recorder.samples,
            "entries_lost": recording.entries_lost,
            "runs_lost": len(recording.lost_runs),
        }
