"""Files: their names, locks and errors, the folder of recordings, and text made safe to print.

A recorder locks its file, and the lock ends with its process: that tells unfinished recordings from
those that are being made.
"""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os.path import lexists
from pathlib import Path
from typing import NamedTuple

from pendu_tui.recordings.system import is_reserved, lock, rename

SUFFIX = ".mcap"
PART = ".part"  # appended to the name of an unfinished recording
GOLDEN = Path(__file__).parent / "golden"
MAGIC = b"\x89MCAP0\r\n"
PROFILE = "pendu"  # in the file's header
_PROFILE_AT = len(MAGIC) + 9  # after the header's opcode and length
MAX_TEXT = 200  # characters of one text from a file; a mark or a scene's name is shorter


class RecordingError(Exception):
    """A recording cannot be read; the text is a sentence for the user."""


class DiskError(OSError):
    """A file cannot be written; the text is a sentence for the user."""

    def __init__(self, why: str, path: object, errno: int = 0) -> None:
        super().__init__(errno, why, str(path))

    def __str__(self) -> str:
        return f"{self.filename}: {self.strerror}"


class NameTakenError(DiskError):
    """A file cannot be written because its name is taken."""


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Turn errors while `path` is read into a RecordingError that names it."""
    try:
        yield
    except (OSError, RecordingError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise RecordingError(f"{path}: {why.removesuffix('.')}.") from error


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn an OSError while `path` is written into a DiskError."""
    try:
        yield
    except DiskError:
        raise
    except OSError as error:
        raise DiskError(error.strerror or str(error), path, error.errno or 0) from error


def printable(text: str, limit: int = MAX_TEXT) -> str:
    """Return at most `limit` characters of the text, without those that control a terminal."""
    if len(text) > limit:
        text = text[: limit - 1] + "…"
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


class Item(NamedTuple):
    """A recording in the library."""

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


def check_target(path: Path, force: bool | None = False) -> None:
    """Raise DiskError if no file can be written under this name.

    With `force` it may be taken; None: where --force is no option.  A device or a pipe is fine.
    """
    if str(path) == "-" or is_reserved(path.name):
        raise DiskError("is not a file name; choose another", path)
    if is_stream(path):
        return
    why = "already exists; choose another name"
    if path.is_dir() or (force is None and lexists(path)):
        raise NameTakenError(why, path)
    if not force and lexists(path):
        raise NameTakenError(f"{why}, or --force to overwrite it", path)
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise DiskError("its folder does not exist or is not writable; choose another", path)


def is_stream(path: Path) -> bool:
    """Return whether this is a device, a pipe or a socket, which no file may replace."""
    return path.exists() and not path.is_file() and not path.is_dir()


def publish(part: Path, path: Path, force: bool) -> None:
    """Give a finished and closed file its name, if that is free or may be replaced.

    Raises NameTakenError if another file took the name meanwhile.
    """
    with writing(path):
        if force:
            part.replace(path)
            return
        try:
            rename(part, path)
        except FileExistsError as error:
            raise NameTakenError("a file of this name has just appeared", path) from error


def folder() -> Path:
    """Return $PENDU_RECORDINGS, or else a folder in the user's data, which need not exist."""
    chosen = os.environ.get("PENDU_RECORDINGS", "").strip()
    if not chosen:
        import platformdirs  # slow to load, and --help needs none

        return platformdirs.user_data_path("pendu-tui", False) / "recordings"
    expanded = os.path.expanduser(chosen)  # noqa: PTH111  # Path's raises for an unknown user
    if "://" in expanded or expanded.startswith("~") or os.path.isfile(expanded):  # noqa: PTH113
        raise DiskError("PENDU_RECORDINGS does not name a folder", chosen)
    return Path(expanded)


def new_path(where: Path | None = None) -> Path:
    """Return a free name made of date and time."""
    name = time.strftime("%Y-%m-%dT%H-%M-%S") + SUFFIX
    return free_path((where or folder()) / name)


def listing(being_made: bool = False) -> list[Item]:
    """Return the recordings that no lab is making, or that one is, the newest first."""
    where = folder()
    items = []
    for path in where.iterdir() if where.is_dir() else ():
        with suppress(OSError):  # deleted meanwhile
            if _is_recording(path) and (path.suffix == PART and in_use(path)) == being_made:
                status = path.stat()
                items.append(Item(path, status.st_size, status.st_mtime))
    return sorted(items, key=lambda item: (item.modified, item.path.name), reverse=True)


def golden_names() -> list[str]:
    """Return the names of the bundled recordings."""
    return sorted(path.stem for path in GOLDEN.glob("*" + SUFFIX))


def _is_recording(path: Path) -> bool:
    """Return whether a file, not a pipe, has the name and the profile of our recordings."""
    if not (path.name.endswith((SUFFIX, SUFFIX + PART)) and path.is_file()):
        return False
    profile = len(PROFILE).to_bytes(4, "little") + PROFILE.encode()
    with path.open("rb") as file:
        file.seek(_PROFILE_AT)
        return file.read(len(profile)) == profile


def in_use(path: Path) -> bool:
    """Return whether a program holds this file; if in doubt, True."""
    try:
        with path.open("rb") as file:
            lock(file, probe=True)
    except OSError:
        return True
    return False
