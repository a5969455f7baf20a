"""LiveScreen: the lab, where the run can be changed."""

from collections.abc import Callable
from typing import ClassVar

from textual.binding import BindingType

from engine.methods import Cast
from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene, SceneError
from tui.playback.live import Live
from tui.screens.base import ALREADY
from tui.screens.keys import COMMON, LIVE
from tui.screens.tour.touring import Touring
from tui.views.keys import Key, bindings
from tui.views.messages import SceneChosen, StepSizeChosen
from tui.words.insight import return_text


class LiveScreen(Touring):
    """Shows a live source and changes it."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(*LIVE)
    KEYS: ClassVar[tuple[Key, ...]] = (*LIVE, *COMMON)

    @property
    def live(self) -> Live:
        assert isinstance(self.source, Live)
        return self.source

    def frame(self) -> None:
        """Pause where time that runs backwards is back at 0, and keep what each method misses its start by."""
        before = self.source.history.returned
        super().frame()
        returned = self.source.history.returned
        if returned is None or returned is before or self.source.playhead.paused:
            return
        if returned.step == self.source.sample.step and not self.live.is_marked:
            self.live.pause(True)
            self.live.mark(return_text(self.live.scene, returned))
            self.show_now()

    def start(self, scene: Scene, speed: float | None = None) -> None:
        """Start a new run, perhaps at another speed; `u` goes back to the one before, where it was."""
        back, before = self.live.way_back(), self.live.playhead.speed

        def undo() -> None:
            self.live.set_speed(before)
            self._do(back)

        if self._do(lambda: self.live.start(scene)):
            self.live.set_speed(speed or before)
            self.remember(undo)

    def set_stepping(self, stepping: Stepping) -> None:
        before = self.live.stepping
        if self._do(lambda: self.live.set_stepping(stepping)):
            self.remember(lambda: self._do(lambda: self.live.set_stepping(before)))

    def _do(self, change: Callable[[], None]) -> bool:
        """Change the run, or notify why not."""
        try:
            change()
        except SceneError as error:
            self.notify(str(error), severity="warning", markup=False)
            return False
        self.show_now()
        return True

    def on_scene_chosen(self, choice: SceneChosen) -> None:
        self.start(choice.scene)

    def on_step_size_chosen(self, choice: StepSizeChosen) -> None:
        self.set_stepping(choice.stepping)

    def action_restart(self) -> None:
        back = self.live.way_back()
        self.live.restart()
        self.remember(lambda: self._do(back))
        self.show_now()

    def action_larger_h(self, direction: int) -> None:
        """Take the next larger or smaller h of 1, 2, 5, 10, ..."""
        self.set_stepping(self.live.stepping.next(up=direction > 0))

    def action_reverse(self) -> None:
        self.set_stepping(self.live.stepping.reversed())

    def action_equal_cost(self) -> None:
        """Toggle between equal force evaluations and equal steps for all methods."""
        self.set_stepping(self.live.stepping.toggled())

    def action_next_scene(self) -> None:
        names, name = list(SCENES), self.live.scene.name
        self.action_start_scene(names[(names.index(name) + 1) % len(names) if name in SCENES else 0])

    def action_scenes(self) -> None:
        from tui.screens.dialogs.scene_list import SceneList

        def chosen(name: str | None) -> None:
            if name is not None:
                self.action_start_scene(name)

        self.app.push_screen(SceneList(self.live.scene.name), chosen)

    def action_start_scene(self, name: str) -> None:
        self.start(SCENES[name], SCENES[name].speed)

    def action_start_values(self) -> None:
        from tui.screens.dialogs.start_form import StartForm  # Textual's input field is imported when it is needed

        def chosen(scene: Scene | None) -> None:
            if scene is not None:
                self.start(scene)

        stepping = self.live.stepping
        self.app.push_screen(StartForm(self.live.scene.altered(h=stepping.smallest), stepping.h < 0), chosen)

    def action_methods(self) -> None:
        from tui.screens.dialogs.cast_form import CastForm

        scene = self.live.scene.altered(h=self.live.stepping.smallest)  # by the answer, another may be on

        def chosen(cast: Cast | None) -> None:
            if cast:
                self.start(scene.with_cast(cast))

        self.app.push_screen(CastForm(scene), chosen)

    def action_mark(self) -> None:
        text = ALREADY if self.live.is_marked else f"Mark at {self.live.sample.t:.2f} s"
        self.live.mark()
        self.notify(text, timeout=2)
