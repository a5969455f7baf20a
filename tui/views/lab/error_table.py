"""ErrorTable: each method's state and energy error now, and the verdict on its error so far."""

from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import NamedTuple

from textual import events

from engine.methods import Method
from engine.models.model import Model, State
from engine.run.judgement import Judgement
from engine.run.lockstep import Reading, Sample
from engine.run.stepping import change_before
from tui.drawing.palette import GOOD, QUIET, SIGNS, TEXT, WARN, inks, mark
from tui.drawing.picture import Picture, Row
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.messages import MethodChosen
from tui.views.view import Pane
from tui.words.numbers import angle, decimal, scientific


class TableLine(NamedTuple):
    """What the cells of a line are made from."""

    model: Model
    method: Method
    reading: Reading
    judgement: Judgement
    exact: State
    h: float  # s, its own step size
    largest: float  # |dE/E0|, since h last changed
    theta_before: float = 0.0  # rad, the theta error when h last changed


class Column(NamedTuple):
    """A column: head and width, narrow and wide, and how its cells are made."""

    keep: int  # columns with the smallest numbers go first where there is no room
    narrow: tuple[str, int]
    wide: tuple[str, int]
    cell: Callable[[TableLine, int], str]


COLUMNS = (
    Column(9, ("h", 6), ("h [s]", 8), lambda line, width: f"{line.h:.4g}"[:width].rjust(width)),
    Column(
        4,
        ("theta", 11),
        ("theta [rad]", 18),
        lambda line, width: angle(line.reading.theta, width, min(width - 8, 5)),
    ),
    Column(
        2,
        ("omega", 6),
        ("omega [rad/s]", 13),
        lambda line, width: decimal(line.reading.omega, width, max(width - 8, 3)),
    ),
    Column(
        7,
        ("dE/E0", 8),
        ("dE/E0", 8),
        lambda line, width: scientific(line.reading.energy_error, width),
    ),
    Column(
        6,
        ("largest", 7),
        ("largest", 8),
        lambda line, width: scientific(line.largest, width, 1, "-"),
    ),
    Column(
        5,
        ("per s", 8),
        ("trend per s", 11),
        lambda line, width: scientific(line.judgement.slope, width),
    ),
    Column(
        8,
        ("verdict", 9),
        ("verdict", 13),
        lambda line, width: verdict_of(line.reading, line.judgement, width).rjust(width),
    ),
    Column(
        3,
        ("th.err", 7),
        ("theta error", 11),
        lambda line, width: scientific(theta_error(line), width, 1, "-"),
    ),
    Column(
        1,
        ("evals/step", 10),
        ("evals/step", 10),
        lambda line, width: str(line.method.force_evaluations).rjust(width),
    ),
)


def extra_columns(model: Model) -> list[Column]:
    """Return the columns that only this model has."""
    return [
        Column(
            8,
            (each.head, 7),
            (each.wide_head, max(len(each.wide_head), 7)),
            lambda line, width, value=each.value: short(value(line.reading.extra), width),  # type: ignore[misc]
        )
        for each in model.extra_columns
    ]


NAME = 20  # columns of a name and its mark, or as many as the longest takes
MOST_GAP = 3


def short(value: float, width: int) -> str:
    """With three digits, or as many as fit."""
    text = f"{value:.3g}"
    return text.rjust(width) if len(text) <= width else scientific(value, width, 1, "-")


def theta_error(line: TableLine) -> float:
    """Return by how much a method is off the exact angle, or further off than when h changed."""
    error = line.model.theta_error(line.reading.theta, line.exact.theta)
    return abs(error - line.theta_before)


def verdict_of(reading: Reading, judgement: Judgement, room: int) -> str:
    """Return a verdict: "+ grows", or "too early 4/8" where there is room."""
    if reading.diverged_at is not None:
        judgement = Judgement("failed")
    sign = SIGNS.get(judgement.verdict, "")
    far = "{}/{}".format(*judgement.progress or ("", ""))
    text = f"{sign} {judgement.verdict} {far}".strip(" /")
    return text if len(text) <= room else judgement.verdict


