"""Recordings left unfinished by a lab that was killed: recovered at the next start, and reported."""

from pathlib import Path

from recordings.errors import printable
from recordings.library import leftovers
from tui.cli.output import progress


def recover_leftovers(folder: Path) -> list[str]:
    """Recover all unfinished recordings in a folder; return a sentence on each, also where the disk fails."""
    sentences = []
    for part in leftovers(folder):
        from recordings.recovery import rescue  # imports mcap, so only if there is something to do

        name = printable(str(part))
        try:
            with progress(f"recovering {printable(part.name)}") as show:
                sentences.append(rescue(part, show))
        except FileNotFoundError:
            pass  # another lab was quicker
        except OSError as error:
            why = error.strerror or error
            sentences.append(f"The unfinished recording {name} cannot be recovered now: {why}.")
    return sentences
