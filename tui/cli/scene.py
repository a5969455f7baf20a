"""The options that describe a scene: its name, its numbers and its cast.

A scene of the user's own is a TOML file with the fields that `scenes --json` prints.
"""

import argparse
import math
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import product
from pathlib import Path
from typing import Any

from engine.methods import METHODS, Cast, Method
from engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from engine.scenes import DEFAULT_SCENE, MOST_METHODS, SCENES, Scene, SceneError
from recordings.errors import printable
from tui.cli.cast import add_cast_options, cast_of, find, own_method_at
from tui.cli.errors import Exit, UserError
from tui.cli.options import (
    LIST,
    Suggestions,
    angle,
    did_you_mean,
    number,
    seconds,
    start_angle,
    values,
)

READERS: dict[str, Callable[[str], float]] = {
    "theta": start_angle,
    "omega": angle,
    "length": number,
    "gravity": number,
    **dict.fromkeys(PARAMETERS, number),
    "h": seconds,
}
"""The numbers of a scene, and how each is read, on the command line and in a file."""

_HELP = {
    "theta": ("RAD|DEGdeg", "start angle from straight down: 2 (in rad), pi/2 or 115deg"),
    "omega": ("RAD_S", "start angular velocity: 2 (in rad/s) or 30deg (a second)"),
    "length": ("M", "length in m"),
    "gravity": ("M_S2", "gravity in m/s²"),
    "h": ("S", "step size: 0.05 (in s) or 50ms"),
}

TEXTS = ("name", "watch", "model")
NO_FIELDS = ("cast", "parameters", "often_said", "shot")
FIELDS = (
    *(field.name for field in fields(Scene) if field.name not in NO_FIELDS),
    *PARAMETERS,
    "methods",
)
MAX_BYTES = 100_000


def add_scene_options(parser: argparse.ArgumentParser, lists: bool = False) -> None:
    """Add the options that determine a scene, for `scene_of`; with `lists`, for `scenes_of`."""
    more = f"; a number may be a list, 0.1,0.2 or {LIST}" if lists else ""
    group = parser.add_argument_group("scene", f"options override the values of the scene{more}")
    meaning = (
        f"see pendu-tui scenes ({DEFAULT_SCENE.name}), or a file with the fields of scenes --json"
    )
    names = Suggestions(SCENES)
    group.add_argument(
        "scene", metavar="SCENE", nargs="?", choices=names, help="the scene, as --scene"
    )
    group.add_argument(
        "--scene", dest="scene_option", metavar="NAME|FILE.toml", choices=names, help=meaning
    )
    parameters = {
        each.name: ("NUMBER", f"{each.about} in {each.unit}") for each in PARAMETERS.values()
    }
    for name, read in READERS.items():
        metavar, meaning = (_HELP | parameters)[name]
        option = f"--{name.replace('_', '-')}"
        group.add_argument(
            option, metavar=metavar, type=values(read) if lists else read, help=meaning
        )
    add_cast_options(group)


@dataclass(frozen=True, slots=True)
class SceneList:
    """Every combination of the values given, the last axis changing fastest."""

    base: Scene
    axes: Mapping[str, Sequence[float]]  # the numbers that are given, each with its values

    def __len__(self) -> int:
        return math.prod(map(len, self.axes.values()))

    def __iter__(self) -> Iterator[Scene]:
        return self._combined(self.axes)

    def corners(self) -> list[Scene]:
        """Return the combinations of the extremes: what limits them, they do not exceed."""
        ends = {name: sorted({axis[0], axis[-1]}) for name, axis in self.axes.items()}
        return list(self._combined(ends))

    def _combined(self, axes: Mapping[str, Sequence[float]]) -> Iterator[Scene]:
        for numbers in product(*axes.values()):
            yield self.base.altered(**dict(zip(axes, numbers, strict=True)))


def scenes_of(options: argparse.Namespace, default: Scene | None = None) -> SceneList:
    """Return the scenes that the options describe, with their cast.

    Without a name they change the `default`.  Raises UserError for an unknown name, SceneError for
    bad numbers, if only in some of the combinations, and OwnMethodError for a bad function.
    """
    given = {name: getattr(options, name) for name in READERS}
    axes = {
        name: value if isinstance(value, list) else [value]
        for name, value in given.items()
        if value is not None
    }
    if options.scene and options.scene_option:
        raise UserError(
            f"there are two scenes, {options.scene} and {options.scene_option}; leave one out."
        )
    name = options.scene or options.scene_option
    scene = scene_named(name) if name else default or DEFAULT_SCENE
    scenes = SceneList(scene.with_cast(cast_of(options, scene.cast, model=scene.model)), axes)
    scenes.corners()
    return scenes


