"""Textual alone: an app that paints what the lab painted, from strips made beforehand, and does nothing else.

python tests/bench/painter.py COLUMNS ROWS [KEY]   films the lab without a terminal, after a key, and shows the film
python tests/bench/painter.py                      an empty app

A film is what every pane of the lab looks like in each frame, borders included, and which of its rows change.
Here each pane is one widget straight on the screen: there is no cheaper way to paint as much with Textual.
"""

import asyncio
import gc
import sys
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[2]))

from textual.app import App, ComposeResult
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Static

FPS, BEGIN, SECONDS, H = 30, 5, 10, 0.01  # more than one step a frame, so that every frame moves
TOLD = ("h 0.02 s", "h 0.01 s")


class Pane(NamedTuple):
    """Where a pane is, and its rows in each frame."""

    region: Region
    frames: list[list[Strip]]


async def film(size: tuple[int, int], key: str | None) -> list[Pane]:
    """What the lab shows in the seconds in which it is watched."""
    from engine.scenes import DEFAULT_SCENE
    from tui.playback.live import Live
    from tui.screens.app import PenduApp
    from tui.screens.live import LiveScreen
    from tui.screens.still import settled

    now, panes = 0.0, {}
    stage = LiveScreen(Live(DEFAULT_SCENE.altered(h=H), clock=lambda: 0.0), clock=lambda: now)
    app = PenduApp(stage)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        stage._timer.stop()
        await pilot.press(*([key] if key else []))
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
        self.strips = pane.frames[0]
        self.styles.position = "absolute"
        self.styles.offset = pane.region.offset
        self.styles.width, self.styles.height = pane.region.size

    def render_line(self, y: int) -> Strip:
        """A row as it was made."""
        return self.strips[y]


class Painter(App[None]):
    """Shows the film to and fro, with r from its start.  + and - change a word at once, as in the lab."""

    ALLOW_SELECT = False
    CSS = "Screen { overflow: hidden; } #told { dock: bottom; height: 1; width: 10; }"
    BINDINGS: ClassVar[Any] = [("+", "tell(0)"), ("-", "tell(1)"), ("r", "rewind"), ("q", "quit")]

    def __init__(self, panes: list[Pane]) -> None:
        super().__init__()
        self._panes = panes
        self._paintings = [Painting(pane) for pane in panes]
        self._changes = [
            [
                [
                    Region(0, y, pane.region.width, 1)
                    for y, pair in enumerate(zip(*two, strict=True))
                    if pair[0] != pair[1]
                ]
                for two in zip(pane.frames, pane.frames[1:], strict=False)
            ]
            for pane in panes
        ]
        self._at, self._step = 0, 1

    def compose(self) -> ComposeResult:
        """Create the panes."""
        yield from self._paintings
        yield Static("", id="told")

    def on_mount(self) -> None:
        """Begin after the first paint, as the lab does."""
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        gc.collect()
        gc.freeze()
        self.set_interval(1 / FPS, self.frame)

    def frame(self) -> None:
        """Show the next frame."""
        if not 0 <= self._at + self._step < len(self._panes[0].frames):
            self._step = -self._step
        before, self._at = self._at, self._at + self._step
        for painting, pane, changes in zip(
            self._paintings, self._panes, self._changes, strict=True
        ):
            if regions := changes[min(before, self._at)]:
                painting.strips = pane.frames[self._at]
                painting.refresh(*regions)

    def action_rewind(self) -> None:
        """Begin anew."""
        self._at, self._step = 0, 1
        for painting, pane in zip(self._paintings, self._panes, strict=True):
            painting.strips = pane.frames[0]
            painting.refresh()

    def action_tell(self, number: int) -> None:
        """Show what a key changes."""
        self.query_one("#told", Static).update(TOLD[number])


class Empty(App[None]):
    """What Textual itself takes to come up."""

    BINDINGS: ClassVar[Any] = [("q", "quit")]

    def compose(self) -> ComposeResult:
        """One word."""
        yield Static("empty")


def main(columns: str = "", rows: str = "", key: str | None = None) -> None:
    """Show a film, or nothing."""
    if columns:
        Painter(asyncio.run(film((int(columns), int(rows)), key))).run()
    else:
        Empty().run()


if __name__ == "__main__":
    main(*sys.argv[1:])
