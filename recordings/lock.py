"""Who is using a recording: a writer holds an exclusive lock on it, a reader a shared one.

A lock ends with its process, however that ends, so a leftover differs from a recording in progress.
Only POSIX has such locks; elsewhere nothing is locked.
"""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, BinaryIO

from recordings.errors import RecordingError


def hold(file: IO[Any], shared: bool = False) -> None:
    """Lock an open file until it is closed, where the file system has locks."""
    with suppress(OSError):  # writers block (others only probe a new file); readers go on without the lock
        _lock(file, shared, wait=not shared)


def in_use(path: Path) -> bool:
    """Whether a recorder or a reader has this file open.  In doubt, yes."""
    try:
        with path.open("rb") as file:
            _lock(file, shared=False, wait=False)
    except OSError:
        return True
    return False


@contextmanager
def alone_with(path: Path) -> Iterator[None]:
    """Have the file to oneself; raises FileNotFoundError if its former user has moved it meanwhile."""
    with path.open("rb") as file:
        hold(file)
        path.stat()
        yield


def open_file(path: Path) -> BinaryIO:
    """The file to read, marked as in use until it is closed."""
    try:
        file = path.open("rb")
    except OSError as error:
        raise RecordingError(error.strerror or str(error)) from error
    if not file.seekable():
        file.close()
        raise RecordingError("this is a pipe, which can be read only once; save it as a file first")
    hold(file, shared=True)
    return file


def _lock(file: IO[Any], shared: bool, wait: bool) -> None:
    try:
        import fcntl
    except ImportError:
        return
    fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | (0 if wait else fcntl.LOCK_NB))
