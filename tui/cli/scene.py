"""Scenes as the user describes them: by options, or in a file of TOML.

The fields of a file are those that `scenes --json` prints, and what differs in the shot.  Scenes
under [[scene]] are the pages of a lesson; the tour is one.
"""

import argparse
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, get_type_hints

from pendu_tui.engine import scenes
from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import METHODS, Cast, Method
from pendu_tui.engine.models import MODELS, NUMBERS
from pendu_tui.engine.scenes import (
    DEFAULT_SCENE,
    MAX_METHODS,
    SCENES,
    Line,
    Scene,
    Shot,
)
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.cast import cast_of, own_method_at
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import did_you_mean, find, number, seconds


@dataclass(frozen=True, slots=True)
class SceneList:
    """All combinations of the given values; the last axis changes fastest."""

    base: Scene
    axes: Mapping[str, Sequence[float]]  # the values of each number that is given

    def __len__(self) -> int:
        return math.prod(map(len, self.axes.values()))

    def __iter__(self) -> Iterator[Scene]:
        return self._combined(self.axes)

    def corners(self) -> list[Scene]:
        """Return the combinations of the extremes; if they are valid, all are."""
        ends = {name: sorted({axis[0], axis[-1]}) for name, axis in self.axes.items()}
        return list(self._combined(ends))

    def _combined(self, axes: Mapping[str, Sequence[float]]) -> Iterator[Scene]:
        for numbers in product(*axes.values()):
            yield self.base.altered(**dict(zip(axes, numbers, strict=True)))


def scenes_of(options: argparse.Namespace, lesson: bool = False) -> SceneList:
    """Return the scenes that the options describe; of a file with a `lesson`, the first.

    Raises UserError for an unknown name, InputError for bad numbers in any combination, and
    OwnMethodError for a bad function.
    """
    if options.scene and options.scene_option:
        raise UserError(
            f"there are two scenes, {options.scene} and {options.scene_option}; leave one out."
        )
    name = options.scene or options.scene_option
    scene = scene_named(name, lesson) if name else DEFAULT_SCENE
    axes: dict[str, Sequence[float]] = {}
    for each in NUMBERS:
        given = getattr(options, each)
        if given is not None:
            axes[each] = given if isinstance(given, list) else [given]
    scenes = SceneList(scene.with_cast(cast_of(options, scene.cast, model=scene.model)), axes)
    scenes.corners()
    return scenes


def scene_of(options: argparse.Namespace, lesson: bool = False) -> Scene:
    """Return the scene that options without lists describe, as `scenes_of` does."""
    (scene,) = scenes_of(options, lesson)
    return scene


def scene_named(name: str, lesson: bool = False) -> Scene:
    """Return a listed scene or that of a file, of a `lesson` the first.  Raises UserError."""
    if name.endswith(".toml"):
        first, *others = read_scenes(Path(name)).values()
        if others and not lesson:
            raise UserError(f"{name} is a lesson of {len(others) + 1} scenes; only the lab pages.")
        return first
    if name not in SCENES:
        hint = did_you_mean(name, SCENES) or "; pendu-tui scenes lists them."
        raise UserError(f"there is no scene {name!r}{hint}")
    return SCENES[name]


def general_scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene of the options.  Raises UserError if it cannot be mapped."""
    scene = scene_of(options)
    if why := scene.why_not_mapped:
        raise UserError(why)
    return scene


TOUR = Path(scenes.__file__).with_name("tour.toml")
MAX_ANSWERS = 4
MAX_TEXT = 400  # characters of a sentence

_READERS = {name: each.read for name, each in NUMBERS.items()}
_READERS |= {"seconds": seconds, "moment": seconds, "speed": number}
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
_EXAMPLES: dict[Any, str] = {
    str: '"text"',
    bool: "true",
    int: "1",
    float: "1.5",
    float | None: "12.5",
    list[str]: '["velocity_verlet", "mine.py:step"]',
    tuple[str, ...]: '["rk4"]',
    dict[str, Any]: '{view = "phase"}',
    Line | None: '{quantity = "theta_error", value = 0.01, name = "0.01 rad"}',
}
"""By the type of a field."""


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
            raise UserError(f"{path}{where}: {error}", Exit.INPUT_UNREADABLE) from None
        found[scene.name] = scene
    return found


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
    except (ValueError, RecursionError) as error:  # binary data, or an integer of 5,000 digits
        why = f"{path} is not TOML: {printable(str(error), 200)}."
    raise UserError(why, Exit.INPUT_UNREADABLE)


def _scene(given: Mapping[str, Any], folder: Path) -> Scene:
    """Return the scene of a table; the user's own methods are in the folder."""
    found = _values(given, _SCENE)
    base = Scene()
    if listed := found.pop("from", ""):
        base = _known(SCENES, listed, "from")
    model = found.get("model", base.model)
    if model not in MODELS:
        raise _FieldError(f"there is no model {model!r}; choose from {', '.join(MODELS)}.", "model")
    if "methods" in found:
        found["cast"] = _methods(found.pop("methods"), folder)
    elif model != base.model:
        found["cast"] = _cast_for(model)
    texts: dict[str, Any] = {
        name: found.pop(name) for name in ("name", "watch", "speed") if name in found
    }
    shot = found.pop("shot", None)
    try:
        scene = base.altered(**found)
        if shot is not None:
            texts["shot"] = _shot(shot, scene)
        return replace(scene, **{"name": scene.name, **texts})
    except InputError as error:
        named = [each for each in given if re.search(rf"\b{re.escape(each)}\b", str(error))]
        raise _FieldError(error, *named[:1]) from None


