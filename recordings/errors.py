"""Errors: what can go wrong with a recording, and how text from a file becomes safe to print."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

MAX_TEXT = 200  # characters of one text from a file; a mark or a scene's name is shorter


class RecordingError(Exception):
    """A recording that cannot be read; its text is a sentence for the user."""


class DiskError(OSError):
    """A recording that can no longer be written; its text is a sentence for the user."""

    def __init__(self, why: str, path: object, errno: int = 0) -> None:
        super().__init__(errno, why, str(path))

    def __str__(self) -> str:
        return f"{printable(str(self.filename))}: {self.strerror}"


class NameTakenError(DiskError):
    """A recording that cannot be made because its name is taken."""


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Turn whatever goes wrong while `path` is read into a RecordingError that names it."""
    try:
        yield
    except RecordingError as error:
        raise RecordingError(f"{printable(str(path))}: {str(error).removesuffix('.')}.") from error
    except DiskError:
        raise
    except OSError as error:
        raise RecordingError(f"{printable(str(path))}: {error.strerror or error}.") from error


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn whatever the disk does while `path` is written into a DiskError."""
    try:
        yield
    except DiskError:
        raise
    except OSError as error:
        raise DiskError(error.strerror or str(error), path, error.errno or 0) from error


def printable(text: str, limit: int = MAX_TEXT) -> str:
    """Return the text without what controls a terminal: escapes, line ends, overrides."""
    text = text if len(text) <= limit else text[: limit - 1] + "…"
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else "\N{REPLACEMENT CHARACTER}" for each in text)
