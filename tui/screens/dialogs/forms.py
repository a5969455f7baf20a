"""The forms over the lab: a scene, the methods, or the start values."""

import argparse
from collections.abc import Callable
from contextlib import suppress
from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Horizontal
from textual.widgets import Input, Label, OptionList
from textual.widgets.option_list import Option

from engine.methods import METHODS, Cast, Method
from engine.models import PARAMETERS
from engine.scenes import GROUPS, MOST_METHODS, SCENES, Scene
from tui.cli.options import angle, number
from tui.screens.dialogs.modal import Form
from tui.words.numbers import counted, z_text


class _Paged(OptionList):
    """Textual 8.2's list knows no pages before its first paint."""

    def action_page_up(self) -> None:
        with suppress(KeyError):
            super().action_page_up()  # type: ignore[no-untyped-call]

    def action_page_down(self) -> None:
        with suppress(KeyError):
            super().action_page_down()  # type: ignore[no-untyped-call]


class SceneList(Form[str | None]):
    """Returns the name of the scene to start, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,P,shift+p,q", "dismiss(None)")]

    def __init__(self, current: str) -> None:
        super().__init__()
        self._current = current

    def compose(self) -> ComposeResult:
        listed = _Paged(id="scenes", markup=False)
        listed.border_title = "Scenes, with what to watch"
        listed.border_subtitle = "Enter starts, Esc cancels"
        for group, scenes in GROUPS.items():
            listed.add_option(Option(Text(group.upper(), "bold"), disabled=True))
            listed.add_options(Option(_line(scene), scene.name) for scene in scenes)
        if self._current in SCENES:
            listed.highlighted = listed.get_option_index(self._current)
        yield listed

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option_id)


def _line(scene: Scene) -> Table:
    line = Table.grid(padding=(0, 2))
    line.add_column(width=max(map(len, SCENES)))
    line.add_column()
    line.add_row(scene.name, scene.watch)
    return line


def method_line(method: Method, cast: Cast) -> str:
    """Return as "2 v Velocity Verlet  order 2  1 force a step  symplectic"; no digit: not taken."""
    digit = str(cast.index(method) + 1) if method in cast else " "
    forces = f"{counted(method.force_evaluations, 'force')} a step"
    kind = "symplectic" if method.symplectic else "not symplectic"
    return f"{digit} {method.letter} {method.label:<22} order {method.order:<2} {forces:<16} {kind}"


class CastForm(Form[Cast | None]):
    """Returns the methods to start with, in the order in which they were taken, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,M,shift+m,q", "dismiss(None)"),
        Binding("space", "take"),
        Binding("enter", "start", priority=True),
    ]

    def __init__(self, scene: Scene) -> None:
        super().__init__()
        self._model = scene.model
        known = dict.fromkeys((*METHODS, *scene.cast))
        self._methods = [each for each in known if scene.model in each.models]
        self.cast = scene.cast

    def compose(self) -> ComposeResult:
        listed = _Paged(*(Text(method_line(each, self.cast)) for each in self._methods), id="cast")
        listed.border_title = f"Methods for the model {self._model}, one to {MOST_METHODS}"
        listed.border_subtitle = "Space takes or leaves a method, Enter starts, Esc cancels"
        yield listed

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Take or leave a method that was clicked."""
        self._toggle(event.option_index)

    def action_take(self) -> None:
        if (index := self.query_one(OptionList).highlighted) is not None:
            self._toggle(index)

    def _toggle(self, index: int) -> None:
        method = self._methods[index]
        if method in self.cast:
            self.cast = tuple(each for each in self.cast if each is not method)
        elif len(self.cast) < MOST_METHODS:
            self.cast = (*self.cast, method)
        else:
            self.notify(f"No more than {MOST_METHODS} methods fit: leave one out first.")
        listed = self.query_one(OptionList)
        for at, each in enumerate(self._methods):
            listed.replace_option_prompt_at_index(at, Text(method_line(each, self.cast)))

    def action_start(self) -> None:
        if self.cast:
            self.dismiss(self.cast)
        else:
            self.notify("Take at least one method.")


FIELDS: dict[str, tuple[str, Callable[[str], float]]] = {
    "theta": ("rad, or 115deg", angle),
    "omega": ("rad/s, or 90deg", angle),
    "h": ("s, the step size", number),
    "length": ("m", number),
    "gravity": ("m/s²", number),
    **{
        each.name: (f"{each.unit}, {each.min:g} to {each.max:g}", number)
        for each in PARAMETERS.values()
    },
}
"""The unit and the parser of each number; of PARAMETERS only those of the scene's model."""


class StartForm(Form[Scene | None]):
    """Returns the scene to start, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)"),
        Binding("down", "app.focus_next"),
        Binding("up", "app.focus_previous"),
    ]

    def __init__(self, scene: Scene, backwards: bool = False) -> None:
        """`backwards`: time runs backwards now; a new run begins forwards."""
        super().__init__()
        self._before = scene
        self._scene: Scene | None = scene
        self._note = "; time will run forwards" if backwards else ""

    def compose(self) -> ComposeResult:
        with Container(id="form") as form:
            form.border_title = "Start values"
            form.border_subtitle = "Enter starts, Esc cancels"
            numbers = self._before.numbers
            for name in [each for each in FIELDS if each in numbers]:
                with Horizontal():
                    yield Label(name)
                    yield Input(f"{numbers[name]!r}", id=name, compact=True, select_on_focus=True)
                    yield Label(FIELDS[name][0], classes="unit")
            yield Label(self._summary(), id="verdict", markup=False)

    @on(Input.Changed)
    def check(self) -> None:
        """Show what is wrong with the values, or w0 and z."""
        verdict = self.query_one("#verdict", Label)
        try:
            self._scene = self._before.altered(**self._values())
        except ValueError as error:
            self._scene = None
            verdict.update(str(error))
        else:
            verdict.update(self._summary())
        verdict.set_class(self._scene is None, "-wrong")

    def _values(self) -> dict[str, float]:
        """Return what is typed.  Raises ValueError with a sentence if it is no number."""
        values = {}
        for field in self.query(Input):
            assert field.id is not None
            try:
                values[field.id] = FIELDS[field.id][1](field.value.strip())
            except argparse.ArgumentTypeError as error:
                raise ValueError(f"{field.id}: {error}.") from None
        return values

    @on(Input.Submitted)
    def submit(self) -> None:
        if self._scene is not None:
            self.dismiss(self._scene)

    def _summary(self) -> str:
        scene = self._scene
        if scene is None:
            return ""
        return f"w0 = {scene.w0:.4g} 1/s, {z_text(scene, 3)}{self._note}"
