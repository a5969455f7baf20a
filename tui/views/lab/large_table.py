"""LargeTable: each method's energy error and verdict, large."""

import math

from rich.style import Style
from textual.renderables.digits import Digits

from engine.methods import Method
from engine.run.lockstep import Reading, Sample
from engine.run.verdict import Judgement
from tui.drawing.cells import Row
from tui.drawing.palette import mark, series
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.lab.error_table import verdict_of
from tui.views.view import Pane
from tui.words.numbers import relative, scientific

DIGITS = 8  # of an energy error
HEIGHT = 3  # rows of large digits
CELL = 40  # columns that a method needs: its digits, and what they are


def large(text: str) -> list[str]:
    """A number as three rows, four columns a character."""
    digits = [list(Digits(character.replace("e", "E")).render(Style(bold=True)))[::2] for character in text]
    return [" ".join(segment.text.ljust(3) for segment in row) for row in zip(*digits, strict=True)]


def large_rows(source: Source, sample: Sample, shown: Shown, width: int) -> list[Row]:
    """A name, a verdict and a large energy error for each method, in as few lines as fit."""
    cast, judgements, conserved = source.scene.cast, source.judgements, source.scene.equations.conserved
    places = shown.places(cast)
    lines = math.ceil(len(places) / max(width // CELL, 1))
    across = math.ceil(len(places) / max(lines, 1))
    rows: list[Row] = []
    for first in range(0, len(places), max(across, 1)):
        room = width // across
        cells = [
            _cell(place, cast[place], sample.readings[place], judgements[place], room, conserved)
            for place in places[first : first + across]
        ]
        rows += [[cell[y] for cell in cells] for y in range(HEIGHT + 1)]
    return rows


def labelled(value: float) -> tuple[str, str]:
    """The number that is shown large, and what it is: "+3.3", "% dE/E0"."""
    text = relative(value, DIGITS).strip()
    if text.endswith("%"):
        return text[:-2], "% dE/E0"
    return text, "dE/E0"


def _cell(
    place: int, method: Method, reading: Reading, judgement: Judgement, width: int, conserved: bool
) -> list[tuple[str, int]]:
    verdict = verdict_of(reading, judgement)
    number, what = labelled(reading.energy_error)
    if not conserved:
        number, what = scientific(reading.energy_error, DIGITS, 1).strip(), "ln E/Etrue"
    *upper, last = large(number)
    lines = [f" {mark(place, method)} {method.label}: {verdict}", *(f" {row}" for row in upper), f" {last} {what}"]
    return [(line.ljust(width), series(method)) for line in lines]


class LargeTable(Pane):
    """Takes as many rows as it needs."""

    PAUSE = 0.5  # so that a class can read it

    def paint(self, source: Source, sample: Sample) -> None:
        rows = large_rows(source, sample, self.shown, self.room.width)
        self.styles.height = len(rows)
        self.show(rows)
