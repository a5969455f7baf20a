"""A terminal on which one can see what the program has sent from now on: what was not painted anew is blank."""

from collections.abc import Callable

import pyte

from tests.tui.pty_lab import PtyLab


class Emulator:
    """The screen of a running program, from the moment on when this is made."""

    def __init__(self, pendu: PtyLab, size: tuple[int, int] = (120, 40)) -> None:
        self._pendu, self._fed = pendu, len(pendu.output)
        self._screen = pyte.Screen(*size)
        self._stream = pyte.ByteStream(self._screen)

    @property
    def lines(self) -> list[str]:
        """What is on it now."""
        sent = bytes(self._pendu.output[self._fed :])
        self._fed += len(sent)
        self._stream.feed(sent)
        return [line.rstrip() for line in self._screen.display]

    def wait_until(self, right: Callable[[list[str]], bool], seconds: float = 30.0) -> list[str]:
        """Read until the screen is right; returns what is on it."""
        end = self._pendu.now + seconds
        while not right(lines := self.lines):
            if self._pendu.now > end:
                raise TimeoutError("\n".join(["the screen is not right:", *lines]))
            self._pendu.run(0.05)
        return lines
