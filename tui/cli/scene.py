"""Scenes as the user describes them: by options, or in a file of TOML.

The fields of a file are those that `scenes --json` prints, and what differs in the shot.  Scenes
under [[scene]] are the pages of a lesson; the tour is one.
"""

import argparse
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, get_type_hints

from pendu_tui.engine import scenes
from pendu_tui.engine.inputs import InputError, check_name, number, seconds
from pendu_tui.engine.methods import METHODS, Cast, all_named
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.models import MODELS, NUMBERS
from pendu_tui.engine.scenes import (
    DEFAULT_SCENE,
    SCENES,
    Line,
    Scene,
    Shot,
)
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.cast import cast_of, check_fits, own_method_at
from pendu_tui.tui.cli.errors import UserError, unreadable
from pendu_tui.tui.cli.options import moment


def scenes_of(options: argparse.Namespace) -> list[Scene]:
    """Return all combinations of the numbers that the options give; the last changes fastest.

    Raises InputError for an unknown name and for bad numbers in any combination, and OwnMethodError
    for a bad function.
    """
    if options.scene and options.scene_option:
        raise UserError(
            f"there are two scenes, {options.scene} and {options.scene_option}; leave one out."
        )
    name = options.scene or options.scene_option
    scene = scene_named(name) if name else DEFAULT_SCENE
    scene = scene.with_cast(cast_of(options, scene.cast, model=scene.model))
    given = {name: getattr(options, name) for name in NUMBERS}
    axes = {
        name: value if isinstance(value, list) else [value]
        for name, value in given.items()
        if value is not None
    }
    combinations = product(*axes.values())
    return [scene.altered(**dict(zip(axes, each, strict=True))) for each in combinations]


def scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene that options without lists describe, whose methods fit a screen."""
    (scene,) = scenes_of(options)
    check_fits(scene.cast)
    return scene


def scene_named(name: str) -> Scene:
    """Return a listed scene or that of a file, of a lesson the first.  Raises InputError."""
    if name.endswith(".toml"):
        return next(iter(read_scenes(Path(name)).values()))
    check_name("scene", name, SCENES)
    return SCENES[name]


def general_scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene of the options.  Raises UserError if it cannot be mapped."""
    (scene,) = scenes_of(options)
    if why := scene.why_not_mapped:
        raise UserError(why)
    return scene


TOUR = Path(scenes.__file__).with_name("tour.toml")
MAX_ANSWERS = 4
MAX_TEXT = 400  # characters of a sentence

_READERS = {name: each.read for name, each in NUMBERS.items()}
_READERS |= {"seconds": seconds, "moment": moment, "speed": number}
_SCENE = {
    "name": str,
    "from": str,
    "watch": str,
    "model": str,
    "speed": float,
    "methods": list[str],
    "shot": dict[str, Any],
    **dict.fromkeys(NUMBERS, float),
}
_SHOT = get_type_hints(Shot)


class _FieldError(InputError):
    """An error in a field of a file; `names` are the path to it."""

    def __init__(self, why: object, *names: str) -> None:
        super().__init__(str(why))
        self.names = names

    def line(self, text: str, start: int) -> str:
        """Return `, line N` of the field in the text from `start` on."""
        for name in self.names:
            pattern = re.compile(rf"^\s*[\"'\[]*(\w+\.)*{re.escape(name)}\b", re.MULTILINE)
            found = pattern.search(text, start)
            if found:
                start = found.end()
        return f", line {text[:start].count(chr(10)) + 1}" if self.names else ""


@contextmanager
def _at(name: str) -> Iterator[None]:
    """Put the name of a field before the path of an InputError."""
    try:
        yield
    except InputError as error:
        raise _FieldError(error, name, *getattr(error, "names", ())) from None


@cache
def read_scenes(path: Path) -> dict[str, Scene]:
    """Return the scenes of a file by name: the whole file, or its [[scene]] tables.

    Fields before the tables belong to all.  Raises UserError with line and field.
    """
    text, given = _read(path)
    tables = given.pop("scene", [given])
    is_list = isinstance(tables, list) and len(tables) > 0
    if not is_list or not all(isinstance(each, dict) and (each or given) for each in tables):
        raise unreadable(
            f"{path} describes no scene; use [[scene]], then fields as in scenes --json."
        )
    heads = [match.end() for match in re.finditer(r"^\s*\[\[", text, re.MULTILINE)]
    heads += [0] * len(tables)
    found: dict[str, Scene] = {}
    for nth, table in enumerate(tables, 1):
        name = f"{path.stem}-{nth}" if len(tables) > 1 else path.stem
        try:
            scene = _scene({**given, **table}, path.parent)
            if scene.name == "custom":
                scene = replace(scene, name=name)
            if scene.name in found:
                raise _FieldError(f"there are two scenes named {scene.name}.", "name")
        except _FieldError as error:
            where = error.line(text, heads[nth - 1])
            raise unreadable(f"{path}{where}: {error}") from None
        found[scene.name] = scene
    return found


