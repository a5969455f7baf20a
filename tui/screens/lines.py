"""The lines around a view: status, tour, insight and keys, or the message that nothing fits."""

import textwrap
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from typing import NamedTuple

from rich.cells import cell_len
from rich.style import Style
from textual import events
from textual.app import App
from textual.binding import ActiveBinding, Binding
from textual.screen import Screen, ScreenResultType

from engine.methods import Cast
from engine.run.lockstep import Sample
from recordings.errors import printable
from tui.drawing.cells import CellWidget
from tui.drawing.palette import EXACT, QUIET, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.terminal.options import SMALLEST
from tui.views.view import Pane
from tui.words.insight import insight_text
from tui.words.numbers import about, factor, seconds, start, two_digits
from tui.words.tour import Tour

SLOW = 1.0  # s of the clock from step to step: without a word, the lab would seem to stand still
BADGE = -10
"""The ink of LIVE and REPLAY, and of the tour's titles."""


class SizedScreen(Screen[ScreenResultType]):
    """A screen that leaves out sizes which the terminal has no longer.

    Two of them could evoke each other for ever.
    """

    def on_resize(self, event: events.Resize) -> None:
        if event.size != self.app.size:
            event.prevent_default()


class Badged(CellWidget):
    """A widget in which the ink BADGE stands out."""

    def style_of(self, ink: int, base: Style) -> Style:
        if ink == BADGE:
            return super().style_of(WARN, base) + Style(reverse=True, bold=True)
        return super().style_of(ink, base)


class Segment(NamedTuple):
    """A part of the status line; where there is no room the smallest priority goes first."""

    priority: int
    text: str
    style: int = TEXT


class StatusLine(Pane, Badged):
    """The run, its speed, its start, and the state of the recording."""

    def picture(self, source: Source, sample: Sample) -> Picture:
        return Picture([status_row(source, self.room.width)])


def status_row(source: Source, width: int) -> Row:
    """Return the status line, as far as there is room."""
    badge = f" {source.kind} "
    scene = source.scene
    parts = [
        *_time(source),
        *_stepping(source),
        Segment(6 if scene.watch else 3, f"scene {scene.name}", QUIET),
        Segment(5, start(scene.theta, scene.omega)),
        *_recording(source),
    ]
    while parts and sum(cell_len(part.text) + 2 for part in parts) > width - len(badge):
        parts.remove(min(parts))
    row: list[tuple[str, int]] = [(badge, BADGE)]
    for part in parts:
        row += [("  ", TEXT), (part.text, part.style)]
    return row


def _time(source: Source) -> Iterator[Segment]:
    playhead = source.playhead
    if source.failure:
        yield Segment(12, "stands still", WARN)
    elif playhead.paused:
        yield Segment(12, "paused ")
    else:
        yield Segment(12, "backwards" if source.stepping.h < 0 else "running")
    speed = speed_text(playhead.speed)
    yield Segment(7, speed)
    if (share := source.pace) < 0.99:
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
        yield Segment(9, f"next step in {about(int(max(source.next_step, 0.0)))}")


def _recording(source: Source) -> Iterator[Segment]:
    status = source.recording_status
    if status is None:
        if source.playhead.seen is not None:  # else it is yet to begin
            yield Segment(8, "not recorded", QUIET)
    elif status.failed:
        yield Segment(10, "NOT RECORDED", WARN)
    else:
        if source.kind == "LIVE":
            yield Segment(8, f"REC {about(int(status.seconds))}")
        yield Segment(1, printable(status.name), QUIET)


def speed_text(speed: float) -> str:
    """Return as "1×", "1/8×", "1024×", "-2×"."""
    sign = "-" if speed < 0 else ""
    size = abs(speed)
    return f"{sign}{factor(size)}×" if size >= 1 else f"{sign}1/{factor(1 / size)}×"


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


class InsightLine(Pane):
    """What to watch in the scene, and what to notice; trouble with the recording comes first."""

    def picture(self, source: Source, sample: Sample) -> Picture:
        width, height = self.room
        status = source.recording_status
        watch = source.scene.watch
        if status is not None and status.failed:
            text, ink = f"Not recording: {status.failed}", WARN
        else:
            text, ink = insight_text(source, self.shown.hidden), TEXT
        if height < 2 or not watch:
            return Picture([[(f" {line}", ink)] for line in fitted(text, width - 2, height)])
        rest = "" if text == watch else text
        lines = [(line, TEXT) for line in fitted(watch, width - 2, 1)]
        lines += [(line, ink) for line in fitted(rest, width - 2, 1)]
        return Picture([[(f" {line}", each)] for line, each in lines])


