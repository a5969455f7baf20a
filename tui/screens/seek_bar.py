"""SeekBar: the position in the replay, and its events."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from textual import events
from textual.message import Message

from engine.run.lockstep import Sample
from tui.drawing.palette import FRAME, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.playback.replay import Replay
from tui.playback.source import Source
from tui.views.view import Pane
from tui.words.numbers import seconds

MIN_WIDTH = 24  # columns for the bar


def bar(position: float, length: float, ticks: Sequence[float], width: int) -> Row:
    """Return the bar: heavy up to the position, and a tick for each event."""

    def column(clock: float) -> int:
        return min(int(clock / length * width), width - 1) if length > 0 else 0

    here = column(position)
    events = {column(clock) for clock in ticks}
    row: list[tuple[str, int]] = []
    for at in range(width):
        if at == here:
            row.append(("█", WARN))
        elif at < here:
            row.append(("┿" if at in events else "━", TEXT))
        else:
            row.append(("┼" if at in events else "─", FRAME))
    return row


def facts(replay: Replay, room: int) -> str:
    """Return position and length; loop, run, step and event as far as there is room.

    A number has the room of the largest, so that the bar beside it stays where it is.
    """
    runs = replay.recording.runs
    ticks = replay.ticks
    length = seconds(replay.length)
    text = f"{seconds(replay.playhead.position):>{max(len(length), len('59.99 s'))}} of {length}"
    parts = [
        f"run {_of(runs.index(replay.run) + 1, len(runs))}",
        f"step {_of(replay.sample.step, replay.run.steps)}",
        f"event {_of(bisect_right(ticks, replay.playhead.position), len(ticks))}",
    ]
    for part in (["loop"] if replay.looping else []) + parts:
        if len(text) + len(part) + 2 <= room:
            text += f"  {part}"
    return text


def _of(number: int, last: int) -> str:
    return f"{number:>{len(str(last))}}/{last}"


class SeekBar(Pane):
    """The bar; a click or a drag on it goes there."""

    @dataclass
    class Sought(Message):
        """The user wants to see this moment."""

        position: float  # s of the recording

    def __init__(self) -> None:
        super().__init__()
        self._columns = 1  # of the bar
        self._length = 0.0  # of the recording
        self._dragging = False

    def picture(self, source: Source, sample: Sample) -> Picture:
        assert isinstance(source, Replay)
        replay = source
        text = facts(replay, self.room.width - MIN_WIDTH - 3)
        self._length = replay.length
        self._columns = max(self.room.width - len(text) - 3, 1)
        row = bar(replay.playhead.position, replay.length, replay.ticks, self._columns)
        return Picture([[(" ", TEXT), *row, ("  " + text, TEXT)]])

    def on_mouse_down(self, event: events.MouseDown) -> None:
        self._dragging = True
        self.capture_mouse()
        self._seek(event)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._dragging:
            self._seek(event)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        self._dragging = False
        self.release_mouse()

    def _seek(self, event: events.MouseEvent) -> None:
        column = event.screen_x - self.content_region.x - 1  # clamped: a drag may leave the bar
        share = min(max((column + 0.5) / self._columns, 0.0), 1.0)
        self.post_message(self.Sought(share * self._length))
