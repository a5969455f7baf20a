"""Files that are written whole or not at all.

A file is written under a temporary name beside its target, and gets its name only once it is
finished and only if the name is still free, or may be replaced.
"""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from recordings.errors import DiskError, NameTakenError, printable, writing


def check_target(path: Path, force: bool = False) -> None:
    """Raise DiskError if the name is taken, its folder is missing, or it is "-"."""
    if str(path) == "-":
        raise DiskError("is no name for a file; choose another", path)
    if os.path.lexists(path) and (not force or path.is_dir()):
        advice = "" if path.is_dir() else ", or --force to overwrite it"
        raise NameTakenError(f"already exists; choose another name{advice}", path)
    if not path.parent.is_dir():
        raise DiskError(
            f"no folder {printable(str(path.parent))}; choose a folder that exists", path
        )


def is_stream(path: Path) -> bool:
    """Return whether this is a device, a pipe or a socket, which is never replaced by a file."""
    return path.exists() and not path.is_file() and not path.is_dir()


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """Yield the path to write to; what is there at the end gets the name `path`.

    If the block raises, nothing is left of it and an older file stays as it was.  A device or a
    pipe is written to as it is.  Raises DiskError before the block if the name is taken.
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
        part.chmod(0o666 & ~umask)  # mkstemp makes it private
        yield part
        publish(part, path, force)
    finally:
        part.unlink(missing_ok=True)


def publish(part: Path, path: Path, force: bool = False) -> None:
    """Give a finished file its name.  Raises NameTakenError if another one has it by now."""
    try:
        with writing(path):
            if force:
                part.replace(path)
                return
            try:
                os.link(part, path)
            except FileExistsError:
                raise
            except OSError:  # no links on this file system
                with part.open("rb") as source, path.open("xb") as target:
                    while block := source.read(1 << 20):
                        target.write(block)
            part.unlink()
    except DiskError as error:
        if isinstance(error.__cause__, FileExistsError):
            raise NameTakenError("a file of this name appeared meanwhile", path) from error
        raise
