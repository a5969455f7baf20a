"""Recordings left unfinished by a lab that was killed: recovered at the next start, and reported."""

from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from recordings.library import leftovers
from tui.cli.output import progress

if TYPE_CHECKING:
    from recordings.recover import Rescue


def recover_leftovers(folder: Path) -> list[str]:
    """Recover all unfinished recordings in a folder; returns a sentence on each, also where the disk fails."""
    sentences = []
    for part in leftovers(folder):
        from recordings.recover import rescue  # imports mcap, so only if there is something to do

        try:
            with progress(f"recovering {printable(part.name)}") as show:
                sentences.append(outcome(rescue(part, show)))
        except FileNotFoundError:
            pass  # another lab was quicker
        except OSError as error:
            why = error.strerror or error
            sentences.append(f"The unfinished recording {printable(str(part))} cannot be recovered now: {why}.")
    return sentences


def outcome(rescue: "Rescue") -> str:
    """What became of an unfinished recording."""
    kept = f" The original is kept as {printable(str(rescue.kept))}." if rescue.kept else ""
    if rescue.saved is None or rescue.recovery is None:
        return f"An unfinished recording cannot be recovered: {rescue.reason}{kept}"
    lost = rescue.recovery.samples_lost
    losses = f", {lost} samples are lost" if lost else ""
    return f"An unfinished recording was recovered: {printable(str(rescue.saved))}{losses}.{kept}"
