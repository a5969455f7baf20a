"""Live: a run that follows the clock and is recorded."""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.own import OwnMethod, OwnMethodError
from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.loops import Loops, TieredLoops, compiled
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import Event, EventKind, noticed, simulate
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.watchdog import limited
from pendu_tui.tui.playback.history import History
from pendu_tui.tui.playback.source import Playhead, RecordingStatus, RunState, Source

if TYPE_CHECKING:  # the first paint does not need it
    from pendu_tui.recordings.recorder import LiveRecorder

FRAME_BUDGET = 0.020  # s of each frame (33 ms) for simulation; the rest is for drawing
CHUNK = 256  # steps between clock readings, about a millisecond
ALTERED = " (altered)"  # after the name of a scene whose start or step was changed
ROW_RATE = 30  # rows of the history and samples of the recording per second
_COMPILER = ThreadPoolExecutor(max_workers=1)  # begins its thread when there is work


class Live(Source):
    kind = "LIVE"
    _run: RewindableRun

    def __init__(
        self,
        scene: Scene,
        speed: float = 1.0,
        clock: Callable[[], float] = time.perf_counter,
        history: History | None = None,
    ) -> None:
        """Begin a run, or continue the one in a history, which the lab then owns."""
        self.playhead = Playhead(speed=speed)
        self.recorder: LiveRecorder | None = None
        self._events: list[Event] = []
        self._recorded = 0.0  # s, the recording clock, which stops while the lab is paused
        self._clock = clock
        self._runs = 1
        run = RewindableRun(scene, 1, compiled_in_background)
        if history is not None:
            with _limited(scene):
                run.repeat(history.changes[1:], history.step)
            history.changes = run.changes
        self._enter(run, history or History(scene, run.changes))

    @property
    def events(self) -> Sequence[Event]:
        run = self._run
        return [event for event in self._events if event.run != run.run or event.step <= run.step]

    @property
    def recording_status(self) -> RecordingStatus | None:
        recorder = self.recorder
        if recorder is None:
            return None
        name = printable(recorder.path.name)
        return RecordingStatus(name, recorder.seconds, recorder.failed)

    # Time

    def tick(self, now: float) -> Sample:
        """Follow the clock as far as the frame's budget allows, and drop the rest of the time."""
        before = self.playhead.position
        played = self.playhead.follow(now)
        if not played:
            return self.sample
        self._recorded += played
        began = self._clock()
        # stop at t = 0 exactly, to show how far each method is from its start
        target = int(min(self._run.step_at(self.playhead.position), self._run.home))
        chunk = CHUNK
        if has_own(self.scene):
            chunk = 1
        while (left := target - self._run.step) > 0 and self._clock() - began < FRAME_BUDGET:
            self._forward(min(left, chunk))
            if self.failure:
                break
        if left > 0:
            self.playhead.position = self._run.x
        share = (self.playhead.position - before) / (played * self.playhead.speed)
        self.pace += (share - self.pace) * (1 - math.exp(-played))  # averaged over a second
        if self._run.step != self.history.step:
            self._take_sample(is_row=False)
        return self.sample

    def _forward(self, steps: int) -> None:
        """Go so many steps forward, but no further than the next row."""
        # at most 10 000 steps apart: a processor may be too slow for the speed
        steps_a_row = abs(self.playhead.speed / self.stepping.h) / ROW_RATE
        spacing = max(1, round(min(steps_a_row, 10_000)))
        with self._standing_still():
            self._run.forward(min(steps, spacing - self._run.step % spacing))
        if self._run.step % spacing == 0:
            self._take_sample()

    @contextmanager
    def _standing_still(self) -> Iterator[None]:
        """Pause if a user's method fails, and restore the state before the block."""
        try:
            with _limited(self.scene, self._run):
                yield
        except OwnMethodError as error:
            self.pause(True)
            self.failure = str(error)

    def step(self, n: int) -> Sample:
        self.pause(True)
        return self._go_to(max(0, self._run.step + n))

    def seek(self, position: float) -> None:
        self._go_to(self._run.step_at(min(max(position, 0.0), self.length)))

    def _go_to(self, step: int) -> Sample:
        with self._standing_still():
            self._run.go_to(min(step, self._run.furthest))
        while self._run.step < step and not self.failure:
            self._forward(step - self._run.step)
        self.playhead.position = self._run.x
        return self._take_sample()

    @property
    def length(self) -> float:
        return max(self._run.x_at(self._run.furthest), self.playhead.position)

    @property
    def places(self) -> Sequence[tuple[float, Event]]:
        run = self._run
        return [(run.x_at(each.step), each) for each in self._events if each.run == run.run]

    @property
    def counts(self) -> dict[str, tuple[int, int]]:
        run = self._run
        return {"run": (run.run, self._runs), "step": (run.step, run.furthest)}

    def pause(self, paused: bool) -> None:
        self.failure = None
        if paused != self.playhead.paused:
            self.playhead.paused = paused
            self._note_here("pause" if paused else "resume")

    def set_speed(self, speed: float) -> None:
        if speed != self.playhead.speed:
            self.playhead.speed = speed
            self.pace = 1.0
            self._note_here("speed", speed=speed)

    # Changes of the run

    def start(self, scene: Scene, equal_cost: bool | None = None) -> None:
        """Begin a new run, at equal cost if asked or if the last one is.

        If its start and h alone are new, the scene keeps its name.
        Raises InputError for a step too large at equal cost, or OwnMethodError; then nothing has
        changed.
        """
        before = self.scene
        altered = before.altered(theta=scene.theta, omega=scene.omega, h=scene.h)
        if scene == altered and scene != before:
            name = before.name.removesuffix(ALTERED) + ALTERED
            scene = replace(scene, name=name)
        if equal_cost is None:
            equal_cost = self.stepping.equal_cost
        stepping = Stepping(scene.h, equal_cost, scene.cast).with_smallest(scene.h)
        stepping.check(scene.w0)
        self._runs += 1
        with _limited(scene):
            run = RewindableRun(scene, self._runs, compiled_in_background)
        self.failure = None
        self.ghost = None
        self._enter(run, History(scene, run.changes))
        if stepping.equal_cost:
            self.change(stepping)

    def restart(self) -> None:
        """Begin again with the current step; a run with another step is laid under it."""
        before = self.history
        self.start(before.scene.altered(h=self.stepping.smallest))
        if self.scene != before.scene:
            self.ghost = before.ghost()

    def lay_under(self, h: float, seconds: float) -> None:
        """Lay a run with another step size [s] under this one, from the start to `seconds`."""
        scene = self.scene.altered(h=h)
        history = History(scene, RewindableRun(scene).changes)
        for sample in simulate(scene, seconds, sample_every=1):
            history.add(sample)
        self.ghost = history.ghost()

    @property
    def run_state(self) -> RunState:
        return super().run_state._replace(run=self._run)

    def return_to(self, state: RunState) -> None:
        """Continue an earlier run from where it was left, as a new run that shares its past."""
        if state.run is not None and state.run is not self._run:
            self.ghost = state.ghost
            self._runs += 1
            state.run.branch(self._runs)
            self._enter(state.run, state.history)
        last = self._run.changes[-1].step
        if state.stepping != self.stepping and last > 0 and last == self._run.step:
            self._take_back_changes()
        if state.stepping != self.stepping:
            self.change(state.stepping)
        super().return_to(state)

    def _take_back_changes(self) -> None:
        """Go on as a new run without the changes at this step, which ended the verdicts."""
        step = self._run.step
        self._go_to(step - 1)  # only from behind is a step reached before its changes
        self._go_to(step)
        self._branch()
        self._take_sample()

    def _branch(self) -> None:
        """Go on from here as a new run, which shares this one's past."""
        self._runs += 1
        self._run.branch(self._runs)
        self._note_start()

    def _enter(self, run: RewindableRun, history: History) -> None:
        self._run = run
        self.history = history
        self.playhead.position = run.x
        self._note_start()
        self._take_sample()

    def change(self, stepping: Stepping) -> None:
        """Change the step from here on.

        Raises InputError for an absurd step size, or OwnMethodError; then nothing has changed.
        """
        stepping.check(self.scene.w0)
        if self._run.in_past:
            self._branch()
        with _limited(self.scene, self._run):
            self._run.change(stepping)
        self._note_here("set_h", h=stepping.h, equal_cost=stepping.equal_cost)

    # The recording

    def record(self, recorder: "LiveRecorder") -> None:
        self.recorder = recorder
        for event in self._events:
            recorder.add(event, self._recorded)
        recorder.add(self.sample, self._recorded)

    def mark(self, text: str | None = None) -> None:
        """Mark this moment, once."""
        here = (self.sample.run, self.sample.step)
        marked = [(event.run, event.step) for event in self._events if event.kind == "mark"]
        if here not in marked:
            self._note_here("mark", text=text)

    def close(self) -> None:
        if self.recorder is not None:
            self.recorder.add(self.sample, self._recorded)
            self.recorder.close()

    def _take_sample(self, is_row: bool = True) -> Sample:
        run = self._run
        sample = run.sample(resets=is_row)
        self.stepping = run.lockstep.stepping
        self.judgements = run.lockstep.judgements
        self.milestones = run.lockstep.milestones
        self.history.add(sample, is_row)
        if is_row and self.recorder is not None:
            self.recorder.add(sample, self._recorded)
        self._note_milestones()
        return sample

    def _note_start(self) -> None:
        """Record the run's start; a branch begins with its parent's changes."""
        run = self._run.run
        self._note(Event("start", run, 0, 0.0, scene=self._run.scene))
        for step, t, stepping, _ in self._run.changes[1:]:
            change = Event("set_h", run, step, t, h=stepping.h, equal_cost=stepping.equal_cost)
            self._note(change)
        self._noticed_step = -1  # milestones up to here have been recorded

    def _note_milestones(self) -> None:
        """Record new milestones; those of repeated steps have been recorded before."""
        for milestone in self._run.lockstep.milestones:
            if milestone.step > self._noticed_step:
                self._note(noticed(self._run.run, milestone))
        self._noticed_step = max(self._noticed_step, self._run.step)

    def _note_here(self, kind: EventKind, **what: Any) -> None:
        here = self._take_sample()
        self._note(Event(kind, here.run, here.step, here.t, **what))

    def _note(self, event: Event) -> None:
        self._events.append(event)
        if self.recorder is not None:
            self.recorder.add(event, self._recorded)


def has_own(scene: Scene) -> bool:
    return any(isinstance(method, OwnMethod) for method in scene.cast)


@contextmanager
def _limited(scene: Scene, run: RewindableRun | None = None) -> Iterator[None]:
    """Limit the time of the user's own methods; an error leaves the run as it was."""
    if not has_own(scene):
        yield
        return
    unchanged = run.unchanged_by_errors() if run else nullcontext()
    with limited(), unchanged:
        yield


def compiled_in_background(method: Method, model: Model) -> Loops:
    """A method's loops: plain until a thread has compiled them, with the same bits."""
    return TieredLoops(method, model, _ready)


def _ready(method: Method, model: Model) -> Loops | None:
    future = _compiling(method, model)
    return future.result() if future.done() else None


@cache
def _compiling(method: Method, model: Model) -> Future[Loops]:
    def compile_now() -> Loops:
        loops = compiled(method, model)
        loops.advance((0.0, 0.0), 1.0, 1, math.inf)  # Numba compiles at the first call
        return loops

    return _COMPILER.submit(compile_now)
