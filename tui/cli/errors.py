"""Errors: one sentence for the user, and an exit code; how sentences and progress are printed."""

import errno
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import IntEnum
from functools import partial
from time import monotonic
from typing import Any, TextIO

from pendu_tui.engine.inputs import InputError

MAX_CELL = 1000  # characters of a line


class Exit(IntEnum):
    """The exit codes of the process."""

    FINE = 0
    CHECK_FAILED = 1
    USAGE = 2
    INPUT_UNREADABLE = 3
    TERMINAL_UNSUITABLE = 4
    DISK = 5
    INTERRUPTED = 130
    PIPE_CLOSED = 141  # what shells report of programs that write into a closed pipe


class UserError(InputError):
    """A sentence for the user, and an exit code."""

    def __init__(self, message: str, code: Exit = Exit.USAGE) -> None:
        super().__init__(message)
        self.code = code


def unreadable(sentence: str) -> UserError:
    return UserError(sentence, Exit.INPUT_UNREADABLE)


def explained(error: BaseException) -> UserError:
    """Return the error as a sentence for the user.  Raises it again if it is a bug."""
    if isinstance(error, UserError):
        return error
    # a library may raise an error of its own about the interrupt
    if isinstance(error, KeyboardInterrupt) or isinstance(error.__context__, KeyboardInterrupt):
        return UserError("interrupted.", Exit.INTERRUPTED)
    # imported here: --help and --version do not need them
    from pendu_tui.engine.methods.own import OwnMethodError
    from pendu_tui.recordings.files import RecordingError

    match error:
        case InputError():
            return UserError(str(error))
        case RecordingError() | OwnMethodError():
            return unreadable(str(error))
        case MemoryError():
            return unreadable("not enough memory; make the run or the input smaller.")
        case OSError():  # also DiskError
            why = (error.strerror or str(error)) + ADVICE.get(error.errno or 0, "")
            return UserError(f"{error.filename or 'output'}: {why}.", Exit.DISK)
    raise error


ADVICE = {
    errno.ENOENT: "; choose a folder that exists",
    errno.ENOSPC: "; free some space or write elsewhere",
    errno.EACCES: "; choose a writable location",
    errno.EROFS: "; choose a writable location",
}
"""What to do about errors of files."""


def warn(sentence: str) -> None:
    """Print a sentence on stderr."""
    say(f"pendu-tui: {sentence}".replace("\n", " "), sys.stderr)


def say(text: str, stream: TextIO | None = None) -> None:
    """Print a text on stdout or another stream, without what would steer the terminal.

    If that is a terminal, the text is wrapped without breaking words or paths.
    """
    from pendu_tui.recordings.files import printable  # --help needs none

    out = stream or sys.stdout
    lines = [printable(line, MAX_CELL) for line in text.split("\n")]
    if out.isatty():
        import shutil  # slow, and pipes need none
        import textwrap

        columns = shutil.get_terminal_size().columns
        fill = partial(textwrap.fill, break_long_words=False, break_on_hyphens=False)
        lines = [fill(line, columns) for line in lines]
    print("\n".join(lines), file=out)


@contextmanager
def progress(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with the work done and the whole work.

    On a terminal it shows a bar and the time left, after a second.
    """
    began = monotonic()
    bar: Any = None

    def show(done: float, total: float) -> None:
        nonlocal bar
        if bar is None and monotonic() > began + 1 and sys.stderr.isatty():
            from rich.console import Console
            from rich.markup import escape
            from rich.progress import Progress

            from pendu_tui.recordings.files import printable

            columns = Progress.get_default_columns()
            bar = Progress(*columns, "left", console=Console(file=sys.stderr), transient=True)
            bar.add_task(escape(printable(what)))
            bar.start()
        if bar is not None:
            bar.update(0, completed=done, total=total)

    try:
        yield show
    finally:
        if bar is not None:
            bar.stop()
