"""The lines around a view: status, seek bar, lesson, insight, keys, "Terminal too small"."""

import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

from rich.cells import cell_len
from rich.style import Style
from textual import events
from textual.binding import Binding
from textual.screen import Screen, ScreenResultType
from textual.widget import Widget

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.drawing.picture import EXACT, FRAME, QUIET, TEXT, WARN, Ink, Picture, Row
from pendu_tui.tui.playback.lesson import ASTRAY
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.keys import ALWAYS
from pendu_tui.tui.terminal.options import SMALLEST
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.insight import insight, painted, watched
from pendu_tui.tui.words.numbers import about, factor, seconds, start, two_digits

BADGE = Style(bold=True)
"""LIVE, REPLAY and a lesson's titles."""


class SizedScreen(Screen[ScreenResultType]):
    """A screen that ignores outdated sizes.

    Two resize events could cause each other for ever.
    """

    def on_resize(self, event: events.Resize) -> None:
        if event.size != self.app.size:
            event.prevent_default()


class Segment(NamedTuple):
    """A part of the status line; where there is no room, the highest priority is kept."""

    priority: int
    text: str
    ink: int = TEXT


class StatusLine(Pane):
    def picture(self, source: Source, sample: Sample) -> Picture:
        stands_still = self.app.screen is not self.screen  # below a dialog
        return Picture([status_row(source, self.shown, self.room.width, stands_still)])


def status_row(source: Source, shown: Shown, width: int, stands_still: bool = False) -> Row:
    badge = f" {source.kind}"
    scene = source.scene
    parts = [
        *_time(source, shown, stands_still),
        *_stepping(source, shown),
        Segment(6 if scene.watch else 3, f"scene {scene.name}", QUIET),
        Segment(5, start(scene.theta, scene.omega)),
        *_recording(source),
    ]
    room = width - len(badge)
    kept = []
    for part in sorted(parts, reverse=True):
        needed = 2 + cell_len(part.text)
        if needed <= room:
            kept.append(part)
            room -= needed
    row: list[tuple[str, Ink]] = [(badge, BADGE)]
    for part in parts:
        if part in kept:
            row += [("  ", TEXT), (part.text, part.ink)]
    return row


def _time(source: Source, shown: Shown, stands_still: bool) -> Iterator[Segment]:
    playhead = source.playhead
    if source.failure:
        yield Segment(12, "stopped", WARN)
    elif shown.held is not None:
        yield Segment(12, "held   ")
    elif playhead.paused or stands_still:
        yield Segment(12, "paused ")
    elif source.stepping.h < 0:
        yield Segment(12, "backwards")
    else:
        yield Segment(12, "running")
    speed = f"{factor(playhead.speed)}×"
    yield Segment(7, speed)
    if 0.01 <= source.pace < 0.99:
        yield Segment(10, f"only {two_digits(100 * source.pace)} % of {speed}", QUIET)
    yield Segment(11, f"t {seconds(source.sample.t)}")


def _stepping(source: Source, shown: Shown) -> Iterator[Segment]:
    stepping = source.stepping
    fastest = source.scene.equations.fastest
    yield Segment(11, f"{stepping.symbol} {stepping.h:.4g} s")
    yield Segment(10, f"{'max ' * stepping.equal_cost}z {abs(stepping.h) * fastest:.3g}")
    if stepping.equal_cost:
        yield Segment(8, "equal cost")
    cast = source.scene.cast
    zs = {cast[place]: abs(stepping.own[place]) * fastest for place in shown.places(cast)}
    if warning := limit_warning(zs):
        yield Segment(9, warning)


def _recording(source: Source) -> Iterator[Segment]:
    status = source.recording_status
    if status is None:
        if source.playhead.seen is not None:  # else it has not begun yet
            yield Segment(8, "not recorded", QUIET)
    elif status.failed:
        yield Segment(10, "NOT RECORDED", WARN)
    else:
        if source.kind == "LIVE":
            yield Segment(8, f"REC {about(int(status.seconds))}")
        yield Segment(1, status.name, QUIET)


