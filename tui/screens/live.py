"""Lab: the live screen, where the run can be changed."""

from collections.abc import Callable
from typing import ClassVar

from textual.binding import BindingType

from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene, SceneError
from tui.playback.live import Live
from tui.screens.base import ALREADY, SourceScreen
from tui.views.keys import COMMON, LIVE, Key, bindings
from tui.views.messages import SceneChosen, StepSizeChosen


class LiveScreen(SourceScreen):
    """Shows a live source and changes it."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(*LIVE)
    KEYS: ClassVar[tuple[Key, ...]] = (*LIVE, *COMMON)

    @property
    def live(self) -> Live:
        """The source."""
        assert isinstance(self.source, Live)
        return self.source

    def start(self, scene: Scene) -> None:
        """Begin a new run, which can be undone by another one."""
        before = self.live.scene
        if self._do(lambda: self.live.start(scene)):
            self.remember(lambda: self._do(lambda: self.live.start(before)))

    def set_stepping(self, stepping: Stepping) -> None:
        """Step otherwise from here on."""
        before = self.live.stepping
        if self._do(lambda: self.live.set_stepping(stepping)):
            self.remember(lambda: self._do(lambda: self.live.set_stepping(before)))

    def _do(self, change: Callable[[], None]) -> bool:
        """Change the run, or say why that cannot be."""
        try:
            change()
        except SceneError as error:
            self.notify(str(error), severity="warning", markup=False)
            return False
        self.show_now()
        return True

    def on_scene_chosen(self, choice: SceneChosen) -> None:
        """Start what was chosen in a view."""
        self.start(choice.scene)

    def on_step_size_chosen(self, choice: StepSizeChosen) -> None:
        """Go on with what was chosen in a view."""
        self.set_stepping(choice.stepping)

    def action_restart(self) -> None:
        """Begin again."""
        self.live.restart()
        self.show_now()

    def action_larger_h(self, direction: int) -> None:
        """Go along 1, 2, 5 with h."""
        self.set_stepping(self.live.stepping.next(up=direction > 0))

    def action_reverse(self) -> None:
        """Let time run the other way."""
        self.set_stepping(self.live.stepping.reversed())

    def action_equal_cost(self) -> None:
        """Give every method the same number of force evaluations, or the same step again."""
        self.set_stepping(self.live.stepping.toggled())

    def action_scene(self, direction: int) -> None:
        """Start the next scene, or the previous one."""
        names = list(SCENES)
        name = self.live.scene.name
        at = names.index(name) + direction if name in SCENES else min(direction, 0)
        self.start(SCENES[names[at % len(names)]])

    def action_start_scene(self, name: str) -> None:
        """Start a scene of the list."""
        self.start(SCENES[name])

    def action_start_values(self) -> None:
        """Ask for the start values."""
        from tui.screens.start_form import StartForm  # Textual's input field can wait until it is wanted

        def chosen(scene: Scene | None) -> None:
            if scene is not None:
                self.start(scene)

        self.app.push_screen(StartForm(self.live.scene.altered(h=self.live.stepping.smallest)), chosen)

    def action_mark(self) -> None:
        """Leave a mark in the recording."""
        text = ALREADY if self.live.is_marked else f"Mark at {self.live.sample.t:.2f} s"
        self.live.mark()
        self.notify(text, timeout=2)
