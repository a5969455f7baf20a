"""Run tasks in this process, in other processes, on a Dask cluster, or in any executor.

    with workers_of(options) as workers:
        for result in workers.map(function, tasks):
            ...

The function and the tasks are pickled.  Results come in the order of the tasks and are the same to
the last bit wherever they are computed, because tasks are independent.
"""

import argparse
import logging
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from functools import partial
from importlib import import_module
from itertools import islice
from multiprocessing import active_children, get_context
from typing import Any, TypeVar

from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.files import interruptible
from pendu_tui.tui.cli.install import install_advice
from pendu_tui.tui.cli.options import count

Task = TypeVar("Task")
Result = TypeVar("Result")

MAX_AHEAD = 4096  # tasks submitted before the first of them is done


def add_worker_options(parser: argparse.ArgumentParser) -> None:
    """Add --workers, --dask and --executor, for `workers_of`."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        metavar="N",
        type=count,
        default=1,
        help="compute in N processes on this machine (%(default)s)",
    )
    where.add_argument(
        "--dask", metavar="ADDRESS", help="on a Dask scheduler, such as tcp://10.0.0.1:8786"
    )
    where.add_argument(
        "--executor",
        metavar="MODULE:CALLABLE",
        help="in the concurrent.futures.Executor that a callable returns, such as "
        "mpi4py.futures:MPIPoolExecutor",
    )


class Workers:
    """A map over tasks in order, in an executor or in this process."""

    def __init__(self, start: Callable[[], Executor] | None = None) -> None:
        """`start` returns a new executor; None: this process."""
        self._start = start
        self._executor = start() if start else None
        self._pending: deque[tuple[Any, Future[Any]]] = deque()  # tasks, in order

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Result]:
        """Yield the result of each task.

        If a process is killed, the executor is started anew.  Raises UserError with exit code 3 if
        the workers are lost.
        """
        if self._executor is None:
            yield from map(function, tasks)
            return
        rest = iter(tasks)
        try:
            while True:
                for task in islice(rest, MAX_AHEAD - len(self._pending)):
                    self._pending.append((task, self._executor.submit(function, task)))
                if not self._pending:
                    return
                yield self._next(function)
                self._pending.popleft()
        except Exception as error:
            raise _explained(error) from error

    def _next(self, function: Callable[[Any], Result], restarts: int = 3) -> Result:
        """Return the result of the first pending task."""
        try:
            result: Result = self._pending[0][1].result()
            return result
        except BrokenExecutor:
            if not restarts or not self._start:
                raise
        executor = self._executor = self._start()
        again = [(task, executor.submit(function, task)) for task, _ in self._pending]
        self._pending = deque(again)
        return self._next(function, restarts - 1)

    def close(self, wait: bool = True) -> None:
        """Cancel what is pending and shut the executor down."""
        for _, future in self._pending:
            future.cancel()
        if self._executor is not None:
            self._executor.shutdown(wait=wait)


def _explained(error: Exception) -> UserError:
    """Return the error of a task, or of its lost worker, for the user."""
    from pendu_tui.engine.methods.own import OwnMethodError

    if isinstance(error, UserError | OwnMethodError):
        return UserError(str(error))
    why = printable(f"{type(error).__name__}: {error}", 300).rstrip(".: ")
    return UserError(f"the workers are lost ({why}).", Exit.INPUT_UNREADABLE)


@contextmanager
def workers_of(options: argparse.Namespace) -> Iterator[Workers]:
    """Yield the workers that the options choose.

    Ctrl+C, SIGTERM and SIGHUP interrupt this process alone, which ends its workers.
    """
    start: Callable[[], Executor] | None = None
    with ExitStack() as stack:
        stack.enter_context(interruptible())
        if options.dask:
            client = stack.enter_context(_client(options.dask))
            start = partial(client.get_executor, pure=False)
        elif options.executor:
            start = partial(_made_by, options.executor)
        elif options.workers > 1:
            start = partial(_processes, min(options.workers, 4 * (os.cpu_count() or 1)))
        workers = Workers(start)
        try:
            yield workers
        except BaseException:
            if options.workers > 1:
                for child in active_children():
                    child.terminate()
            workers.close(wait=options.workers > 1)
            raise
        workers.close()


def _processes(count: int) -> Executor:
    """Return an executor of processes that import nothing from the current folder."""
    os.environ["PYTHONSAFEPATH"] = "1"
    ignore = (signal.SIGINT, signal.SIG_IGN)
    return ProcessPoolExecutor(count, get_context("spawn"), signal.signal, ignore)


def _made_by(text: str) -> Executor:
    """Return the executor that MODULE:CALLABLE makes."""
    module, _, name = text.partition(":")
    try:
        executor = getattr(import_module(module), name)()
        if isinstance(executor, Executor):
            return executor
        why = f"it returns a {type(executor).__name__}"
    except Exception as error:
        why = printable(f"{type(error).__name__}: {error}", 200)
    raise UserError(
        f"--executor {text!r} is no MODULE:CALLABLE that returns a concurrent.futures.Executor: "
        f"{why}."
    )


def _client(address: str) -> Any:
    """Return a client of a Dask scheduler, a context manager."""
    try:
        import distributed

        # or it prints tracebacks
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        return distributed.Client(address, timeout="10s")
    except ImportError:
        advice = install_advice("distributed", "cluster")
        raise UserError(f"--dask needs the package distributed: {advice}.") from None
    except (OSError, ValueError) as error:
        raise UserError(
            f"no Dask scheduler answers at {address!r}: {type(error).__name__}; is it running?"
        ) from None
