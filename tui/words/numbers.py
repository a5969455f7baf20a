"""Numbers -> text: of a fixed width for tables, short for sentences.

Tables get the width that they ask for, and a hyphen instead of "nan" or "inf".
"""

import math

from engine.scenes import Scene


def counted(number: int, noun: str) -> str:
    """As "1 sample" or "3 samples"."""
    return f"{number} {noun}{'s' * (number != 1)}"


def decimal(value: float | None, width: int, decimals: int = 3) -> str:
    """With a sign and as many decimals as fit, or in scientific notation: " +1.000", "+1.2e+09"."""
    if value is None or not math.isfinite(value):
        return "-".rjust(width)
    for places in range(decimals, -1, -1):
        text = f"{value:+.{places}f}"
        if len(text) <= width:
            return text.rjust(width)
    return scientific(value, width)


def scientific(value: float | None, width: int, digits: int = 1, sign: str = "+") -> str:
    """As "+3.3e+00", with fewer digits if needed; `sign` "-": a sign only if negative."""
    if value is None or not math.isfinite(value):
        return "-".rjust(width)
    for places in range(digits, -1, -1):
        text = f"{value:{sign}.{places}e}"
        if len(text) <= width:
            return text.rjust(width)
    return "#" * width  # as spreadsheets do


def angle(theta: float, width: int, decimals: int) -> str:
    """An angle [rad]; beyond a turn as turns and, if there is room, the rest: "-5 turns +0.89"."""
    turns = round(theta / math.tau) if math.isfinite(theta) else 0
    text = f"{turns:+d} turn{'s' * (abs(turns) != 1)}"
    rest = f" {theta - turns * math.tau:+.2f}"
    if abs(theta) <= math.tau or len(text) > width:
        return decimal(theta, width, max(decimals, 1))
    return (text + rest if len(text + rest) <= width else text).rjust(width)


def start(theta: float, omega: float) -> str:
    """Start values: "57.3° 0 rad/s"."""
    return f"{math.degrees(theta):.4g}° {omega:.4g} rad/s"


def seconds(value: float) -> str:
    """Return a time or a duration: "12.34 s", "3 min 05 s", "1 h 02 min", "3 d 04 h"."""
    if not math.isfinite(value):
        return "-"
    sign = "-" if round(value, 2) < 0 else ""
    size = abs(value)
    if round(size, 2) < 60:
        return f"{sign}{size:.2f} s"
    if round(size) < 3600:
        minutes, rest = divmod(round(size), 60)
        return f"{sign}{minutes} min {rest:02d} s"
    if round(size / 60) < 24 * 60:
        hours, rest = divmod(round(size / 60), 60)
        return f"{sign}{hours} h {rest:02d} min"
    days, rest = divmod(round(size / 3600), 24)
    return f"{sign}{days} d {rest:02d} h" if days < 10_000 else f"{sign}{size:.1e} s"


def about(seconds: float) -> str:
    """A duration with about two digits: "40 s", "32 min", "8.4 h", "12 days"."""
    units = (("days", 86400), ("h", 3600), ("min", 60), ("s", 1))
    unit, size = next((unit for unit in units if seconds >= 2 * unit[1]), units[-1])
    value = seconds / size
    return f"{value:.0f} {unit}" if value >= 9.95 else f"{value:.2g} {unit}"


def two_digits(value: float) -> str:
    """A positive number with about two digits: "0.00029", "0.66", "4.3", "440", "1.3e+06"."""
    return (
        f"{value:#.2g}" if value < 9.95 else f"{value:.0f}" if value < 99_999.5 else f"{value:.1e}"
    )


def file_size(count: int) -> str:
    """Bytes as "640 B", "96 kB", "1.2 MB"."""
    if count < 1000:
        return f"{count} B"
    power = next((power for power in (1, 2, 3) if round(count / 1000**power) < 1000), 4)
    value = count / 1000**power
    unit = ("kB", "MB", "GB", "TB")[power - 1]
    return f"{value:.1f} {unit}" if round(value, 1) < 10 else f"{value:.0f} {unit}"


def factor(value: float) -> str:
    """A factor in full: "4", "262144", "0.125"."""
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e9 else f"{value:.4g}"


def z_text(scene: Scene, digits: int = 4) -> str:
    """Return a scene's z and what it is: "z = h·w0 = 0.1566"."""
    return f"z = h·{scene.equations.frequency_symbol} = {scene.z:.{digits}g}"
