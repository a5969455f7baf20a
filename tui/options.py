"""Options that several commands share, and how their values are read."""

import argparse
import difflib
import math
import re
from collections.abc import Iterable, Sequence
from typing import NoReturn

from engine.scenes import DEFAULT_SCENE, LIMITS, SCENES, Scene
from tui.errors import UserError


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one sentence."""

    def error(self, message: str) -> NoReturn:
        """Raise UserError instead of printing the usage."""
        raise UserError(f"{message.removeprefix('argument ')}; {self.prog} --help shows the options.")


def joined(arguments: Sequence[str]) -> list[str]:
    """The arguments with negative numbers tied to their options: argparse takes -1e-3 for an option."""
    tied: list[str] = []
    for argument in arguments:
        if tied and re.match(r"-\.?\d", argument) and re.fullmatch(r"--[a-z-]+", tied[-1]):
            tied[-1] += "=" + argument
        else:
            tied.append(argument)
    return tied


def angle(text: str) -> float:
    """An angle [rad] from `2`, `2rad`, `115deg` or `115°`."""
    number = re.sub(r"(deg|°|rad)$", "", text)
    try:
        value = float(number)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no angle: give radians such as 2, or degrees such as 115deg"
        ) from None
    return math.radians(value) if text.endswith(("deg", "°")) else value


def number(text: str) -> float:
    """A number; whether it makes sense is for the one who takes it to say."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no number: give one such as 0.05 or 1e-3") from None


def positive(text: str) -> float:
    """A number above zero, and finite."""
    value = number(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is out of range: give a number above zero")
    return value


def count(text: str) -> int:
    """A whole number, 1 or more."""
    if not re.fullmatch(r"\d{1,18}", text) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no count: give a whole number, 1 or more")
    return int(text)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The end of a sentence about a word that is not known."""
    near = difflib.get_close_matches(word, known, n=1)
    return f": did you mean {near[0]}?" if near else ""


def add_scene_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that determine a scene; `scene_of` reads them."""
    group = parser.add_argument_group("scene", "a scene from the list, or its numbers, or both: numbers win")
    group.add_argument("--scene", metavar="NAME", default=DEFAULT_SCENE.name, help="see pendu-tui scenes (%(default)s)")
    group.add_argument(
        "--theta", metavar="RAD|DEGdeg", type=angle, help="start angle from straight down, such as 115deg"
    )
    group.add_argument("--omega", metavar="RAD_S", type=angle, help="start angular velocity")
    group.add_argument("--length", metavar="M", type=number)
    group.add_argument("--gravity", metavar="M_S2", type=number)
    group.add_argument("--h", metavar="S", type=number, help="step size")


def scene_of(options: argparse.Namespace) -> Scene:
    """The scene that the options describe.

    Raises UserError for an unknown name and SceneError for numbers that cannot be run.
    """
    if options.scene not in SCENES:
        hint = did_you_mean(options.scene, SCENES) or "; pendu-tui scenes lists them."
        raise UserError(f"there is no scene {options.scene!r}{hint}")
    given = {name: getattr(options, name) for name in (*LIMITS, "h")}
    return SCENES[options.scene].altered(**{name: value for name, value in given.items() if value is not None})
