"""Numbers: what a scene is made of, a row each, and how people write them.

Options, forms, scene files, recorded fields, cards and checks are read off the rows.
"""

import math
import re
from collections.abc import Callable
from typing import NamedTuple


def number(text: str) -> float:
    """Return a number, `0.05` or `5%`.  Raises ValueError with a clause, as all readers do."""
    return _float(re.sub("%$", "e-2", text), text, "a number", "0.05 or 1e-3")


def angle(text: str) -> float:
    """Return an angle [rad] from `2`, `2rad`, `115deg`, `115°`, `pi/2` or `-2pi/3`.

    An angular velocity may end in `/s`.
    """
    bare = re.sub(r"\s*(deg|°|rad)(/s)?$", "", text)
    multiple = re.fullmatch(r"([-+]?)([\d.]*)\*?(?:pi|π)(?:/([1-9]\d{,9}))?", bare)
    if multiple:
        bare = f"{multiple[1]}{multiple[2] or 1}"
    value = _float(bare, text, "an angle", "2 (radians), pi/2 or 115deg")
    if multiple:
        return value * math.pi / int(multiple[3] or 1)
    return math.radians(value) if re.search("deg|°", text) else value


def start_angle(text: str) -> float:
    """Return an angle [rad]; above a turn it needs a unit, because degrees may be meant."""
    value = angle(text)
    if math.tau < abs(value) < math.inf and not re.search(r"deg|°|rad|pi|π", text):
        turns = abs(value) / math.tau
        raise ValueError(f"{text} is {turns:.3g} turns: {text}deg or {text}rad?")
    return value


def seconds(text: str) -> float:
    """Return a time [s] from `2`, `2s`, `50ms`, `1min` or `1h`."""
    bare = re.sub(r"\s*(ms|s|min|h)$", "", text)
    unit = text[len(bare) :].strip()
    value = _float(bare, text, "a time", "0.05 (seconds), 50ms or 1min")
    return value / 1000 if unit == "ms" else value * {"min": 60, "h": 3600}.get(unit, 1)


def _float(bare: str, text: str, what: str, example: str) -> float:
    """Return the number in a text, without its unit."""
    try:
        return float(bare)
    except ValueError:
        raise ValueError(f"{text!r} is not {what}; use for example {example}") from None


class Number(NamedTuple):
    """A number of a scene, or of its model's equations."""

    name: str  # of the field, in scenes, files, recordings and on the command line
    unit: str
    about: str  # in the help of its option
    min: float  # inclusive
    max: float  # inclusive; a larger value is a typo
    default: float = 0.0
    read: Callable[[str], float] = number
    hint: str = ""  # beside its field in a form, after the unit
    metavar: str = "NUMBER"
    max_over_w0: float = math.inf


COMMON = (
    Number(
        "theta",
        "rad",
        "start angle from straight down: 2 (in rad), pi/2 or 115deg",
        min=-1e9,
        max=1e9,
        default=1.0,
        read=start_angle,
        hint=", or 115deg",
        metavar="RAD|DEGdeg",
    ),
    Number(
        "omega",
        "rad/s",
        "start angular velocity: 2 (in rad/s) or 30deg (a second)",
        min=-1e9,
        max=1e9,
        read=angle,
        hint=", or 90deg",
        metavar="RAD_S",
    ),
    Number("length", "m", "length in m", min=1e-6, max=1e6, default=1.0, metavar="M"),
    Number("gravity", "m/s²", "gravity in m/s²", 1e-6, 1e6, default=9.81, metavar="M_S2"),
    Number(
        "h",
        "s",
        "step size: 0.05 (in s) or 50ms",
        min=0.0,  # its limits depend on w0: engine.scenes.check_h
        max=math.inf,
        default=0.05,
        read=seconds,
        hint=", the step size",
        metavar="S",
    ),
)
"""The numbers of every scene; a model adds its own."""
