"""Run tasks in this process, in other processes, or on a Dask cluster.

    with work_of(options, "runs", len(tasks)) as work:
        for result in work.run(function, tasks):
            results.append(result)
            work.step()
    ...
    return work.conclude()

The function and the tasks are pickled.  Results come in the order of the tasks and are the same to
the last bit wherever they are computed, because tasks are independent.
"""

import argparse
import logging
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from multiprocessing import active_children, get_context
from multiprocessing.connection import wait
from multiprocessing.context import SpawnContext
from multiprocessing.process import BaseProcess
from typing import Any

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.errors import Exit, UserError, explained, progress, unreadable, warn
from pendu_tui.tui.cli.files import interruptible, keep_older

MAX_WORKERS = 61  # Windows waits for no more

Run = Callable[[Callable[[Any], Any], Iterable[Any]], Iterator[Any]]
"""A `map` of one iterable."""


def started(function: Callable[..., object], *arguments: object) -> tuple[BaseProcess, Any]:
    """Call a function in another process, with a connection to this one before its arguments.

    Return the process, which ends with this one, and the connection to it.
    """
    context = _spawning()
    here, there = context.Pipe()
    process = context.Process(target=function, args=(there, *arguments), daemon=True)
    process.start()
    there.close()
    return process, here


def received(results: Any, process: BaseProcess, seconds: float | None = None) -> Any:
    """Return what a process sends.  Raises what it sends as an error, EOFError, or TimeoutError.

    On Windows no end of the pipe tells of a process that ends before it has begun.
    """
    ready = wait([results, process.sentinel], seconds)
    if not ready:
        raise TimeoutError
    if results not in ready:
        raise EOFError
    result = results.recv()
    if isinstance(result, Exception):
        raise result
    return result


@dataclass
class Work:
    """Work of which the parts that are done are kept if it is interrupted."""

    run: Run
    what: str
    total: float
    show: Callable[[float, float], None]
    done: float = 0
    ended: UserError | None = None  # by this

    def step(self, amount: float = 1) -> None:
        """Note that so much more is done."""
        self.done += amount
        self.show(self.done, self.total)

    def conclude(self) -> Exit:
        """Warn if the work was interrupted, and return the exit code."""
        if self.ended is None:
            return Exit.FINE
        share = f"{100 * self.done / self.total:.0f} % of the {self.what} are done and kept"
        warn(f"{str(self.ended).rstrip('.')}: {share}.")
        return self.ended.code


@contextmanager
def work_of(options: argparse.Namespace, what: str, total: float) -> Iterator[Work]:
    """Yield work that the workers of the options do.

    If something is done, an interrupt, a lost worker or a user's method that fails ends the block,
    not the command.
    """
    with progress(what) as show:
        work = Work(map, what, total, show)
        try:
            with workers_of(options) as work.run:
                yield work
        except (KeyboardInterrupt, UserError, OwnMethodError) as error:
            if not work.done:
                raise
            keep_older(options.output)
            work.ended = explained(error)


@contextmanager
def workers_of(options: argparse.Namespace) -> Iterator[Run]:
    """Yield the map over tasks that the options choose.

    It raises UserError with exit code 3 if the workers are lost.  Ctrl+C, SIGTERM and SIGHUP
    interrupt this process alone, which ends its workers.
    """
    with ExitStack() as stack:
        stack.enter_context(interruptible())
        if options.dask:
            client = stack.enter_context(_client(options.dask))
            executor = client.get_executor(pure=False)
        elif options.workers > 1:
            count = min(options.workers, 4 * (os.cpu_count() or 1), MAX_WORKERS)
            ignore = (signal.SIGINT, signal.SIG_IGN)
            executor = ProcessPoolExecutor(count, _spawning(), signal.signal, ignore)
        else:
            yield map
            return

        def run(function: Callable[[Any], Any], tasks: Iterable[Any]) -> Iterator[Any]:
            try:
                # not by `map`, which cancels: Python 3.11 prints a traceback for a cancelled task
                futures = [executor.submit(function, task) for task in tasks]
                yield from (future.result() for future in futures)
            except (InputError, OwnMethodError):
                raise
            except Exception as error:
                why = printable(f"{type(error).__name__}: {error}").rstrip(".: ")
                raise unreadable(f"the workers are lost ({why}).") from error

        try:
            yield run
        except BaseException:
            for child in active_children():
                child.terminate()
            executor.shutdown(wait=not options.dask)
            raise
        executor.shutdown()


def _spawning() -> SpawnContext:
    """Return a context whose processes import nothing from the current folder."""
    os.environ["PYTHONSAFEPATH"] = "1"
    return get_context("spawn")


def _client(address: str) -> Any:
    """Return a client of a Dask scheduler, a context manager."""
    try:
        import distributed

        # or it prints tracebacks
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        return distributed.Client(address, timeout="10s")
    except ImportError:
        raise UserError("--dask needs an extra: install pendu-tui[cluster].") from None
    except (OSError, ValueError) as error:
        raise UserError(
            f"no Dask scheduler answers at {address!r}: {type(error).__name__}; is it running?"
        ) from None
