"""What is said of a step beyond a method's linear limit."""

from collections.abc import Sequence

from engine.methods import METHODS


def limit_warning(zs: Sequence[float]) -> str:
    """As "beyond limit 2 of s, v", the methods by their letters; "" below all limits.  `zs` are in METHODS' order.

    Explicit Euler has no limit to be beyond.
    """
    letters: dict[float, list[str]] = {}
    for method, z in zip(METHODS, zs, strict=True):
        if 0 < method.linear_limit < z:
            letters.setdefault(method.linear_limit, []).append(method.letter)
    each = "; ".join(f"{limit:.3g} of {', '.join(who)}" for limit, who in letters.items())
    return f"beyond limit {each}" if each else ""
