"""Options that several commands share, and the readers of their values."""

import argparse
import math
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path
from typing import Any, NoReturn

from pendu_tui.engine.inputs import InputError, did_you_mean, number
from pendu_tui.tui.cli.errors import UserError

LIST = "FIRST:LAST:HOW_MANY"
MAX_RUNGS = 1000  # of a ladder of step sizes


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, and which takes -1e-3 and -pi/2 for numbers."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self._negative_number_matcher = re.compile(r"-(\.?\d|pi|π)")

    def _get_value(self, action: argparse.Action, text: str) -> Any:
        """Return the value of an option; a ValueError's text is the reason to refuse it."""
        try:
            return action.type(text) if callable(action.type) else text
        except ValueError as error:
            raise argparse.ArgumentError(action, str(error)) from None

    def error(self, message: str) -> NoReturn:
        sentence = message.removeprefix("argument ")
        match sentence.split():
            case ["unrecognized", "arguments:", file] if (
                "." in file and "-o" in self._option_string_actions
            ):
                sentence += f"; to write a file: -o {file}"
        if not sentence.endswith("?"):
            sentence += f"; {self.prog} --help shows the options."
        raise UserError(sentence)

    def parse_args(  # type: ignore[override]
        self, arguments: Sequence[str], namespace: Any = None
    ) -> Any:
        """Parse the arguments; optional words, such as SCENE, may also come after options."""
        if {"-h", "--help"} & {*arguments}:  # intermixing would change its text
            return super().parse_args(arguments, namespace)
        for argument in takewhile("--".__ne__, arguments):
            self._check(argument)
        if any(each.nargs == "?" and not each.option_strings for each in self._actions):
            return self.parse_intermixed_args(arguments, namespace)
        return super().parse_args(arguments, namespace)

    def _check(self, argument: str) -> None:
        """Raise UserError for an unknown option; argparse would report a missing one first."""
        if self._negative_number_matcher.match(argument):
            return
        option = re.match(r"--[a-zA-Z][\w-]*|-[a-zA-Z]", argument)
        if option is None:
            return
        if option[0] not in self._option_string_actions:
            similar = did_you_mean(option[0], self._option_string_actions)
            hint = similar or f"; {self.prog} --help shows the options."
            raise UserError(f"{self.prog.rpartition(' ')[2]} has no option {option[0]}{hint}")
        if argument[option.end() :].removeprefix("=") == "--":  # of which Python 3.11 makes a list
            self.error(f"{option[0]}: expected one argument")


class Suggestions(list[str]):
    """`choices` for the tab key only: the command itself checks the text."""

    def __contains__(self, text: object) -> bool:
        return True


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
    items = files.listing(folder)
    if name == "latest" and items:
        return items[0].path
    if name == "latest":
        why = f"no recordings in {folder} yet; start pendu-tui to make one."
        raise RecordingError(why)
    bundled = ["latest", *files.golden_names()]
    advice = did_you_mean(name, [*bundled, *(item.path.name for item in items)])
    advice = advice or f": choose a file, or one of {', '.join(bundled)}."
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
                if low < high:
                    steps = range(size - 1)
                    return [*(low + (high - low) * i / (size - 1) for i in steps), high]
        raise ValueError(f"{text!r} is not a list of values; use 0.5,1,2 or 0.1:3:30 ({LIST})")

    return read


def above_zero(read: Callable[[str], Any], limit: float = math.inf) -> Callable[[str], Any]:
    """Return a reader of numbers above zero and below a limit."""

    def read_one(text: str) -> Any:
        value = read(text)
        if not 0 < value < limit:  # also refuses nan
            below = "" if limit == math.inf else f" and below {limit:g}"
            raise ValueError(f"{text!r} is out of range; use a number above zero{below}")
        return value

    return read_one


positive = above_zero(number)


def count(text: str) -> int:
    """Return a whole number, 1 or more."""
    if not re.fullmatch(r"\d{1,18}", text) or int(text) < 1:
        raise ValueError(f"{text!r} is not a count; use a whole number, 1 or more")
    return int(text)


def port(text: str) -> int:
    """Return a port to listen on; 0: any free one."""
    if not re.fullmatch(r"\d{1,5}", text):
        raise ValueError(f"{text!r} is not a port; use 0 to 65535")
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
        case [first, last, many] if count(many) <= MAX_RUNGS:
            low, high = sorted((positive(first), positive(last)))
            return high, low, count(many)
    raise ValueError(f"{text!r} is not a list of step sizes; use A:B:N, for example 0.2:0.001:10")


def moment(text: str) -> float:
    """Return a time [s] up to an hour."""
    value = number(text)
    if not 0 <= value <= 3600:
        raise ValueError(f"{text!r} is not a valid time; use 0 to 3600 s")
    return value


def record_time(text: str) -> float:
    """Return a time in a record, which may be infinite."""
    value = number(text)
    if math.isnan(value):
        raise ValueError("nan is not a time")
    return value


def scale(text: str) -> float | str:
    """Return a number, or the text: first, std or kinetic:COLUMN."""
    if text in ("first", "std") or text.startswith("kinetic:"):
        return text
    try:
        size: float = positive(text)
    except ValueError:
        raise ValueError(
            f"{text[:40]!r} is none of first, std, kinetic:COLUMN and a positive number"
        ) from None
    return size


def step_sizes(text: str) -> list[float]:
    """Return a step size for each file."""
    return [positive(part) for part in text.split(",")]
