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


def arrows(group: str, cursor: str, purpose: str, big_step: int) -> tuple[Key, ...]:
    """The keys for `move(right, up)`, with shift in big steps; of four arrows, the help shows the first."""
    directions = {"left": (-1, 0), "right": (1, 0), "up": (0, 1), "down": (0, -1)}
    return tuple(
        Key(
            f"{shift}{name}",
            f"{shift}arrows" if name == "left" else "",
            does,
            f"move({step * right}, {step * up})",
            group,
        )
        for shift, step, does in (("", 1, f"{cursor}, to {purpose}"), ("shift+", big_step, f"{cursor} in big steps"))
        for name, (right, up) in directions.items()
    )
