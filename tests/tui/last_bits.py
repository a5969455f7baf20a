"""A pytest plugin that emulates another processor, whose functions differ in the last bit.

pytest -p tests.tui.last_bits loads it before anything imports from math.
"""

import math
from collections.abc import Callable

INEXACT = "sin cos tan asin acos atan atan2 sinh cosh tanh exp expm1 log log1p pow hypot"


def off_by_one(function: Callable[..., float]) -> Callable[..., float]:
    """Return a function whose inexact values are off by a unit in the last place."""

    def other(*arguments: float) -> float:
        value = function(*arguments)
        if value in (0, 1, -1):
            return value
        return math.nextafter(value, math.inf if hash(arguments) % 2 else -math.inf)

    return other


for name in INEXACT.split():
    setattr(math, name, off_by_one(getattr(math, name)))
