"""LabScreen: the views, keys and lines around a source, which is a lab or a replay."""

import asyncio
import gc
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.reactive import var
from textual.screen import ModalScreen
from textual.widget import Widget

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.recordings import files
from pendu_tui.tui.cli.errors import explained
from pendu_tui.tui.cli.scene import scene_text
from pendu_tui.tui.playback.lesson import Lesson, LessonState, tour
from pendu_tui.tui.playback.live import Live, has_own
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import RunState, Source, doubled
from pendu_tui.tui.screens.dialogs import (
    CastForm,
    Finder,
    StartForm,
    TextScreen,
    entries,
    help_text,
)
from pendu_tui.tui.screens.keys import KEYS
from pendu_tui.tui.screens.lines import (
    InsightLine,
    KeyLine,
    LessonPanel,
    SeekBar,
    SizedScreen,
    StatusLine,
    TooSmall,
)
from pendu_tui.tui.terminal.driver import is_writing
from pendu_tui.tui.terminal.options import FPS
from pendu_tui.tui.views import VIEWS, create, following
from pendu_tui.tui.views.view import (
    Box,
    Held,
    Pane,
    SceneChosen,
    StepSizeChosen,
    View,
    Zoomed,
)
from pendu_tui.tui.words.numbers import seconds
from pendu_tui.tui.words.plain_text import description, event_lines, numbered

STALL = 1.0  # s; longer gaps between frames (Ctrl+Z, sleep, a dead line) are not simulated


class State(NamedTuple):
    """Everything that undo restores."""

    source: Source
    run: RunState
    shown: Shown
    lesson: LessonState


