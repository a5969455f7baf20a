"""Where tasks run: in this process, in others, on a Dask cluster, or in any executor.

    with workers_of(options) as workers:
        for result in workers.map(function, tasks):
            ...

The function and the tasks are pickled.  Results come in the order of the tasks and are the same to
the last bit whoever computes them, because a task depends on nothing but itself.
"""

import argparse
import logging
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, nullcontext
from functools import partial
from importlib import import_module
from itertools import islice
from multiprocessing import active_children, get_context
from typing import Any, TypeVar

from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.files import interruptible
from tui.cli.install import install_advice
from tui.cli.options import count

Task = TypeVar("Task")
Result = TypeVar("Result")

MAX_AHEAD = 4096  # tasks that are handed out before the first of them is done
MAX_PROCESSES = 4  # for each processor
MAX_RESTARTS = 3  # of an executor that breaks before one and the same task is done


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

        An executor that breaks, because one of its processes was killed, is started anew.  Raises
        UserError, exit code 3, where the workers are lost.
        """
        if self._executor is None:
            yield from map(function, tasks)
            return
        rest = iter(tasks)
        while True:
            try:
                for task in islice(rest, MAX_AHEAD - len(self._pending)):
                    self._pending.append((task, self._executor.submit(function, task)))
                if not self._pending:
                    return
                result = self._next(function)
            except Exception as error:
                raise _explained(error) from error
            yield result

    def _next(self, function: Callable[[Any], Result]) -> Result:
        """Return the result of the first task that is pending."""
        for _ in range(MAX_RESTARTS):
            try:
                result: Result = self._pending[0][1].result()
                break
            except BrokenExecutor:
                assert self._start is not None
                self._executor = self._start()
                for place, (task, future) in enumerate(self._pending):
                    if not future.done() or future.cancelled() or future.exception():
                        self._pending[place] = task, self._executor.submit(function, task)
        else:
            result = self._pending[0][1].result()
        self._pending.popleft()
        return result

    def close(self, wait: bool = True) -> None:
        """Cancel what is pending and shut the executor down."""
        for _, future in self._pending:
            future.cancel()
        if self._executor is not None:
            self._executor.shutdown(wait=wait)


def _explained(error: Exception) -> UserError:
    """Return the sentence about what a task raised, or what happened to its worker."""
    from engine.methods.own import OwnMethodError

    if isinstance(error, UserError | OwnMethodError):
        return UserError(str(error))
    why = printable(f"{type(error).__name__}: {error}", 300).rstrip(".: ")
    return UserError(f"the workers are lost ({why}).", Exit.INPUT_UNREADABLE)


@contextmanager
def workers_of(options: argparse.Namespace) -> Iterator[Workers]:
    """Yield the workers that the options choose.

    Ctrl+C, SIGTERM and SIGHUP interrupt this process alone, which ends its workers.
    """
    with interruptible(), _client(options.dask) if options.dask else nullcontext() as client:
        start: Callable[[], Executor] | None = None
        if client is not None:
            start = partial(client.get_executor, pure=False)
        elif options.executor:
            start = _callable(options.executor)
        elif options.workers > 1:
            most = MAX_PROCESSES * (os.cpu_count() or 1)
            start = partial(_processes, min(options.workers, most))
        workers = Workers(start)
        try:
            yield workers
        except BaseException:
            is_local = options.workers > 1
            for child in active_children() if is_local else ():
                child.terminate()
            workers.close(wait=is_local)
            raise
        workers.close()


def _processes(count: int) -> Executor:
    """Return an executor of processes, which import no module from the current folder."""
    os.environ["PYTHONSAFEPATH"] = "1"
    ignore = (signal.SIGINT, signal.SIG_IGN)
    return ProcessPoolExecutor(count, get_context("spawn"), signal.signal, ignore)


def _callable(text: str) -> Callable[[], Executor]:
    """Return what makes the executor of MODULE:CALLABLE."""
    module, _, name = text.partition(":")
    try:
        start = getattr(import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        why = printable(str(error), 100)
        raise UserError(f"--executor {text!r} is not MODULE:CALLABLE: {why}.") from None

    def checked() -> Executor:
        try:
            executor = start()
        except Exception as error:
            why = printable(f"{type(error).__name__}: {error}", 200)
            raise UserError(f"--executor {text!r} gives no executor: {why}.") from error
        if not isinstance(executor, Executor):
            kind = type(executor).__name__
            raise UserError(
                f"--executor {text!r} returns a {kind}, not a concurrent.futures.Executor."
            )
        return executor

    return checked


def _client(address: str) -> Any:
    """Return a client of a Dask scheduler, to be used in a `with` statement."""
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
