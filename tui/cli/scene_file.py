"""A scene of the user's own from a TOML file, with the fields that `scenes --json` prints."""

import argparse
import re
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

from engine.methods import METHODS, Cast
from engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from engine.scenes import DEFAULT_SCENE, MOST_METHODS, SCENES, Scene, SceneError
from recordings.errors import printable
from tui.cli.cast import find
from tui.cli.errors import Exit, UserError
from tui.cli.options import angle, did_you_mean

TEXTS = ("name", "watch", "model")
NO_FIELDS = ("cast", "parameters", "often_said")
FIELDS = (
    *(field.name for field in fields(Scene) if field.name not in NO_FIELDS),
    *PARAMETERS,
    "methods",
)
MAX_BYTES = 100_000


def read_scene(path: Path) -> Scene:
    """Return the scene in a file.  Raises UserError with line and field."""
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
        if len(raw) > MAX_BYTES:
            raise UserError(
                f"{path} is longer than {MAX_BYTES} bytes; is it a scene?", Exit.INPUT_UNREADABLE
            )
        text = raw.decode("utf-8-sig")
        given = tomllib.loads(text)
    except OSError as error:
        raise UserError(f"cannot read {path}: {error.strerror}.", Exit.INPUT_UNREADABLE) from None
    except (
        ValueError,
        RecursionError,
    ) as error:  # ValueError: no text, no TOML, or an integer of 5,000 digits
        raise UserError(
            f"{path} is not TOML: {printable(str(error), 200)}.", Exit.INPUT_UNREADABLE
        ) from None
    values: dict[str, Any] = {"name": path.stem}
    for name, value in given.items():
        try:
            values["cast" if name == "methods" else name] = _value(name, value)
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
    if name == "methods":
        return _methods(value)
    if name in TEXTS:
        if not isinstance(value, str) or (name == "model" and value not in MODELS):
            allowed = f"one of {', '.join(MODELS)}" if name == "model" else "a text"
            raise UserError(f"{name} is not {allowed}.")
        return printable(value, 200)
    if name in ("theta", "omega") and isinstance(value, str):
        try:
            return angle(value)
        except argparse.ArgumentTypeError as error:
            raise UserError(f"{name}: {error}.") from None
    if isinstance(value, bool) or not isinstance(value, int | float):
        example = getattr(DEFAULT_SCENE, name, None) or 1.0
        raise UserError(f"{name} is not a number; use for example {name} = {example}.")
    try:
        return float(value)
    except OverflowError:
        raise UserError(f"{name} is out of range; use a number of ordinary size.") from None


def _methods(value: Any) -> Cast:
    if not isinstance(value, list) or not value or not all(isinstance(key, str) for key in value):
        raise UserError(
            'methods is not a list of names; use for example ["velocity_verlet", "rk4"].'
        )
    if len(set(value)) < len(value):
        raise UserError("methods has a name twice; name each method once.")
    return tuple(find(key, METHODS, "methods") for key in value)


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
