"""The real program on a pseudo-terminal: type to it, read its output, wait for text."""

import os
import re
import select
import signal
import struct
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Self

import pytest

from tests.tui.command_line import PENDU, ROOT

try:
    import fcntl
    import pty
    import termios
except ImportError:
    pty = None

SIZES = ("COLUMNS", "LINES")


class PtyLab:
    """A running `pendu-tui` with its terminal."""

    def __init__(
        self,
        *arguments: str,
        size: tuple[int, int] = (120, 40),
        program: Sequence[str] = PENDU,
        folder: Path = ROOT,
        **environment: str,
    ) -> None:
        if pty is None:
            pytest.skip("needs a pseudo-terminal")
        columns, rows = size
        self.began = time.monotonic()
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
            os.chdir(folder)
            terminal = {
                "TERM": "xterm-256color",
                "COLORTERM": "truecolor",
                "COLORFGBG": "15;0",  # so that the program does not query the background
                "PYTHONUTF8": "1",
            }
            # not os.environ: readline gives this process COLUMNS and LINES behind its back
            kept = {name: os.environ[name] for name in os.environ if name not in SIZES}
            os.execvpe(program[0], [*program, *arguments], kept | terminal | environment)
        self.output = bytearray()
        self.reads: list[tuple[float, int]] = []  # s since the start, bytes
        self.code: int | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self.code is None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        self.hang_up()

    @property
    def now(self) -> float:
        return time.monotonic() - self.began

    def read(self, seconds: float) -> bytes:
        """Read once, after at most `seconds`; return b"" if nothing came or the program ended."""
        ready, _, _ = select.select([self.terminal], [], [], max(seconds, 0))
        if not ready:
            return b""
        try:
            piece = os.read(self.terminal, 1 << 16)
        except OSError:  # Linux: the other end is closed
            time.sleep(0.01)
            return b""
        self.output += piece
        self.reads.append((self.now, len(piece)))
        return piece

    def run(self, seconds: float) -> bytes:
        end = self.now + seconds
        start = len(self.output)
        while self.now < end:
            self.read(end - self.now)
        return bytes(self.output[start:])

    def wait_for(self, sign: str | re.Pattern[bytes], seconds: float = 20.0) -> float:
        """Read until a text or a match comes; return the time [s since the start]."""
        known = len(self.output)
        if isinstance(sign, str):
            known = max(0, known - len(sign))  # the last thing read may be what is waited for
            sign = re.compile(re.escape(sign.encode()))
        end = self.now + seconds
        while not sign.search(self.output, known):
            if self.now > end:
                raise TimeoutError(f"{sign!r} did not come: {bytes(self.output[-2000:])!r}")
            self.read(end - self.now)
        return self.now

    def type(self, keys: str) -> None:
        os.write(self.terminal, keys.encode())

    def signal(self, number: int) -> None:
        os.kill(self.pid, number)

    def hang_up(self) -> None:
        if self.terminal >= 0:
            os.close(self.terminal)
            self.terminal = -1

    def end(self, seconds: float = 20.0) -> int:
        """Read until the program has ended; return its exit code, negative for a signal."""
        end = self.now + seconds
        while self.code is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.code = os.waitstatus_to_exitcode(status)
            elif self.now > end:
                raise TimeoutError(f"it did not end within {seconds} s")
            elif self.terminal >= 0:
                self.read(0.02)
            else:
                time.sleep(0.02)
        while self.terminal >= 0 and self.read(0.05):
            pass
        return self.code

    def cpu_seconds(self) -> float:
        """Return the processor time used so far."""
        fields = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
