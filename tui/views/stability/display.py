"""StabilityDisplay: the map of stability, a panel a method, and in words what becomes of one swing."""

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from rich.segment import Segment
from textual.geometry import Region
from textual.reactive import var
from textual.strip import Strip
from textual.widget import Widget

from engine.methods import METHODS
from engine.run.lockstep import Sample
from engine.stability.grid import Grid
from engine.stability.outcomes import Cells
from engine.stability.study import amplitude
from tui.drawing.palette import Palette, palette
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.stability.picture import MARGIN, Line, differing, legend, panel, side_by_side, title
from tui.views.stability.words import note, verdict

if TYPE_CHECKING:
    from tui.screens.app import PenduApp

WORDS = 2  # lines
SOME = 3  # rows that are sent at once over a slow line
ROOMY = 28  # rows from which on there is room for all of the legend


class StabilityDisplay(Widget, can_focus=True):
    """Draws what is known of the map; who derives from it sets the cursor, the pointer and the method in words."""

    ALLOW_SELECT = False
    DEFAULT_CSS = """
    StabilityDisplay { border: round $panel-lighten-2; border-title-color: $foreground; width: 1fr; height: 1fr; }
    StabilityDisplay:focus { border: round $primary; }
    """

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    shown: var[Shown] = var(Shown())

    def __init__(self, grid: Grid) -> None:
        super().__init__()
        self.grid = grid
        self.cells: Cells = grid.unknown()
        self.complete = False  # nothing will be added to them
        self.cursor: tuple[int, int] | None = None  # indices of z and theta
        self.pointer: tuple[int, int] | None = None
        self.index = 2  # the method that is spoken of
        self._panels: list[list[Line]] = [[]] * len(METHODS)  # as large as they were last drawn
        self._filled: set[int] = set()  # methods with something new to draw
        self._lines: list[Line] = []
        self._painted: list[Line] = []
        self._drawn_for: object = None

    @property
    def settled(self) -> bool:
        """Whether the map is complete and drawn."""
        return self.complete and not self._filled and self._painted == self._lines

    def watch_sample(self) -> None:
        """Follow the scene and the step; of what has been computed, draw a panel at a time, 5 ms each."""
        if self.source is not None and self._state(self.source) != self._drawn_for:
            self.draw()
        elif self._painted != self._lines:
            self._paint()
        elif self._filled:
            self.draw([self._filled.pop()], wait=True)

    def on_resize(self) -> None:
        """Draw for the new size."""
        self.draw()

    def on_show(self) -> None:
        """Draw what has been computed in the meantime."""
        self.draw()

    def fill(self, z: slice, method: int, cells: Cells) -> None:
        """Take in some of the map; it is drawn with one of the next samples."""
        self.cells[z, method] = cells
        self._filled.add(method)

    def here(self, index: int) -> tuple[float, float] | None:
        """The (z, amplitude) of a method on screen, if it swings."""
        if self.source is None or (theta := amplitude(self.source.scene)) is None:
            return None
        return abs(self.source.stepping.own()[index]) * self.source.scene.w0, theta

    def aim(self, index: int) -> tuple[int, int] | None:
        """The cell of a method that is spoken of: at the cursor, under the pointer, or nearest to here."""
        if self.cursor or self.pointer:
            return self.cursor or self.pointer
        if (here := self.here(index)) is None or here[0] > self.grid.z[-1]:
            return None
        return int(abs(self.grid.z - here[0]).argmin()), int(abs(self.grid.theta - here[1]).argmin())

    @property
    def text(self) -> str:
        """What is shown, without colours."""
        return "\n".join("".join(segment.text for segment in line).rstrip() for line in self._painted)

    def draw(self, changed: Sequence[int] = range(len(METHODS)), wait: bool = False) -> None:
        """Draw the panels of the methods that changed, and the words; over a slow line they may have to wait."""
        source = self.source
        if source is None or not self.size or not self.is_on_screen:
            return
        columns, rows = self.panel_size()
        if columns <= 2 * MARGIN:
            return
        self._drawn_for = self._state(source)
        cursor = (self.grid.z[self.cursor[0]], self.grid.theta[self.cursor[1]]) if self.cursor else None
        for index in changed:
            marked, w0 = cursor or self.here(index), source.scene.w0
            self._panels[index] = panel(self.grid, self.cells, index, columns, rows, self._colours, here=marked, w0=w0)
        self.tell(wait)

    def tell(self, wait: bool = False) -> None:
        """Say what becomes of the swing that is spoken of, above each panel and below all."""
        columns = self.panel_size()[0]
        panels = [
            [title(index, columns, self._colours, self._note(index)), *self._panels[index][1:]]
            for index in self.shown.indices
        ]
        said = [*textwrap.wrap(self._verdict(), max(self.size.width - 1, 1)), "", ""][:WORDS]
        self._lines = [*side_by_side(panels, 2), *([Segment(f" {line}")] for line in said), *self._legend()]
        self._paint(wait)

    def _paint(self, wait: bool = True) -> None:
        at_once = (
            SOME if wait and cast("PenduApp", self.app).throughput.is_slow else None
        )  # a key waits for what is sent
        self._painted[len(self._lines) :] = [[] for _ in self._lines[len(self._painted) :]]
        ends = {y: differing(*lines) for y, lines in enumerate(zip(self._painted, self._lines, strict=True))}
        changed = [(y, end) for y, end in ends.items() if end][:at_once]
        for y, _ in changed:
            self._painted[y] = self._lines[y]
        if changed:
            self.refresh(*(Region(0, y, end, 1) for y, end in changed))

    def render_line(self, y: int) -> Strip:
        """One row."""
        style = self.rich_style
        line = self._painted[y] if y < len(self._painted) else []
        return Strip(Segment.apply_style(line, style)).adjust_cell_length(self.size.width, style)

    def _state(self, source: Source) -> object:
        """What the picture depends on besides the map."""
        return source.scene, source.stepping.own(), self.shown, self.app.theme

    @property
    def _colours(self) -> Palette | None:
        return None if self.app.no_color or self.app.native_ansi_color else palette(self.app.theme)

    def panel_size(self) -> tuple[int, int]:
        """Columns of a panel, and rows of its map: two panels in a row, below them words and the legend."""
        lines = -(-len(self.shown.indices) // 2) or 1
        return (self.size.width - 2) // 2, max(1, (self.size.height - WORDS - len(self._legend())) // lines - 2)

    def _legend(self) -> list[Line]:
        lines = legend(self.grid.steps, self._colours, self.size.width + 2)  # as if the frame were part of it
        return lines if self.size.height >= ROOMY else lines[:1]

    def _note(self, index: int) -> str:
        if (aim := self.aim(index)) is None:
            return ""
        z, theta = aim
        return note(METHODS[index], self.grid.theta[theta], self.grid.z[z], self.cells[z, index, theta])

    def _verdict(self) -> str:
        shown = self.shown.indices
        index = self.index if self.index in shown else shown[0] if shown else 0
        if self.source is None or not shown or (aim := self.aim(index)) is None:
            return ""
        z, theta = aim
        cells, w0 = self.cells[:, index, theta], self.source.scene.w0
        return verdict(METHODS[index], self.grid.theta[theta], self.grid.z, cells, z, w0)
