"""Round numbers along the axes of phase space: theta in pi, omega in rad/s."""

import math


def nice(value: float) -> float:
    """The smallest of 1, 2, 5, 10 … times a power of ten that is not below the value."""
    if not value > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= value * (1 - 1e-9))


def omega_ticks(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Places and labels of about `most` numbers [rad/s]."""
    step = nice((high - low) / most)
    if low <= 0 <= high or step > 1e-4 * max(abs(low), abs(high)):
        return [(k * step, short(k * step)) for k in _multiples(low, high, step)]
    return _around(round((low + high) / 2 / step) * step, low, high, step)


def theta_ticks(low: float, high: float, most: int, wrap: bool) -> list[tuple[float, str]]:
    """Places and labels of about `most` angles: in pi, and where one sees little of a turn, in rad from one of them."""
    share = (high - low) / math.pi / most
    if high - low > 0.02 * math.pi:
        step = next((quarters / 4 for quarters in (1, 2, 4) if quarters / 4 >= share), nice(share))
        step = step if share > 0.1 else nice(share)
        return [(k * step * math.pi, in_pi(k * step, wrap)) for k in _multiples(low / math.pi, high / math.pi, step)]
    step, middle = nice((high - low) / most), (low + high) / 2
    turns = round(middle / math.pi)
    anchor = turns * math.pi if low <= turns * math.pi <= high else round(middle / step) * step
    return _around(anchor, low, high, step)


def _multiples(low: float, high: float, step: float) -> range:
    return range(math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6) + 1)


def _around(anchor: float, low: float, high: float, step: float) -> list[tuple[float, str]]:
    """A number in full, and others by how far they are from it."""
    turns = anchor / math.pi
    name = in_pi(turns) if turns == round(turns) else f"{anchor:.12g}"
    return [
        (anchor + k * step, short(k * step, "+") if k else name) for k in _multiples(low - anchor, high - anchor, step)
    ]


def short(value: float, sign: str = "-") -> str:
    """As few characters as needed: "0.5", "-2e-7"."""
    mantissa, e, exponent = f"{value:{sign}.6g}".partition("e")
    return mantissa + (f"e{int(exponent)}" if e else "")


def in_pi(turns: float, wrap: bool = False) -> str:
    """A multiple of pi: "-pi", "3pi/4", "0.35pi"; wrapped, one from -pi to pi."""
    if wrap and abs(turns) > 1:
        turns = round(math.remainder(turns, 2), 12)
    if turns == 0:
        return "0"
    for divisor in (1, 2, 4):
        over = turns * divisor
        if over == round(over):
            factor = {1: "", -1: "-"}.get(round(over), str(round(over)))
            return f"{factor}pi" + (f"/{divisor}" if divisor > 1 else "")
    return f"{short(turns)}pi"
