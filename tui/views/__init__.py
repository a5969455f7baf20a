"""The views, each in a folder with its panes: `lab`, `phase`, `accuracy`, `stability`.

A screen binds its Source and Samples to a View, and the View to its Panes, both of which `view`
defines.  Panes draw, and post `messages` that ask the lab for another start or step size.
`background` computes in another process for F4 and F5; `reach` frames the motion.
"""

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:  # the process that computes for a view starts sooner without Textual
    from tui.views.view import View


class ViewEntry(NamedTuple):
    """A view: its title, and where its widget is."""

    title: str
    module: str  # imported when the view is first shown
    widget: str


VIEWS: dict[str, ViewEntry] = {
    "lab": ViewEntry("Lab", "tui.views.lab.view", "LabView"),
    "phase": ViewEntry("Phase space", "tui.views.phase.view", "PhaseView"),
    "accuracy": ViewEntry("Accuracy", "tui.views.accuracy.view", "AccuracyView"),
    "stability": ViewEntry("Stability", "tui.views.stability.view", "StabilityView"),
}
"""In the order of the key v."""


def create(name: str) -> "View":
    """The view of this name."""
    entry = VIEWS[name]
    widget: type[View] = getattr(import_module(entry.module), entry.widget)
    return widget(id=name)


def following(name: str) -> str:
    """The view after this one."""
    names = list(VIEWS)
    return names[(names.index(name) + 1) % len(names)]
