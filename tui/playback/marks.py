"""Marks made during a replay.  They are kept next to the recording, which is not touched.

Those of a bundled recording are kept in a folder of the library, because its own folder is the
program's and the library may have a recording of the same name.
"""

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recordings import library
from recordings.errors import printable
from recordings.events import Event
from recordings.fields import MAX_INTEGER
from recordings.files import whole_file
from recordings.library import MARKS

if TYPE_CHECKING:
    from recordings.recording import Recording

SCHEMA = "pendu.marks/1"
MAX_SIZE = 1 << 20  # bytes


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark at a moment of a recording."""

    clock: float  # s, the recording clock
    run: int
    step: int
    text: str | None = None


class Marks:
    """The marks of one recording, in FILE.marks.json."""

    def __init__(self, recording: Path) -> None:
        is_bundled = recording.parent == library.GOLDEN
        folder = library.folder() / "bundled" if is_bundled else recording.parent
        self.path = folder / (recording.name + MARKS)
        self._marks = _read(self.path)

    def __iter__(self) -> Iterator[Mark]:
        return iter(self._marks)

    def add(self, mark: Mark) -> None:
        """Add a mark and save all of them.

        Raises OSError if they cannot be saved; the mark is set nevertheless.
        """
        others = {*_read(self.path), *self._marks}  # another replay may have added some
        self._marks = sorted({*others, mark}, key=lambda each: each.clock)
        text = json.dumps(
            {"schema": SCHEMA, "marks": [asdict(each) for each in self._marks]}, indent=1
        )
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(self.path, force=True) as part:
            part.write_text(text, encoding="utf-8")


def mark_event(recording: "Recording", mark: Mark) -> Event:
    """Return a mark as an event, at the simulated time of its step."""
    t = 0.0
    h = 0.0
    since = 0
    run = recording.run_of(mark.run)
    for _, event in run.events if run else ():
        if event.kind in ("start", "set_h") and event.step <= mark.step:
            t = event.t
            since = event.step
            h = event.scene.h if event.scene else event.h or 0.0
    return Event("mark", mark.run, mark.step, t + (mark.step - since) * h, text=mark.text)


def _read(path: Path) -> list[Mark]:
    """The marks in a file; none, where it is not there or not ours."""
    try:
        if path.stat().st_size > MAX_SIZE:
            return []
        content = json.loads(path.read_text(encoding="utf-8"))
        marks = (
            [_mark(fields) for fields in content["marks"]] if content["schema"] == SCHEMA else []
        )
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return []
    return sorted(marks, key=lambda mark: mark.clock)


def _mark(fields: dict[str, Any]) -> Mark:
    clock = float(fields["clock"])
    text = fields["text"]
    run = int(fields["run"])
    step = int(fields["step"])
    if not math.isfinite(clock) or max(abs(run), abs(step)) >= MAX_INTEGER:
        raise ValueError("a mark needs a time, a run and a step")
    return Mark(clock, run, step, None if text is None else printable(str(text)))
