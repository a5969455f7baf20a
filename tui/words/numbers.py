"""Numbers as text: with a fixed width for tables, short for sentences; and the exact motion.

Tables get a hyphen for nan and inf.
"""

import math

from pendu_tui.engine.models.model import ExactMotion, Model
from pendu_tui.engine.scenes import Scene

SIGNED = "+.1e", "+.0e"
UNSIGNED = ".1e", ".0e"
"""Formats of scientific notation: "+3.3e+00" and "3.3e+00", or with fewer digits."""


def counted(number: int, noun: str) -> str:
    """Write "1 sample" or "3 samples"."""
    if number != 1:
        noun += "s"
    return f"{number} {noun}"


def decimal(value: float, width: int, decimals: int) -> str:
    """Write a sign and as many decimals as fit, or scientific notation: " +1.000", "+1.2e+09"."""
    return fitting(value, width, *(f"+.{places}f" for places in range(decimals, -1, -1)), *SIGNED)


def fitting(value: float | None, width: int, *formats: str) -> str:
    """Write a number in the first format that fits, or # as spreadsheets do."""
    if value is None or not math.isfinite(value):
        return "-".rjust(width)
    texts = (format(value, each) for each in formats)
    return next((text.rjust(width) for text in texts if len(text) <= width), "#" * width)


def start(theta: float, omega: float) -> str:
    """Write initial values: "57.3° 0 rad/s"."""
    return f"{math.degrees(theta):.4g}° {omega:.4g} rad/s"


def seconds(value: float) -> str:
    """Write a time or a duration: "12.34 s", "3 min 05 s", "1 h 02 min", "3 d 04 h"."""
    if not math.isfinite(value):
        return "-"
    if round(value, 2) < 0:
        return f"-{seconds(-value)}"
    if round(value, 2) < 60:
        return f"{abs(value):.2f} s"
    if round(value) < 3600:
        return "{} min {:02d} s".format(*divmod(round(value), 60))
    if round(value / 60) < 24 * 60:
        return "{} h {:02d} min".format(*divmod(round(value / 60), 60))
    if value < 1e9:
        return "{} d {:02d} h".format(*divmod(round(value / 3600), 24))
    return f"{value:.1e} s"


def about(seconds: float) -> str:
    """Write a duration with about two digits: "40 s", "32 min", "8.4 h", "12 days"."""
    units = {"days": 86400, "h": 3600, "min": 60, "s": 1}
    unit = next((unit for unit, size in units.items() if seconds >= 2 * size), "s")
    value = seconds / units[unit]
    if value >= 9.95:
        return f"{value:.0f} {unit}"
    return f"{value:.2g} {unit}"


def two_digits(value: float) -> str:
    """Write a positive number with about two digits: "0.00029", "0.66", "440", "1.3e+06"."""
    if value < 9.95:
        return f"{value:#.2g}"
    if value < 99_999.5:
        return f"{value:.0f}"
    return f"{value:.1e}"


def file_size(count: int) -> str:
    """Write bytes as "640 bytes", "96.4 kB", "1.2 MB"."""
    from rich.filesize import decimal  # --help needs no rich

    return decimal(count)


def factor(value: float) -> str:
    """Write a factor in full: "4", "262144", "-1/8"."""
    if value < 0:
        return f"-{factor(-value)}"
    if 0 < value < 1 and (1 / value).is_integer():
        return f"1/{1 / value:.9g}"
    return f"{value:.9g}"


def z_text(scene: Scene, digits: int = 4) -> str:
    """Write a scene's z: "z = h·w0 = 0.1566"."""
    return f"z = h·{scene.equations.frequency_symbol} = {scene.z:.{digits}g}"


def regime(model: Model, theta: float, omega: float) -> str:
    """Return the kind of exact motion through a state: "libration", "rotation" or "separatrix"."""
    level = model.level(theta, omega)
    if level == 0:
        return "separatrix"
    if level > 0:
        return "libration"
    return "rotation"


def energy_share(model: Model, theta: float, omega: float) -> str:
    """Write E/Es; near 1 as the difference: "1 - 2.5e-13"."""
    level = model.level(theta, omega)
    if 0 < abs(level) < 1e-3:
        return f"1 {'-' if level > 0 else '+'} {abs(level):.1e}"
    return f"{1 - level:.4g}"


def motion_text(scene: Scene, exact: ExactMotion) -> str:
    """Describe a scene's motion: "exact period 2.139 s  E/Es 0.2298  libration"."""
    parts = []
    if exact.period is not None:
        parts.append(f"exact period {exact.period:.6g} s")
    if scene.equations.has_separatrix:
        parts.append(f"E/Es {energy_share(scene.equations, scene.theta, scene.omega)}")
    return "  ".join([*parts, exact.regime])
