"""The options that describe a scene: its name, its numbers and its cast.

A scene of the user's own is a TOML file with the fields that `scenes --json` prints, and what
differs in its shot; scenes under [[scene]] are a lecture.
"""

import argparse
import math
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from engine.methods import METHODS, Cast, Method
from engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from engine.scenes import (
    DEFAULT_SCENE,
    MOST_METHODS,
    QUANTITIES,
    SCENES,
    Line,
    Scene,
    SceneError,
    Shot,
)
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

_READERS = {**READERS, **dict.fromkeys(("seconds", "moment"), seconds), "speed": number}
VIEWS = ("lab", "phase", "stability", "accuracy")
EXAMPLES = {
    "name": '"swing"',
    "theta": '"57deg"',
    "omega": "2.0",
    "length": "1.0",
    "gravity": "9.81",
    "h": "0.05",
    "watch": '"Verlet keeps its energy."',
    "model": '"damped"',
    "speed": "4",
    "methods": '["rk4", "velocity_verlet"]',
    "shot": "",
    **{name: f"{parameter.default:g}" for name, parameter in PARAMETERS.items()},
    **{name: f"{value:g}" for scene in SCENES.values() for name, value in scene.parameters.items()},
}
"""The fields of a scene file, each with a value."""
SHOT_EXAMPLES = {
    "view": '"phase"',
    "theta": '"40deg"',
    "quantity": '"theta_error"',
    "log": "false",
    "seconds": "20",
    "line": '{quantity = "energy_error", value = 0.01, name = "1 %"}',
    "front": '["rk4"]',
    "ring": "true",
    "moment": "12.5",
    "sentence": '"Here they part."',
}
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


def scenes_of(
    options: argparse.Namespace, default: Scene | None = None, lecture: bool = False
) -> SceneList:
    """Return the scenes that the options describe, with their cast; of a `lecture` the first.

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
    scene = scene_named(name, lecture) if name else default or DEFAULT_SCENE
    scenes = SceneList(scene.with_cast(cast_of(options, scene.cast, model=scene.model)), axes)
    scenes.corners()
    return scenes


def scene_of(
    options: argparse.Namespace, default: Scene | None = None, lecture: bool = False
) -> Scene:
    """Return the one scene of options without lists, as `scenes_of` does."""
    (scene,) = scenes_of(options, default, lecture)
    return scene


def scene_named(name: str, lecture: bool = False) -> Scene:
    """Return a listed scene, or that of a file, the first of a `lecture`.  Raises UserError."""
    if name.endswith(".toml"):
        first, *others = read_scenes(Path(name)).values()
        if others and not lecture:
            raise UserError(f"{name} is a lecture of {len(others) + 1} scenes; only the lab pages.")
        return first
    if name not in SCENES:
        hint = did_you_mean(name, SCENES) or "; pendu-tui scenes lists them."
        raise UserError(f"there is no scene {name!r}{hint}")
    return SCENES[name]


def general_scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene of the options, if it can be mapped and charted.  Raises UserError."""
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


@cache
def read_scenes(path: Path) -> dict[str, Scene]:
    """Return the scenes in a file by name: the one that it is, or its [[scene]] tables.

    Fields before the tables are those of all.  Raises UserError with line and field.
    """
    text, given = _read(path)
    tables = given.pop("scene", [{}])
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise UserError(f"{path}: begin each with [[scene]].", Exit.INPUT_UNREADABLE)
    heads = [match.end() for match in re.finditer(r"^\s*\[\[", text, re.MULTILINE)]
    heads += [0] * len(tables)
    scenes: dict[str, Scene] = {}
    for nth, table in enumerate(tables, 1):
        place = _Place(path, text, heads[nth - 1])
        name = f"{path.stem}-{nth}" if len(tables) > 1 else path.stem
        scene = _scene(place, name, {**given, **table})
        if scenes.setdefault(scene.name, scene) is not scene:
            raise place.error(["name"], f"there are two scenes named {scene.name}.")
    return scenes


