"""Library: the folder of recordings, their names and locks.

A writer locks a recording exclusively; readers share it.  A lock ends with its process, which
tells leftovers from recordings in progress.  Only POSIX has such locks.
"""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os.path import lexists
from pathlib import Path
from typing import IO, Any, BinaryIO, NamedTuple

import platformdirs

from pendu_tui.recordings.errors import DiskError, RecordingError
from pendu_tui.recordings.files import is_stream

SUFFIX = ".mcap"
PART = ".part"  # appended to the name of an unfinished recording
GOLDEN = Path(__file__).parent / "golden"


class Item(NamedTuple):
    """A finished recording in the library."""

    path: Path
    bytes: int
    modified: float  # s since 1970


def part_of(path: Path) -> Path:
    """Return where a recording is until it is finished."""
    return path.with_name(path.name + PART)


def free_path(path: Path) -> Path:
    """Return `path`, or the first of NAME-2, NAME-3, … that is free, also with PART appended."""
    candidate = path
    number = 1
    while lexists(candidate) or lexists(part_of(candidate)):
        number += 1
        candidate = path.with_name(f"{path.stem}-{number}{path.suffix}")
    return candidate


def folder() -> Path:
    """Return $PENDU_RECORDINGS, or else a folder in the user's data, which need not exist."""
    chosen = os.environ.get("PENDU_RECORDINGS")
    if not chosen:
        return platformdirs.user_data_path("pendu-tui", False) / "recordings"
    try:
        return Path(chosen).expanduser()
    except RuntimeError as error:
        raise DiskError("PENDU_RECORDINGS names no folder", chosen) from error


def new_path(where: Path | None = None) -> Path:
    """Return a free name made of date and time."""
    name = time.strftime("%Y-%m-%dT%H-%M-%S") + SUFFIX
    return free_path((where or folder()) / name)


def listing(where: Path | None = None) -> list[Item]:
    """Return the finished recordings, newest first."""
    items = []
    for path in _files(where or folder(), SUFFIX):
        with suppress(OSError):  # deleted meanwhile
            status = path.stat()
            items.append(Item(path, status.st_size, status.st_mtime))
    return sorted(items, key=lambda item: (item.modified, item.path.name), reverse=True)


def golden_names() -> list[str]:
    """Return the names of the bundled recordings."""
    return sorted(path.stem for path in GOLDEN.glob("*" + SUFFIX))


def leftovers(where: Path | None = None, being_made: bool = False) -> list[Path]:
    """Return the unfinished recordings that no lab is writing, or those that are being made."""
    unfinished = _files(where or folder(), SUFFIX + PART)
    return [path for path in unfinished if in_use(path) == being_made]


def _files(where: Path, suffix: str) -> list[Path]:
    try:
        return [path for path in where.iterdir() if path.name.endswith(suffix) and path.is_file()]
    except FileNotFoundError:
        return []


def hold(file: IO[Any], shared: bool = False) -> None:
    """Lock an open file until it is closed, where the file system has locks.

    An exclusive lock waits for the probes of `in_use`; without a shared one a reader goes on.
    """
    with suppress(OSError):
        _lock(file, shared, wait=not shared)


def in_use(path: Path) -> bool:
    """Return whether a recorder or a reader has this file open; if in doubt, True."""
    try:
        with path.open("rb") as file:
            _lock(file, shared=False, wait=False)
    except OSError:
        return True
    return False


@contextmanager
def alone_with(path: Path) -> Iterator[None]:
    """Lock the file.  Raises FileNotFoundError if whoever held the lock before moved the file."""
    with path.open("rb") as file:
        hold(file)
        path.stat()
        yield


def open_file(path: Path) -> BinaryIO:
    """Open a file to read, locked until it is closed."""
    if is_stream(path):
        raise RecordingError("this is a device or a pipe; save it as a file")
    try:
        file = path.open("rb")
    except OSError as error:
        raise RecordingError(error.strerror or str(error)) from error
    hold(file, shared=True)
    return file


def _lock(file: IO[Any], shared: bool, wait: bool) -> None:
    try:
        import fcntl
    except ImportError:
        return
    operation = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
    if not wait:
        operation |= fcntl.LOCK_NB
    fcntl.flock(file, operation)
