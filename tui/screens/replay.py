"""ReplayScreen: plays a recording; any moment is a key or a click away."""

import asyncio
import time
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.widget import Widget

from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.recordings.errors import RecordingError
from pendu_tui.tui.cli.errors import UserError, explained
from pendu_tui.tui.drawing.palette import FRAME, TEXT, WARN
from pendu_tui.tui.drawing.picture import Picture, Row
from pendu_tui.tui.playback.live import Live, has_own
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.base import SourceScreen
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.numbers import seconds

_SECONDS = Binding.Group("back, forward 1 s")
_ENDS = Binding.Group("to the start, to the end")
_TENTHS = Binding.Group("back, forward 10 %")


class SeekBar(Pane):
    """Shows position and events; a click or a drag seeks."""

    _columns = 1  # of the bar

    def picture(self, source: Source, sample: Sample) -> Picture:
        assert isinstance(source, Replay)
        text = facts(source, self.room.width - 27)  # leaves 24 columns for the bar
        self._columns = max(self.room.width - len(text) - 3, 1)
        row = bar(source.playhead.position, source.length, source.ticks, self._columns)
        return Picture([[(" ", TEXT), *row, (f"  {text}", TEXT)]])

    async def on_mouse_down(self, event: events.MouseDown) -> None:
        self.capture_mouse()
        await self._seek(event)

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        if self.app.mouse_captured is self:
            await self._seek(event)

    def on_mouse_up(self) -> None:
        self.release_mouse()

    async def _seek(self, event: events.MouseEvent) -> None:
        assert isinstance(self.source, Replay)
        column = event.screen_x - self.content_region.x - 1  # a drag may leave the bar
        share = min(max((column + 0.5) / self._columns, 0.0), 1.0)
        position = share * self.source.length
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
    return [("".join(played), TEXT), ("█", WARN), ("".join(ahead), FRAME)]


def facts(replay: Replay, room: int) -> str:
    """Return position and length, and what fits of loop, run, step and event.

    Numbers are as wide as the largest, so that the bar stays in place.
    """
    position = replay.playhead.position
    runs = replay.recording.runs
    length = seconds(replay.length)
    text = f"{seconds(position):>{max(len(length), len('59.99 s'))}} of {length}"
    numbers = {
        "run": (runs.index(replay.run) + 1, len(runs)),
        "step": (replay.sample.step, replay.run.steps),
        "event": (bisect_right(replay.ticks, position), len(replay.ticks)),
    }
    parts = [f"{name} {at:>{len(str(last))}}/{last}" for name, (at, last) in numbers.items()]
    if replay.looping:
        parts.insert(0, "loop")
    for part in parts:
        if len(text) + len(part) + 2 <= room:
            text += f"  {part}"
    return text


class ReplayScreen(SourceScreen):
    """Shows a replay.  `go_live` makes the screen of a lab that continues it."""

    BINDING_GROUP_TITLE = "Replay"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "seek(-1)", "-1 s", True, "left", tooltip="back 1 s", group=_SECONDS),
        Binding("right", "seek(1)", "+1 s", True, "right", tooltip="forward 1 s", group=_SECONDS),
        Binding("home", "part(-1)", "go to the start", False, group=_ENDS),
        Binding("end", "part(1)", "go to the end", False, group=_ENDS),
        Binding("pageup", "part(-0.1)", "back 10 %", False, "pgup", group=_TENTHS),
        Binding("pagedown", "part(0.1)", "forward 10 %", False, "pgdn", group=_TENTHS),
        Binding("b", "reverse", "Back", tooltip="play back in time"),
        Binding("f", "live", "Live", tooltip="continue live from here"),
        Binding("plus,equals_sign,minus,p,P,shift+p,i,m,M,shift+m,r,n,T,shift+t", "change"),
    ]

    def __init__(
        self,
        source: Replay,
        go_live: Callable[[Live], SourceScreen],
        clock: Callable[[], float] = time.monotonic,
        notices: Sequence[str] = (),
    ) -> None:
        super().__init__(source, clock, notices=notices)
        self._go_live = go_live

    @property
    def replay(self) -> Replay:
        assert isinstance(self.source, Replay)
        return self.source

    def more(self) -> Iterator[Widget]:
        yield self.line(SeekBar())

    def action_change(self) -> None:
        self.notify("A recording cannot be changed: f continues it live, and then it can.")

    def action_seek(self, seconds: float) -> None:
        self.replay.seek(self.replay.playhead.position + seconds)
        self.show_now()

    def action_part(self, share: float) -> None:
        self.action_seek(share * self.replay.length)

    def action_reverse(self) -> None:
        self.replay.set_speed(-self.replay.playhead.speed)
        self.show_now()

    async def action_live(self) -> None:
        """Continue live from here, after simulating the run again up to here."""
        replay = self.replay
        replay.pause(True)
        if not replay.fill():
            self.notify("Loading earlier samples ...", timeout=2)
        while not replay.fill():
            await asyncio.sleep(0)
        if replay.sample.step > 100_000:  # takes more than 0.25 s
            self.notify(f"Simulating {replay.sample.step} steps ...", timeout=2)
        try:
            if has_own(replay.scene):
                live = replay.live()  # not in a thread, where it could not be interrupted
            else:
                live = await asyncio.to_thread(replay.live)
            lab = self._go_live(live)
        except (RecordingError, OwnMethodError) as error:
            self.warn(str(error))
        except (OSError, UserError) as error:
            self.warn(f"Cannot start recording: {explained(error)}")
        else:
            self.frame_timer.stop()
            replay.close()
            self.host.source_screens.append(lab)
            self.app.push_screen(lab)
