"""SourceScreen: what the lab's screen and the replay's share: the clock of the frames, the views, the settings."""

import gc
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, cast

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.events import Resize
from textual.message import Message
from textual.reactive import Initialize, var
from textual.screen import Screen
from textual.timer import Timer
from textual.widget import Widget

from engine.run.lockstep import Sample
from tui.playback.playhead import doubled
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.screens.host import Host
from tui.screens.insight_line import InsightLine
from tui.screens.key_line import KeyLine
from tui.screens.keys import COMMON, hinted
from tui.screens.status_line import StatusLine
from tui.screens.too_small import TooSmall
from tui.terminal.writer import is_writing
from tui.views import create, following
from tui.views.keys import Key, bindings
from tui.views.messages import Asked, MethodChosen, Zoomed
from tui.views.view import Box, Pane, View
from tui.words.undone import State, undone

READ_RATE = 5  # updates a second of what people read
STALL = 1.0  # s; a longer gap between frames does not count as time: Ctrl+Z, a computer asleep, a dead line
UNDOS = 30  # changes; each may hold a run
ALREADY = "Already marked"


class SourceScreen(Screen[None]):
    """Shows a source, following a clock that is passed in."""

    BLANK = True  # everything on it is covered

    @dataclass
    class Began(Message):
        """This screen follows the clock now."""

        screen: "SourceScreen"

    BINDINGS: ClassVar[list[BindingType]] = bindings(*COMMON)
    AUTO_FOCUS = ""  # keys belong to the screen until a pane is clicked
    KEYS: ClassVar[tuple[Key, ...]] = COMMON

    source: var[Source] = var(Initialize(lambda screen: cast(Source, cast(Any, screen).first_source)))
    shown: var[Shown] = var(Shown())
    view: var[str] = var("lab")

    def __init__(
        self,
        source: Source,
        clock: Callable[[], float] = time.monotonic,
        prepare: Callable[[], None] = lambda: None,
        notices: Sequence[str] = (),
    ) -> None:
        """`prepare` is called after the first paint, since it may take time; it may raise OSError."""
        super().__init__()
        self._prepare = prepare
        self._notices = notices
        self.first_source = source
        self.clock = clock
        self._on_stage: View = create(self.view)
        self._timer: Timer | None = None  # of the frames
        self._frames = 0
        self._missed = 0.0  # s of the clock while the program was stopped
        self._is_late = False  # the next frame shows everything
        self._undo: deque[Callable[[], object]] = deque(maxlen=UNDOS)
        self._lines: list[Pane] = []

    @property
    def host(self) -> Host:
        return cast(Host, self.app)

    def compose(self) -> ComposeResult:
        yield self.line(StatusLine())
        with Box(id="views"):
            yield self._bound(self._on_stage)
        yield TooSmall()
        yield from self.more()
        yield self.line(InsightLine())
        yield KeyLine(hinted(self.KEYS))

    def line(self, line: Pane) -> Pane:
        """Let a line of this screen follow the samples, as often as people can read it."""
        self._lines.append(line)
        line.sample = self.source.sample
        return line.data_bind(SourceScreen.source, SourceScreen.shown)

    def more(self) -> Iterable[Widget]:
        """The widgets above the insight line."""
        return ()

    def on_resize(self, event: Resize) -> None:
        """Leave out a size that the terminal no longer has: two could call each other up for ever."""
        if event.size != self.app.size:
            event.prevent_default()

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        try:
            self._prepare()
        except OSError as error:
            self.app.exit(error)
            return
        gc.collect()
        gc.freeze()  # what exists now stays: collecting it again and again would cost frames
        gc.enable()
        self.post_message(self.Began(self))
        self._timer = self.set_interval(1 / self.host.fps, self.frame)
        for notice in self._notices:
            self.notify(notice, timeout=15, markup=False)

    def end(self) -> None:
        """Stop following the clock: another screen takes over."""
        if self._timer is not None:
            self._timer.stop()
        self.source.close()

    def frame(self) -> None:
        """Follow the clock, and show where it has led unless the terminal is behind."""
        now, seen = self.clock() - self._missed, self.source.playhead.seen
        if seen is not None and now - seen > STALL:
            self._missed += now - seen
            now = seen
        sample = self.source.tick(now)
        if is_writing(self.app):
            return
        self._frames += 1
        turn = self._frames % max(self.host.fps // READ_RATE, 1) == 0
        self._follow(sample, read=turn or self._is_late)
        self._is_late = False

    def _follow(self, sample: Sample, read: bool = True) -> None:
        self._on_stage.follow(sample, read)
        if read:
            for line in self._lines:
                line.follow(sample)

    def show_now(self) -> None:
        """Show everything now, or with the next frame if the terminal is behind."""
        self._is_late = is_writing(self.app)
        if not self._is_late:
            self._follow(self.source.sample)

    def remember(self, undo: Callable[[], object]) -> None:
        """Keep the function that undoes a change."""
        self._undo.append(undo)

    def change_shown(self, shown: Shown) -> None:
        if (before := self.shown) != shown:
            self.remember(lambda: setattr(self, "shown", before))
            self.shown = shown

    def on_asked(self, message: Asked) -> None:
        self.call_next(self.run_action, message.action)

    def action_pause(self) -> None:
        self.frame()  # the clock goes on from here, not from the last frame
        self.source.pause(not self.source.playhead.paused)
        self.show_now()

    def action_step(self, n: int) -> None:
        """Pause and go n steps forward, or back if n is negative."""
        self.source.step(n)
        self.show_now()

    def action_event(self, direction: int) -> None:
        self.source.seek_event(direction)
        self.show_now()

    def action_speed(self, doublings: int) -> None:
        self.action_set_speed(doubled(self.source.playhead.speed, doublings))

    def action_set_speed(self, speed: float) -> None:
        """Set the speed; `u` undoes it."""
        before = self.source.playhead.speed
        if speed != before:
            self.remember(lambda: self.source.set_speed(before))
            self.source.set_speed(speed)
            self.show_now()

    def action_show(self, number: int) -> None:
        self.change_shown(self.shown.toggled(number, self.source.scene.cast))

    def action_switch(self, name: str) -> None:
        self.change_shown(self.shown.switched(name))

    def action_alone(self) -> None:
        self.change_shown(self.shown.next_alone(self.source.scene.cast))

    def on_method_chosen(self, message: MethodChosen) -> None:
        self.change_shown(self.shown.alone(message.place, self.source.scene.cast))

    def action_quantity(self) -> None:
        self.change_shown(self.shown.next_quantity(self.source.scene))

    def action_window(self, direction: int) -> None:
        self.change_shown(self.shown.of(self.source.sample.run).next_window(direction))

    def on_zoomed(self, message: Zoomed) -> None:
        self.shown = self.shown.zoomed(message.stretch)  # `w` leads back; undoing every turn of the wheel would be long

    def action_undo(self) -> None:
        if self._undo:
            before = State.of(self.source, self.shown)
            self._undo.pop()()
            self.show_now()
            self.notify(undone(before, State.of(self.source, self.shown)), timeout=3, markup=False)

    def action_view(self, name: str = "") -> None:
        """Show a view, or the next one."""
        self.call_next(self._show_view, name or following(self.view))  # data_bind works in the screen's own turn only

    async def _show_view(self, name: str) -> None:
        views = self.query_one("#views")
        if not views.query(f"#{name}"):
            await views.mount(self._bound(create(name)))
        for each in views.children:
            each.display = each.id == name
        self.view, view = name, self.query_one(f"#{name}", View)
        self._on_stage = view
        self.query_one(KeyLine).keys = hinted(self.KEYS, name, view.KEYS)
        self.call_after_refresh(view.wake)
        self.show_now()

    def action_help(self) -> None:
        """Show the help, with the keys of a focused pane first."""
        from tui.screens.dialogs.text import TextScreen, help_text

        panes = self.query_one(f"#{self.view}", View).KEYS
        keys = (*panes, *self.KEYS) if self.focused is not None else (*self.KEYS, *panes)
        self.app.push_screen(TextScreen("Help", help_text(keys, self.source)))

    def action_quit(self) -> None:
        self.app.exit()

    def _bound(self, view: View) -> View:
        view.follow(self.source.sample, read=False)
        return view.data_bind(SourceScreen.source, SourceScreen.shown)
