"""StabilityView: where each method becomes unstable; the map fills in as it is computed."""

import math

import numpy as np

from engine.methods import Cast
from engine.stability.grid import Grid, pieces
from tui.playback.source import Source
from tui.views.background import computed
from tui.views.stability.pane import StabilityPane
from tui.views.view import StudyView

PASSES = (300, 10_000)
"""Steps of each swing: a first map at once, then the final one."""


def _grid(cast: Cast) -> Grid:
    return Grid(
        (np.arange(48) + 0.5) * math.pi / 48, (np.arange(80) + 0.5) * 3 / 80, PASSES[-1], cast
    )


class StabilityView(StudyView[StabilityPane]):
    """The map depends only on z and amplitude: another scene moves the mark and the axis."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(StabilityPane(_grid(())), id)

    def compute_missing(self, source: Source) -> None:
        """Compute the map for the methods on screen."""
        cast = source.scene.cast
        if source.scene.general and cast != self.pane.grid.methods:
            self.workers.cancel_node(self)
            self.pane.begin(_grid(cast))
            self.compute(self._fill)

    async def _fill(self) -> None:
        """Compute the map; show progress in tenths, as each new title repaints the pane."""
        pane = self.pane
        async for piece in computed(pieces, pane.grid, PASSES):
            pane.fill(piece.z, piece.method, piece.cells)
            pane.complete = piece.done == 1 and piece.steps == PASSES[-1]
            state = "" if pane.complete else f", computing {int(10 * piece.done) * 10} %"
            pane.title = f"Stability (F5), {piece.steps} steps: h [s], amplitude [°]{state}"
