"""The loops of engine.run.loops compiled by Numba, from the same functions: the same bits, some ten times as fast.

Numba is the optional extra `fast`.  It is imported at the first use and not before: it takes half a
second, and compiling another fifth of a second for each method and model.  Nothing is kept on disk: Numba's
cache does not notice when a function in another file changes, and ours are in three.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from engine.methods import Method
from engine.methods.splitting import COMPILABLE
from engine.models.model import Model, Phase
from engine.run import loops
from engine.run.loops import Advanced, Loops, plain

COMPILED_FROM = 1_000_000  # steps of a method: in plain Python they take as long as importing and compiling


@cache
def available() -> bool:
    """Whether Numba is installed.  Does not import it."""
    return find_spec("numba") is not None


@cache
def compiled(method: Method, model: Model) -> Loops:
    """The method's loops on this model, compiled; its parameters become constants.  Raises ImportError without Numba.

    They release the interpreter's lock while they run.  Where Numba's sine is not Python's, which
    depends on the platform's libraries, bits would differ: there the plain loops are returned, and for a user's own
    method, which may hold anything, for one that is not general, and on a model that is not plain.
    """
    from engine.methods.own import OwnMethod  # with all that measures one, which most runs do not need

    numba: Any = import_module("numba")
    general = method.general and model.has_force and not isinstance(method, OwnMethod)
    if not general or not _same_sine(numba):
        return plain(method, model)
    inner = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)  # never called by Python: compiles twice as fast
    phases = inner(COMPILABLE.get(method.phases, method.phases))
    force, energy = inner(model.force()), inner(model.energy())
    travel, advance = inner(_travel), inner(loops.advance)

    def travelling(phase: Phase, h: float, n: int) -> Any:
        return travel(phases(force, phase, h), phase, n)

    def advancing(phase: Phase, h: float, n: int, limit: float) -> Any:
        return advance(phases(force, phase, h), energy, phase, n, limit)

    return Loops(*(numba.njit(nogil=True)(loop) for loop in (travelling, advancing)))


def _travel(phases: Iterator[Phase], phase: Phase, n: int) -> Phase:
    for following in phases:
        phase = following
        n -= 1
        if n == 0:
            break
    return phase


@cache
def tiered(
    method: Method, model: Model, fast: Callable[[Method, Model], Loops | None] = compiled, ahead: int = 0
) -> Loops:
    """Plain loops, and from COMPILED_FROM steps on those of `fast`, as soon as it has any, if Numba is installed.

    Counted are the method's steps so far; more than those count if so many are known to lie `ahead`.
    Both kinds of loops give the same bits.
    """
    done = 0

    def loops_for(n: int) -> Loops:
        nonlocal done
        done += n
        return (max(done, ahead) >= COMPILED_FROM and available() and fast(method, model)) or plain(method, model)

    def travel(phase: Phase, h: float, n: int) -> Phase:
        return loops_for(n).travel(phase, h, n)

    def advance(phase: Phase, h: float, n: int, limit: float) -> Advanced:
        return loops_for(n).advance(phase, h, n, limit)

    return Loops(travel, advance)


@cache
def _same_sine(numba: Any) -> bool:
    """Whether compiled code has Python's sine.  Of another library's values, one in 1400 or so differs."""
    sine = numba.njit(lambda x: math.sin(x))
    return all(sine(x) == math.sin(x) for x in (0.001 * n for n in range(20_000)))
