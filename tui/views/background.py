"""Long computations in a process of their own, result by result.

A thread would take the interpreter from the lab for milliseconds at a time; `multiprocessing` cannot
start a process while Textual stands in for stderr.
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

Item = TypeVar("Item")


@contextmanager
def elsewhere(function: Callable[..., Iterator[Item]], *arguments: object) -> Iterator[Iterator[Item]]:
    """What function(*arguments) yields, as another process computes it.

    The function must be importable, and all values picklable.  The process is ended when the
    context is left; should this process end without a word, it ends with the next result.
    """
    command = [sys.executable, "-m", "tui.views.background"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        pickle.dump((function, arguments), process.stdin)
        process.stdin.close()
        try:
            yield _received(process.stdout)
        finally:
            process.kill()


def _received(stream: object) -> Iterator[Item]:
    while True:
        try:
            item: Item = pickle.load(stream)  # type: ignore[arg-type]
        except EOFError:
            return
        yield item


def main() -> None:
    """The other process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C is the lab's business
    if hasattr(os, "nice"):
        os.nice(10)  # the lab comes first
    function, arguments = pickle.load(sys.stdin.buffer)
    for item in function(*arguments):
        pickle.dump(item, sys.stdout.buffer)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
