"""Scene files: a scene of the user's own, or a lecture of several, as TOML.

The fields are those that `scenes --json` prints, and what differs in the shot; scenes under
[[scene]] are a lecture.
"""

import argparse
import json
import math
import re
from collections import ChainMap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields as fields_of
from functools import cache
from pathlib import Path
from typing import Any

from pendu_tui.engine.methods import METHODS, Cast, Method
from pendu_tui.engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from pendu_tui.engine.scenes import MAX_METHODS, SCENES, Line, Scene, SceneError, Shot
from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.cast import find, own_method_at
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import angle, did_you_mean, number, seconds, start_angle

NUMBERS: dict[str, tuple[Callable[[str], float], str, str]] = {
    "theta": (
        start_angle,
        "RAD|DEGdeg",
        "start angle from straight down: 2 (in rad), pi/2 or 115deg",
    ),
    "omega": (angle, "RAD_S", "start angular velocity: 2 (in rad/s) or 30deg (a second)"),
    "length": (number, "M", "length in m"),
    "gravity": (number, "M_S2", "gravity in m/s²"),
    **{
        name: (number, "NUMBER", f"{each.about} in {each.unit}")
        for name, each in PARAMETERS.items()
    },
    "h": (seconds, "S", "step size: 0.05 (in s) or 50ms"),
}
"""The numbers of a scene: the reader, metavar and help of each option."""


_READERS = {name: read for name, (read, _, _) in NUMBERS.items()}
_READERS |= {"seconds": seconds, "moment": seconds, "speed": number}
_DEFAULTS = {name: each.default for name, each in PARAMETERS.items()}
_PARAMETERS = ChainMap(*(dict(scene.parameters) for scene in SCENES.values()), _DEFAULTS)
_EXAMPLE = """
name = "swing"
theta = "57deg"
omega = 2.0
length = 1.0
gravity = 9.81
h = 0.05
watch = "Verlet keeps its energy."
model = "damped"
speed = 4
methods = ["velocity_verlet", "mine.py:step"]
shot = {view = "phase"}
""" + "".join(f"{name} = {value:g}\n" for name, value in _PARAMETERS.items())
_SHOT_EXAMPLE = """
view = "phase"
theta = "40deg"
quantity = "theta_error"
log = false
seconds = 20
line = {quantity = "energy_error", value = 0.01, name = "1 %"}
front = ["rk4"]
ring = true
moment = 12.5
sentence = "Here they part."
"""


class _FieldError(Exception):
    """An error in a field of a file; `names` are the path to it."""

    def __init__(self, why: object, *names: str) -> None:
        super().__init__(why)
        self.names = names

    def line(self, text: str, start: int) -> str:
        """Return `, line N` of the field in the text from `start` on."""
        for name in self.names:
            pattern = re.compile(rf"^\s*[\"'\[]*(\w+\.)*{re.escape(name)}\b", re.MULTILINE)
            found = pattern.search(text, start)
            if found:
                start = found.end()
        return f", line {text[:start].count(chr(10)) + 1}" if self.names else ""


@cache
def read_scenes(path: Path) -> dict[str, Scene]:
    """Return the scenes of a file by name: the whole file, or its [[scene]] tables.

    Fields before the tables belong to all.  Raises UserError with line and field.
    """
    text, given = _read(path)
    if not given:
        why = f"{path} describes no scene; give fields of scenes --json."
        raise UserError(why, Exit.INPUT_UNREADABLE)
    tables = given.pop("scene", [{}])
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise UserError(f"{path}: begin each with [[scene]].", Exit.INPUT_UNREADABLE)
    heads = [match.end() for match in re.finditer(r"^\s*\[\[", text, re.MULTILINE)]
    heads += [0] * len(tables)
    scenes: dict[str, Scene] = {}
    for nth, table in enumerate(tables, 1):
        name = f"{path.stem}-{nth}" if len(tables) > 1 else path.stem
        try:
            scene = _scene({"name": name, **given, **table}, path.parent)
            if scene.name in scenes:
                raise _FieldError(f"there are two scenes named {scene.name}.", "name")
        except _FieldError as error:
            where = error.line(text, heads[nth - 1])
            raise UserError(f"{path}{where}: {error}", Exit.INPUT_UNREADABLE) from None
        scenes[scene.name] = scene
    return scenes


