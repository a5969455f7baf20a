"""ErrorTable: the verdict on each method's energy error so far, its errors, and its state now."""

import math
from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import NamedTuple

from textual import events

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import ExtraColumn
from pendu_tui.engine.quantities import (
    ENERGY_ERROR,
    EVALUATIONS,
    LARGEST,
    OMEGA,
    THETA,
    THETA_ERROR,
    TREND,
    Head,
)
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.stepping import change_before
from pendu_tui.engine.run.verdicts import FAILED, VERDICTS, Judgement
from pendu_tui.tui.drawing.picture import GOOD, QUIET, TEXT, WARN, Picture, Row, inks, mark
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.numbers import SIGNED, UNSIGNED, decimal, fitting

WIDE = 120  # columns, from which heads are written in full, in every scene


class TableLine(NamedTuple):
    method: Method
    reading: Reading
    judgement: Judgement
    h: float  # s, the method's own step size
    largest: float  # |dE/E0|, since h last changed
    theta_error: float  # rad, since h last changed
    held: bool  # by the user: there is no run

    @property
    def verdict(self) -> str:
        return FAILED if self.reading.diverged_at is not None else self.judgement.verdict


class Column(NamedTuple):
    keep: int  # where there is no room the smallest goes first
    head: Head
    cell: Callable[[TableLine, int], str]  # at most so many characters


def _verdict(line: TableLine, width: int) -> str:
    """Return "+ grows"; of an undecided one what is missing: "5 of 8 cycles" or "5/8 cycles"."""
    if line.held:
        return "held"
    verdict = VERDICTS[line.verdict]
    if verdict.sign:
        return f"{verdict.sign} {verdict.word}"
    texts = [str(line.judgement)]
    if missing := line.judgement.progress:
        count = f"{missing.have}/{missing.need}"
        texts = [str(missing), f"{count} {missing.unit}", count]
    return next((text for text in texts if len(text) <= width), verdict.word)


VERDICT = Column(9, Head("verdict", 10, "verdict", 13), _verdict)
STEP_SIZE = Column(
    6, Head("h", 6, "h [s]", 8), lambda line, w: fitting(line.h, w, ".4g", ".2g", ".0e")
)
COLUMNS = (
    VERDICT,
    Column(8, ENERGY_ERROR.head, lambda line, w: fitting(line.reading.energy_error, w, *SIGNED)),
    Column(7, LARGEST.head, lambda line, w: fitting(line.largest, w, *UNSIGNED)),
    Column(5, TREND.head, lambda line, w: fitting(line.judgement.trend, w, *SIGNED)),
    Column(3, THETA_ERROR.head, lambda line, w: fitting(line.theta_error, w, *UNSIGNED)),
    Column(4, THETA.head, lambda line, w: decimal(line.reading.theta, w, w - 8)),
    Column(2, OMEGA.head, lambda line, w: decimal(line.reading.omega, w, max(w - 8, 3))),
    STEP_SIZE,
    Column(1, EVALUATIONS.head, lambda line, w: f"{line.method.force_evaluations}"),
)


def extra_column(extra: ExtraColumn) -> Column:
    def cell(line: TableLine, width: int) -> str:
        return fitting(extra.value(line.reading.extra), width, ".3g", *UNSIGNED)

    head = Head(extra.head, 7, extra.wide_head, max(len(extra.wide_head), 7))
    return Column(6, head, cell)


def _columns(
    source: Source, width: int, names: int, more: Sequence[Column]
) -> list[tuple[str, int, Column]]:
    """Return heads and widths of the columns that fit; h only where methods differ in it."""
    extra = map(extra_column, source.scene.equations.extra_columns)
    columns = [*COLUMNS[:5], *more, *extra, *COLUMNS[5:]]
    if len(set(source.stepping.own)) == 1:
        columns.remove(STEP_SIZE)
    heads = {each: each.head[2:] if width >= WIDE else each.head[:2] for each in columns}
    spare = width - names - 1 - sum(size + 1 for _, size in heads.values())
    while heads and spare < 0:
        _, size = heads.pop(min(heads, key=lambda column: column.keep))
        spare += size + 1
    more_room = {VERDICT: min(spare, 3)}  # "2 of 5 cycles"
    return [
        (title, size + more_room.get(column, 0), column) for column, (title, size) in heads.items()
    ]