def verdict_ink(text: str) -> int:
    """Return the ink of a verdict."""
    if text.startswith("="):
        return GOOD
    return WARN if text[:1] in "+-!~" else QUIET


def chosen(
    columns: Sequence[Column], room: int
) -> list[tuple[str, int, Callable[[TableLine, int], str]]]:
    """Return (head, width, cell) of the columns that fit: wide ones, or many narrow ones."""
    if sum(column.wide[1] + 1 for column in columns) <= room:
        return [(*column.wide, column.cell) for column in columns]
    left = list(columns)
    while left and sum(column.narrow[1] + 1 for column in left) > room:
        left.remove(min(left, key=lambda column: column.keep))
    return [(*column.narrow, column.cell) for column in left]


def since_change(source: Source, sample: Sample) -> tuple[list[float], list[float], str]:
    """Return the largest energy errors and the theta errors at the last change of h, and a head.

    Of the whole run, and zero, unless h has changed.
    """
    readings = sample.readings
    change = change_before(source.changes, sample.step)
    found = source.history.since(change.step) if change.step else None
    if found is None:  # or in a replay that has not read so far
        largest = [reading.max_energy_error for reading in readings]
        return largest, [0.0] * len(readings), "method"
    return *found, f"since h {change.stepping.h:.4g} s"


def table(source: Source, sample: Sample, shown: Shown, width: int) -> list[Row]:
    """The table's rows, its head first; each method's own step size where they differ."""
    cast = source.scene.cast
    judgements = source.judgements
    h = source.stepping.own
    model = source.scene.equations
    exact = source.exact.at(sample.t)
    every = COLUMNS[len(set(h)) == 1 :]
    every = (*every[:-1], *extra_columns(model), every[-1])
    room = max(
        [NAME, *(len(f"{mark(place, method)} {method.label}") for place, method in enumerate(cast))]
    )
    columns = chosen(every, width - room)
    spare = width - room - sum(size + 1 for _, size, _ in columns)
    gap = " " * (1 + min(spare // max(len(columns), 1), MOST_GAP))
    heads = [(head.replace("dE/E0", model.energy_error.symbol), size) for head, size, _ in columns]
    names = [(gap + head.rjust(size), QUIET) for head, size in heads]
    largest, before, head = since_change(source, sample)
    rows: list[Row] = [[(head.ljust(room), QUIET), *names]]
    for place in shown.places(cast):
        method = cast[place]
        line = TableLine(
            model,
            method,
            sample.readings[place],
            judgements[place],
            exact,
            h[place],
            largest[place],
            before[place],
        )
        failed = line.reading.diverged_at is not None
        name = f"{mark(place, method)} {method.label}".ljust(room)
        rows.append([(name, inks(cast)[place])])
        for head, size, cell in columns:
            text = gap + cell(line, size)
            ink = WARN if failed else TEXT
            if head == "verdict":
                ink = verdict_ink(text.strip())
            rows[-1] = [*rows[-1], (text, ink)]
    return rows


class ErrorTable(Pane):
    """As many columns as fit.  The pointer on a head says what it means."""

    _rows_shown = 0
    _head: Sequence[str] = ()

    def picture(self, source: Source, sample: Sample) -> Picture:
        rows = table(source, sample, self.shown, self.room.width)
        if len(rows) != self._rows_shown:
            self._rows_shown = len(rows)
            self.styles.height = len(rows)  # hidden methods leave no gap
        self._head = [text for text, _ in rows[0]]
        return Picture(rows)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Say what the head of the column under the pointer means."""
        from tui.words.cards import head_text  # not needed for the first paint

        ends = accumulate(map(len, self._head))
        head = next((text for text, end in zip(self._head, ends, strict=True) if event.x < end), "")
        self.tooltip = head_text(head.strip()) if event.y == 0 else None

    def on_click(self, event: events.Click) -> None:
        """Show the method of this row alone, or all again."""
        if 0 < event.y <= len(self.places):
            self.post_message(MethodChosen(self.places[event.y - 1]))