def _known(listed: Mapping[str, Any], name: str, field: str) -> Any:
    if name not in listed:
        hint = did_you_mean(name, listed) or "; pendu-tui scenes lists them."
        raise _FieldError(f"{field}: there is no {name!r}{hint}", field)
    return listed[name]


def _cast_for(model: str) -> Cast:
    casts = (scene.cast for scene in SCENES.values() if scene.model == model)
    suited = tuple(method for method in METHODS if model in method.models)
    return next(casts, suited[:MAX_METHODS])


def _shot(given: Mapping[str, Any], scene: Scene) -> Shot:
    shot = Shot(**_values(given, _SHOT, "shot"))
    charted = [each.name for each in scene.equations.charted()]
    keys = [method.key for method in scene.cast]
    for name, words, known in (
        ("view", [shot.view], ["lab", "phase", "stability", "accuracy"]),
        ("quantity", [shot.quantity], charted),
        ("front", shot.front, keys),
    ):
        if unknown := [word for word in words if word not in known]:
            why = f"a shot has no {unknown[0]!r}; choose from {', '.join(known)}."
            raise _FieldError(why, "shot", name)
    if shot.moment is None and (shot.question or shot.returns):
        why = "it needs a moment; use for example moment = 12.5."
        raise _FieldError(why, "shot", "question" if shot.question else "returns")
    count = len(shot.answers)
    if shot.question and not (2 <= count <= MAX_ANSWERS and 1 <= shot.right <= count):
        raise _FieldError(
            f"a question has two to {MAX_ANSWERS} answers, and the number of the right one; use "
            'for example answers = ["Verlet.", "RK4."] and right = 1.',
            "shot",
            "question",
        )
    return shot


def _values(given: Mapping[str, Any], types: Mapping[str, Any], *above: str) -> dict[str, Any]:
    """Return the values of a table's fields; `above` is the table's name, if any."""
    import msgspec

    found: dict[str, Any] = {}
    for name, value in given.items():
        if name not in types:
            advice = did_you_mean(name, types) or f"; choose from {', '.join(types)}."
            owner = above[0] if above else "scene"
            raise _FieldError(f"a {owner} has no field {printable(name, 40)}{advice}", *above, name)
        try:
            if name in _READERS:
                value = _READERS[name](str(value))
            found[name] = _printable(msgspec.convert(value, types[name]))
        except msgspec.ValidationError as error:
            why = f"{error}; use for example {name} = {_EXAMPLES[types[name]]}."
            raise _FieldError(f"{name}: {why}", *above, name) from None
        except ValueError as error:  # of a reader
            raise _FieldError(f"{name}: {error}", *above, name) from None
    return found


def _printable(value: Any) -> Any:
    if isinstance(value, str):
        return printable(value, MAX_TEXT)
    if isinstance(value, (tuple, list)):
        return type(value)(map(_printable, value))
    if isinstance(value, Line):
        return replace(value, name=printable(value.name, 40))
    return value


def _methods(keys: Sequence[str], folder: Path) -> Cast:
    """Return the methods of a scene file; FILE.py:FUNCTION is relative to its folder."""
    if not keys:
        raise _FieldError(f"methods: use for example {_EXAMPLES[list[str]]}.", "methods")
    cast: list[Method] = []
    for key in keys:
        try:
            if ".py:" in key:
                found: Method = own_method_at(f"{folder / key}", cast)
            else:
                found = find(key, METHODS, "methods")
        except UserError as error:
            raise _FieldError(error, "methods") from None
        if found in cast:
            raise _FieldError(f"methods: {key} is given twice.", "methods")
        cast.append(found)
    return tuple(cast)


def scene_text(scene: Scene) -> str:
    """Return a scene as TOML, which `read_scenes` reads to the last bit."""
    default = Shot()
    shot = {each.name: getattr(scene.shot, each.name) for each in fields(Shot)}
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
        return f"{{{', '.join(_lines(asdict(value)))}}}"
    if name == "theta" and abs(value) > math.tau:
        return f'"{value!r}rad"'  # without a unit it is refused: it may be meant in degrees
    return json.dumps(value, ensure_ascii=False)
