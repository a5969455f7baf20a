"""ReplayScreen: a recording, with any moment a key or a click away."""

import asyncio
import time
from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widget import Widget

from engine.methods.own import OwnMethodError
from recordings.errors import RecordingError
from tui.cli.errors import UserError, explained
from tui.playback.live import Live, has_own
from tui.playback.replay import Replay
from tui.screens.base import SourceScreen
from tui.screens.seek_bar import SeekBar

LONG = 100_000  # steps; a quarter of a second
_SECONDS = Binding.Group("back, forward 1 s")
_ENDS = Binding.Group("to the start, to the end")
_TENTHS = Binding.Group("back, forward 10 %")


class ReplayScreen(SourceScreen):
    """Shows a replay.  `go_live` makes the screen of a lab that continues from its moment."""

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
        Binding("plus,equals_sign,minus,p,P,shift+p,i,M,shift+m,r,n,T,shift+t", "change"),
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

    def on_seek_bar_sought(self, message: SeekBar.Sought) -> None:
        self.seek(message.position)

    def action_change(self) -> None:
        """Answer a key of the lab."""
        self.notify(
            "A recording cannot be changed: f continues it live, and then it can.", timeout=4
        )

    def seek(self, position: float) -> None:
        self.replay.seek(position)
        self.show_now()

    def action_seek(self, seconds: float) -> None:
        self.seek(self.replay.playhead.position + seconds)

    def action_part(self, share: float) -> None:
        """Go forward by a share of the whole, or back."""
        self.seek(self.replay.playhead.position + share * self.replay.length)

    def action_reverse(self) -> None:
        self.replay.set_speed(-self.replay.playhead.speed)
        self.show_now()

    async def action_live(self) -> None:
        """Continue live from here, once the run so far is known and simulated again up to here."""
        self.replay.pause(True)
        if not self.replay.fill():
            self.notify("Loading earlier samples ...", timeout=2)
        while not self.replay.fill():
            await asyncio.sleep(0)
        if self.replay.sample.step > LONG:
            self.notify(f"Simulating {self.replay.sample.step} steps ...", timeout=2)
        try:
            if has_own(self.replay.scene):
                live = self.replay.live()  # it can be interrupted here, but not in a thread
            else:
                live = await asyncio.to_thread(self.replay.live)
        except (RecordingError, OwnMethodError) as error:
            self.notify(str(error), severity="warning", markup=False)
            return
        try:
            lab = self._go_live(live)
        except (OSError, UserError) as error:
            self.notify(
                f"Cannot start recording: {explained(error)}", severity="warning", markup=False
            )
            return
        self.end()
        self.app.push_screen(lab)
