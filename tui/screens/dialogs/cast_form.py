"""CastForm: the list of methods, to choose those on stage."""

from collections.abc import Sequence
from typing import ClassVar

from rich.style import Style
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.geometry import Region

from engine.methods import METHODS, Cast, Method
from engine.scenes import MOST_METHODS, Scene
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT, ink_of
from tui.drawing.picture import Picture, Row
from tui.screens.dialogs.modal import Form
from tui.words.numbers import counted

MARKED = Style(reverse=True)


def toggled(cast: Cast, method: Method) -> Cast:
    """With the method as the last one, or without it; as it was where that would be too many."""
    if method in cast:
        return tuple(each for each in cast if each is not method)
    return (*cast, method) if len(cast) < MOST_METHODS else cast


def method_line(method: Method, cast: Cast) -> str:
    """As "2 v Velocity Verlet      order 2   1 force a step  symplectic": its digit if it is in the cast."""
    digit = str(cast.index(method) + 1) if method in cast else " "
    forces = f"{counted(method.force_evaluations, 'force')} a step"
    kind = "symplectic" if method.symplectic else "not symplectic"
    return f" {digit} {method.letter} {method.label:<22} order {method.order:<2}  {forces:<15} {kind} "


def method_rows(methods: Sequence[Method], cast: Cast, cursor: int, width: int) -> list[Row]:
    """A line for each method, that of the cursor in reverse."""
    rows: list[Row] = []
    for at, method in enumerate(methods):
        line = method_line(method, cast).ljust(width)
        rows.append([(line[:3], TEXT), (line[3:27], ink_of(method, cast)), (line[27:], TEXT)])
        if at == cursor:
            rows[-1] = [(line, MARKED)]
    return rows


class MethodList(CellWidget, can_focus=True):
    """The lines; space or a click takes a method or leaves it."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", show=False),
        Binding("down,j", "move(1)", show=False),
        Binding("space", "take", show=False),
        Binding("enter", "start", show=False),
    ]

    def __init__(self, cast: Cast, model: str) -> None:
        super().__init__()
        self.methods = [method for method in dict.fromkeys((*METHODS, *cast)) if model in method.models]
        self.cast, self.cursor = cast, 0
        self.styles.height = len(self.methods)

    def draw(self) -> None:
        self.show(Picture(method_rows(self.methods, self.cast, self.cursor, self.room.width)))
        self.screen.query_one("#cast").border_subtitle = (
            "Space takes or leaves a method, Enter starts, Esc cancels" if self.cast else "At least one method"
        )

    def action_move(self, down: int) -> None:
        self.cursor = (self.cursor + down) % len(self.methods)
        self.screen.query_one(VerticalScroll).scroll_to_region(Region(0, self.cursor, 1, 1), animate=False)
        self.draw()

    def action_take(self) -> None:
        method = self.methods[self.cursor]
        if method not in self.cast and len(self.cast) == MOST_METHODS:
            self.notify(f"No more than {MOST_METHODS} methods fit on the screen: leave one out first.")
        self.cast = toggled(self.cast, method)
        self.draw()

    def action_start(self) -> None:
        if self.cast:
            self.screen.dismiss(self.cast)

    def on_click(self, event: events.Click) -> None:
        if event.y < len(self.methods):
            self.cursor = event.y
            self.action_take()


class CastForm(Form[Cast | None]):
    """Returns the methods to start with, or None."""

    AUTO_FOCUS = "MethodList"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,M,shift+m,q", "dismiss(None)", "cancel")]

    def __init__(self, scene: Scene) -> None:
        super().__init__()
        self._scene = scene

    def compose(self) -> ComposeResult:
        with VerticalScroll(id="cast", can_focus=False) as form:
            form.border_title = f"Methods for the model {self._scene.model}, one to {MOST_METHODS}"
            yield MethodList(self._scene.cast, self._scene.model)
