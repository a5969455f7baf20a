"""The views, each in a module of its own: a View with Panes that draw the screen's source."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the process that computes for a view starts faster without Textual
    from pendu_tui.tui.views.view import View


VIEWS = {
    "lab": "Lab",
    "phase": "Phase space",
    "accuracy": "Accuracy",
    "stability": "Stability",
}
"""The titles of the views by their modules, in the order of the key v."""


def create(name: str) -> "View":
    """Return a view, whose module is imported when it is first shown."""
    view: View = import_module(f"{__name__}.{name}").view(name)
    return view


def following(name: str) -> str:
    """Return the name of the view after this one."""
    names = list(VIEWS)
    return names[(names.index(name) + 1) % len(names)]
