"""Long computations in a process of their own, result by result.

A thread would take the interpreter from the lab for milliseconds at a time.
"""

import asyncio
import multiprocessing
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager, redirect_stderr
from multiprocessing import resource_tracker
from threading import Thread
from types import ModuleType
from typing import Any, TypeVar

Item = TypeVar("Item")

ENVIRONMENT = {"PYTHONSAFEPATH": "1", "PYTHONWARNINGS": "ignore"}
"""No module from the current folder, and no word of semaphores if the lab is killed."""

_items: Iterator[Any]  # in the other process: what is left to compute


async def computed(function: Callable[..., Iterator[Item]], *arguments: object) -> AsyncIterator[Item]:
    """Yield what function(*arguments) yields, as another process computes it.

    The function must be importable, and all values picklable.  The process is killed when this task
    is cancelled, and ends when this process does, even if that is killed.
    """
    loop, others = asyncio.get_running_loop(), set(multiprocessing.active_children())
    with _spawning():
        executor = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), _begin, (function, arguments))
        item = loop.run_in_executor(executor, _next)
    ours = set(multiprocessing.active_children()) - others
    try:
        while (found := await asyncio.shield(item)) is not None:  # an executor stumbles over cancelled items
            yield found
            item = loop.run_in_executor(executor, _next)
    finally:
        for process in ours:
            process.kill()
        item.add_done_callback(asyncio.Future.exception)  # else asyncio complains that nobody asked for it
        executor.shutdown()


@contextmanager
def _spawning() -> Iterator[None]:
    """Let processes be started: with the real stderr, deaf to Ctrl+C, and in ENVIRONMENT."""
    before = {name: os.environ.get(name, "") for name in ENVIRONMENT}  # empty is as good as not set
    script = sys.modules["__main__"]
    os.environ.update(ENVIRONMENT)
    try:
        with redirect_stderr(sys.__stderr__):  # Textual's has no file number
            resource_tracker.ensure_running()  # or it would be started now, and unblock the signal
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            sys.modules["__main__"] = ModuleType("__main__")  # or the script that started the lab would be run again
            yield
    finally:
        sys.modules["__main__"] = script
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        os.environ.update(before)


def _begin(function: Callable[..., Iterator[Item]], arguments: tuple[object, ...]) -> None:
    global _items
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # nothing is to be written across the screen
    os.nice(10)  # the lab comes first
    Thread(target=_end_with_parent, daemon=True).start()
    _items = function(*arguments)


def _next() -> Any:
    return next(_items, None)


def _end_with_parent() -> None:
    if (parent := multiprocessing.parent_process()) is not None:
        parent.join()
    os._exit(0)