def limit_warning(zs: Mapping[Method, float]) -> str:
    """Return "unstable: e, s v (z > 2), r (z > 2.83)", or "" below all limits.

    Explicit Euler, which is never stable, is named only beside others.
    """
    letters: dict[float, list[str]] = {}
    for method, z in zs.items():
        if method.linear_limit is not None and method.linear_limit < z:
            letters.setdefault(method.linear_limit, []).append(method.letter)
    beyond = [f"{' '.join(each)} (z > {limit:.3g})" for limit, each in letters.items() if limit]
    if not beyond:
        return ""
    return f"unstable: {', '.join([*letters.get(0.0, ()), *beyond])}"


class InsightLine(Pane):
    """What to watch in the scene and what to notice, or why there is no recording."""

    EVERY = 30

    def picture(self, source: Source, sample: Sample) -> Picture:
        width, height = self.room
        status = source.recording_status
        watch = watched(source, self.shown.hidden)
        text = insight(source, self.shown.hidden).text
        if self.shown.held is not None:
            text = "Let go or throw: all methods start from your hand."
        ink = TEXT
        if source.failure:
            text = f"{without_folder(source.failure)} The run has stopped; space tries again."
            ink = WARN
        elif status is not None and status.failed:
            text = f"Not recording: {without_folder(status.failed)}"
            ink = WARN
        rows = []
        if watch != text and height > 1:
            rows = text_rows(watch, TEXT, self.cast, width, 1)
            height -= len(rows)
        return Picture([*rows, *text_rows(text, ink, self.cast, width, height)])


def without_folder(failure: str) -> str:
    """Return a sentence that begins with a path without its folder: the reason must fit."""
    return re.sub(r"^(\w:)?[^:=`]*[/\\]", "", failure)


def text_rows(text: str, ink: int, cast: Cast, width: int, height: int | None = None) -> list[Row]:
    """Return the text on rows, at most `height`, the last one cut off with an ellipsis.

    No row ends within the name of a method, or between an answer and its number.
    """
    whole = "|".join([r"\d: ", *(method.label for method in cast)])
    glued = re.sub(whole, lambda found: found[0].replace(" ", "\xa0"), text)
    lines = textwrap.wrap(glued, width - 1, max_lines=height, placeholder=" …")
    return [[(" ", ink), *painted(line.replace("\xa0", " "), cast, ink)] for line in lines]


class LessonPanel(Pane):
    """The lesson's text, in place of the insight line; a click goes forward."""

    def picture(self, source: Source, sample: Sample) -> Picture:
        """Return title and keys, then the sentences; where room is short, the last ones."""
        width, height = self.room
        screen: Any = self.screen
        lesson = screen.lesson
        text = lesson.text
        forward = "enter continue"
        if lesson.is_astray(source):
            text = (ASTRAY,)
            forward = "enter restart"
        elif lesson.stage == "asked":
            numbers = range(1, len(lesson.shot.answers) + 1)
            forward = f"{' '.join(map(str, numbers))} answer  enter show answer"
        elif lesson.stage == "watching" and lesson.shot.moment is not None:
            forward = "enter skip ahead"
        elif lesson.index + 1 == len(lesson.pages):
            forward = "enter end"
        title = f" {lesson.title}"
        keys = f"{forward}  esc leave  backspace back"
        while len(keys) > max(width - len(title) - 2, 0):
            keys = keys.rpartition("  ")[0]
        *others, last = text
        rows = [row for each in others for row in text_rows(each, EXACT, self.cast, width)]
        rows += text_rows(last, TEXT, self.cast, width)
        return Picture([[(title, BADGE), ("  ", TEXT), (keys, EXACT)], *rows[-(height - 1) :]])

    def on_click(self) -> None:
        self.app.simulate_key("enter")


