"""ErrorTable: each method's state and energy error now, and the verdict on its error so far."""

from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import NamedTuple

from textual import events

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import ExtraColumn, Model
from pendu_tui.engine.quantities import (
    ENERGY_ERROR,
    EVALUATIONS,
    LARGEST,
    OMEGA,
    THETA,
    THETA_ERROR,
    TREND,
    Quantity,
)
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.stepping import change_before
from pendu_tui.engine.run.verdicts import FAILED, VERDICTS, Judgement
from pendu_tui.tui.drawing.palette import GOOD, QUIET, TEXT, WARN, inks, mark
from pendu_tui.tui.drawing.picture import Picture, Row
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.numbers import angle, decimal, scientific


class TableLine(NamedTuple):
    method: Method
    reading: Reading
    judgement: Judgement
    h: float  # s, the method's own step size
    largest: float  # |dE/E0|, since h last changed
    theta_error: float  # rad, since h last changed


class Column(NamedTuple):
    """A column: its heads and widths, narrow and wide, and its cells."""

    keep: int  # where there is no room the smallest goes first
    head: str
    width: int
    wide_head: str
    wide_width: int
    cell: Callable[[TableLine, int], str]  # at most so many characters


def _angle(line: TableLine, width: int) -> str:
    return angle(line.reading.theta, width, min(width - 8, 5))


def _omega(line: TableLine, width: int) -> str:
    return decimal(line.reading.omega, width, max(width - 8, 3))


def _judgement(line: TableLine) -> Judgement:
    if line.reading.diverged_at is not None:
        return Judgement(FAILED)
    return line.judgement


def _verdict(line: TableLine, width: int) -> str:
    """Return a verdict: "+ grows", or "undecided 4/8" where there is room."""
    judgement = _judgement(line)
    far = "{}/{}".format(*judgement.progress or ("", ""))
    text = f"{VERDICTS[judgement.verdict].sign} {judgement.verdict} {far}".strip(" /")
    if len(text) > width:
        return judgement.verdict
    return text


def _quantity(quantity: Quantity, keep: int, cell: Callable[[TableLine, int], str]) -> Column:
    return Column(keep, *quantity.head, cell)


COLUMNS = (
    Column(9, "h", 6, "h [s]", 8, lambda line, width: f"{line.h:.4g}"[:width]),
    _quantity(THETA, 4, _angle),
    _quantity(OMEGA, 2, _omega),
    _quantity(ENERGY_ERROR, 7, lambda line, w: scientific(line.reading.energy_error, w)),
    _quantity(LARGEST, 6, lambda line, w: scientific(line.largest, w, 1, "-")),
    _quantity(TREND, 5, lambda line, w: scientific(line.judgement.slope, w)),
    Column(8, "verdict", 9, "verdict", 13, _verdict),
    _quantity(THETA_ERROR, 3, lambda line, w: scientific(line.theta_error, w, 1, "-")),
    _quantity(EVALUATIONS, 1, lambda line, w: f"{line.method.force_evaluations}"),
)


def extra_columns(model: Model) -> list[Column]:
    def column(extra: ExtraColumn) -> Column:
        def cell(line: TableLine, width: int) -> str:
            value = extra.value(line.reading.extra)
            text = f"{value:.3g}"
            if len(text) > width:
                text = scientific(value, width, 1, "-")
            return text

        return Column(8, extra.head, 7, extra.wide_head, max(len(extra.wide_head), 7), cell)

    return [column(each) for each in model.extra_columns]


def _columns(source: Source, room: int) -> list[Column]:
    """Return the columns that fit; that of h only where methods differ in it."""
    columns = [*COLUMNS[:-1], *extra_columns(source.scene.equations), COLUMNS[-1]]
    if len(set(source.stepping.own)) == 1:
        columns = columns[1:]
    wide = [each._replace(head=each.wide_head, width=each.wide_width) for each in columns]
    if sum(column.width + 1 for column in wide) <= room:
        return wide
    while columns and sum(column.width + 1 for column in columns) > room:
        columns.remove(min(columns, key=lambda column: column.keep))
    return columns


def _since_change(source: Source, sample: Sample) -> tuple[list[float], list[float], str]:
    """Return the largest energy and theta errors since h changed, and a head."""
    change = change_before(source.changes, sample.step)
    if change.step and (errors := source.history.since(change)):
        return *errors, f"since h {change.stepping.h:.4g} s"
    readings = sample.readings  # a replay may not have read the change yet
    return [reading.max_energy_error for reading in readings], [0.0] * len(readings), "method"


def table(source: Source, sample: Sample, shown: Shown, width: int) -> list[Row]:
    """Return the rows, the head first."""
    cast = source.scene.cast
    model = source.scene.equations
    exact = source.exact.at(sample.t).theta
    largest, theta_errors, head = _since_change(source, sample)
    names = [f"{mark(place, method)} {method.label}" for place, method in enumerate(cast)]
    room = max([20, *map(len, names)])
    columns = _columns(source, width - room)
    spare = width - room - sum(column.width + 1 for column in columns)
    gap = " " * (1 + min(spare // max(len(columns), 1), 3))
    row = [(head.ljust(room), QUIET)]
    for column in columns:
        title = column.head.replace(ENERGY_ERROR.head.narrow, model.error.head.narrow)
        row.append((gap + title.rjust(column.width), QUIET))
    rows = [row]
    for place in shown.places(cast):
        reading = sample.readings[place]
        line = TableLine(
            cast[place],
            reading,
            source.judgements[place],
            h=source.stepping.own[place],
            largest=largest[place],
            theta_error=abs(model.theta_error(reading.theta, exact) - theta_errors[place]),
        )
        row = [(names[place].ljust(room), inks(cast)[place])]
        for column in columns:
            text = column.cell(line, column.width)
            row.append((gap + text.rjust(column.width), _ink(column, line)))
        rows.append(row)
    return list[Row](rows)


def _ink(column: Column, line: TableLine) -> int:
    if column.head == "verdict":
        return {"good": GOOD, "warn": WARN, "quiet": QUIET}[VERDICTS[_judgement(line).verdict].ink]
    if line.reading.diverged_at is not None:
        return WARN
    return TEXT


class ErrorTable(Pane):
    """Shows as many columns as fit.  The pointer on a head explains it."""

    _head: Sequence[str] = ()

    def picture(self, source: Source, sample: Sample) -> Picture:
        rows = table(source, sample, self.shown, self.room.width)
        self.styles.height = len(rows)  # hidden methods leave no gap
        self._head = [text for text, _ in rows[0]]
        return Picture(rows)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        from pendu_tui.tui.words.cards import head_text  # not needed for the first paint

        ends = accumulate(map(len, self._head))
        head = next((text for text, end in zip(self._head, ends, strict=True) if event.x < end), "")
        self.tooltip = None
        if event.y == 0:
            self.tooltip = head_text(head.strip())

    async def on_click(self, event: events.Click) -> None:
        if 0 < event.y <= len(self.places):
            await self.run_action(f"screen.show_alone({self.places[event.y - 1]})")
