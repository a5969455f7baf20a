"""The table below the portrait: what each method made of the area around its start, and of its time and energy."""

from engine.methods import METHODS
from engine.phase_space.area import Neighbourhood, Neighbours
from tui.drawing.canvas import Span
from tui.drawing.palette import FRAME, TEXT, mark
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.words.motion import area_text
from tui.words.numbers import scientific

_NAME, _CELL = 22, 14


def fact_rows(
    source: Source, shown: Shown, neighbours: Neighbours | None, ring: Neighbourhood | None, width: int
) -> list[list[Span]]:
    """The rows; of the columns, the first ones that fit."""
    exact, fit = source.exact.at(source.sample.t), max((width - _NAME) // _CELL, 0)
    heads = ("sum log det J", "area", "theta error", "dE/E0")[:fit]
    rows: list[list[Span]] = [
        [(_ring_text(source, neighbours)[:width], TEXT)],
        [(" " * _NAME + "".join(head.rjust(_CELL) for head in heads), FRAME)],
    ]
    for index in shown.indices:
        reading = source.sample.readings[index]
        cells = (
            *(("-", "-") if ring is None else area_text(ring.area_ratios[index])),
            scientific(reading.theta - exact.theta, _CELL, 3),
            scientific(reading.energy_error, _CELL, 3),
        )
        name = f" {mark(index)} {METHODS[index].label}".ljust(_NAME)
        rows.append([(name, index), ("".join(cell.rjust(_CELL) for cell in cells[:fit]), TEXT)])
    return rows


def _ring_text(source: Source, neighbours: Neighbours | None) -> str:
    if neighbours is None:
        return " No ring of neighbours, no area: g draws one."
    behind = source.sample.step - neighbours.step
    text = f" A ring of neighbours, {neighbours.radius:g} rad around the start (g)"
    return f"{text}: {behind} steps behind" if behind else text