class LabScreen(SizedScreen[None]):
    """Shows a source.  In a replay a key that changes the run continues it live from there."""

    BLANK = True  # covered by its children
    AUTO_FOCUS = ""  # keys belong to the screen until a pane is clicked
    BINDING_GROUP_TITLE = "Lab"
    HELP = "Drag the pendulum to throw it. Click a key, an event, a row, a pane; the wheel zooms."
    BINDINGS: ClassVar[list[BindingType]] = KEYS

    shown: var[Shown] = var(Shown())
    is_replay: var[bool] = var(False, bindings=True, toggle_class="-replay")
    is_guided: var[bool] = var(False, toggle_class="-lesson")
    fps = FPS
    record: Callable[[Live], object] = staticmethod(lambda live: None)
    """Begins a lab's recording, after the first paint; may raise OSError or UserError."""
    guide: Lesson | None = None
    """The lesson that key T begins; None: the tour, which is read then."""

    def __init__(
        self,
        source: Source,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__()
        self.source = source
        self.sources = [source]
        self.set_reactive(LabScreen.shown, Shown().through(source.scene))
        self.clock = clock
        self.view = source.scene.shot.view
        self._view_in_front = create(self.view)
        self._lines: tuple[Pane, ...] = (StatusLine(), SeekBar(), LessonPanel(), InsightLine())
        self.scenes = Lesson("Scene", SCENES.values())
        self.scenes.index = self.scenes.index_of(source.scene.name)
        self._before_lesson: tuple[State, str, deque[State]]
        self._beat = 0  # sixtieths of a second
        self._undo: deque[State] = deque(maxlen=30)  # a state may hold a whole run
        self._changing = asyncio.Lock()

    # What is on the screen

    def compose(self) -> ComposeResult:
        status, *below = self._lines
        yield status
        with Box(id="views"):
            yield self._view_in_front
        yield TooSmall()
        yield from below
        yield KeyLine()

    def _enter(self, source: Source) -> None:
        """Show another source."""
        self.source = source
        self.is_replay = isinstance(source, Replay)

    def watch_shown(self) -> None:
        if self.is_mounted:  # commands set it earlier
            self.show_now()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Keep visitors in a browser from this computer's files."""
        match action:
            case "screenshot" | "save_scene":
                return not self.app.is_web
            case "turn":
                return self.is_guided
            case "live":
                return self.is_replay
            case "mark":
                return not self.is_replay
        return super().check_action(action, parameters)

    # Frames, from the clock to the panes

    def on_mount(self) -> None:
        self._enter(self.source)
        for pane in (*self._view_in_front.panes, *self._lines):
            if not pane.NEEDS_NUMPY:
                pane.follow(self.source, self.source.sample, self.shown)
        self.frame_timer = self.set_interval(1 / self.fps, self.frame, pause=True)
        self.call_after_refresh(self.begin)

    async def begin(self) -> None:
        self._follow(self.source.sample)  # also what needs NumPy
        if isinstance(self.source, Live):
            self.record(self.source)  # an error ends the lab
        gc.freeze()  # never collect what exists now, which would cost frames
        gc.enable()
        self.frame_timer.resume()
        if isinstance(self.source, Replay) and (reason := self.source.recording.reason):
            self.warn(f"This recording is incomplete ({reason}); showing what is intact.")
        if self.guide and self.source.scene == self.guide.page:
            await self.action_lesson()

    def frame(self) -> None:
        """Follow the clock, and draw unless the terminal is behind."""
        now = self.clock()
        playhead = self.source.playhead
        stands_still = self.shown.held is not None or self.app.screen is not self
        if playhead.seen is not None and (stands_still or now - playhead.seen > STALL):
            playhead.seen = now
        before = self.source.sample
        sample = self.source.tick(now)
        if isinstance(self.source, Live):
            self._pause_where_due(self.source, before)
        if is_writing(self.app):
            return
        passed = 60 // self.fps
        self._beat += passed
        if sample != before or self._beat % Pane.EVERY < passed:
            self._follow(sample, self._beat)

    def _pause_where_due(self, live: Live, before: Sample) -> None:
        """Pause at the moment of a page, and where reversed time is back at 0."""
        if self.lesson.follow(live, before):
            self.show_now()
        elif live.is_back and before.step < live.sample.step:
            live.pause(True)
            live.mark("Back at the start")
            self.show_now()

    def show_now(self) -> None:
        """Show everything; if the terminal is behind, each pane when it is its turn."""
        if not is_writing(self.app):
            self._follow(self.source.sample)

    def _follow(self, sample: Sample, beat: int = 0) -> None:
        """Show a sample in what is due at a beat, or everywhere."""
        if (theta := self.shown.held) is not None:
            held = [each._replace(theta=theta, omega=0.0) for each in sample.readings]
            sample = sample._replace(readings=tuple(held))
        for pane in (*self._view_in_front.panes, *self._lines):
            pane.follow(self.source, sample, self.shown, beat)

    def warn(self, text: str) -> None:
        self.notify(text, severity="warning", timeout=15)

    # Time

    def action_pause(self) -> None:
        self.frame()  # catch up first, or pausing would drop part of a frame
        self.source.pause(not self.source.playhead.paused)
        self.show_now()

    def action_step(self, n: int) -> None:
        self.source.step(n)
        self.show_now()

    def action_event(self, direction: int) -> None:
        self.source.seek_event(direction)
        self.show_now()

    def action_seek(self, seconds: float) -> None:
        self.source.seek(self.source.playhead.position + seconds)
        self.show_now()

    def action_part(self, share: float) -> None:
        self.action_seek(share * self.source.length)

    def action_go_to(self, run: int, step: int) -> None:
        if self.source.go_to(run, step):
            self.show_now()
        else:
            self.notify(f"That event belongs to run {run}; replay the recording to see it.")

    def action_speed(self, doublings: int) -> None:
        self._undo.append(self.state)
        self.source.set_speed(doubled(self.source.playhead.speed, doublings))
        self.show_now()

    def action_mark(self) -> None:
        assert isinstance(self.source, Live)
        self.source.mark()
        self.notify(f"Mark at {self.source.sample.t:.2f} s", timeout=4)
        self.show_now()

    # Changes of the run

    async def change(self, change: Callable[[Live], object]) -> bool:
        """Change the run and keep its state for undo, or notify why it cannot be changed.

        A replay continues live, and is recorded elsewhere; undo leads back to it.
        """
        async with self._changing:
            before = self.state
            try:
                live = await self._continued()
                change(live)
                if live is not self.source:
                    self.record(live)
            except Exception as error:  # `explained` raises a bug again
                self.warn(str(explained(error)))
                return False
            self._undo.append(before)
            if live is not self.source:
                self._go_live(live, before.source.sample.t)
        self.show_now()
        return True

    async def _continued(self) -> Live:
        """Return the lab, or one that has simulated a replay's run up to here."""
        source = self.source
        if isinstance(source, Live):
            return source
        assert isinstance(source, Replay)
        source.pause(True)
        if source.sample.step > 100_000:  # takes more than 0.25 s
            self.notify(f"Simulating {source.sample.step} steps ...", timeout=2)
        while not source.fill():
            await asyncio.sleep(0)
        if has_own(source.scene):
            return source.live()  # not in a thread, where it could not be interrupted
        return await asyncio.to_thread(source.live)

    def _go_live(self, live: Live, t: float) -> None:
        self.sources.append(live)
        self._enter(live)
        where = "not recorded"
        if live.recorder is not None:
            where = f"recorded as {live.recorder.path}"
        self.notify(f"Live from {seconds(t)} on, {where}; u returns to the replay.", timeout=8)

    async def start(self, scene: Scene) -> bool:
        """Begin a run; return whether that was possible."""
        if not await self.change(lambda live: live.start(scene)):
            return False
        self.shown = self.shown._replace(theta=scene.shot.theta, line=scene.shot.line)
        return True

    async def set_h(self, stepping: Stepping) -> None:
        if await self.change(lambda live: live.change(stepping)):
            self.shown = self.shown._replace(line=None)  # it belongs to the scene's own h

    def on_held(self, message: Held) -> None:
        self.shown = self.shown._replace(held=message.theta)

    async def on_scene_chosen(self, choice: SceneChosen) -> None:
        await self.start(choice.scene)

    async def on_step_size_chosen(self, choice: StepSizeChosen) -> None:
        await self.set_h(choice.stepping)

    async def action_live(self) -> None:
        await self.change(lambda live: None)

    async def action_restart(self) -> None:
        await self.change(Live.restart)

    async def action_next_h(self, direction: int) -> None:
        await self.set_h(self.source.stepping.next(up=direction > 0))

    async def action_reverse(self) -> None:
        """Reverse time in a lab; play a replay backwards."""
        if self.is_replay:
            self.source.set_speed(-self.source.playhead.speed)
            self.show_now()
        else:
            await self.set_h(self.source.stepping.reversed())

    async def action_equal_cost(self) -> None:
        await self.set_h(self.source.stepping.toggled())

    # Scenes and lessons

    @property
    def lesson(self) -> Lesson:
        """The pages that key p leads through: those of the guide, or all scenes."""
        if self.is_guided and self.guide:
            return self.guide
        return self.scenes

    async def action_next_scene(self) -> None:
        await self._turn_to((self.lesson.index + 1) % len(self.lesson.pages))

    async def action_start_scene(self, name: str) -> None:
        await self._turn_to(self.lesson.index_of(name))

    async def _turn_to(self, index: int) -> bool:
        """Begin a page; return whether that was possible."""
        if await self.change(lambda live: self.lesson.begin(live, index)):
            self._show_shot(self.lesson.page)
            return True
        return False

    def _show_shot(self, scene: Scene) -> None:
        self.shown = self.shown.through(scene, scene.shot)
        self.call_next(self.action_view, scene.shot.view)

    async def action_lesson(self) -> None:
        """Begin or resume the lesson, or leave it."""
        if self.is_guided:
            self._leave_lesson()
            return
        before = self.state
        self._before_lesson = (before, self.view, self._undo)
        self.guide = self.guide or tour()
        self.is_guided = True
        self.is_guided = await self._turn_to(self.guide.index)
        if self.is_guided:  # u does not leave it
            self._undo[-1] = before  # among all scenes
            self._undo = deque(maxlen=self._undo.maxlen)

    async def action_turn(self, way: str) -> None:
        """Go forward to the moment, the answer or the next page, or back."""
        lesson = self.lesson
        before = (lesson.index, self.source.sample.run)
        await self.change(getattr(lesson, way))
        if lesson.stage == "over":
            self._leave_lesson("That was the last page. T starts over.")
        elif (lesson.index, self.source.sample.run) != before:
            self._show_shot(lesson.page)

    def _leave_lesson(
        self, notice: str = "T resumes the lesson; u restores the run before it."
    ) -> None:
        before, view, self._undo = self._before_lesson
        self.is_guided = False
        own = self.shown  # of the run, which stays
        self.shown = before.shown._replace(line=own.line)
        if before.run.history.scene.cast != self.source.scene.cast:
            self.shown = self.shown._replace(hidden=own.hidden)
        self.source.set_speed(abs(before.run.speed))
        self.source.pause(False)
        self.call_next(self.action_view, view)
        self.notify(notice, timeout=6)

    def action_back(self) -> None:
        """Leave the lesson, else a view for the lab, else the zoom of the chart."""
        if self.is_guided:
            self._leave_lesson()
        elif self.view != "lab":
            self.call_next(self.action_view, "lab")
        elif self.shown.stretch:
            self.change_shown(self.shown.zoomed(None))

    def action_show(self, number: int) -> None:
        """Answer the lesson's question, or show or hide a method.

        In a lesson the keys of the answers hide no method.
        """
        if number >= len(self.lesson.shot.answers):
            self.change_shown(self.shown.toggled(number, self.source.scene.cast))
        elif self.lesson.stage == "asked":
            self.lesson.answer(number + 1)
            self.show_now()

    # Forms

    def _ask(self, form: ModalScreen[Any], use: Callable[[Any], object]) -> None:
        """Open a form over the lab, and use its answer unless it is cancelled.

        The answer comes by callback: a worker waiting for it would hang when the app ends.
        """

        def answered(answer: Any) -> None:
            if answer is not None:
                self.call_next(use, answer)

        self.app.push_screen(form, answered)

    def action_find(self, typed: str = "") -> None:
        found = entries(self.lesson.pages, self.active_bindings.values())
        self._ask(Finder(found, typed), self.run_action)

    def action_start_values(self) -> None:
        self._ask(StartForm(self._scene_now()), self.start)

    def action_methods(self) -> None:
        self._ask(CastForm(self._scene_now()), self.start)

    def _scene_now(self) -> Scene:
        return self.source.scene.altered(h=self.source.stepping.smallest)

    # Settings

    def change_shown(self, shown: Shown) -> None:
        self._undo.append(self.state)
        self.shown = shown

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
            text = f"Only {cast[place].label} is shown. Click it again, or press u, to see all."
            self.notify(text, timeout=4)

    def action_quantity(self) -> None:
        quantity = self.shown.quantity_ahead(1, self.source.scene)
        self.change_shown(self.shown._replace(quantity=quantity))

    def action_window(self) -> None:
        self.change_shown(self.shown.of(self.source.sample.run).next_window())

    def action_zoom(self, factor: float) -> None:
        self._view_in_front.zoom(factor)

    def on_zoomed(self, message: Zoomed) -> None:
        # not undone by u, or u would undo each turn of the wheel; w leads back
        self.shown = self.shown.zoomed(message.stretch)

    # Undo

    @property
    def state(self) -> State:
        return State(self.source, self.source.run_state, self.shown, self.lesson.state)

    def action_undo(self) -> None:
        if not self._undo:
            return
        state = self._undo.pop()
        notice = "Undone"
        if state.source is not self.source:
            self.source.close()
            self._enter(state.source)
            notice = "Back in the replay"
        self.source.return_to(state.run)
        self.lesson.state = state.lesson
        self.shown = state.shown
        self.show_now()
        self.notify(notice, timeout=3)

    # Views, texts and files

    async def action_view(self, name: str = "") -> None:
        name = name or following(self.view)
        views = self.query_one("#views")
        if not views.query(f"#{name}"):
            await views.mount(create(name))
        for each in views.children:
            each.display = each.id == name
        self.view = name
        self._view_in_front = self.query_one(f"#{name}", View)
        self._view_in_front.retry()
        self._follow(self.source.sample)

    def _show_text(self, title: str, lines: Iterable[str]) -> None:
        self.app.push_screen(TextScreen(title, "\n".join(lines)))

    def action_help(self) -> None:
        panes = [type(each) for each in self._view_in_front.query(Pane) if each.HELP]
        owners: list[type[Widget]] = [*dict.fromkeys(panes), type(self)]
        # the keys of the view in front come first
        owners.sort(key=lambda each: VIEWS[self.view] != each.BINDING_GROUP_TITLE)
        self._show_text("Help", [help_text(owners, self.source.scene, self.app.size.width)])

    def action_events(self) -> None:
        self._show_text("Events", numbered(event_lines(self.source)))

    def action_describe(self) -> None:
        self._show_text("In words", description(self.source, stands_still=True))

    def action_screenshot(self) -> None:
        self._save("Screenshot", lambda folder: self.app.save_screenshot(path=str(folder)))

    def action_save_scene(self) -> None:
        """Save what is on the screen as a scene file, which a lesson may begin with."""
        scene = self.source.scene
        stepping = self.source.stepping
        shot = self.shown.shot(scene, self.view, stepping.equal_cost)
        text = scene_text(replace(scene, h=stepping.smallest, shot=shot))

        def save(folder: Path) -> Path:
            path = files.free_path(folder / "scene.toml")
            path.write_text(text, encoding="utf-8")
            return path

        self._save("Scene", save)

    def _save(self, what: str, save: Callable[[Path], object]) -> None:
        """Save a file in the folder of recordings, and say where it is or why it is not."""
        try:
            folder = files.folder()
            folder.mkdir(parents=True, exist_ok=True)
            self.notify(f"Saved {save(folder)}", timeout=15)
        except OSError as error:
            self.warn(f"{what} not saved: {explained(error)}")
