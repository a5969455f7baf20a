"""The loops of engine.run.loops compiled by Numba, from the same functions: the same bits, some ten times as fast.

Numba is the optional extra `fast`.  It is imported at the first use and not before: it takes half a
second, and compiling another quarter of a second for each method.  Nothing is kept on disk: Numba's
cache does not notice when a function in another file changes, and ours are in three.
"""

import math
from collections.abc import Callable
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from engine.methods import Method
from engine.models.state import Phase
from engine.run import loops
from engine.run.loops import Advanced, Loops, plain

COMPILED_FROM = 1_000_000  # steps of a method: in plain Python they take as long as importing and compiling


@cache
def available() -> bool:
    """Whether Numba is installed.  Does not import it."""
    return find_spec("numba") is not None


@cache
def compiled(method: Method) -> Loops:
    """The method's loops, compiled.  Raises ImportError without Numba.

    They release the interpreter's lock while they run.  Where Numba's sine is not Python's, which
    depends on the platform's libraries, bits would differ: there the plain loops are returned.
    """
    numba: Any = import_module("numba")
    if not _same_sine(numba):
        return plain(method)
    inner = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)  # never called by Python: compiles twice as fast
    step, travel, advance = (inner(function) for function in (method.step, loops.travel, loops.advance))
    pendulum = _pendulum(numba)

    def travelling(w0_squared: float, phase: Phase, h: float, n: int) -> Any:
        return travel(step, pendulum(w0_squared).acceleration, phase, h, n)

    def advancing(w0_squared: float, phase: Phase, h: float, n: int, limit: float) -> Any:
        return advance(step, pendulum(w0_squared).acceleration, w0_squared, phase, h, n, limit)

    return Loops(*(_function(numba.njit(nogil=True)(loop)) for loop in (travelling, advancing)))


@cache
def tiered(method: Method, fast: Callable[[Method], Loops | None] = compiled, ahead: int = 0) -> Loops:
    """Plain loops, and from COMPILED_FROM steps on those of `fast`, as soon as it has any, if Numba is installed.

    Counted are the method's steps so far; more than those count if so many are known to lie `ahead`.
    Both kinds of loops give the same bits.
    """
    done = 0

    def loops_for(n: int) -> Loops:
        nonlocal done
        done += n
        return (max(done, ahead) >= COMPILED_FROM and available() and fast(method)) or plain(method)

    def travel(w0_squared: float, phase: Phase, h: float, n: int) -> Phase:
        return loops_for(n).travel(w0_squared, phase, h, n)

    def advance(w0_squared: float, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        return loops_for(n).advance(w0_squared, phase, h, n, limit)

    return Loops(travel, advance)


def _function(dispatcher: Callable[..., Any]) -> Callable[..., Any]:
    """The same as a function of Python's, which a copy of a Lockstep shares; Numba's own cannot be copied."""
    return lambda *arguments: dispatcher(*arguments)


@cache
def _same_sine(numba: Any) -> bool:
    """Whether compiled code has Python's sine.  Of another library's values, one in 1400 or so differs."""
    sine = numba.njit(lambda x: math.sin(x))
    return all(sine(x) == math.sin(x) for x in (0.001 * n for n in range(20_000)))


@cache
def _pendulum(numba: Any) -> Any:
    """engine.models.pendulum for Numba: w0_squared -> an object with the acceleration as its method.

    A closure over w0_squared would be compiled again for each pendulum.
    """
    experimental: Any = import_module("numba.experimental")

    class Pendulum:
        def __init__(self, w0_squared: float) -> None:
            self.w0_squared = w0_squared

        def acceleration(self, theta: float) -> float:
            return -self.w0_squared * math.sin(theta)

    return experimental.jitclass([("w0_squared", numba.float64)])(Pendulum)