def _since_change(source: Source, sample: Sample) -> tuple[list[float], list[float], str]:
    """Return the largest energy and theta errors since h changed, and a head."""
    change = change_before(source.changes, sample.step)
    if change.step and (errors := source.history.since(change)):
        return *errors, f"since {change.stepping.symbol} = {change.stepping.h:.4g} s"
    readings = sample.readings  # a replay may not have read the change yet
    return [reading.max_energy_error for reading in readings], [0.0] * len(readings), "method"


def table(
    source: Source, sample: Sample, shown: Shown, width: int, more: Sequence[Column] = ()
) -> list[Row]:
    """Return the rows, the head first, with `more` columns after the errors."""
    cast = source.scene.cast
    model = source.scene.equations
    names = [f" {mark(place, method)} {method.label}" for place, method in enumerate(cast)]
    lines, head = _lines(source, sample, shown)
    room = max(20, len(head) + 1, *map(len, names))
    columns = _columns(source, width, room, more)
    spare = width - 1 - room - sum(width + 1 for _, width, _ in columns)
    gap = " " * (1 + min(spare // max(len(columns), 1), 3))
    row = [(f" {head}".ljust(room), QUIET)]
    for title, size, column in columns:
        title = title.replace(ENERGY_ERROR.head.narrow, model.error.head.narrow)
        row.append((gap + _aligned(title, size, column), QUIET))
    rows = [row]
    for place, line in lines.items():
        row = [(names[place].ljust(room), inks(cast)[place])]
        for _, size, column in columns:
            text = _aligned(column.cell(line, size), size, column)
            row.append((gap + text, _ink(column, line)))
        rows.append(row)
    return list[Row](rows)


def _lines(source: Source, sample: Sample, shown: Shown) -> tuple[dict[int, TableLine], str]:
    """Return the methods shown by their place, and the head of their names."""
    model = source.scene.equations
    exact = source.exact.at(sample.t).theta
    largest, theta_errors, head = _since_change(source, sample)
    lines = {}
    for place in shown.places(source.scene.cast):
        reading = sample.readings[place]
        line = TableLine(
            source.scene.cast[place],
            reading,
            source.judgements[place],
            h=source.stepping.own[place],
            largest=largest[place],
            theta_error=abs(model.theta_error(reading.theta, exact) - theta_errors[place]),
            held=shown.held is not None,
        )
        if line.held:
            line = line._replace(
                reading=reading._replace(energy_error=math.nan, diverged_at=None),
                judgement=Judgement(),
                largest=math.nan,
                theta_error=math.nan,
            )
        lines[place] = line
    return lines, head


def _aligned(text: str, width: int, column: Column) -> str:
    return text.ljust(width) if column is VERDICT else text.rjust(width)


def _ink(column: Column, line: TableLine) -> int:
    """Return the ink of a cell: red is for failures."""
    if column is VERDICT and not line.held:
        inks = {"good": GOOD, "warn": WARN, "quiet": QUIET, "text": TEXT}
        return inks[VERDICTS[line.verdict].ink]
    if line.reading.diverged_at is not None:
        return QUIET
    return TEXT


class ErrorTable(Pane):
    """Shows as many columns as fit.  The pointer on a head explains it."""

    def __init__(self, more: Callable[[], Sequence[Column]] = lambda: ()) -> None:
        """`more` returns columns after the errors."""
        super().__init__()
        self._more = more
        self._head: Sequence[str] = ()

    def picture(self, source: Source, sample: Sample) -> Picture:
        rows = table(source, sample, self.shown, self.room.width, self._more())
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
