"""Long computations in another process: a thread would slow the lab down."""

import asyncio
import multiprocessing
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import redirect_stderr
from multiprocessing.connection import Connection
from threading import Thread
from typing import Any

from pendu_tui.recordings.system import give_way
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.watchdog import watchdog
from pendu_tui.tui.cli.workers import received, started


async def computed(
    function: Callable[..., Iterator[Any]], *arguments: object
) -> AsyncIterator[Any]:
    """Yield what function(*arguments) yields in another process.

    The process is killed when this task is cancelled, and ends with this process.  Raises
    UserError if something else ends it, and what the function raises.
    """
    with redirect_stderr(sys.__stderr__):  # Textual's replacement has no file number
        process, results = started(_send_all, function, arguments)
    try:
        while (result := await asyncio.to_thread(received, results, process)) is not None:
            yield result
    except EOFError:
        raise UserError("The process that computes for this view was stopped.") from None
    finally:
        process.kill()
        process.join()


def _send_all(
    results: Connection, function: Callable[..., Iterator[Any]], arguments: tuple[object, ...]
) -> None:
    """Send all results, then None: the main function of the other process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)  # nothing may write across the screen
    give_way()
    Thread(target=_end_with_parent, daemon=True).start()
    watchdog()
    try:
        for item in function(*arguments):
            results.send(item)
        results.send(None)
    except Exception as error:
        results.send(error)


def _end_with_parent() -> None:
    if (parent := multiprocessing.parent_process()) is not None:
        parent.join()
    os._exit(0)
