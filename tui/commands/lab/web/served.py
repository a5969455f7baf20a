"""A lab in a browser, in a process of its own."""

import os
import pickle
import sys
from pathlib import Path
from typing import Any

from textual.drivers.web_driver import WebDriver

from recordings import library
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.launch import live_screen
from tui.terminal.options import LARGEST


class BoundedDriver(WebDriver):
    """Textual's driver for a browser, which may have any size."""

    def on_meta(self, packet_type: str, payload: dict[str, Any]) -> None:
        if packet_type == "resize":
            columns, rows = bounded(payload["width"], payload["height"])
            payload.update(width=columns, height=rows)
        super().on_meta(packet_type, payload)


def bounded(columns: float, rows: float) -> tuple[int, int]:
    """Return a size within reason."""
    return int(min(max(columns, 1), LARGEST[0])), int(min(max(rows, 1), LARGEST[1]))


def main() -> None:
    """Show a lab of the scene, look and folder of recordings that a file holds."""
    scene, terminal, folder = pickle.loads(Path(sys.argv[1]).read_bytes())
    columns, rows = bounded(int(os.environ["COLUMNS"]), int(os.environ["ROWS"]))
    os.environ.update(COLUMNS=str(columns), ROWS=str(rows))
    live = Live(scene)
    app = PenduApp(live_screen(live, folder and library.new_path(folder)), terminal=terminal)
    app.driver_class = BoundedDriver
    try:
        app.run()
    finally:
        live.close()


if __name__ == "__main__":
    main()