class SeekBar(Pane):
    """Shows position and events; a click or a drag seeks."""

    _columns = 1  # of the bar

    def picture(self, source: Source, sample: Sample) -> Picture:
        text = facts(source, self.room.width - 28)  # leaves 24 columns for the bar
        self._columns = self.room.width - len(text) - 4
        row = bar(source.playhead.position, source.length, source.ticks, self._columns)
        return Picture([[(" ", TEXT), *row, (f"  {text} ", TEXT)]])

    async def on_mouse_down(self, event: events.MouseDown) -> None:
        self.capture_mouse()
        await self._seek(event)

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        if self.app.mouse_captured is self:
            await self._seek(event)

    def on_mouse_up(self) -> None:
        self.release_mouse()

    async def _seek(self, event: events.MouseEvent) -> None:
        column = event.screen_x - 1  # a drag may leave the bar
        position = (column + 0.5) / self._columns * self.source.length
        await self.run_action(f"screen.seek({position - self.source.playhead.position})")


def bar(position: float, length: float, ticks: Sequence[float], width: int) -> Row:
    """Return the bar: heavy up to the position, and a tick for each event."""

    def column(clock: float) -> int:
        return min(int(clock / (length or 1.0) * width), width - 1)

    here = column(position)
    played = ["━"] * here
    ahead = ["─"] * (width - here - 1)
    for at in map(column, ticks):
        if at < here:
            played[at] = "┿"
        elif at > here:
            ahead[at - here - 1] = "┼"
    return [("".join(played), TEXT), ("█", TEXT), ("".join(ahead), FRAME)]


def facts(source: Source, room: int) -> str:
    """Return position and length, and what fits of loop, run and step.

    Numbers are as wide as the largest, so that the bar stays in place.
    """
    position = source.playhead.position
    length = seconds(source.length)
    text = f"{seconds(position):>{max(len(length), len('59.99 s'))}} of {length}"
    counts = source.counts
    parts = [f"{name} {at:>{len(str(last))}}/{last}" for name, (at, last) in counts.items()]
    if source.looping:
        parts.insert(0, "loop")
    for part in parts:
        if len(text) + len(part) + 2 <= room:
            text += f"  {part}"
    return text


def key_text(binding: Binding) -> str:
    return binding.key_display or binding.key.partition(",")[0]


class KeyLine(CellWidget):
    """The keys that can be used now; a click presses one."""

    _keys: Sequence[str] = ()
    """For each column, the key that a click presses."""

    def on_mount(self) -> None:
        self.screen.bindings_updated_signal.subscribe(self, lambda _: self.draw())

    def draw(self) -> None:
        if self.screen.is_current:
            self.show(Picture([self._row()]))

    def _needed(self) -> list[Binding]:
        own: dict[str, Binding] = {}
        panes: dict[str, Binding] = {}
        for node, binding, *_ in self.screen.active_bindings.values():
            if binding.show:
                bindings = own if node is self.screen else panes
                bindings[binding.action] = binding
        listed = [*own.values()]
        return [*listed[:ALWAYS], *panes.values(), *listed[ALWAYS:]]

    def _row(self) -> Row:
        """Return what fits; grouped keys share a hint."""
        row: list[tuple[str, int]] = []
        columns: list[str] = []
        for _, members in groupby(self._needed(), key=lambda each: each.group or each):
            bindings = [*members]
            keys = [f" {key_text(each)}".replace("ctrl+", "^") for each in bindings]
            text = "".join(keys)
            hint = f"{bindings[0].description} "
            if len(columns) + len(text) + len(hint) > self.room.width:  # but for the last blank
                continue
            row += [(f"{text} ", TEXT), (hint, QUIET)]
            for each, key in zip(bindings, keys, strict=True):
                columns += [each.key] * len(key)
            columns += [bindings[-1].key] * (1 + len(hint))
        self._keys = columns
        return row

    def on_click(self, event: events.Click) -> None:
        if event.x < len(self._keys):
            self.app.simulate_key(self._keys[event.x])


class TooSmall(Widget):
    """Replaces everything on a small terminal; the keys still work."""

    def render(self) -> str:
        size = "{}x{}".format(*self.app.size)
        needed = "{}x{}".format(*SMALLEST)
        return f"Terminal too small: {size}, need {needed}. Enlarge it, or press q to quit."
