"""What one operating system has and another lacks; only this module asks for it."""

import os
import re
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl
    import termios
    import tty

_ENDING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
ENDING = [getattr(signal, name) for name in _ENDING if hasattr(signal, name)]
"""The signals that ask for an end."""
CAN_STOP = hasattr(signal, "SIGTSTP")
PLAIN_SCREEN = b"\x1b[<u\x1b[?1000;1003;1004;1006;2004l\x1b[?7;25h\x1b[?1049l"
"""Escape sequences that leave the alternate screen and stop mouse reports."""
LOCKED = 0x7FFFFFFF  # on Windows; a byte behind all data, because a locked one cannot be read


def lock(file: IO[Any], probe: bool = False) -> None:
    """Lock an open file until it is closed; with `probe`, raise OSError if it is locked."""
    if sys.platform == "win32":
        here = os.lseek(file.fileno(), 0, os.SEEK_CUR)
        os.lseek(file.fileno(), LOCKED, os.SEEK_SET)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK if probe else msvcrt.LK_LOCK, 1)
        finally:
            os.lseek(file.fileno(), here, os.SEEK_SET)
    else:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB if probe else fcntl.LOCK_EX)


@contextmanager
def key_by_key(keyboard: int) -> Iterator[bool]:
    """Read a terminal without an echo in the block; yield whether that is possible."""
    if sys.platform == "win32":
        yield False
    else:
        before = termios.tcgetattr(keyboard)
        try:
            tty.setcbreak(keyboard, termios.TCSANOW)
            yield True
        finally:
            termios.tcsetattr(keyboard, termios.TCSAFLUSH, before)


def environment() -> dict[str, str]:
    """Return the environment variables, for a console of Windows with what others set."""
    variables = dict(os.environ)
    if sys.platform == "win32":
        variables = {"TERM": "xterm-256color", "COLORTERM": "truecolor"} | variables
    return variables


def rename(source: Path, target: Path) -> None:
    """Rename a closed file.  Raises FileExistsError if the name is taken."""
    if sys.platform == "win32":
        source.rename(target)  # which elsewhere would replace a file
    else:
        try:
            os.link(source, target)
        except OSError:  # perhaps the file system has no links
            if os.path.lexists(target):
                raise FileExistsError from None
            source.rename(target)
        else:
            source.unlink()


def is_reserved(name: str) -> bool:
    """Return whether no file can have this name, as con.mcap or 19:44.mcap on Windows.

    NUL alone is a device.
    """
    device, dot, _ = name.lower().partition(".")
    devices = r"con|prn|aux|nul|(com|lpt)[1-9¹²³]"
    is_device = dot == "." and bool(re.fullmatch(devices, device.strip()))
    return sys.platform == "win32" and (is_device or ":" in name)


def quoted(words: list[str]) -> str:
    """Return words of a command as the system's shell reads them."""
    import shlex  # these are slow to load, and --help needs none
    import subprocess

    if sys.platform == "win32":
        command = subprocess.list2cmdline(words)
    else:
        command = shlex.join(words)
    return command


def shell_command(arguments: list[str]) -> str:
    """Return a command for the system's shell, which it replaces where it can."""
    command = quoted(arguments)
    if sys.platform != "win32":
        command = f"exec {command}"
    return command


def terminal_state() -> Any:
    """Return the settings of the terminal on stderr; None without one, or on Windows."""
    if sys.platform != "win32":
        try:
            return termios.tcgetattr(2)
        except termios.error:
            pass
    return None


def restore_terminal(state: Any) -> None:
    """Give the terminal on stderr back to the shell, if the lab has it."""
    if sys.platform == "win32":
        if os.isatty(2):
            os.write(2, PLAIN_SCREEN)
    elif state is not None and state != terminal_state():
        termios.tcsetattr(2, termios.TCSANOW, state)
        os.write(2, PLAIN_SCREEN)


def is_gone() -> bool:
    """Return whether the terminal has been closed; writing would fail or block for ever."""
    try:
        os.get_terminal_size(2)
    except OSError:
        return True
    return False


def give_way() -> None:
    """Let other processes go first."""
    if sys.platform != "win32":
        os.nice(10)


def stop() -> None:
    """Stop this process until it is continued."""
    if sys.platform != "win32":
        os.kill(os.getpid(), signal.SIGSTOP)


def stop_as_usual() -> None:
    """Let signals stop and continue this process, without handlers."""
    if sys.platform != "win32":
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        signal.signal(signal.SIGCONT, signal.SIG_DFL)


def is_stopped(process: int) -> bool:
    """Return whether a process has been stopped by a signal."""
    state = ""
    if sys.platform != "win32":
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2]
        except OSError:  # macOS
            import subprocess

            state = subprocess.getoutput(f"ps -o state= -p {process}")
    return state.strip().startswith("T")


def kill(process: int, code: int) -> None:
    """End a process at once; only on Windows it has this exit code."""
    if sys.platform == "win32":
        os.kill(process, code)
    else:
        os.kill(process, signal.SIGKILL)
