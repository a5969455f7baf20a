"""The help text: the keys of the view in front, the other keys, then the words on the screen.

Every key is a line of some widget's BINDINGS; keys of one `Binding.Group` share a line.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, zip_longest

from textual.binding import Binding
from textual.dom import DOMNode

from tui.playback.source import Source
from tui.words.cards import glossary, method_card, scene_card
from tui.words.describe import step_text

KEY_WIDTH = 9  # columns
COLUMN_WIDTH = 36  # of a key and what it does
TWO_COLUMNS = 80  # columns of a screen from which on two fit


def bindings_of(owner: type[DOMNode]) -> list[Binding]:
    """Return our own bindings of a class that have a description, then those of its bases."""
    classes = [each for each in owner.__mro__ if each.__module__.startswith("tui.")]
    found = [binding for each in classes for binding in each.__dict__.get("BINDINGS", ())]
    return [each for each in found if isinstance(each, Binding) and each.description]


def key_text(binding: Binding) -> str:
    """Return a key as people read it."""
    return binding.key_display or binding.key.partition(",")[0]


def purpose(binding: Binding) -> str:
    """Return what a key does, in a phrase."""
    return binding.tooltip or binding.description


def key_lines(bindings: Iterable[Binding]) -> Iterator[str]:
    """Yield a line for each key, or for each group of keys."""
    for group, members in groupby(bindings, key=lambda each: each.group or each):
        keys = [key_text(each) for each in members]
        text = " ".join(keys) if len(keys) < 4 else f"{keys[0]} … {keys[-1]}"
        does = group.description if isinstance(group, Binding.Group) else purpose(group)
        yield f"{text:<{KEY_WIDTH - 1}} {does}"


def section(owner: type[DOMNode], width: int) -> str:
    """Return the keys of a class below its title, in two columns if they fit, and its mouse."""
    lines = list(key_lines(bindings_of(owner)))
    if width >= TWO_COLUMNS:
        half = (len(lines) + 1) // 2
        pairs = zip_longest(lines[:half], lines[half:], fillvalue="")
        lines = [f"{left:<{COLUMN_WIDTH}}{right}".rstrip() for left, right in pairs]
    return "\n".join(filter(None, [owner.BINDING_GROUP_TITLE, *lines, owner.HELP]))


def help_text(owners: Sequence[type[DOMNode]], source: Source, width: int) -> str:
    """Return the keys of these classes, the scene, the glossary, and the methods.

    `width`: columns of the screen.
    """
    scene = source.scene
    now = "" if source.stepping.h == scene.h else f"h = {step_text(source)}"
    keys = [section(owner, width) for owner in owners]
    cards = [scene_card(scene, now), glossary(), *map(method_card, scene.cast)]
    return "\n\n".join([*keys, *cards])
