"""StatusLine: the run, its speed, its start, and the state of the recording."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rich.cells import cell_len
from rich.style import Style

from engine.methods import Cast
from engine.run.lockstep import Sample
from recordings.errors import printable
from tui.drawing.palette import QUIET, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.numbers import factor, seconds, start, two_digits

SLOW = 1.0  # s of the clock from step to step: without a word, the lab would seem to stand still
BADGE = -10
"""The ink of LIVE and REPLAY."""


class Segment(NamedTuple):
    """A part of the line; where there is no room the smallest priority goes first."""

    priority: int
    text: str
    style: int = TEXT


def speed_text(speed: float) -> str:
    """Return as "1×", "1/8×", "1024×", "-2×"."""
    sign = "-" if speed < 0 else ""
    size = abs(speed)
    return f"{sign}{factor(size)}×" if size >= 1 else f"{sign}1/{factor(1 / size)}×"


def coarse(value: float) -> str:
    """Return as "12 s", "3 min", "1 h 02 min"."""
    if value < 60:
        return f"{int(value)} s"
    return f"{int(value / 60)} min" if value < 3600 else seconds(value)


def limit_warning(cast: Cast, zs: Sequence[float]) -> str:
    """Return as "unstable: e, s v (z > 2), r (z > 2.83)"; "" below all limits.

    `zs` are in the order of the cast.  Explicit Euler, never stable, is named only beside others.
    """
    letters: dict[float, list[str]] = {}
    for method, z in zip(cast, zs, strict=True):
        if method.linear_limit and method.linear_limit < z:
            letters.setdefault(method.linear_limit, []).append(method.letter)
    if not letters:
        return ""
    always = [method.letter for method in cast if method.linear_limit == 0.0]
    beyond = [f"{' '.join(each)} (z > {limit:.3g})" for limit, each in letters.items()]
    return f"unstable: {', '.join([*always, *beyond])}"


def segments(source: Source) -> Iterator[Segment]:
    """Yield the parts of the line, from left to right."""
    yield from _time(source)
    yield from _stepping(source)
    scene = source.scene
    yield Segment(6 if scene.watch else 3, f"scene {scene.name}", QUIET)
    yield Segment(5, start(scene.theta, scene.omega))
    yield from _recording(source)


def _time(source: Source) -> Iterator[Segment]:
    playhead = source.playhead
    state = "backwards" if source.stepping.h < 0 else "running"
    if source.failure:
        yield Segment(12, "stands still", WARN)
    else:
        yield Segment(12, "paused " if playhead.paused else state)
    speed = speed_text(playhead.speed)
    yield Segment(7, speed)
    share = source.pace.share
    if share < 0.99:
        yield Segment(10, f"only {two_digits(100 * share)} % of {speed}", WARN)
    yield Segment(11, f"t {seconds(source.sample.t)}")


def _stepping(source: Source) -> Iterator[Segment]:
    stepping = source.stepping
    fastest = source.scene.equations.fastest
    warning = limit_warning(source.scene.cast, [abs(h) * fastest for h in stepping.own])
    yield Segment(11, f"h {stepping.h:.4g} s{' equal cost' if stepping.equal_cost else ''}")
    yield Segment(10, f"z {abs(stepping.h) * fastest:.3g}", WARN if warning else TEXT)
    if warning:
        yield Segment(9, warning, WARN)
    is_slow = abs(stepping.h / source.playhead.speed) >= SLOW
    if is_slow and not source.playhead.paused and source.next_step is not None:
        yield Segment(9, f"next step in {coarse(max(source.next_step, 0.0))}")


def _recording(source: Source) -> Iterator[Segment]:
    status = source.recording_status
    if status is None:
        if source.playhead.seen is not None:  # else it is yet to begin
            yield Segment(8, "not recorded", QUIET)
    elif status.failed:
        yield Segment(10, "NOT RECORDED", WARN)
    else:
        if source.kind == "LIVE":
            yield Segment(8, f"REC {coarse(status.seconds)}")
        yield Segment(1, printable(status.name), QUIET)


def fit(parts: list[Segment], width: int) -> list[Segment]:
    """Return the segments that fit, with two blanks before each."""
    kept = list(parts)
    while kept and sum(cell_len(part.text) + 2 for part in kept) > width:
        kept.remove(min(kept))
    return kept


def status_row(source: Source, width: int) -> Row:
    """Return the line, as far as there is room."""
    badge = f" {source.kind} "
    row: list[tuple[str, int]] = [(badge, BADGE)]
    for part in fit(list(segments(source)), width - len(badge)):
        row += [("  ", TEXT), (part.text, part.style)]
    return row


class StatusLine(Pane):
    """The line; LIVE and REPLAY stand out."""

    def picture(self, source: Source, sample: Sample) -> Picture:
        return Picture([status_row(source, self.room.width)])

    def style_of(self, ink: int, base: Style) -> Style:
        if ink == BADGE:
            return super().style_of(WARN, base) + Style(reverse=True, bold=True)
        return super().style_of(ink, base)