@lru_cache(maxsize=8)  # a sentence stays for many seconds
def fitted(text: str, width: int, height: int) -> list[str]:
    """Return the text on `height` lines; where it does not fit it ends in …."""
    return textwrap.wrap(text, max(width, 2), max_lines=max(height, 1), placeholder=" …")


FORWARD = {
    "watching": "enter to the moment",
    "asked": "1 2 answer  enter the truth",
    "answered": "enter go on",
}


class TourPanel(Badged):
    """The words of the tour, in place of the insight line; a click goes forward."""

    def __init__(self, tour: Tour) -> None:
        super().__init__()
        self.tour = tour

    def draw(self) -> None:
        """Show title and keys, then the sentences, the last of them in full."""
        if not self.drawable:
            return
        width, height = self.room
        title = f" {self.tour.title} "
        forward = "enter again" if self.tour.is_astray else FORWARD[self.tour.stage]
        keys = f"{forward}  esc leave  backspace back"
        while len(keys) > max(width - len(title) - 2, 0):
            keys = keys.rpartition("  ")[0]
        *others, last = [textwrap.wrap(each, max(width - 2, 2)) for each in self.tour.text]
        lines = [(line, EXACT) for sentence in others for line in sentence]
        lines += [(line, TEXT) for line in last]
        head = [(title, BADGE), ("  ", TEXT), (keys, EXACT)]
        below = [[(f" {line}", ink)] for line, ink in lines[-(height - 1) :]]
        self.show(Picture([head, *below]))

    def on_click(self) -> None:
        self.app.simulate_key("enter")


def key_text(binding: Binding) -> str:
    """Return a key as people read it."""
    return binding.key_display or binding.key.partition(",")[0]


class KeyLine(CellWidget):
    """The keys that are needed now, in an order of their hints; a click on a key presses it.

    The bindings of a focused pane come where `order` has "".
    """

    def __init__(self, order: Sequence[str]) -> None:
        super().__init__()
        self._order = order
        self._places: list[tuple[int, int, str]] = []  # first column, end, key

    def on_mount(self) -> None:
        self.screen.bindings_updated_signal.subscribe(self, lambda _: self.draw())

    def draw(self) -> None:
        if self.drawable and self.screen.is_current:
            self.show(Picture([self._row()]))

    def _needed(self) -> list[ActiveBinding]:
        """Return the bindings that are shown, one an action, in their order; the rest last."""
        by_action: dict[str, ActiveBinding] = {}
        for each in self.screen.active_bindings.values():
            if each.binding.show and each.enabled:
                by_action.setdefault(each.binding.action, each)

        def place(each: ActiveBinding) -> int:
            hint = each.binding.description if isinstance(each.node, (Screen, App)) else ""
            return self._order.index(hint) if hint in self._order else len(self._order)

        return sorted(by_action.values(), key=place)

    def _row(self) -> Row:
        """Return what fits; grouped keys share a hint."""
        row: list[tuple[str, int]] = []
        self._places = []
        column = 0
        grouped = groupby(self._needed(), key=lambda each: each.binding.group or each.binding)
        for _, members in grouped:
            keys = [each.binding for each in members]
            hint = f"{keys[0].description} "
            texts = [f" {key_text(key)}" for key in keys]
            texts[-1] += " "
            if column + sum(map(cell_len, texts)) + cell_len(hint) > self.room.width:
                continue
            for binding, text in zip(keys, texts, strict=True):
                self._places.append((column, column + cell_len(text), binding.key))
                column += cell_len(text)
            row += [("".join(texts), TEXT), (hint, QUIET)]
            column += cell_len(hint)
            self._places[-1] = (self._places[-1][0], column, keys[-1].key)
        return row

    def on_click(self, event: events.Click) -> None:
        for first, end, key in self._places:
            if first <= event.x < end:
                self.app.simulate_key(key)


class TooSmall(CellWidget):
    """Says the size there is and the size it takes, in place of everything; the keys still work."""

    def draw(self) -> None:
        columns, rows = self.room
        needed = "x".join(map(str, SMALLEST))
        text = (
            f"Terminal too small: {columns}x{rows}, need {needed}. Enlarge it, or press q to quit."
        )
        self.show(Picture.of_text(text, columns, rows, TEXT))
