"""Who is using a recording: a writer holds an exclusive lock on it, a reader a shared one.

Locks end with their process, however it ends, so a leftover is told from a recording in progress.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, BinaryIO

from recordings.errors import RecordingError

if sys.platform == "win32":  # where a file that is open can be neither renamed nor deleted anyway

    def hold(file: IO[Any], shared: bool = False) -> None:
        """Lock an open file until it is closed."""

    def in_use(path: Path) -> bool:
        """Whether somebody records into this file or replays it.  In doubt, somebody does."""
        with suppress(OSError):
            path.rename(path)
            return False
        return True

    @contextmanager
    def alone_with(path: Path) -> Iterator[None]:
        """Have the file to oneself."""
        yield

else:
    import fcntl

    def hold(file: IO[Any], shared: bool = False) -> None:
        """Lock an open file until it is closed, where the file system has locks."""
        # A writer waits: on its new file nobody else has more than a look.  A reader need not have the lock.
        with suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB if shared else fcntl.LOCK_EX)

    def in_use(path: Path) -> bool:
        """Whether somebody records into this file or replays it.  In doubt, somebody does."""
        try:
            with path.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
        return False

    @contextmanager
    def alone_with(path: Path) -> Iterator[None]:
        """Have the file to oneself; raises FileNotFoundError if whoever had it before has taken it away."""
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
