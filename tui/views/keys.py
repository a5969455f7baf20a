"""A key: what it is called, what it does, and its binding in Textual."""

from typing import NamedTuple

from textual.binding import Binding, BindingType


class Key(NamedTuple):
    """A key or two, and what it does; or what the mouse does, which has neither names nor an action."""

    names: str  # as Textual calls them, separated by commas
    shown: str  # as people read it; empty if another key's line speaks of it, too
    does: str
    action: str
    group: str
    hint: str = ""  # on the key line, if it is there


def bindings(*keys: Key) -> list[BindingType]:
    """The keys as Textual takes them."""
    return [Binding(key.names, key.action, key.does, show=False) for key in keys if key.names]


def arrows(does: str, group: str, *actions: str, shift: bool = False) -> tuple[Key, ...]:
    """The arrow keys with their actions for left, right, up and down, which are one line of the help."""
    names = [f"shift+{name}" if shift else name for name in ("left", "right", "up", "down")]
    first, *rest = (Key(name, "", "", action, group) for name, action in zip(names, actions, strict=True))
    return first._replace(shown="shift+arrows" if shift else "arrows", does=does), *rest
