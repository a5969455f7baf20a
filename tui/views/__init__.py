"""The views.  A view is a module here with a widget, and its entry in VIEWS."""

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:  # the process that computes for a view starts sooner without Textual
    from tui.views.view import View


class ViewEntry(NamedTuple):
    """Where a view is, and how one gets there."""

    title: str
    module: str  # imported when the view is first shown
    widget: str


VIEWS: dict[str, ViewEntry] = {
    "lab": ViewEntry("Lab", "tui.views.lab.view", "LabView"),
    "phase": ViewEntry("Phase space", "tui.views.phase.view", "PhaseView"),
    "accuracy": ViewEntry("Accuracy", "tui.views.accuracy.view", "AccuracyView"),
    "stability": ViewEntry("Stability", "tui.views.stability.view", "StabilityView"),
}
"""In the order in which v goes through them."""


def create(name: str) -> "View":
    """The view of this name."""
    entry = VIEWS[name]
    widget: type[View] = getattr(import_module(entry.module), entry.widget)
    return widget(id=name)


def following(name: str) -> str:
    """The view after this one."""
    names = list(VIEWS)
    return names[(names.index(name) + 1) % len(names)]
