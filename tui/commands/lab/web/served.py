"""A lab in a browser, in a process of its own.

Who uses it need not be who started the server, so nothing in it reads or writes a file by name, there is no shell to
suspend to, and it ends with the server.
"""

import os
from typing import ClassVar

from textual.binding import Binding, BindingType

from tui.commands.lab.web.server import Settings
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.launch import start_recording
from tui.screens.live import LiveScreen

WATCH = 2.0  # s between looks at whether the server is still there


class ServedScreen(LiveScreen):
    """The lab's screen without the actions on files."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return action not in ("screenshot", "replay") and super().check_action(action, parameters)


class ServedApp(PenduApp, inherit_bindings=False):
    """The lab's app, whose actions on files do nothing, by whatever way they are called."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+c", "interrupt", show=False, priority=True)]

    def on_mount(self) -> None:
        """End with the server, even if that was killed."""
        server = os.getppid()
        self.set_interval(WATCH, lambda: None if os.getppid() == server else self.exit())

    def action_suspend_process(self) -> None:
        """Do nothing: there is no shell."""


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
