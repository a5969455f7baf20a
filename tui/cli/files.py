"""Files that are written whole or not at all, and work that a signal ends in order."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from types import FrameType
from typing import TextIO

from pendu_tui.recordings.system import ENDING
from pendu_tui.tui.cli.errors import Exit, UserError, warn

FIGURES = (".svg", ".pdf", ".png")  # the suffixes of figures


@contextmanager
def whole_file(path: Path, force: bool = False) -> Iterator[Path]:
    """Yield a temporary path; the file gets the name `path` at the end, which is said on stderr.

    If the block raises, or at Ctrl+C, SIGTERM or SIGHUP, nothing is left of it and an older file
    is unchanged.  Devices and pipes are written to directly.  Raises DiskError before the block
    if the name is taken.
    """
    from tempfile import TemporaryDirectory  # loads random and hashlib, which --help needs not

    from pendu_tui.recordings.files import check_target, is_stream, publish, writing

    check_target(path, force)
    if is_stream(path):
        yield path
        return
    with (
        interruptible(),
        writing(path),
        TemporaryDirectory(prefix=".pendu-", dir=path.parent) as folder,
    ):
        part = Path(folder, path.name)
        yield part
        publish(part, path, force)
    warn(f"wrote {path}")


@contextmanager
def text_file(path: Path | None, force: bool = False) -> Iterator[TextIO]:
    """Yield a stream to a whole file, or stdout if `path` is None."""
    if path is None:
        yield sys.stdout
        return
    with whole_file(path, force) as part, part.open("w", encoding="utf-8", newline="") as stream:
        yield stream


def keep_older(path: Path | None) -> None:
    """Raise UserError if an unfinished result would replace a file."""
    if path is not None and path.is_file():
        raise UserError(f"interrupted; {path} is unchanged.", Exit.INTERRUPTED)


def interruptible() -> AbstractContextManager[None]:
    """Let SIGTERM and SIGHUP interrupt the block as Ctrl+C does, so that it cleans up."""
    return _signals_to(_interrupt)


def _interrupt(number: int, frame: FrameType | None) -> None:
    # asyncio replaces signal.default_int_handler by one that waits for an await
    raise KeyboardInterrupt


@contextmanager
def stop_requests() -> Iterator[Callable[[], bool]]:
    """Yield a function that tells whether a signal has asked for an end; a second interrupts."""
    asked = False

    def ask(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True

    with _signals_to(ask):
        yield lambda: asked


@contextmanager
def _signals_to(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Handle the signals in ENDING; ignored ones, as under nohup, stay ignored."""
    heard = [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]
    before = [(number, signal.signal(number, handler)) for number in heard]
    try:
        yield
    finally:
        for number, earlier in before:
            signal.signal(number, earlier)
