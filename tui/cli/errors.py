"""Errors: one sentence for the user, and an exit code."""

import errno
from enum import IntEnum


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


class UserError(Exception):
    """An error that the user can fix: one sentence, what is wrong, why, and what to do."""

    def __init__(self, message: str, code: Exit = Exit.USAGE) -> None:
        super().__init__(message)
        self.code = code


def explained(error: BaseException) -> UserError:
    """Return the error as a sentence for the user.  Raises it again if it is a bug."""
    if isinstance(error, UserError):
        return error
    if isinstance(error, KeyboardInterrupt) or isinstance(error.__context__, KeyboardInterrupt):
        return UserError(
            "interrupted.", Exit.INTERRUPTED
        )  # or a library's error about the interrupt
    # imported here: --help and --version do not need them
    from pendu_tui.engine.methods.own import OwnMethodError
    from pendu_tui.engine.scenes import SceneError
    from pendu_tui.recordings.errors import RecordingError

    match error:
        case SceneError() | OwnMethodError():
            return UserError(str(error))
        case RecordingError():
            return UserError(str(error), Exit.INPUT_UNREADABLE)
        case MemoryError():
            why = "not enough memory; use less of it, or smaller input."
            return UserError(why, Exit.INPUT_UNREADABLE)
        case OSError():  # also recordings.errors.DiskError
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
