"""The process that ends the lab if a user's call in C keeps the interpreter for itself.

Its argument is the number of the lab's process, of which each byte on stdin is a sign of life.
"""

import os
import signal
import sys
from threading import Event, Thread

from pendu_tui.recordings.system import is_stopped, kill, restore_terminal, terminal_state

MAX_SILENCE = 5  # s


def main(process: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    state = terminal_state()
    alive = Event()
    Thread(target=_listen, args=(alive,), daemon=True).start()
    silence = 0
    while silence < MAX_SILENCE:
        if alive.wait(1.0):
            alive.clear()
            silence = 0
        elif not is_stopped(process):
            silence += 1
    restore_terminal(state)
    why = "your method's call in C does not return; the recording is kept as a .part"
    print(f"pendu-tui: ended, for {why}.", file=sys.stderr)
    kill(process, 2)


def _listen(alive: Event) -> None:
    while os.read(0, 4096):
        alive.set()
    os._exit(0)  # the lab has ended


if __name__ == "__main__":
    main(int(sys.argv[1]))
