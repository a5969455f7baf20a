"""StabilityPane: a map of each method's stability, to choose h and amplitude from."""

import math
from typing import Any

import numpy as np
from textual import events

from pendu_tui.engine.methods import Cast
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.stability.grid import Grid, Piece, pieces
from pendu_tui.engine.stability.outcomes import CHAOTIC, FATES, HELD, UNKNOWN, Cells, is_lost
from pendu_tui.engine.stability.study import amplitude
from pendu_tui.tui.drawing.palette import TEXT, palette
from pendu_tui.tui.drawing.picture import Picture, Row
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.stability.picture import MARGIN, legend, panel, place_at, side_by_side
from pendu_tui.tui.views.view import Chooser, StudyView

PASSES = (300, 10_000)
"""Steps of each swing: first a quick map, then the final one."""


def _grid(cast: Cast) -> Grid:
    theta = (np.arange(48) + 0.5) * math.pi / 48
    return Grid(theta, (np.arange(80) + 0.5) * 3 / 80, PASSES[-1], cast)


def _outcome(cell: Any) -> str:
    fate = FATES[cell["fate"]]
    return fate.replace("holds, wobbling", "held, larger wobble").replace("holds", "held")


def note(cell: Any) -> str:
    if cell["fate"] == UNKNOWN:
        return "…"
    if cell["fate"] == CHAOTIC:
        return _outcome(cell)
    if is_lost(cell):
        return f"{_outcome(cell)}, step {cell['steps'] + 1}"
    return f"{_outcome(cell)}, {cell['error']:.0e}"


def verdict(grid: Grid, cells: Cells, index: int, place: tuple[int, int], w0: float) -> str:
    """Return the outcome of a method at a place, and the nearest h with another outcome."""
    z, theta = place
    row = cells[:, index, theta]
    cell = row[z]
    degrees = math.degrees(grid.theta[theta])
    where = f"{grid.methods[index].label} at h {grid.z[z] / w0:.3g} s, {degrees:.3g}°:"
    if cell["fate"] == UNKNOWN:
        return f"{where} not computed yet"
    outcome = _outcome(cell)
    here = "held"
    there = "lost"
    if is_lost(cell):
        here, there = there, here
        if cell["fate"] != CHAOTIC:
            outcome = f"lost at step {cell['steps'] + 1}, {outcome}"
    else:
        outcome += f", energy error {cell['error']:.1e}"
    known = row["fate"] != UNKNOWN
    other = np.flatnonzero(known & (np.isin(row["fate"], HELD) != (here == "held")))
    if not len(other) and not known.all():
        missing = {"lost": "loss", "held": "h that holds"}[there]
        return f"{where} {outcome}; no {missing} found yet"
    if not len(other):
        return f"{where} {outcome}; {here} at every h on this map"
    nearest = grid.z[other[np.abs(other - z).argmin()]]
    return f"{where} {outcome}; {there} at h {nearest / w0:.3g} s"


