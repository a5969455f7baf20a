"""What a user gives: numbers with units, names, and the error if they cannot be used."""

import math
import re
from collections.abc import Iterable


class InputError(ValueError):
    """What a user gave cannot be used; its text is a sentence: what, why, and what to do."""


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known word that is most like this one, "" if none is.

    One that begins with another letter must be much alike.
    """
    from difflib import get_close_matches  # slow to load, and few words are wrong

    bare = word[:200].lstrip("-").lower()  # longer ones take seconds
    names = {each.lstrip("-").lower(): each for each in known}
    alike = get_close_matches(bare, names, cutoff=0.8)
    alike += get_close_matches(bare, [each for each in names if each[:1] == bare[:1]])
    return next((names[each] for each in alike), "")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the end of a sentence about an unknown word, "" without a suggestion."""
    near = nearest(word, known)
    return near and f": did you mean {near}?"


def check_name(what: str, name: str, known: Iterable[str]) -> None:
    """Raise InputError unless the name is known; `what` is what it is a name of."""
    names = [*known]
    if name not in names:
        advice = did_you_mean(name, names) or f"; choose from {', '.join(names)}."
        raise InputError(f"there is no {what} {name[:60]!r}{advice}")


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
        raise ValueError(f"{text} is {turns:.1f} turns; write {text}deg or {text}rad")
    return value


def seconds(text: str) -> float:
    """Return a time [s] from `2`, `2s`, `50ms`, `20us`, `1min` or `1h`."""
    bare = re.sub(r"\s*([mµu]?s|min|h)$", "", text)
    unit = text[len(bare) :].strip()
    value = _float(bare, text, "a time", "0.05 (seconds), 50ms or 1min")
    parts = {"ms": 1e3, "us": 1e6, "µs": 1e6}.get(unit, 1)  # of a second
    return value / parts * {"min": 60, "h": 3600}.get(unit, 1)


def _float(bare: str, text: str, what: str, example: str) -> float:
    """Return the number in a text, without its unit."""
    try:
        return float(bare)
    except ValueError:
        raise ValueError(f"{text!r} is not {what}; use, for example, {example}") from None
