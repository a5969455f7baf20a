"""How often a method asks for its force."""

from collections.abc import Callable
from itertools import islice
from typing import Any

from engine.methods import Method
from engine.models.model import Model, Phase


def count_evaluations(method: Method, model: Model, phase: Phase, h: float, n: int) -> int:
    """How often a run of n >= 1 steps evaluates the force, its fast part, or solves for that part."""
    count = 0

    def counting(function: Callable[..., Any]) -> Callable[..., Any]:
        def counted(*arguments: Any) -> Any:
            nonlocal count
            count += 1
            return function(*arguments)

        return counted

    force = model.force()
    counted = counting(force)
    for name, value in vars(force).items():
        setattr(counted, name, counting(value) if name in ("fast", "solve") else value)
    next(islice(method.on(model).phases(counted, phase, h), n - 1, None))
    return count
