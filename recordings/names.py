"""Names of recordings, finished and not."""

from itertools import chain, count
from os.path import lexists
from pathlib import Path

SUFFIX = ".mcap"
PART = ".part"  # appended to the name of a recording that is not finished
MARKS = ".marks.json"  # appended to the name of a recording: what was marked while it was replayed


def part_of(path: Path) -> Path:
    """Where a recording is until it is finished."""
    return path.with_name(path.name + PART)


def free_path(path: Path) -> Path:
    """`path`, or the first of NAME-2, NAME-3, … that no recording has, finished or not."""
    numbered = (path.with_name(f"{path.stem}-{n}{path.suffix}") for n in count(2))
    return next(free for free in chain([path], numbered) if not lexists(free) and not lexists(part_of(free)))
