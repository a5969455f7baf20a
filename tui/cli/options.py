"""Options that several commands share, and how their values are read."""

import argparse
import difflib
import math
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from tui.cli.errors import UserError

LIST = "FIRST:LAST:HOW_MANY"
MAX_VALUES = 1_000_000  # of a list
MAX_WORD = 200  # characters of a word that is looked up; difflib takes seconds for long ones


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one sentence; -1e-3 is a number, not an option."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        sentence = message.removeprefix("argument ")
        if not sentence.endswith("?"):
            sentence += f"; {self.prog} --help shows the options."
        raise UserError(sentence)

    def parse_args(self, arguments: Sequence[str], namespace: Any = None) -> Any:  # type: ignore[override]
        """Parse the arguments; optional words, such as a SCENE, may also follow options."""
        for argument in arguments:
            if re.fullmatch(r"(--?[\w-]+=|-\w)--", argument):  # Python 3.11 makes a list of it
                self.error(
                    f"{argument.removesuffix('--').removesuffix('=')}: expected one argument"
                )
        has_optional = any(each.nargs == "?" and not each.option_strings for each in self._actions)
        if has_optional and not {"-h", "--help"} & {*arguments}:  # whose text intermixing changes
            return self.parse_intermixed_args(arguments, namespace)
        return super().parse_args(arguments, namespace)

    def unknown_option(self, arguments: Sequence[str]) -> UserError | None:
        """Return the error for the first unknown option; argparse reports a missing one first."""
        for argument in arguments:
            name = argument.partition("=")[0] if argument.startswith("--") else argument[:2]
            if argument == "--" or " " in name or name in self._option_string_actions:
                continue
            if re.match(r"--?[a-z]", name, re.IGNORECASE):
                similar = did_you_mean(name, self._option_string_actions)
                hint = similar or f"; {self.prog} --help shows the options."
                return UserError(f"{self.prog.rpartition(' ')[2]} has no option {name}{hint}")
        return None


class Suggestions(list[str]):
    """The `choices` that the tab key offers for an option; the command judges any other text."""

    def __contains__(self, text: object) -> bool:
        return True


def add_file(parser: argparse._ActionsContainer, *names: str, **settings: Any) -> None:
    """Add an option whose value the tab key completes to a file."""
    parser.add_argument(*names, **settings).complete = "file"  # type: ignore[attr-defined]


def add_recording(
    parser: argparse.ArgumentParser,
    name: str = "file",
    metavar: str = "FILE",
    help: str = "a file, latest, or a name such as drift",
    **settings: Any,
) -> None:
    """Add an argument for `resolve`."""
    add_file(parser, name, metavar=metavar, help=help, **settings)


def resolve(name: str) -> Path:
    """Return the recording of this name: a file, `latest`, one of the library, or a bundled one.

    Raises RecordingError, a sentence, if there is none.
    """
    from recordings import library
    from recordings.errors import RecordingError, printable

    folder = library.folder()
    file = name + library.SUFFIX
    for path in (Path(name), library.GOLDEN / file, folder / name, folder / file):
        if path.exists() and not path.is_dir():
            return path
    items = library.listing(folder)
    if name == "latest":
        if items:
            return items[0].path
        why = f"no recordings in {printable(str(folder))} yet; start pendu-tui to make one."
        raise RecordingError(why)
    bundled = ["latest", *library.golden_names()]
    advice = did_you_mean(name, [*bundled, *(item.path.name for item in items)])
    advice = printable(advice) or f": choose a file, or one of {', '.join(bundled)}."
    raise RecordingError(f"there is no recording {printable(name)!r}{advice}")


def _example(text: str, examples: str) -> str:
    """Return what to write: a point for a comma, or an example."""
    comma = re.fullmatch(r"[-+]?\d*,\d+\D*", text)
    return f"write {text.replace(',', '.')}" if comma else f"use for example {examples}"


def angle(text: str) -> float:
    """Return an angle [rad] from `2`, `2rad`, `115deg`, `115°`, `pi/2` or `-2pi/3`.

    An angular velocity may end in `/s`.
    """
    bare = re.sub(r"\s*(deg|°|rad)(/s)?$", "", text)
    multiple = re.fullmatch(r"([-+]?)([\d.]*)\*?(?:pi|π)(?:/([\d.]+))?", bare)
    try:
        if multiple:
            sign, factor, divisor = multiple.groups()
            value = float(f"{sign}{factor or 1}") * math.pi / float(divisor or 1)
        else:
            value = float(bare)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not an angle; {_example(text, '2 (radians), pi/2 or 115deg')}"
        ) from None
    return math.radians(value) if "deg" in text or "°" in text else value


def start_angle(text: str) -> float:
    """Return an angle [rad]; of more than a turn only with its unit, as degrees may be meant."""
    value = angle(text)
    if math.tau < abs(value) < math.inf and not re.search(r"deg|°|rad|pi|π", text):
        turns = abs(value) / math.tau
        raise argparse.ArgumentTypeError(f"{text} is {turns:.3g} turns: {text}deg or {text}rad?")
    return value


def seconds(text: str) -> float:
    """Return a time [s] from `2`, `2s`, `50ms`, `1min` or `1h`."""
    bare = re.sub(r"\s*(ms|s|min|h)$", "", text)
    unit = text[len(bare) :].strip()
    try:
        value = float(bare)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a time; {_example(text, '0.05 (seconds), 50ms or 1min')}"
        ) from None
    return value / 1000 if unit == "ms" else value * {"min": 60, "h": 3600}.get(unit, 1)


def number(text: str) -> float:
    """Return any number, `0.05` or `5%`; the caller checks its range."""
    try:
        return float(re.sub("%$", "e-2", text))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a number; {_example(text, '0.05 or 1e-3')}"
        ) from None


def values(element: Callable[[str], float]) -> Callable[[str], list[float]]:
    """Return a reader of ascending values, each read by `element`: `0.5,1,2` or `0.1:3:30`."""

    def read(text: str) -> list[float]:
        match text.split(":"):
            case [_] if re.fullmatch(r"[-+]?\d*,0\d+\D*", text):
                element(text)  # raises: no list
            case [_]:
                return sorted({element(part) for part in text.split(",")})
            case [first, last, many] if 2 <= (size := count(many)) <= MAX_VALUES:
                low = element(first)
                high = element(last)
                if low < high:
                    steps = range(size - 1)
                    return [*(low + (high - low) * i / (size - 1) for i in steps), high]
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of values; use 0.5,1,2 or 0.1:3:30 ({LIST})"
        )

    return read


def positive(text: str, read: Callable[[str], float] = number) -> float:
    """Return a number above zero, and finite."""
    value = read(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is out of range; use a number above zero")
    return value


def duration(text: str) -> float:
    """Return a time above zero [s]."""
    return positive(text, seconds)


def count(text: str) -> int:
    """Return a whole number, 1 or more."""
    if not re.fullmatch(r"\d{1,18}", text) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a count; use a whole number, 1 or more")
    return int(text)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the end of a sentence about an unknown word."""
    near = difflib.get_close_matches(word[:MAX_WORD], known, n=1)
    return f": did you mean {near[0]}?" if near else ""
