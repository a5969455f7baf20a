"""LiveScreen: the lab, where the run can be changed."""

import math
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any, ClassVar

from textual.binding import Binding, BindingType
from textual.screen import ModalScreen
from textual.widget import Widget

from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene, SceneError
from pendu_tui.tui.playback.common import State
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.base import SourceScreen
from pendu_tui.tui.screens.lines import TourPanel
from pendu_tui.tui.views.view import Held, SceneChosen, StepSizeChosen
from pendu_tui.tui.words.insight import return_text
from pendu_tui.tui.words.tour import Tour

_H = Binding.Group("larger, smaller step h")


class LiveScreen(SourceScreen):
    BINDING_GROUP_TITLE = "Lab"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(
            "plus,equals_sign", "next_h(1)", "Step", True, "+", False, "larger step h", group=_H
        ),
        Binding("minus", "next_h(-1)", "Step", True, "-", False, "smaller step h", group=_H),
        Binding("p", "next_scene", "Scene", tooltip="next scene"),
        Binding("P,shift+p", "scenes", "choose a scene", show=False),
        Binding("i", "start_values", "Edit", tooltip="edit start values"),
        Binding("M,shift+m", "methods", "Methods", True, "M", tooltip="choose methods"),
        Binding("r", "restart", "Restart", tooltip="restart; dims the old run"),
        Binding("b", "reverse", "Back", tooltip="run back in time"),
        Binding("n", "equal_cost", "Equal cost", tooltip="equal cost for all"),
        Binding("m", "mark", "mark this moment", show=False),
        Binding("T,shift+t", "tour", "Tour", True, "T", tooltip="tour: begin, leave, resume"),
        Binding("enter", "tour_forward"),  # the tour's panel shows these two
        Binding("backspace", "tour_back"),
    ]

    begins_with_tour = False
    lecture: Mapping[str, Scene] = SCENES
    """The scenes that key p leads through, by name."""
    page = ""
    """The scene from which key p goes on."""
    is_on_tour = False

    @cached_property
    def tour(self) -> Tour:
        return Tour(self.live)

    def more(self) -> Iterator[Widget]:
        yield TourPanel(self.tour)

    @property
    def live(self) -> Live:
        assert isinstance(self.source, Live)
        return self.source

    def frame(self) -> None:
        """Pause at the moment of the scene's shot, and when reversed time is back at 0."""
        before = self.source.history.returned
        step = self.source.sample.step
        super().frame()
        self._pause_at_moment(step)
        returned = self.source.history.returned
        if returned is not None and returned is not before:
            self._stop_at_start(returned)
        if self.is_on_tour:
            if self.tour.follow():
                self._show_tour()
            self.query_one(TourPanel).draw()

    def _pause_at_moment(self, before: int) -> None:
        """Pause if the scene's moment came after step `before`, unless h has changed."""
        scene = self.live.scene
        if scene.shot.moment is None or self.is_on_tour or len(self.live.changes) > 1:
            return
        step = round(scene.shot.moment / scene.h)
        if before < step <= self.live.sample.step and not self.live.playhead.paused:
            self.live.go_to(self.live.sample.run, step)
            self.show_now()

    def _stop_at_start(self, returned: Sample) -> None:
        is_here = returned.step == self.source.sample.step
        if is_here and not self.source.playhead.paused and not self.live.is_marked:
            self.live.pause(True)
            self.live.mark(return_text(self.live.scene, returned))
            self.show_now()

    def action_mark(self) -> None:
        text = f"Mark at {self.source.sample.t:.2f} s"
        if self.live.is_marked:
            text = "Already marked"
        self.live.mark()
        self.notify(text, timeout=4)
        self.show_now()

    # Changes of the run

    def start(self, scene: Scene, speed: float | None = None) -> None:
        before = self.state
        if self._changed(lambda: self.live.start(scene)):
            self.live.set_speed(speed or before.speed)
            self.shown = self.shown._replace(theta=scene.shot.theta, line=scene.shot.line)

    def set_stepping(self, stepping: Stepping) -> None:
        if self._changed(lambda: self.live.set_stepping(stepping)):
            self.shown = self.shown._replace(line=None)  # it belongs to the scene's own h

    def _changed(self, change: Callable[[], None]) -> bool:
        """Change the run and keep its state for undo, or notify why it cannot be changed."""
        before = self.state
        try:
            change()
        except (SceneError, OwnMethodError) as error:
            self.warn(str(error))
            return False
        self.keep(before)
        self.show_now()
        return True

    def restore(self, state: State) -> None:
        if state.run is not None and state.run.run is not self.live.run_state.run:
            self.live.return_to(state.run)
        if state.stepping != self.live.stepping:
            self.live.set_stepping(state.stepping)
        super().restore(state)

    def on_held(self, message: Held) -> None:
        self.shown = self.shown._replace(held=message.theta)

    def _follow(self, sample: Sample, read: bool = True) -> None:
        """Show the angle at which the user holds the pendulums; meanwhile there is no run."""
        if (theta := self.shown.held) is not None:
            readings = [
                reading._replace(
                    theta=theta, omega=0.0, energy_error=math.nan, max_energy_error=math.nan
                )
                for reading in sample.readings
            ]
            sample = sample._replace(readings=tuple(readings))
        super()._follow(sample, read)

    def on_scene_chosen(self, choice: SceneChosen) -> None:
        self.start(choice.scene)

    def on_step_size_chosen(self, choice: StepSizeChosen) -> None:
        self.set_stepping(choice.stepping)

    def action_restart(self) -> None:
        self._changed(self.live.restart)

    def action_next_h(self, direction: int) -> None:
        self.set_stepping(self.live.stepping.next(up=direction > 0))

    def action_reverse(self) -> None:
        self.set_stepping(self.live.stepping.reversed())

    def action_equal_cost(self) -> None:
        self.set_stepping(self.live.stepping.toggled())

    def action_next_scene(self) -> None:
        names = list(self.lecture)
        index = 0
        if self.page in names:
            index = (names.index(self.page) + 1) % len(names)
        self.action_start_scene(names[index])

    def action_start_scene(self, name: str) -> None:
        scene = self.lecture.get(name) or SCENES[name]
        self.page = name
        self.start(scene, scene.speed)
        self.shown = self.shown.through(scene)
        self.call_next(self.action_view, scene.shot.view)

    # Forms, imported when they are needed

    def _ask(self, form: ModalScreen[Any], use: Callable[[Any], None]) -> None:
        """Open a form over the lab, and use its answer unless it is cancelled.

        The answer comes by callback: a worker waiting for it would hang when the app ends.
        """

        def answered(answer: Any) -> None:
            if answer is not None:
                use(answer)

        self.app.push_screen(form, answered)

    def action_scenes(self) -> None:
        from pendu_tui.tui.screens.dialogs import SceneList

        self._ask(SceneList(self.live.scene.name), self.action_start_scene)

    def action_start_values(self) -> None:
        from pendu_tui.tui.screens.dialogs import StartForm

        self._ask(StartForm(self._scene_now()), self.start)

    def action_methods(self) -> None:
        from pendu_tui.tui.screens.dialogs import CastForm

        self._ask(CastForm(self._scene_now()), self.start)

    def _scene_now(self) -> Scene:
        return self.live.scene.altered(h=self.live.stepping.smallest)

    # The tour

    def begin(self) -> None:
        super().begin()
        self.page = self.live.scene.name
        if self.begins_with_tour:
            self.action_tour()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action in ("tour_forward", "tour_back"):
            return self.is_on_tour
        return super().check_action(action, parameters)

    def action_tour(self) -> None:
        if self.is_on_tour:
            self._leave_tour("T goes on with the tour; u brings back the run before it.")
            return
        self._before_tour = self.state, self.view
        self.is_on_tour = True
        self.add_class("-tour")
        self.tour.begin(self.tour.index)
        self._show_shot()

    def action_tour_forward(self) -> None:
        """Go to the moment, the answer, or the next shot."""
        index = self.tour.index
        if not self.tour.forward():
            self._leave_tour(
                "That was the tour. At equal cost each method has its own h; n gives all the same "
                "again."
            )
        elif self.tour.index != index:
            self._show_shot()
        else:
            self._show_tour()

    def action_tour_back(self) -> None:
        self.tour.back()
        self._show_shot()

    def action_show(self, number: int) -> None:
        """Answer the tour's question, or show or hide a method.

        On the tour the keys of the answers hide no method.
        """
        if not self.is_on_tour or number >= 2:
            super().action_show(number)
        elif self.tour.stage == "asked":
            self.tour.answer(number)
            self._show_tour()

    def action_back(self) -> None:
        """Leave the tour, else the zoom of the chart."""
        if self.is_on_tour:
            self.action_tour()
        else:
            super().action_back()

    def _leave_tour(self, notice: str) -> None:
        before, view = self._before_tour
        self.is_on_tour = False
        self.remove_class("-tour")
        self.keep(before)
        self.shown = before.shown
        self.live.set_speed(before.speed)
        self.live.pause(False)
        self.call_next(self.action_view, view)
        self.notify(notice, timeout=6)
        self._show_tour()

    def _show_shot(self) -> None:
        step = self.tour.step
        self.shown = self.shown.through(step.scene, step.shot)
        self.call_next(self.action_view, step.shot.view)
        self._show_tour()

    def _show_tour(self) -> None:
        self.show_now()
        self.refresh_bindings()
        self.query_one(TourPanel).draw()
