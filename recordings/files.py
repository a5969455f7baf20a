"""Files that are written whole or not at all.

A file is written under a temporary name beside its target.  It gets its name when it is finished,
if the name is still free or may be replaced.
"""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pendu_tui.recordings.errors import DiskError, NameTakenError, writing
from pendu_tui.recordings.system import rename


def check_target(path: Path, force: bool = False) -> None:
    """Raise DiskError if the name is taken, its folder is missing, or it is "-"."""
    if str(path) == "-":
        raise DiskError("is no name for a file; choose another", path)
    why = "already exists; choose another name"
    if path.is_dir():
        raise NameTakenError(why, path)
    if not force and os.path.lexists(path):
        raise NameTakenError(f"{why}, or --force to overwrite it", path)
    if not path.parent.is_dir():
        raise DiskError(f"no folder {path.parent}; choose a folder that exists", path)


def is_stream(path: Path) -> bool:
    """Return whether this is a device, a pipe or a socket, which no file may replace."""
    return path.exists() and not path.is_file() and not path.is_dir()


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """Yield a temporary path to write to, which is renamed to `path` after the block.

    If the block raises, the temporary file is deleted and an older file stays as it was.  Devices
    and pipes are written to directly.  Raises DiskError before the block if the name is taken.
    """
    if is_stream(path):
        yield path
        return
    check_target(path, force)
    with writing(path):
        handle, name = tempfile.mkstemp(".part", f".{path.name[:100]}.", path.parent)
        os.close(handle)
    part = Path(name)
    try:
        umask = os.umask(0)
        os.umask(umask)
        part.chmod(0o666 & ~umask)  # mkstemp makes files private
        yield part
        publish(part, path, force)
    finally:
        part.unlink(missing_ok=True)


def publish(part: Path, path: Path, force: bool = False) -> None:
    """Give a finished and closed file its name.  Raises NameTakenError if another file took it meanwhile."""
    with writing(path):
        if force:
            part.replace(path)
            return
        try:
            rename(part, path)
        except FileExistsError as error:
            raise NameTakenError("a file of this name appeared meanwhile", path) from error
