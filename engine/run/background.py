"""Loops for one who must not wait: plain until another thread has compiled them."""

import math
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache

from engine.methods import Method
from engine.run.compiled import changing, compiled
from engine.run.loops import Loops

COMPILED_FROM = 3_000_000  # steps of a method: who does so many is in fast-forward, and will not mind some late frames


@cache
def unhurried(method: Method) -> Loops:
    """The method's loops, the same bits at any time, faster after so many steps if Numba is installed."""
    return changing(method, COMPILED_FROM, lambda method: _now(_compiling(method)))


@cache
def _compiling(method: Method) -> Future[Loops]:
    """The compiled loops, as one thread makes them, one method after the other."""

    def ready() -> Loops:
        fast = compiled(method)
        fast.advance(1.0, (0.0, 0.0), 0.1, 1, math.inf)  # Numba compiles at the first call
        return fast

    return _compiler().submit(ready)


@cache
def _compiler() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=1)


def _now(future: Future[Loops]) -> Loops | None:
    return future.result() if future.done() else None
