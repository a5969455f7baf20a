"""A lab in a browser, in a process of its own.

The visitor is not necessarily the person who started the server, so no action names a file.
"""

import os
import pickle
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from textual.drivers.web_driver import WebDriver

from engine.scenes import Scene
from recordings import library
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.launch import live_screen
from tui.terminal.options import LARGEST, TerminalOptions


@dataclass(frozen=True, slots=True)
class Settings:
    """The scene, the look and the folder of recordings of each lab that is served."""

    scene: Scene
    terminal: TerminalOptions
    folder: Path | None


class BoundedDriver(WebDriver):
    """Textual's driver for a browser, which may ask for any size."""

    def on_meta(self, packet_type: str, payload: dict[str, Any]) -> None:
        if packet_type == "resize":
            payload["width"] = bounded(payload["width"], LARGEST[0])
            payload["height"] = bounded(payload["height"], LARGEST[1])
        super().on_meta(packet_type, payload)


def bounded(size: float, largest: int) -> int:
    """Return a size in cells within reason."""
    return int(min(max(size, 1), largest))


def main() -> None:
    """Show the lab of the settings in a file, and record it if they have a folder."""
    settings: Settings = pickle.loads(Path(sys.argv[1]).read_bytes())
    for name, largest in zip(("COLUMNS", "ROWS"), LARGEST, strict=True):
        os.environ[name] = str(bounded(int(os.environ[name]), largest))
    live = Live(settings.scene)
    path = settings.folder and library.new_path(settings.folder)
    app = PenduApp(live_screen(live, path), terminal=settings.terminal)
    app.driver_class = BoundedDriver
    try:
        app.run()
    finally:
        live.close()


if __name__ == "__main__":
    main()
