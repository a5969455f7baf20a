"""The lab of one browser tab, in a process of its own."""

import os
import pickle
import sys
from functools import partial
from pathlib import Path
from typing import Any

from textual.drivers.web_driver import WebDriver

from pendu_tui.tui.commands.lab import start_recording
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.options import LARGEST

RESIZE_EVERY = 0.2  # s


class BoundedDriver(WebDriver):
    """Textual's driver for a browser, which may ask for any size, and for thousands a second."""

    _asked: dict[str, int] | None = None  # the last size that the lab does not have yet

    def on_meta(self, packet_type: str, payload: dict[str, Any]) -> None:
        if packet_type != "resize":
            super().on_meta(packet_type, payload)
            return
        is_waiting = self._asked is not None
        self._asked = bounded(payload)
        if not is_waiting:
            self._loop.call_soon_threadsafe(self._loop.call_later, RESIZE_EVERY, self._resize)

    def _resize(self) -> None:
        asked = self._asked
        self._asked = None
        super().on_meta("resize", dict[str, Any](asked or {}))

    def stop_application_mode(self) -> None:
        """Finish the recording before the server hears of the end and ends this process."""
        self._app.finish()  # type: ignore[attr-defined]
        super().stop_application_mode()


def bounded(size: Any) -> dict[str, int]:
    sides = zip(("width", "height"), LARGEST, strict=True)
    return {side: int(min(max(float(size[side]), 1), largest)) for side, largest in sides}


def main() -> None:
    scene, terminal, folder = pickle.loads(Path(sys.argv[1]).read_bytes())
    size = bounded({"width": os.environ["COLUMNS"], "height": os.environ["ROWS"]})
    os.environ.update(COLUMNS=str(size["width"]), ROWS=str(size["height"]))
    live = Live(scene)
    screen = LabScreen(live)
    if folder is not None:
        screen.record = partial(start_recording, folder=folder)
    app = PenduApp(screen, terminal=terminal)
    app.driver_class = BoundedDriver
    try:
        app.run()
    finally:
        live.close()


if __name__ == "__main__":
    main()
