"""The options that describe a scene: its name, its numbers and its cast."""

import argparse
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Scene
from pendu_tui.tui.cli.cast import add_cast_options, cast_of
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.options import LIST, Suggestions, did_you_mean, values


def add_scene_options(parser: argparse.ArgumentParser, lists: bool = False) -> None:
    """Add the options of a scene, for `scene_of`; with `lists`, for `scenes_of`."""
    more = f"; a number may be a list, 0.1,0.2 or {LIST}" if lists else ""
    group = parser.add_argument_group("scene", f"options override the values of the scene{more}")
    names = Suggestions(SCENES)
    group.add_argument(
        "scene", metavar="SCENE", nargs="?", choices=names, help="the scene, as --scene"
    )
    group.add_argument(
        "--scene",
        dest="scene_option",
        metavar="NAME|FILE.toml",
        choices=names,
        help=f"see pendu-tui scenes ({DEFAULT_SCENE.name}), or a file with the fields of scenes "
        "--json",
    )
    for each in NUMBERS.values():
        option = f"--{each.name.replace('_', '-')}"
        read = values(each.read) if lists else each.read
        group.add_argument(option, metavar=each.metavar, type=read, help=each.about)
    add_cast_options(group)


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


def scenes_of(
    options: argparse.Namespace, default: Scene | None = None, lesson: bool = False
) -> SceneList:
    """Return the scenes that the options describe; of a file with a `lesson`, the first.

    Without a name they change the `default`.  Raises UserError for an unknown name, SceneError for
    bad numbers in any combination, and OwnMethodError for a bad function.
    """
    if options.scene and options.scene_option:
        raise UserError(
            f"there are two scenes, {options.scene} and {options.scene_option}; leave one out."
        )
    name = options.scene or options.scene_option
    scene = scene_named(name, lesson) if name else default or DEFAULT_SCENE
    axes: dict[str, Sequence[float]] = {}
    for each in NUMBERS:
        given = getattr(options, each)
        if given is not None:
            axes[each] = given if isinstance(given, list) else [given]
    scenes = SceneList(scene.with_cast(cast_of(options, scene.cast, model=scene.model)), axes)
    scenes.corners()
    return scenes


def scene_of(
    options: argparse.Namespace, default: Scene | None = None, lesson: bool = False
) -> Scene:
    """Return the scene that options without lists describe, as `scenes_of` does."""
    (scene,) = scenes_of(options, default, lesson)
    return scene


def scene_named(name: str, lesson: bool = False) -> Scene:
    """Return a listed scene or that of a file, of a `lesson` the first.  Raises UserError."""
    if name.endswith(".toml"):
        from pendu_tui.tui.cli.scene_file import read_scenes

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
