"""Errors of reading and writing, and text from files made safe to print."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

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
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
