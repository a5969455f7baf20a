"""The command palette's entries, and the actions that are imported when first used: texts, screenshot, replay."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from textual.content import Content

from engine.methods import METHODS, method_of
from engine.scenes import GROUPS
from recordings import library
from tui.cli.errors import explained
from tui.drawing.palette import PALETTES
from tui.playback.live import Live
from tui.screens.base import SourceScreen
from tui.screens.dialogs.text import TextScreen
from tui.terminal.screenshot import save_screenshot
from tui.views import VIEWS
from tui.views.keys import Key
from tui.views.view import View
from tui.words.cards import method_card
from tui.words.command_line import command, reproduces
from tui.words.describe import description
from tui.words.events import event_lines, numbered


def show_description(screen: SourceScreen) -> None:
    """Describe in words what runs and what is on screen."""
    from tui.words.orbit import period_sentence  # with NumPy

    panes = [
        Content.from_markup(pane.border_title).plain
        for pane in screen.query("*")
        if pane.border_title and pane.is_on_screen
    ]
    shown = f"On screen: {VIEWS[screen.view].title}; {'; '.join(panes)}."
    lines = [*description(screen.source), period_sentence(screen.source), shown]
    screen.app.push_screen(TextScreen("In words", "\n".join(filter(None, lines))))


def show_events(screen: SourceScreen) -> None:
    """List all events."""
    screen.app.push_screen(TextScreen("Events", "\n".join(numbered(event_lines(screen.source)))))


def zoom(screen: SourceScreen, factor: float) -> None:
    """Show `factor` times the stretch of time in the chart."""
    screen.query_one(f"#{screen.view}", View).zoom(factor)


def shift(screen: SourceScreen, share: float) -> None:
    """Show a stretch of time in the chart that is later by a share of it."""
    screen.query_one(f"#{screen.view}", View).zoom(1.0, share)


def go_to(screen: SourceScreen, place: tuple[int, int]) -> None:
    """Go to a run's step."""
    run, step = place
    if screen.source.go_to(run, step):
        screen.show_now()
    else:
        screen.notify(f"That was in run {run}, which is over; its recording has it.", markup=False)


def show_card(screen: SourceScreen, key: str) -> None:
    """Show a method's card."""
    screen.app.push_screen(TextScreen("Method", method_card(method_of(key))))


def take_screenshot(screen: SourceScreen) -> None:
    """Save the screen next to the recordings."""
    try:
        picture, text = save_screenshot(screen.app.export_screenshot(), library.folder())
    except OSError as error:
        screen.notify(f"Screenshot failed: {explained(error)}", severity="warning", markup=False)
    else:
        screen.notify(f"Saved {picture} and {text.name}", markup=False)


def copy_command(screen: SourceScreen) -> None:
    """Copy the command that shows this again, and show it: not every terminal has a clipboard."""
    text = command(screen.source)
    screen.app.copy_to_clipboard(text)
    missing = "" if reproduces(screen.source) else " (the start only: h changed later, which only a recording holds)"
    screen.notify(f"Copied: {text}{missing}", markup=False, timeout=15)


def replay(screen: SourceScreen, path: str) -> None:
    """Finish what is on the screen and replay a recording."""
    assert screen.host.open_replay is not None
    try:
        other = screen.host.open_replay(Path(path))
    except Exception as error:
        screen.notify(str(explained(error)), severity="warning", markup=False)
        return
    screen.end()
    if isinstance(screen.source, Live) and screen.source.recorder is not None:
        for file in screen.source.recorder.files:
            screen.notify(f"Recorded: {file}", markup=False)
    screen.app.push_screen(other)


EXTRAS: dict[str, Callable[..., Any]] = {
    "describe": show_description,
    "events": show_events,
    "card": show_card,
    "go_to": go_to,
    "zoom": zoom,
    "shift": shift,
    "screenshot": take_screenshot,
    "copy_command": copy_command,
    "replay": replay,
}


class PaletteEntry(NamedTuple):
    """An entry and the action behind it."""

    title: str
    about: str
    action: str


def palette_entries(keys: Iterable[Key], live: bool, recordings: Iterable[Path]) -> list[PaletteEntry]:
    """The entries; only a live lab can be given another scene."""
    entry = PaletteEntry
    return [
        *(
            entry(f"{key.does} ({key.shown})", key.group, key.action)
            for key in keys
            if key.does and key.action not in ("", "command_palette")
        ),
        *(
            entry(f"scene {scene.name}", f"{group}: {scene.watch}", f"start_scene({scene.name!r})")
            for group, scenes in GROUPS.items()
            for scene in scenes
            if live
        ),
        *(entry(f"method {method.label}", "details", f"app.extra('card', {method.key!r})") for method in METHODS),
        *(entry(f"theme {name}", "", f"app.use_theme({name!r})") for name in PALETTES),
        *(entry(f"replay {path.stem}", str(path), f"app.extra('replay', {str(path)!r})") for path in recordings),
        entry("copy the command for this moment", "to the clipboard", "app.extra('copy_command')"),
    ]