def _read(path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text of a TOML file and its values."""
    import tomllib  # takes 6 ms, of 450 to the first pendulum

    most = 100_000  # bytes
    try:
        with path.open("rb") as file:
            raw = file.read(most + 1)
        text = raw[:most].decode("utf-8-sig")
        if len(raw) > most:
            raise ValueError(f"it is longer than {most} bytes")
        return text, tomllib.loads(text)
    except OSError as error:
        why = f"cannot read {path}: {error.strerror}."
    except (
        ValueError,
        RecursionError,
    ) as error:  # such as binary data, or an integer of 5,000 digits
        why = f"{path} is not TOML: {printable(str(error), 200)}."
    raise UserError(why, Exit.INPUT_UNREADABLE)


def _scene(given: Mapping[str, Any], folder: Path) -> Scene:
    """Return the scene in a table; the user's own methods are in the folder."""
    found = _values(given, _EXAMPLE, folder)
    model = found.get("model", DEFAULT_MODEL)
    casts = (scene.cast for scene in SCENES.values() if scene.model == model)
    suited = tuple(method for method in METHODS if model in method.models)
    cast = found.pop("methods", None) or next(casts, suited[:MAX_METHODS])
    parameters = {name: found.pop(name) for name in PARAMETERS if name in found}
    try:
        scene = Scene(cast=cast, parameters=parameters, **found)
    except SceneError as error:
        named = [each for each in given if re.search(rf"\b{re.escape(each)}\b", str(error))]
        raise _FieldError(error, *named[:1]) from None
    charted = [each.name for each in MODELS[model].charted()]
    keys = [method.key for method in cast]
    for name, words, known in (
        ("view", [scene.shot.view], ["lab", "phase", "stability", "accuracy"]),
        ("quantity", [scene.shot.quantity], charted),
        ("front", scene.shot.front, keys),
    ):
        if unknown := [word for word in words if word not in known]:
            why = f"a shot has no {unknown[0]!r}; choose from {', '.join(known)}."
            raise _FieldError(why, "shot", name)
    return scene


def _values(given: Mapping[str, Any], example: str, folder: Path, *above: str) -> dict[str, Any]:
    """Return the values of a table's fields; `above` is the table's name, if any."""
    import tomllib

    known = tomllib.loads(example)
    found: dict[str, Any] = {}
    for name, value in given.items():
        names = (*above, name)
        try:
            if name not in known:
                advice = did_you_mean(name, known) or f"; choose from {', '.join(known)}."
                owner = above[0] if above else "scene"
                raise UserError(f"a {owner} has no field {printable(name, 40)}{advice}")
            found[name] = _value(name, value, type(known[name]), folder)
        except UserError as error:
            raise _FieldError(error, *names) from None
        except (argparse.ArgumentTypeError, LookupError, TypeError, ValueError) as error:
            why = str(error).partition(";")[0]
            like = next(line for line in example.splitlines() if line.startswith(f"{name} ="))
            raise _FieldError(f"{name}: {why}; use for example {like}.", *names) from None
    return found


def _value(name: str, value: Any, kind: Any, folder: Path) -> Any:
    """Return a field's value in the type that Scene or Shot has."""
    if name in _READERS:
        return _READERS[name](str(value))
    if not isinstance(value, kind):
        kinds = {str: "a text", bool: "true or false", list: "a list", dict: "a table"}
        raise ValueError(f"{printable(str(value), 40)!r} is not {kinds[kind]}")
    match name:
        case "shot":
            return Shot(**_values(value, _SHOT_EXAMPLE, folder, name))
        case "line":
            return Line(value["quantity"], float(value["value"]), printable(value["name"], 40))
        case "methods":
            return _methods(value, folder)
        case "front":
            return tuple(map(str, value))
        case "model" if value not in MODELS:
            raise ValueError(f"{printable(value, 40)!r} is not one of {', '.join(MODELS)}")
    return printable(value, 200) if kind is str else value


def _methods(keys: Sequence[Any], folder: Path) -> Cast:
    """Return the methods of a scene file; FILE.py:FUNCTION is relative to its folder."""
    if not keys:
        raise ValueError("the list is empty")
    cast: list[Method] = []
    for key in map(str, keys):
        is_own = ".py:" in key
        found = own_method_at(f"{folder / key}", cast) if is_own else find(key, METHODS, "methods")
        if found in cast:
            raise ValueError(f"{key} is given twice")
        cast.append(found)
    return tuple(cast)


def scene_text(scene: Scene) -> str:
    """Return a scene as TOML, which `read_scenes` reads to the last bit."""
    default = Shot()
    shot = {each.name: getattr(scene.shot, each.name) for each in fields_of(Shot)}
    shot = {name: value for name, value in shot.items() if value != getattr(default, name)}
    methods = list(map(_method_text, scene.cast))
    lines = _lines({**scene.fields(), "methods": methods, "speed": scene.speed})
    if shot:
        lines += ["", "[shot]", *_lines(shot)]
    return "\n".join([*lines, ""])


def _method_text(method: Method) -> str:
    """Return a method's key, or FILE.py:KEY of a user's own."""
    file = getattr(method, "file", "")
    return f"{Path(file).absolute()}:{method.key}" if file else method.key


def _lines(table: Mapping[str, Any]) -> list[str]:
    return [f"{name} = {_toml(name, value)}" for name, value in table.items()]


def _toml(name: str, value: Any) -> str:
    """Return a value as TOML, which is JSON but for tables."""
    if isinstance(value, Line):
        return f"{{{', '.join(_lines(value._asdict()))}}}"
    if name == "theta" and abs(value) > math.tau:
        return f'"{value!r}rad"'  # without a unit it is refused: it may be meant in degrees
    return json.dumps(value, ensure_ascii=False)
