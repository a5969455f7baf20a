"""What one does not need to watch the lab: its state in words, its events, cards, pictures, other recordings."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recordings import library
from tui.cli.errors import explained
from tui.playback.live import Live
from tui.screens.text import TextScreen
from tui.terminal.screenshot import save_picture
from tui.views import VIEWS
from tui.words.cards import method_card
from tui.words.command_line import command
from tui.words.describe import description
from tui.words.events import event_lines

if TYPE_CHECKING:
    from tui.screens.app import PenduApp


def show_description(app: "PenduApp") -> None:
    """Say in words what runs and what is on screen."""
    stage = app.stage
    panes = [str(pane.border_title) for pane in stage.query("*") if pane.border_title and pane.is_on_screen]
    shown = f"On screen: {VIEWS[stage.view].title}; {'; '.join(panes)}."
    app.push_screen(TextScreen("In words", "\n".join([*description(stage.source), shown])))


def show_diary(app: "PenduApp") -> None:
    """List all events."""
    app.push_screen(TextScreen("Events", "\n".join(map(str, event_lines(app.stage.source)))))


def show_card(app: "PenduApp", index: int) -> None:
    """Show a method's card."""
    app.push_screen(TextScreen("Method", method_card(index)))


def take_picture(app: "PenduApp") -> None:
    """Save the screen beside the recordings."""
    try:
        picture, text = save_picture(app.export_screenshot(), library.folder())
    except OSError as error:
        app.notify(f"The screen cannot be saved: {explained(error)}", severity="warning", markup=False)
    else:
        app.notify(f"Saved {picture} and {text.name}", markup=False)


def copy_command(app: "PenduApp") -> None:
    """Copy the command that reproduces the run, and show it: not every terminal has a clipboard."""
    text = command(app.stage.source)
    app.copy_to_clipboard(text)
    app.notify(f"Copied: {text}", markup=False, timeout=15)


def replay(app: "PenduApp", path: str) -> None:
    """Finish what is on stage and replay a recording."""
    assert app.opened is not None
    try:
        stage = app.opened(Path(path))
    except Exception as error:
        app.notify(str(explained(error)), severity="warning", markup=False)
        return
    ended = app.stage
    ended.end()
    if isinstance(ended.source, Live) and ended.source.recorder is not None:
        for file in ended.source.recorder.files:
            app.notify(f"Recorded: {file}", markup=False)
    app.push_screen(stage)


EXTRAS: dict[str, Callable[..., Any]] = {
    "describe": show_description,
    "diary": show_diary,
    "card": show_card,
    "picture": take_picture,
    "copy_command": copy_command,
    "replay": replay,
}
