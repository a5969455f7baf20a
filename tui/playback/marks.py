"""Marks made during a replay.  They are kept next to the recording, which is not touched."""

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from recordings import library
from recordings.errors import printable
from recordings.files import whole_file

SCHEMA = "pendu.marks/1"


@dataclass(frozen=True, slots=True)
class Mark:
    clock: float  # s, the recording clock
    run: int
    step: int
    text: str | None = None


class Marks:
    """The marks of one recording, in FILE.marks.json; of a bundled one, in the library."""

    def __init__(self, recording: Path) -> None:
        folder = recording.parent
        if folder == library.GOLDEN:
            folder = library.folder() / "bundled"
        self.path = folder / (recording.name + library.MARKS)
        self._marks = _read(self.path)

    def __iter__(self) -> Iterator[Mark]:
        return iter(self._marks)

    def add(self, mark: Mark) -> None:
        """Add a mark and save all of them.

        Raises OSError if they cannot be saved; the mark is set nevertheless.
        """
        others = {*_read(self.path), *self._marks}  # another replay may have added some
        self._marks = sorted({*others, mark}, key=lambda each: each.clock)
        content = {"schema": SCHEMA, "marks": [asdict(each) for each in self._marks]}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(self.path, force=True) as part:
            part.write_text(json.dumps(content, indent=1), encoding="utf-8")


def _read(path: Path) -> list[Mark]:
    """The marks in a file; none, where it is not there or not ours."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        marks = [_mark(**fields) for fields in content["marks"] if content["schema"] == SCHEMA]
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return []
    return sorted(marks, key=lambda mark: mark.clock)


def _mark(clock: Any, run: Any, step: Any, text: Any) -> Mark:
    return Mark(float(clock), int(run), int(step), text and printable(str(text)))