class _Place(NamedTuple):
    """Where a scene begins."""

    path: Path
    text: str  # of the file
    head: int  # character

    def error(self, names: Sequence[str], why: object) -> UserError:
        """Return an error with the line of the last of nested names."""
        at = self.head
        for name in names:
            pattern = re.compile(rf"^\s*[\"'\[]*(\w+\.)*{re.escape(name)}\b", re.MULTILINE)
            found = pattern.search(self.text, at)
            if found:
                at = found.end()
        where = f", line {self.text[:at].count(chr(10)) + 1}" if names else ""
        return UserError(f"{self.path}{where}: {why}", Exit.INPUT_UNREADABLE)


def _scene(place: _Place, name: str, given: Mapping[str, Any]) -> Scene:
    values: dict[str, Any] = {"name": name}
    shot: dict[str, Any] = {}
    table = given.get("shot", {})
    if not isinstance(table, dict):
        raise place.error(["shot"], "shot is not a table; begin it with [shot].")
    fields = [([each], value) for each, value in given.items() if each != "shot"]
    fields += [(["shot", each], value) for each, value in table.items()]
    for names, value in fields:
        try:
            if names == ["methods"]:
                values["cast"] = _methods(value, place.path.parent)
            else:
                (shot if len(names) > 1 else values)[names[-1]] = _value(names, value)
        except UserError as error:
            raise place.error(names, error) from None
    model = values.get("model", DEFAULT_MODEL)
    casts = (scene.cast for scene in SCENES.values() if scene.model == model)
    suited = tuple(method for method in METHODS if model in method.models)
    values.setdefault("cast", next(casts, suited[:MOST_METHODS]))
    parameters = {each: values.pop(each) for each in PARAMETERS if each in values}
    try:
        scene = Scene(parameters=parameters, shot=Shot(**shot), **values)
        _check_shot(scene)
        return scene
    except SceneError as error:
        named = [each for each in given if re.search(rf"\b{re.escape(each)}\b", str(error))]
        raise place.error(named[:1], error) from None


def _check_shot(scene: Scene) -> None:
    """Raise SceneError where the shot shows what the scene does not have."""
    shot = scene.shot
    quantities = (*QUANTITIES, *(each.name for each in MODELS[scene.model].quantities()))
    checked = {shot.view: VIEWS, shot.quantity: quantities}
    keys = tuple(method.key for method in scene.cast)
    checked |= dict.fromkeys(shot.front, keys)
    for value, allowed in checked.items():
        if value not in allowed:
            raise SceneError(f"a shot has no {value!r}; choose from {', '.join(allowed)}.")


def _value(names: Sequence[str], value: Any) -> Any:
    """Return the value of a field, as a Scene or a Shot takes it, if it is like its example."""
    owner, examples = (("a scene", EXAMPLES), ("a shot", SHOT_EXAMPLES))[len(names) - 1]
    name = names[-1]
    if name not in examples:
        advice = did_you_mean(name, examples) or f"; choose from {', '.join(examples)}."
        raise UserError(f"{owner} has no field {printable(name, 40)}{advice}")
    example = examples[name]
    like = tomllib.loads(f"x = {example}")["x"]
    try:
        if name in _READERS:
            return _READERS[name](str(value))
        if isinstance(like, dict):
            return Line(value["quantity"], float(value["value"]), printable(value["name"], 40))
    except (argparse.ArgumentTypeError, LookupError, TypeError, ValueError) as error:
        why = str(error).partition(";")[0]
        raise UserError(f"{name}: {why}; use for example {name} = {example}.") from None
    if type(value) is not type(like):
        kind = {str: "a text", bool: "true or false"}.get(type(like), "a list")
        raise UserError(f"{name} is not {kind}; use for example {name} = {example}.")
    if name == "model" and value not in MODELS:
        raise UserError(f"model is not one of {', '.join(MODELS)}.")
    if isinstance(value, list):
        return tuple(map(str, value))
    return printable(value, 200) if isinstance(value, str) else value


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
