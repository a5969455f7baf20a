"""LargeTable: each method's energy error and verdict, large."""

import math
from collections.abc import Sequence

from textual.reactive import var

from engine.methods import METHODS
from engine.run.lockstep import Sample
from engine.run.verdict import Judgement
from tui.drawing.cells import CellWidget, Row
from tui.drawing.large import HEIGHT, large
from tui.drawing.palette import mark
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.words.numbers import scientific

DIGITS = 8  # of an energy error
CELL = 4 * DIGITS + 2  # columns that a method needs


def large_rows(sample: Sample, judgements: Sequence[Judgement], shown: Shown, width: int) -> list[Row]:
    """A name, a verdict and a large energy error for each method, in as few lines as fit."""
    lines = math.ceil(len(shown.indices) / max(width // CELL, 1))
    across = math.ceil(len(shown.indices) / max(lines, 1))
    rows: list[Row] = []
    for first in range(0, len(shown.indices), max(across, 1)):
        room = width // across
        cells = [_cell(index, sample, judgements[index], room) for index in shown.indices[first : first + across]]
        rows += [[cell[y] for cell in cells] for y in range(HEIGHT + 1)]
    return rows


def _cell(index: int, sample: Sample, judgement: Judgement, width: int) -> list[tuple[str, int]]:
    reading = sample.readings[index]
    verdict = "failed" if reading.diverged_at is not None else judgement.verdict
    title = f" {mark(index)} {METHODS[index].label}: {verdict}"
    lines = [title, *(f" {row}" for row in large(scientific(reading.energy_error, DIGITS)))]
    return [(line.ljust(width), index) for line in lines]


class LargeTable(CellWidget):
    """The table."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    shown: var[Shown] = var(Shown())

    def watch_sample(self) -> None:
        """Follow the sample."""
        self.draw()

    def watch_shown(self) -> None:
        """Follow the settings."""
        self.draw()

    def draw(self) -> None:
        """Draw the table, and take the room it needs."""
        if self.source is None or self.sample is None or not self.drawable:
            return
        rows = large_rows(self.sample, self.source.judgements, self.shown, self.room.width)
        self.styles.height = len(rows)
        self.show(rows)
