"""A file that a command writes: whole, or not at all, and over another one only by force."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from tui.cli.errors import Exit, UserError

_SIGNALS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """Yield the path to write to meanwhile; what is there at the end gets the name `path`.

    If the block raises, and also at Ctrl+C, SIGTERM and SIGHUP, nothing is left of it and an older file stays as
    it was.  A device or a pipe is written to as it is.  Raises UserError and OSError before the block if the file
    exists already or cannot be made, so that nothing is computed in vain.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        yield path
        return
    check_free(path, force)
    if not path.parent.is_dir():
        raise UserError(f"{path}: there is no folder {path.parent}; create the folder first.", Exit.DISK)
    part = path.with_name(path.name + ".part")
    before = {number: signal.signal(number, _stop) for number in _SIGNALS}
    try:
        part.touch()
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
        for number, handler in before.items():
            signal.signal(number, handler)


def check_free(path: Path, force: bool) -> None:
    """Raise UserError if something has this name and must not be overwritten, or cannot."""
    if path.exists() and (not force or path.is_dir()):
        advice = "choose another name" if path.is_dir() else "choose another name, or --force to overwrite it"
        raise UserError(f"{path} exists already: {advice}.", Exit.DISK)


def _stop(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt
