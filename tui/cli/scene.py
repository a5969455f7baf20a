"""The options that describe a scene: its name, its numbers and its cast."""

import argparse
from pathlib import Path

from engine.models import PARAMETERS
from engine.scenes import DEFAULT_SCENE, LIMITS, SCENES, Scene
from tui.cli.cast import add_cast_options, cast_of
from tui.cli.errors import UserError
from tui.cli.options import Suggestions, angle, did_you_mean, number, start_angle


def add_scene_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that determine a scene; `scene_of` reads them."""
    group = parser.add_argument_group("scene", "options override the values of the scene")
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
    for name, metavar, read, meaning in (
        (
            "theta",
            "RAD|DEGdeg",
            start_angle,
            "start angle from straight down, in rad, or in degrees (115deg)",
        ),
        (
            "omega",
            "RAD_S",
            angle,
            "start angular velocity in rad/s, or in degrees per second (30deg)",
        ),
        ("length", "M", number, "length in m"),
        ("gravity", "M_S2", number, "gravity in m/s²"),
        *(
            (each.name, "NUMBER", number, f"{each.about} in {each.unit}")
            for each in PARAMETERS.values()
        ),
        ("h", "S", number, "step size in s"),
    ):
        group.add_argument(f"--{name.replace('_', '-')}", metavar=metavar, type=read, help=meaning)
    add_cast_options(group)


def scene_of(options: argparse.Namespace, default: Scene | None = None) -> Scene:
    """Return the scene that the options describe, with its cast; without a name they change the `default`.

    Raises UserError for an unknown name, SceneError for bad numbers, OwnMethodError for a bad function.
    """
    given = {name: getattr(options, name) for name in (*LIMITS, *PARAMETERS, "h")}
    changes = {name: value for name, value in given.items() if value is not None}
    if options.scene and options.scene_option:
        raise UserError(
            f"there are two scenes, {options.scene} and {options.scene_option}; leave one out."
        )
    name = options.scene or options.scene_option
    scene = (scene_named(name) if name else default or DEFAULT_SCENE).altered(**changes)
    return scene.with_cast(cast_of(options, scene.cast))


def scene_named(name: str) -> Scene:
    """Return a listed scene, or that of a file.  Raises UserError."""
    if name.endswith(".toml"):
        from tui.cli.scene_file import read_scene

        return read_scene(Path(name))
    if name not in SCENES:
        hint = did_you_mean(name, SCENES) or "; pendu-tui scenes lists them."
        raise UserError(f"there is no scene {name!r}{hint}")
    return SCENES[name]


def general_scene_of(options: argparse.Namespace) -> Scene:
    """Return the scene of the options if it can be mapped and its errors charted.  Raises UserError as well."""
    scene = scene_of(options)
    if why := scene.why_not_mapped:
        raise UserError(why)
    return scene