def scene_of(options: argparse.Namespace, default: Scene | None = None) -> Scene:
    """Return the one scene of options without lists, as `scenes_of` does."""
    (scene,) = scenes_of(options, default)
    return scene


def scene_named(name: str) -> Scene:
    """Return a listed scene, or that of a file.  Raises UserError."""
    if name.endswith(".toml"):
        return read_scene(Path(name))
    if name not in SCENES:
        hint = did_you_mean(name, SCENES) or "; pendu-tui scenes lists them."
        raise UserError(f"there is no scene {name!r}{hint}")
    return SCENES[name]


def general_scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene of the options, if it can be mapped and charted.

    Raises UserError.
    """
    scene = scene_of(options)
    if why := scene.why_not_mapped:
        raise UserError(why)
    return scene


def _read(path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text of a TOML file, and what it holds."""
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
        if len(raw) > MAX_BYTES:
            raise UserError(
                f"{path} is longer than {MAX_BYTES} bytes; is it a scene?", Exit.INPUT_UNREADABLE
            )
        text = raw.decode("utf-8-sig")
        return text, tomllib.loads(text)
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror}.", Exit.INPUT_UNREADABLE) from None
    except (
        ValueError,
        RecursionError,
    ) as error:  # ValueError: no text, no TOML, or an integer of 5,000 digits
        raise UserError(
            f"{path} is not TOML: {printable(str(error), 200)}.", Exit.INPUT_UNREADABLE
        ) from None


def read_scene(path: Path) -> Scene:
    """Return the scene in a file.  Raises UserError with line and field."""
    text, given = _read(path)
    values: dict[str, Any] = {"name": path.stem}
    for name, value in given.items():
        try:
            if name == "methods":
                values["cast"] = _methods(value, path.parent)
            else:
                values[name] = _value(name, value)
        except UserError as error:
            raise UserError(
                f"{path}, line {_line(text, name)}: {error}", Exit.INPUT_UNREADABLE
            ) from None
    model = values.get("model", DEFAULT_MODEL)
    casts = (scene.cast for scene in SCENES.values() if scene.model == model)
    suited = tuple(method for method in METHODS if model in method.models)
    values.setdefault("cast", next(casts, suited[:MOST_METHODS]))
    parameters = {name: values.pop(name) for name in PARAMETERS if name in values}
    try:
        return Scene(parameters=parameters, **values)
    except SceneError as error:
        named = next(
            (name for name in given if re.search(rf"\b{re.escape(name)}\b", str(error))), None
        )
        where = "" if named is None else f", line {_line(text, named)}"
        raise UserError(f"{path}{where}: {error}", Exit.INPUT_UNREADABLE) from None


def _value(name: str, value: Any) -> Any:
    """Return a field's value, as a Scene takes it."""
    if name not in FIELDS:
        advice = did_you_mean(name, FIELDS) or f"; choose from {', '.join(FIELDS)}."
        raise UserError(f"a scene has no field {printable(name, 40)}{advice}")
    if name in TEXTS:
        if not isinstance(value, str) or (name == "model" and value not in MODELS):
            allowed = f"one of {', '.join(MODELS)}" if name == "model" else "a text"
            raise UserError(f"{name} is not {allowed}.")
        return printable(value, 200)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        usual = (scene.numbers.get(name) or getattr(scene, name, 0) for scene in SCENES.values())
        example = next(filter(None, usual))
        raise UserError(f"{name} is not a number; use for example {name} = {example:g}.")
    try:
        return READERS.get(name, number)(str(value))
    except argparse.ArgumentTypeError as error:
        raise UserError(f"{name}: {error}.") from None


def _methods(value: Any, folder: Path) -> Cast:
    """Return the methods of a scene file; the user's own are FILE.py:FUNCTION, in its folder."""
    if not isinstance(value, list) or not value or not all(isinstance(key, str) for key in value):
        raise UserError(
            'methods is not a list of names; use for example ["velocity_verlet", "mine.py:step"].'
        )
    if len(set(value)) < len(value):
        raise UserError("methods has a name twice; name each method once.")
    cast: list[Method] = []
    for key in value:
        is_own = ".py:" in key
        found = own_method_at(f"{folder / key}", cast) if is_own else find(key, METHODS, "methods")
        cast.append(found)
    return tuple(cast)


def _line(text: str, name: str) -> int:
    """Return the line that a field is on, from 1."""
    lines = text.splitlines()
    return next(
        (
            n
            for n, line in enumerate(lines, 1)
            if re.match(rf"\s*[\"'\[]*{re.escape(name)}\b", line)
        ),
        1,
    )