class StabilityPane(Chooser[tuple[int, int]]):
    """Draws the map while it is computed; another scene only moves the mark and the axis.

    Places on the map are indices of z and theta.
    """

    BINDING_GROUP_TITLE = "Stability"
    HELP = "A click starts with that h and amplitude."

    def __init__(self) -> None:
        super().__init__()
        self._begin(())

    def _begin(self, cast: Cast) -> None:
        self.grid = _grid(cast)
        self.cells: Cells = self.grid.unknown()
        self._is_begun = False
        self._title = ""
        self._state = ""
        self.cursor = self.pointer = None

    @property
    def settled(self) -> bool:
        if self.source.scene.why_not_mapped:
            return True
        return self._is_begun and not self.is_computing

    def forget(self) -> None:
        self._begin(())

    def add(self, result: Piece) -> None:
        part = result.part
        self.cells[part.z, part.method] = result.cells
        self._is_begun = True
        self._title = f"Stability (F5), {part.grid.steps} steps: h [s], amplitude [°]"
        self._state = (
            f"Computing {100 * result.done:.0f} %. "  # as a title it would repaint the pane
        )
        if result.done == 1 and part.grid.steps == PASSES[-1]:
            self._state = ""

    def here(self, index: int) -> tuple[float, float] | None:
        """Return the (z, amplitude) of a method on screen, if it swings."""
        theta = amplitude(self.source.scene)
        if theta is None:
            return None
        return abs(self.source.stepping.own[index]) * self.source.scene.w0, theta

    def aim(self, index: int) -> tuple[int, int] | None:
        if self.cursor or self.pointer:
            return self.cursor or self.pointer
        if (here := self.here(index)) is None or here[0] > self.grid.z[-1]:
            return None
        z, theta = here
        return int(abs(self.grid.z - z).argmin()), int(abs(self.grid.theta - theta).argmin())

    def picture(self, source: Source, sample: Sample) -> Picture:
        if why := source.scene.why_not_mapped:
            self.write_titles("Stability (F5)")
            return Picture(self.words(why))
        if self.cast != self.grid.methods:
            self._begin(self.cast)
            self.compute(pieces, self.grid, PASSES)
        self.write_titles(self._title)
        columns, rows = self._panel_size
        if columns <= 2 * MARGIN:
            return Picture()
        panels = [self._panel(index, columns, rows) for index in self.places]
        words = ""
        if self.places and (aim := self.aim(self.index)):
            words = verdict(self.grid, self.cells, self.index, aim, source.scene.w0)
        blank: Row = [("", TEXT)]
        below = [*self.words(f"{self._state}{words}"), blank, blank][:2]
        return Picture([*side_by_side(panels, 2), *below, *self._legend])

    def _panel(self, index: int, columns: int, rows: int) -> list[Row]:
        here = self.here(index)
        if self.cursor is not None:
            here = self.grid.z[self.cursor[0]], self.grid.theta[self.cursor[1]]
        words = ""
        if aim := self.aim(index):
            words = note(self.cells[aim[0], index, aim[1]])
        return panel(
            self.grid,
            self.cells,
            index,
            columns,
            rows,
            palette(self.app.theme),
            here=here,
            w0=self.source.scene.w0,
            note=words,
        )

    @property
    def _panel_size(self) -> tuple[int, int]:
        """Columns of a panel and rows of its map; two panels are side by side."""
        lines = -(-len(self.places) // 2) or 1
        rows = (self.room.height - 2 - len(self._legend)) // lines - 2
        return (self.room.width - 2) // 2, max(1, rows)

    @property
    def _legend(self) -> list[Row]:
        # it may use the columns of the frame, too
        lines = legend(self.grid.steps, palette(self.app.theme), self.room.width + 2)
        return lines[: max(self.room.height // 7, 1)]

    def action_move(self, right: int, up: int) -> None:
        if self.cast != self.grid.methods:
            return
        z, theta = self.aim(self.index) or (0, 0)
        z = min(max(z + right, 0), len(self.grid.z) - 1)
        self.cursor = z, min(max(theta + up, 0), len(self.grid.theta) - 1)
        self.draw()

    def choose(self, place: tuple[int, int]) -> None:
        z, theta = place
        h = float(self.grid.z[z]) / self.source.scene.w0
        self.start_at(float(self.grid.theta[theta]), 0.0, h)

    def place_under(self, event: events.MouseEvent) -> tuple[int, int] | None:
        columns, rows = self._panel_size
        x, y = event.get_content_offset_capture(self)
        across, column = divmod(x, columns + 2)
        down, row = divmod(y, rows + 2)
        inside = across in (0, 1) and MARGIN <= column < columns and 1 <= row <= rows
        number = 2 * down + across
        is_mapped = inside and self.cast == self.grid.methods
        if not is_mapped or number not in range(len(self.places)):
            return None
        self.described = self.cast[self.places[number]].key
        return place_at(self.grid, row - 1, column - MARGIN, rows, columns - MARGIN)


class StabilityView(StudyView):
    PANE = StabilityPane
