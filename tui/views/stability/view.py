"""StabilityView: where each method becomes unstable; the map fills in as it is computed."""

import math
from functools import partial

import numpy as np
from textual.app import ComposeResult
from textual.content import Content

from engine.methods import Cast
from engine.run.lockstep import Sample
from engine.stability.grid import Grid, pieces
from tui.views.background import computed
from tui.views.stability.pane import StabilityPane
from tui.views.view import View

PASSES = (300, 10_000)
"""Steps of each swing: a first map at once, then the final one."""


def _grid(cast: Cast) -> Grid:
    return Grid(
        (np.arange(48) + 0.5) * math.pi / 48, (np.arange(80) + 0.5) * 3 / 80, PASSES[-1], cast
    )


class StabilityView(View):
    """The map depends on z and amplitude only: another scene moves the mark and the axis, not the map."""

    def compose(self) -> ComposeResult:
        yield self.at_5_hz(StabilityPane(_grid(())))

    def on_show(self) -> None:
        self.query_one(StabilityPane).focus()

    def follow(self, sample: Sample, read: bool = True) -> None:
        if read:
            self._compute_missing()
        super().follow(sample, read)

    def _compute_missing(self) -> None:
        """Compute the map for the methods on screen."""
        if self.source is None or not self.display or not self.query(StabilityPane):
            return
        pane, cast = self.query_one(StabilityPane), self.source.scene.cast
        if not self.source.scene.general:
            cast = ()
            pane.border_title = "Stability (F5)"
        if cast != pane.grid.methods:
            self.workers.cancel_node(self)
            pane.begin(_grid(cast))
            if cast:
                self.compute(partial(self._fill, pane))

    async def _fill(self, pane: StabilityPane) -> None:
        """Compute the map, and show how far it is in tenths: with a new title, Textual sends all of the pane again."""
        shown = ""
        async for piece in computed(pieces, pane.grid, PASSES):
            pane.fill(piece.z, piece.method, piece.cells)
            pane.complete = piece.done == 1 and piece.steps == PASSES[-1]
            state = "" if pane.complete else f", {int(10 * piece.done) / 10:.0%}"
            title = f"Stability (F5), {piece.steps} steps: h [s], amplitude [°]{state}"
            if title != shown:
                shown, pane.border_title = (
                    title,
                    Content(title),
                )  # as markup, units in brackets would be gone
