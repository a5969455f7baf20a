"""A lab in a browser, in a process of its own.

Who uses it need not be who started the server, so nothing in it reads or writes a file by name, there is no shell to
suspend to, and it ends with the server.
"""

import os
from collections.abc import Iterable
from typing import ClassVar

from textual.app import SystemCommand
from textual.binding import Binding, BindingType
from textual.screen import Screen

from tui.commands.lab.web.server import Settings
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.launch import start_recording
from tui.screens.live import LiveScreen
from tui.screens.tour.touring import Touring
from tui.views.keys import Key, bindings

EXTRAS = {"describe", "events", "card", "copy_command", "go_to", "zoom", "shift"}
"""The rarely used actions that touch no file."""

KEPT_OUT = {"app.extra('screenshot')", "app.suspend_process"}
"""The actions whose keys are not there."""

KEYS = tuple(key for key in LiveScreen.KEYS if key.action not in KEPT_OUT)
WATCH = 2.0  # s between looks at whether the server is still there


class ServedScreen(LiveScreen, inherit_bindings=False):
    """The lab's screen without the keys that are kept out."""

    BINDINGS: ClassVar[list[BindingType]] = [*Screen.BINDINGS, *Touring.BINDINGS, *bindings(*KEYS)]
    KEYS: ClassVar[tuple[Key, ...]] = KEYS


class ServedApp(PenduApp, inherit_bindings=False):
    """The lab's app, whose actions on files do nothing, by whatever way they are called."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+c", "interrupt", show=False, priority=True)]

    def on_mount(self) -> None:
        """End with the server, even if that was killed."""
        server = os.getppid()
        self.set_interval(WATCH, lambda: None if os.getppid() == server else self.exit())

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action == "extra":
            return parameters[0] in EXTRAS
        return action not in ("suspend_process", "screenshot") and super().check_action(action, parameters)

    def action_extra(self, name: str, argument: object = None) -> None:
        if name in EXTRAS:
            super().action_extra(name, argument)

    def action_suspend_process(self) -> None:
        """Do nothing: there is no shell."""

    def get_system_commands(self, screen: Screen[object]) -> Iterable[SystemCommand]:
        self.open_replay = None
        return super().get_system_commands(screen)


def main(text: str) -> None:
    """Show the lab of these settings, and record it if they have a folder."""
    from recordings import library

    settings = Settings.from_text(text)
    live = Live(settings.scene)
    path = settings.folder and library.new_path(settings.folder)
    screen = ServedScreen(live, prepare=lambda: start_recording(live, path, or_next=True))
    app = ServedApp(screen, terminal=settings.terminal)
    app.run()
    live.close()
