"""Readers of the values of options, and of the names of recordings."""

import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from pendu_tui.engine.inputs import InputError, did_you_mean, number, seconds

LIST = "FIRST:LAST:HOW_MANY"


def resolve(name: str) -> Path:
    """Return the path of a recording: a file, `latest`, one of the library, or a bundled one.

    Raises RecordingError if there is none.
    """
    from pendu_tui.recordings import files
    from pendu_tui.recordings.files import RecordingError

    folder = files.folder()
    file = name + files.SUFFIX
    with files.named(Path(name)):  # no file may have a name so long
        for path in (Path(name), files.GOLDEN / file, folder / name, folder / file):
            if path.exists() and not path.is_dir():
                return path
    items = files.listing()
    if name == "latest" and items:
        return items[0].path
    known = files.golden_names()
    if items:
        known.insert(0, "latest")
    advice = did_you_mean(name, [*known, *(each.path.name for each in items)])
    advice = advice or f": choose a file, or one of {', '.join(known)}."
    raise RecordingError(f"there is no recording {name!r}{advice}")


def values(element: Callable[[str], float]) -> Callable[[str], list[float]]:
    """Return a reader of ascending values, `0.5,1,2` or `0.1:3:30`, each read by `element`."""

    def read(text: str) -> list[float]:
        match text.split(":"):
            case [_]:
                return sorted({element(part) for part in text.split(",")})
            case [first, last, many] if 2 <= (size := count(many)) <= 1_000_000:
                low = element(first)
                high = element(last)
                if not low < high:
                    raise ValueError(f"{text!r} does not ascend; write the lower value first")
                steps = range(size - 1)
                return [*(low + (high - low) * i / (size - 1) for i in steps), high]
        raise ValueError(f"{text!r} is not a list of values; use 0.5,1,2 or 0.1:3:30 ({LIST})")

    return read


def above_zero(read: Callable[[str], float], limit: float = math.inf) -> Callable[[str], float]:
    """Return a reader of numbers above zero and below a limit."""

    def read_one(text: str) -> float:
        value = read(text)
        if not 0 < value < limit:  # also refuses nan
            below = "" if limit == math.inf else f" and below {limit:g}"
            raise ValueError(f"{text!r} is out of range; use a number above zero{below}")
        return value

    return read_one


positive = above_zero(number)


def moment(text: str) -> float:
    """Return a time [s] of up to an hour."""
    value = seconds(text)
    if not 0 <= value <= 3600:  # also refuses nan
        raise ValueError(f"{text!r} is out of range; use 0 to 3600 s")
    return value


def count(text: str, least: int = 1) -> int:
    """Return a whole number, `least` or more."""
    if not re.fullmatch(r"\d{1,18}", text) or int(text) < least:
        raise ValueError(f"{text!r} is not a count; use a whole number, {least} or more")
    return int(text)


@contextmanager
def given_by(option: str) -> Iterator[None]:
    """Put the option before the sentence of an InputError."""
    try:
        yield
    except InputError as error:
        error.args = (f"{option}: {error}",)
        raise


def ladder(text: str) -> tuple[float, float, int]:
    """Return the ends of a ladder of step sizes [s], the larger first, and its rungs: A:B:N."""
    match text.split(":"):
        case [first, last, many] if count(many) <= 1000:
            low, high = sorted((positive(first), positive(last)))
            return high, low, count(many)
    why = "is not a list of up to 1000 step sizes; use A:B:N, for example 0.2:0.001:10"
    raise ValueError(f"{text!r} {why}")


def scale(text: str) -> tuple[float | str | None, str | None]:
    """Return what errors are relative to: a number, first or std; or the column of kinetic:."""
    kind, _, column = text.partition(":")
    if kind == "kinetic" and column:
        return None, column
    if text in ("first", "std"):
        return text, None
    try:
        return positive(text), None
    except ValueError:
        raise ValueError(
            f"{text[:40]!r} is not first, std, kinetic:COLUMN or a positive number"
        ) from None


def step_sizes(text: str) -> list[float]:
    """Return a step size for each file."""
    return [positive(part) for part in text.split(",")]
