"""StartForm: the start values, checked while they are typed."""

import argparse
from collections.abc import Callable
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Horizontal
from textual.widgets import Input, Label

from engine.models import PARAMETERS
from engine.scenes import Scene
from tui.cli.options import angle, number
from tui.screens.dialogs.modal import Form
from tui.words.numbers import z_name

FIELDS: dict[str, tuple[str, Callable[[str], float]]] = {
    "theta": ("rad, or 115deg", angle),
    "omega": ("rad/s, or 90deg", angle),
    "h": ("s, the step size", number),
    "length": ("m", number),
    "gravity": ("m/s²", number),
    **{each.name: (f"{each.unit}, {each.min:g} to {each.max:g}", number) for each in PARAMETERS.values()},
}
"""What may be typed in, and how it is read; of PARAMETERS those that the scene's model has."""


def scene_from(texts: dict[str, str], before: Scene) -> Scene:
    """The scene of these values.  Raises ValueError with a sentence if they are not valid."""
    values = {}
    for name, text in texts.items():
        try:
            values[name] = FIELDS[name][1](text.strip())
        except argparse.ArgumentTypeError as error:
            raise ValueError(f"{name}: {error}.") from None
    return before.altered(**values)


class StartForm(Form[Scene | None]):
    """Returns the scene to start, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", "cancel"),
        Binding("down", "app.focus_next", show=False),
        Binding("up", "app.focus_previous", show=False),
    ]

    def __init__(self, scene: Scene, backwards: bool = False) -> None:
        """`backwards`: time runs backwards now; a new run begins forwards."""
        super().__init__()
        self._backwards = backwards
        self._before = scene
        self._scene: Scene | None = scene
        self._fields = [name for name in FIELDS if name not in PARAMETERS or name in scene.parameters]

    def compose(self) -> ComposeResult:
        with Container(id="form") as form:
            form.border_title = "Start values"
            form.border_subtitle = "Enter starts, Esc cancels"
            for name in self._fields:
                unit, _ = FIELDS[name]
                with Horizontal():
                    yield Label(name)
                    yield Input(f"{self._before.numbers[name]!r}", id=name, compact=True, select_on_focus=True)
                    yield Label(unit, classes="unit")
            yield Label(self._summary(), id="verdict", markup=False)

    @on(Input.Changed)
    def check(self) -> None:
        """Show what is wrong with the values, or w0 and z."""
        texts = {name: self.query_one(f"#{name}", Input).value for name in self._fields}
        verdict = self.query_one("#verdict", Label)
        try:
            self._scene = scene_from(texts, self._before)
        except ValueError as error:
            self._scene = None
            verdict.update(str(error))
        else:
            verdict.update(self._summary())
        verdict.set_class(self._scene is None, "-wrong")

    @on(Input.Submitted)
    def submit(self) -> None:
        if self._scene is not None:
            self.dismiss(self._scene)

    def _summary(self) -> str:
        scene = self._scene
        forward = "; it begins forward in time" if self._backwards else ""
        return "" if scene is None else f"w0 = {scene.w0:.4g} 1/s, {z_name(scene.model)} = {scene.z:.3g}{forward}"
