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
    from pendu_tui.engine.scenes import DEFAULT_SCENE  # an empty app starts without them
    from tests.tui.harness import lab

    panes: dict[Widget, Pane] = {}
    async with lab(DEFAULT_SCENE.altered(h=H), size) as theatre:
        stage = theatre.stage
        stage.frame_timer.stop()
        for frame in range(1, (BEGIN + SECONDS) * FPS):
            theatre.now = frame / FPS
            stage.frame()
            await theatre.pilot.pause(0)
            await theatre.settled()
            if theatre.now < BEGIN:
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
    """Shows the film again and again."""

    ALLOW_SELECT = False
    CSS = "Screen { overflow: hidden; }"
    BINDINGS: ClassVar[Any] = [("q", "quit")]

    def __init__(self, panes: list[Pane]) -> None:
        super().__init__()
        self._paintings = [Painting(pane) for pane in panes]
        self._frames = len(panes[0].frames)
        self._shown = 0

    def compose(self) -> ComposeResult:
        yield from self._paintings

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)  # as the lab does

    def _begin(self) -> None:
        gc.collect()
        gc.freeze()
        self.set_interval(1 / FPS, self._next)

    def _next(self) -> None:
        self._shown = (self._shown + 1) % self._frames
        for painting in self._paintings:
            painting.show(self._shown)


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
