"""A pytest plugin: another processor.

pytest -p tests.tui.last_bits; it must come before all that imports from math.
"""

import math
from collections.abc import Callable

INEXACT = "sin cos tan asin acos atan atan2 sinh cosh tanh exp expm1 log log1p pow hypot"


def off_by_one(function: Callable[..., float]) -> Callable[..., float]:
    """Return a function whose inexact values are off by a unit in the last place."""

    def other(*arguments: float) -> float:
        value = function(*arguments)
        way = math.inf if hash(arguments) % 2 else -math.inf
        return value if value in (0, 1, -1) else math.nextafter(value, way)

    return other


for name in INEXACT.split():
    setattr(math, name, off_by_one(getattr(math, name)))
