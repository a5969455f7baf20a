"""Marks made during a replay.  They are kept next to the recording, which is not touched.

Those of a bundled recording are kept in the library, because its own folder is the program's.
"""

import json
import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recordings import library
from recordings.errors import printable
from recordings.events import Event
from recordings.format import STEP_LIMIT
from recordings.library import MARKS

if TYPE_CHECKING:
    from recordings.timeline import Events

SCHEMA = "pendu.marks/1"
SIZE_LIMIT = 1 << 20  # bytes


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
        folder = library.folder() if recording.parent == library.GOLDEN else recording.parent
        self.path = folder / (recording.name + MARKS)
        self._marks = _read(self.path)

    def __iter__(self) -> Iterator[Mark]:
        return iter(self._marks)

    def add(self, mark: Mark) -> None:
        """Add a mark and save them all.  Raises OSError where that is impossible; the mark is there nevertheless."""
        self._marks = sorted([*self._marks, mark], key=lambda each: each.clock)
        text = json.dumps({"schema": SCHEMA, "marks": [asdict(each) for each in self._marks]}, indent=1)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        beside = self.path.with_name(self.path.name + ".new")
        beside.write_text(text, encoding="utf-8")
        beside.replace(self.path)


def mark_events(marks: Iterable[Mark], events: "Events") -> Iterator[Event]:
    """Marks as events, at the simulated times that the starts and changes among `events` give their steps."""
    for run, of_run in groupby(sorted(marks, key=attrgetter("run", "clock")), attrgetter("run")):
        changes = [event for _, event in events.of(run) if event.kind in ("start", "set_h")]
        for mark in of_run:
            t, h, since = 0.0, 0.0, 0
            at = bisect_right(changes, mark.step, key=attrgetter("step"))
            if at:
                event = changes[at - 1]
                t, since = event.t, event.step
                h = event.scene.h if event.scene is not None else event.h or 0.0
            yield Event("mark", mark.run, mark.step, t + (mark.step - since) * h, text=mark.text)


def _read(path: Path) -> list[Mark]:
    """The marks in a file; none, where it is not there or not ours."""
    try:
        if path.stat().st_size > SIZE_LIMIT:
            return []
        content = json.loads(path.read_text(encoding="utf-8"))
        marks = [_mark(fields) for fields in content["marks"]] if content["schema"] == SCHEMA else []
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return []
    return sorted(marks, key=lambda mark: mark.clock)


def _mark(fields: dict[str, Any]) -> Mark:
    clock, run, step, text = float(fields["clock"]), int(fields["run"]), int(fields["step"]), fields["text"]
    if not math.isfinite(clock) or max(abs(run), abs(step)) >= STEP_LIMIT:
        raise ValueError("a mark needs a time, a run and a step")
    return Mark(clock, run, step, None if text is None else printable(str(text)))
