"""SourceScreen: the views, keys, settings and undo that the lab and a replay share."""

import gc
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.reactive import var
from textual.widget import Widget

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import MAX_METHODS, Scene
from pendu_tui.recordings import library
from pendu_tui.tui.cli.errors import explained
from pendu_tui.tui.cli.scene_file import scene_text
from pendu_tui.tui.playback.common import State, doubled
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.lines import InsightLine, KeyLine, SizedScreen, StatusLine, TooSmall
from pendu_tui.tui.terminal.check import is_writing
from pendu_tui.tui.views import VIEWS, create, following
from pendu_tui.tui.views.view import Box, Pane, View, Zoomed
from pendu_tui.tui.words.events import event_lines, numbered
from pendu_tui.tui.words.plain_text import description

STALL = 1.0  # s; longer gaps between frames (Ctrl+Z, sleep, a dead line) are not simulated

_SPEED = Binding.Group("half, double speed")
_STEPS = Binding.Group("one step back, forward")
_EVENTS = Binding.Group("previous, next event")
_METHODS = Binding.Group("show or hide a method")
_VIEWS = Binding.Group("view: lab, phase, …")


class SourceScreen(SizedScreen[None]):
    BLANK = True  # covered by its children
    AUTO_FOCUS = ""  # keys belong to the screen until a pane is clicked
    HELP = "Click a key on the last line, an event, a row or a pane; the wheel zooms the chart."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("space", "pause", "Pause", tooltip="pause, go on"),
        Binding("less_than_sign", "speed(-1)", "half speed", False, "<", group=_SPEED),
        Binding("greater_than_sign", "speed(1)", "double speed", False, ">", group=_SPEED),
        Binding("comma", "step(-1)", "one step back", False, ",", group=_STEPS),
        Binding("full_stop", "step(1)", "one step forward", False, ".", group=_STEPS),
        Binding("left_square_bracket", "event(-1)", "previous event", False, "[", group=_EVENTS),
        Binding("right_square_bracket", "event(1)", "next event", False, "]", group=_EVENTS),
        *(
            Binding(f"{n}", f"show({n - 1})", f"show or hide method {n}", False, group=_METHODS)
            for n in range(1, MAX_METHODS + 1)
        ),
        Binding(f"{MAX_METHODS + 1}", f"show({MAX_METHODS})", "the exact motion", show=False),
        Binding("e", "quantity", "chart: next quantity", show=False),
        Binding("y", "axes", "chart: log, log time, …", show=False),
        Binding("w", "window", "chart: last 20 s, 60 s, …", show=False),
        Binding("o", "switch('overview')", "overview: all angles", show=False),
        Binding("z", "zoom(0.5)", "chart: zoom in", show=False),
        Binding("escape", "back", "chart: back from the zoom", False, "esc"),
        Binding("v", "view", "View", tooltip="next view"),
        *(
            Binding(f"f{n}", f"view({name!r})", f"view: {view.title}", False, f"F{n}", group=_VIEWS)
            for n, (name, view) in enumerate(VIEWS.items(), 2)
        ),
        Binding("E,shift+e", "events", "list all events", show=False),
        Binding("d", "describe", "describe it in words", show=False),
        Binding("s", "screenshot", "save a screenshot", show=False),
        Binding("u", "undo", "Undo", tooltip="undo the last change"),
        Binding("question_mark", "help", "Help", True, "?", tooltip="this help"),
        Binding(
            "ctrl+p", "app.command_palette", "Find", True, "ctrl+p", True, "find scenes, themes, …"
        ),
        Binding("ctrl+z", "app.suspend_process", "suspend to the shell", show=False),
        Binding("q", "app.quit", "Quit", tooltip="finish the recording, quit"),
    ]

    shown: var[Shown] = var(Shown())

    def __init__(
        self,
        source: Source,
        clock: Callable[[], float] = time.monotonic,
        prepare: Callable[[], None] = lambda: None,
        notices: Sequence[str] = (),
    ) -> None:
        """`prepare` is called after the first paint, as it may be slow; it may raise OSError."""
        super().__init__()
        self._prepare = prepare
        self._notices = notices
        self.source = source
        shown = Shown().through(source.scene)
        self.set_reactive(SourceScreen.shown, shown)
        self.clock = clock
        self.view = source.scene.shot.view
        self._view_in_front = create(self.view, source, shown)
        self._lines: list[Pane] = []
        self._frames = 0
        self._missed = 0.0  # s, how long the program was stopped
        self._is_late = False  # whether the next frame must show everything
        self._failure: str | None = None  # the one last shown
        self._paused_by_dialog = False
        self._undo: deque[State] = deque(maxlen=30)  # a state may hold a whole run

    @property
    def host(self) -> Any:
        """The PenduApp, untyped because it imports this module."""
        return self.app

    # What is on the screen

    def compose(self) -> ComposeResult:
        yield self.line(StatusLine())
        with Box(id="views"):
            yield self._view_in_front
        yield TooSmall()
        yield from self.more()
        yield self.line(InsightLine())
        yield KeyLine()

    def more(self) -> Iterable[Widget]:  # above the insight line
        return ()

    def line(self, line: Pane) -> Pane:
        """Register a line; it is refreshed five times a second."""
        self._lines.append(line)
        line.source = self.source
        line.sample = self.source.sample
        return line

    def watch_shown(self) -> None:
        if self.is_mounted:  # commands set it earlier
            self.show_now()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Keep visitors in a browser from this computer's files."""
        if self.app.is_web and action == "screenshot":
            return False
        return super().check_action(action, parameters)

    # Frames, from the clock to the panes

    def on_mount(self) -> None:
        self.frame_timer = self.set_interval(1 / self.host.fps, self.frame, pause=True)
        self.call_after_refresh(self.begin)

    def begin(self) -> None:
        try:
            self._prepare()
        except OSError as error:
            self.app.exit(error)
            return
        gc.collect()
        gc.freeze()  # never collect what exists now, which would cost frames
        gc.enable()
        self.frame_timer.resume()
        for notice in self._notices:
            self.notify(notice, timeout=15)

    def frame(self) -> None:
        """Follow the clock, and draw unless the terminal is behind."""
        now = self.clock() - self._missed
        seen = self.source.playhead.seen
        if seen is not None and (now - seen > STALL or self.shown.held is not None):
            self._missed += now - seen
            now = seen
        sample = self.source.tick(now)
        failure = self.source.failure
        if failure is not None and failure is not self._failure:
            self.warn(f"{failure} The run stands still; space tries again.")
        self._failure = failure
        if is_writing(self.app):
            return
        self._frames += 1
        # text, which people read, changes five times a second
        turn = self._frames % max(self.host.fps // 5, 1) == 0
        self._follow(sample, read=turn or self._is_late)
        self._is_late = False

    def warn(self, text: str) -> None:
        self.notify(text, severity="warning", timeout=15)

    def show_now(self) -> None:
        """Show everything, with the next frame if the terminal is behind."""
        self._is_late = is_writing(self.app)
        if not self._is_late:
            self._follow(self.source.sample)

    def _follow(self, sample: Sample, read: bool = True) -> None:
        self._view_in_front.follow(sample, self.shown, read)
        if read:
            for line in self._lines:
                line.follow(sample, self.shown)

    # Time

    def on_screen_suspend(self) -> None:
        if not self.source.playhead.paused:
            self._paused_by_dialog = True
            self._pause(True)

    def on_screen_resume(self) -> None:
        if self._paused_by_dialog:
            self._paused_by_dialog = False
            self._pause(False)

    def action_pause(self) -> None:
        self._pause(not self.source.playhead.paused)

    def _pause(self, paused: bool) -> None:
        self.frame()  # catch up first, or pausing would drop part of a frame
        self.source.pause(paused)
        self.show_now()

    def action_step(self, n: int) -> None:
        self.source.step(n)
        self.show_now()

    def action_event(self, direction: int) -> None:
        self.source.seek_event(direction)
        self.show_now()

    def action_go_to(self, run: int, step: int) -> None:
        if self.source.go_to(run, step):
            self.show_now()
        else:
            self.notify(f"That event belongs to run {run}; replay the recording to see it.")

    def action_speed(self, doublings: int) -> None:
        self.keep(self.state)
        self.source.set_speed(doubled(self.source.playhead.speed, doublings))
        self.show_now()

    # Settings

    def change_shown(self, shown: Shown) -> None:
        if shown != self.shown:
            self.keep(self.state)
            self.shown = shown

    def action_show(self, number: int) -> None:
        self.change_shown(self.shown.toggled(number, self.source.scene.cast))

    def action_switch(self, name: str) -> None:
        changes: dict[str, Any] = {name: not getattr(self.shown, name)}
        self.change_shown(self.shown._replace(**changes))

    def action_axes(self) -> None:
        self.change_shown(self.shown.next_axes())

    def action_show_alone(self, place: int) -> None:
        """Show one method of the cast alone, or all again if it already is alone."""
        cast = self.source.scene.cast
        self.change_shown(self.shown.alone(place, cast))
        if self.shown.places(cast) == [place]:
            label = cast[place].label
            self.notify(f"{label} alone. Click it again, or u, to see all.", timeout=4)

    def action_quantity(self) -> None:
        quantity = self.shown.quantity_ahead(1, self.source.scene)
        self.change_shown(self.shown._replace(quantity=quantity))

    def action_window(self) -> None:
        self.change_shown(self.shown.of(self.source.sample.run).next_window())

    def action_back(self) -> None:
        if self.shown.stretch:
            self.change_shown(self.shown.zoomed(None))

    def action_zoom(self, factor: float) -> None:
        self._view_in_front.zoom(factor)

    def on_zoomed(self, message: Zoomed) -> None:
        # not undone by u, or u would undo each turn of the wheel; w leads back
        self.shown = self.shown.zoomed(message.stretch)

    # Undo

    @property
    def state(self) -> State:
        source = self.source
        return State(source.stepping, source.playhead.speed, self.shown, source.run_state)

    def keep(self, state: State) -> None:
        self._undo.append(state)

    def restore(self, state: State) -> None:
        self.source.set_speed(state.speed)
        self.shown = state.shown

    def action_undo(self) -> None:
        if self._undo:
            self.restore(self._undo.pop())
            self.show_now()
            now = f"{self.source.scene.name}, h {self.source.stepping.h:.4g} s"
            self.notify(f"Undone: {now}, {self.source.playhead.speed:.4g}×", timeout=3)

    # Views and dialogs

    async def action_view(self, name: str = "") -> None:
        name = name or following(self.view)
        views = self.query_one("#views")
        if not views.query(f"#{name}"):
            await views.mount(create(name, self.source, self.shown))
        for each in views.children:
            each.display = each.id == name
        self.view = name
        self._view_in_front = self.query_one(f"#{name}", View)
        self._view_in_front.retry()
        self.refresh_bindings()
        self.show_now()

    def show_text(self, title: str, *paragraphs: str) -> None:
        from pendu_tui.tui.screens.dialogs import TextScreen

        self.app.push_screen(TextScreen(title, "\n".join(filter(None, paragraphs))))

    def action_help(self) -> None:
        from pendu_tui.tui.screens.dialogs import help_text

        panes = dict.fromkeys(type(pane) for pane in self._view_in_front.query(Pane))
        owners: list[type[Widget]] = [pane for pane in panes if pane.BINDING_GROUP_TITLE]
        if self.view == "lab":
            owners.insert(0, type(self))
        else:
            owners.append(type(self))
        self.show_text("Help", help_text(owners, self.source, self.app.size.width))

    def action_events(self) -> None:
        self.show_text("Events", *numbered(event_lines(self.source)))

    def action_describe(self) -> None:
        titles = [pane.border_title or "" for pane in self.query(Pane) if pane.is_on_screen]
        panes = [Content.from_markup(title).plain for title in titles]
        on_screen = "; ".join(filter(None, [VIEWS[self.view].title, *panes]))
        self.show_text("In words", *description(self.source), f"On screen: {on_screen}.")

    def action_screenshot(self) -> None:
        try:
            library.folder().mkdir(parents=True, exist_ok=True)
            picture = self.app.save_screenshot(path=str(library.folder()))
        except OSError as error:
            self.warn(f"Screenshot failed: {explained(error)}")
        else:
            self.notify(f"Saved {picture}")

    def action_save_scene(self) -> None:
        """Save what is on the screen as a scene file, which a lecture may begin with."""
        try:
            path = library.free_path(library.folder() / "scene.toml")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(scene_text(self._seen()), encoding="utf-8")
        except OSError as error:
            self.warn(f"Scene not saved: {explained(error)}")
        else:
            self.notify(f"Saved {path}; open it with: pendu-tui {path}", timeout=15)

    def _seen(self) -> Scene:
        """Return the scene with the current step, and a shot of what is shown."""
        scene = self.source.scene
        front = [scene.cast[place].key for place in self.shown.places(scene.cast)]
        shot = replace(
            scene.shot,
            view=self.view,
            theta=self.shown.theta,
            quantity=self.shown.quantity,
            log=self.shown.log,
            seconds=self.shown.seconds,
            line=self.shown.line,
            front=tuple(front) if self.shown.hidden else (),
            ring=self.shown.ring,
        )
        return replace(scene, h=self.source.stepping.smallest, shot=shot)
