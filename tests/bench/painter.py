"""Textual alone: an app that paints what the lab painted, from strips made beforehand.

python -m tests.bench.painter COLUMNS ROWS   film the lab and show the film
python -m tests.bench.painter                show an empty app

A film holds the rows of every pane of the lab in each frame, borders included.  Each pane is one
widget directly on the screen, and only rows that change are painted: Textual cannot paint as much
for less.
"""

import asyncio
import gc
import sys
from typing import Any, ClassVar, NamedTuple

from textual.app import App, ComposeResult
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Static

FPS = 30
BEGIN = 5  # s of the lab before the film
SECONDS = 10
H = 0.01  # s; several steps a frame, so that every frame differs


class Pane(NamedTuple):
    """The place of a pane, and its rows in each frame."""

    region: Region
    frames: list[list[Strip]]


async def film(size: tuple[int, int]) -> list[Pane]:
    """Film the lab."""
    from pendu_tui.engine.scenes import DEFAULT_SCENE
    from pendu_tui.tui.commands.lab import settled
    from pendu_tui.tui.playback.live import Live
    from pendu_tui.tui.screens.app import PenduApp
    from pendu_tui.tui.screens.lab import LabScreen

    now = 0.0
    panes: dict[Widget, Pane] = {}
    stage = LabScreen(Live(DEFAULT_SCENE.altered(h=H), clock=lambda: 0.0), clock=lambda: now)
    app = PenduApp(stage)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        stage.frame_timer.stop()
        for frame in range(1, (BEGIN + SECONDS) * FPS):
            now = frame / FPS
            stage.frame()
            await pilot.pause(0)
            await settled(app)
            if now < BEGIN:
                continue
            for widget in stage.walk_children(Widget):
                if not widget.children and widget.is_on_screen and widget.region:
                    lines = widget.render_lines(Region(0, 0, *widget.region.size))
                    strips = [Strip([*line], line.cell_length) for line in lines]
                    panes.setdefault(widget, Pane(widget.region, [])).frames.append(strips)
    return list(panes.values())


class Painting(Widget):
    """One pane."""

    ALLOW_SELECT = False

    def __init__(self, pane: Pane) -> None:
        super().__init__()
        self._frames = pane.frames
        self._frame = 0
        self.styles.position = "absolute"
        self.styles.offset = pane.region.offset
        self.styles.width, self.styles.height = pane.region.size

    def render_line(self, y: int) -> Strip:
        return self._frames[self._frame][y]

    def show(self, frame: int) -> None:
        before = self._frames[self._frame]
        self._frame = frame
        pairs = enumerate(zip(before, self._frames[frame], strict=True))
        if changed := [Region(0, y, self.size.width, 1) for y, (old, new) in pairs if old != new]:
            self.refresh(*changed)


class Painter(App[None]):
    """Shows the film forwards and backwards; r rewinds it, + and - change a word as in the lab."""

    ALLOW_SELECT = False
    CSS = "Screen { overflow: hidden; } #word { dock: bottom; height: 1; width: 10; }"
    BINDINGS: ClassVar[Any] = [
        *(("+", "word('h 0.02 s')"), ("-", "word('h 0.01 s')")),
        *(("r", "rewind"), ("q", "quit")),
    ]

    def __init__(self, panes: list[Pane]) -> None:
        super().__init__()
        self._paintings = [Painting(pane) for pane in panes]
        forwards = list(range(len(panes[0].frames)))
        backwards = forwards[::-1]
        self._order = forwards + backwards[1:-1]
        self._shown = 0

    def compose(self) -> ComposeResult:
        yield from self._paintings
        yield Static("", id="word")

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)  # as the lab does

    def _begin(self) -> None:
        gc.collect()
        gc.freeze()
        self.set_interval(1 / FPS, self._next)

    def _next(self) -> None:
        self._shown = (self._shown + 1) % len(self._order)
        for painting in self._paintings:
            painting.show(self._order[self._shown])

    def action_rewind(self) -> None:
        self._shown = -1

    def action_word(self, word: str) -> None:
        self.query_one("#word", Static).update(word)


class Empty(App[None]):
    """Shows how long Textual itself takes to start."""

    BINDINGS: ClassVar[Any] = [("q", "quit")]

    def compose(self) -> ComposeResult:
        yield Static("empty")


if __name__ == "__main__":
    if len(sys.argv) == 1:
        Empty().run()
    else:
        columns, rows = map(int, sys.argv[1:])
        Painter(asyncio.run(film((columns, rows)))).run()
