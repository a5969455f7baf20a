"""The views, each in a module of its own: a View with Panes that draw the screen's source."""

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:  # the process that computes for a view starts faster without Textual
    from pendu_tui.tui.playback.shown import Shown
    from pendu_tui.tui.playback.source import Source
    from pendu_tui.tui.views.view import View


class ViewEntry(NamedTuple):
    title: str
    module: str  # imported when the view is first shown
    widget: str


VIEWS: dict[str, ViewEntry] = {
    "lab": ViewEntry("Lab", "pendu_tui.tui.views.lab", "LabView"),
    "phase": ViewEntry("Phase space", "pendu_tui.tui.views.phase", "PhaseView"),
    "accuracy": ViewEntry("Accuracy", "pendu_tui.tui.views.accuracy", "AccuracyView"),
    "stability": ViewEntry("Stability", "pendu_tui.tui.views.stability", "StabilityView"),
}
"""In the order of the key v."""


def create(name: str, source: "Source", shown: "Shown") -> "View":
    entry = VIEWS[name]
    widget: type[View] = getattr(import_module(entry.module), entry.widget)
    return widget(source, shown, name)


def following(name: str) -> str:
    """Return the name of the view after this one."""
    names = list(VIEWS)
    return names[(names.index(name) + 1) % len(names)]