def _read(path: Path) -> tuple[str, dict[str, Any]]:
    """Return the text of a TOML file and its values."""
    import tomllib  # takes 6 ms, of 450 to the first pendulum

    try:
        text = path.read_text(encoding="utf-8-sig")
        return text, _printable(tomllib.loads(text))
    except OSError as error:
        why = f"cannot read {path}: {error.strerror}."
    except (ValueError, RecursionError) as error:  # binary data, or an integer of 5,000 digits
        why = f"{path} is not TOML: {printable(str(error))}."
    raise unreadable(why)


def _scene(given: Mapping[str, Any], folder: Path) -> Scene:
    """Return the scene of a table; the user's own methods are in the folder."""
    found = _values(given, _SCENE)
    base = Scene()
    if listed := found.pop("from", ""):
        _check("from", "scene", listed, SCENES)
        base = SCENES[listed]
    model = found.get("model", base.model)
    _check("model", "model", model, MODELS)
    if "methods" in found:
        with _at("methods"):
            found["cast"] = _cast(found.pop("methods"), folder)
    elif model != base.model:
        found["cast"] = _cast_for(model)
    shot = found.pop("shot", None)
    texts = {name: found.pop(name) for name in ("name", "watch", "speed") if name in found}
    try:
        scene = replace(base.altered(**found), **texts)
    except InputError as error:
        named = [each for each in given if re.search(rf"\b{re.escape(each)}\b", str(error))]
        raise _FieldError(error, *named[:1]) from None
    if shot is not None:
        with _at("shot"):
            scene = replace(scene, shot=_shot(shot, scene))
    return scene


def _cast_for(model: str) -> Cast:
    return next(scene.cast for scene in SCENES.values() if scene.model == model)


def _shot(given: Mapping[str, Any], scene: Scene) -> Shot:
    shot = Shot(**_values(given, _SHOT))
    _check("view", "view", shot.view, ("lab", "phase", "stability", "accuracy"))
    charted = (each.name for each in scene.equations.charted())
    _check("quantity", "quantity", shot.quantity, charted)
    for key in shot.front:
        _check("front", "method", key, (method.key for method in scene.cast))
    if shot.moment is None and (shot.question or shot.returns):
        name = "question" if shot.question else "returns"
        raise _FieldError(f"{name} needs a moment; use, for example, moment = 12.5.", name)
    count = len(shot.answers)
    if shot.question and not (2 <= count <= MAX_ANSWERS and 1 <= shot.right <= count):
        raise _FieldError(
            f"a question has 2 to {MAX_ANSWERS} answers, and the number of the right one; "
            'use, for example, answers = ["Verlet.", "RK4."] and right = 1.',
            "question",
        )
    return shot


def _check(field: str, what: str, name: str, known: Iterable[str]) -> None:
    with _at(field):
        check_name(what, name, known)


def _values(given: Mapping[str, Any], types: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the fields of a scene or shot."""
    import msgspec

    found: dict[str, Any] = {}
    for name, value in given.items():
        with _at(name):
            check_name("field", name, types)
            try:
                if name in _READERS:
                    value = _READERS[name](str(value))
                found[name] = msgspec.convert(value, types[name])
            except msgspec.ValidationError as error:
                raise InputError(f"{name}: {error}; use, for example, {_example(name)}.") from None
            except ValueError as error:  # of a reader
                raise InputError(f"{name}: {error}") from None
    return found


def _example(name: str) -> str:
    """Return a whole line of a scene file with this field."""
    texts = (*map(scene_text, SCENES.values()), TOUR.read_text(encoding="utf-8"))
    found = re.search(rf'^\[?{name}\b(?! = """).*', "\n".join(texts), re.MULTILINE)
    assert found
    return found[0]


def _printable(value: Any) -> Any:
    match value:
        case str():
            return printable(value, MAX_TEXT)
        case list():
            return [*map(_printable, value)]
        case dict():
            return {name: _printable(each) for name, each in value.items()}
    return value


def _cast(names: Sequence[str], folder: Path) -> Cast:
    """Return the methods of a scene file; FILE.py:FUNCTION is relative to its folder."""
    own: list[OwnMethod] = []
    keys = []
    for name in names:
        if ".py:" in name:
            own.append(own_method_at(f"{folder / name}", own))
            name = own[-1].key
        keys.append(name)
    return all_named(keys, (*own, *METHODS))


def scene_text(scene: Scene) -> str:
    """Return a scene as TOML, which `read_scenes` reads to the last bit."""
    default = vars(Shot())
    shot = {name: value for name, value in vars(scene.shot).items() if value != default[name]}
    methods = []
    for method in scene.cast:
        file = getattr(method, "file", "")  # of the user's own
        methods.append(f"{Path(file).absolute()}:{method.key}" if file else method.key)
    lines = _lines({**scene.fields(), "methods": methods, "speed": scene.speed})
    if shot:
        lines += ["", "[shot]", *_lines(shot)]
    return "\n".join([*lines, ""])


def _lines(table: Mapping[str, Any]) -> list[str]:
    return [f"{name} = {_toml(name, value)}" for name, value in table.items()]


def _toml(name: str, value: Any) -> str:
    """Return a value as TOML, which is JSON but for tables."""
    import json  # a lab starts without it

    if isinstance(value, Line):
        return f"{{{', '.join(_lines(asdict(value)))}}}"
    if name == "theta" and abs(value) > math.tau:
        return f'"{value!r}rad"'  # without a unit it is refused: it may be meant in degrees
    return json.dumps(value, ensure_ascii=False)
