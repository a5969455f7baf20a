"""Compile methods in a thread, while the lab runs."""

import math
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run.compiled import TieredLoops, compiled
from pendu_tui.engine.run.loops import Loops


def compiled_in_background(method: Method, model: Model) -> Loops:
    """A method's loops: plain until a thread has compiled them, with the same bits."""
    return TieredLoops(method, model, _ready)


def _ready(method: Method, model: Model) -> Loops | None:
    future = _compiling(method, model)
    return future.result() if future.done() else None


@cache
def _compiling(method: Method, model: Model) -> Future[Loops]:
    def compile_now() -> Loops:
        loops = compiled(method, model)
        loops.advance((0.0, 0.0), 0.1, 1, math.inf)  # Numba compiles at the first call
        return loops

    return _thread().submit(compile_now)


@cache
def _thread() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(max_workers=1)
