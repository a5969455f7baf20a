"""Recordings that were begun and never finished: recovered at the next start, and never behind the user's back."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from recordings.library import leftovers

if TYPE_CHECKING:
    from recordings.recover import Rescue

Progress = Callable[[str], AbstractContextManager[Callable[[float, float], None]]]


def recover_leftovers(folder: Path, progress: Progress) -> list[str]:
    """Make whole recordings of what is left in the folder; returns a sentence on each, whatever the disk does."""
    sentences = []
    for part in leftovers(folder):
        from recordings.recover import rescue  # brings mcap, so only where there is something to do

        try:
            with progress(f"recovering {printable(part.name)}") as show:
                sentences.append(told(rescue(part, show)))
        except FileNotFoundError:
            pass  # another lab was quicker
        except OSError as error:
            why = error.strerror or error
            sentences.append(f"{printable(str(part))} was left unfinished, and cannot be recovered now: {why}.")
    return sentences


def told(rescue: "Rescue") -> str:
    """A sentence on what became of a leftover."""
    kept = f" What was left is kept as {printable(str(rescue.kept))}." if rescue.kept else ""
    if rescue.saved is None or rescue.recovery is None:
        return f"A recording was left unfinished and cannot be recovered: {rescue.reason}{kept}"
    lost = rescue.recovery.samples_lost
    losses = f"; {lost} samples are lost" if lost else ""
    return f"A recording was left unfinished; it was recovered as {printable(str(rescue.saved))}{losses}.{kept}"
