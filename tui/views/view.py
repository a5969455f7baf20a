"""View and Pane: what the screen shows between the status line and the key line."""

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from textwrap import TextWrapper
from typing import Any, ClassVar, Generic, TypeVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.content import Content
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip
from textual.worker import Worker

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import Cast
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.errors import explained
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.drawing.picture import TEXT, Picture, Row
from pendu_tui.tui.playback.shown import Shown, Stretch
from pendu_tui.tui.playback.source import Source

Place = TypeVar("Place")
Result = TypeVar("Result")


@dataclass
class SceneChosen(Message):
    scene: Scene


@dataclass
class StepSizeChosen(Message):
    stepping: Stepping


@dataclass
class Held(Message):
    """The user holds the pendulums at an angle [rad], or has let go (None)."""

    theta: float | None


@dataclass
class Zoomed(Message):
    """The user zoomed the chart to this stretch, or back to the whole run (None)."""

    stretch: Stretch | None


class Memo(Generic[Result]):
    """A function that is called again only with other arguments than the last ones."""

    result: Result  # of the last call

    def __init__(self, function: Callable[..., Result]) -> None:
        self._function = function
        self.arguments: tuple[object, ...] | None = None

    def __call__(self, *arguments: object) -> Result:
        if arguments != self.arguments:
            self.result = self._function(*arguments)
            self.arguments = arguments
        return self.result

    def forget(self) -> None:
        self.arguments = None


class Box(Container):
    """Is covered by its children, and so not painted."""

    def render_lines(self, crop: Region) -> list[Strip]:
        return []


class View(Box):
    """Has panes, which its screen shows each sample."""

    def __init__(self, name: str, *panes: "Pane") -> None:
        super().__init__(id=name)
        self.panes = panes

    def compose(self) -> ComposeResult:
        yield from self.panes

    def zoom(self, factor: float) -> None:
        """Zoom the chart over time, if the view has one."""

    def retry(self) -> None:
        for pane in self.panes:
            pane.retry()


class Pane(CellWidget):
    EVERY: ClassVar[int] = 12
    """It is drawn every so many sixtieths of a second; people read text five times a second."""
    NEEDS_NUMPY: ClassVar[bool] = False
    """Whether to draw after the first paint only: importing NumPy would double its time."""

    source: Source
    shown = Shown()
    sample: Sample | None = None
    failure = ""
    """Why the picture cannot be computed, in a sentence."""
    _titles = ("", "")
    _turn = 0

    def follow(self, source: Source, sample: Sample, shown: Shown, beat: int = 0) -> None:
        """Show a sample if it is this pane's turn, as it always is at beat 0."""
        turn = beat // self.EVERY
        if not beat or turn != self._turn:
            self._turn = turn
            self.source = source
            self.sample = sample
            self.shown = shown
            self.draw()

    @property
    def cast(self) -> Cast:
        return self.source.scene.cast

    @property
    def places(self) -> list[int]:
        return self.shown.places(self.cast)

    def write_titles(self, above: str, below: str = "") -> None:
        """Write on the border, if it changed: Textual repaints the whole pane for it."""
        if (above, below) != self._titles:
            self._titles = above, below
            self.border_title = Content(above)  # not markup, as units are in brackets
            self.border_subtitle = Content(below)

    def draw(self) -> None:
        """Draw the picture, or say why it cannot be computed."""
        sample = self.sample
        if sample is None or not self.drawable:
            return
        if sample.run != self.source.sample.run:
            return  # a new run may have other methods
        picture = self.picture(self.source, sample)
        if self.failure:
            picture = Picture(self.words(self.failure))
        self.show(picture)

    def picture(self, source: Source, sample: Sample) -> Picture:
        raise NotImplementedError

    def start_at(self, theta: float, omega: float, h: float | None = None) -> None:
        """Ask for a run from here [rad, rad/s], with the current step size if h [s] is None."""
        h = h or self.source.stepping.smallest
        try:
            scene = self.source.scene.altered(theta=theta, omega=omega, h=h)
        except InputError as error:  # zoomed out, omega may be beyond the scene's limits
            self.notify(str(error), severity="warning")
        else:
            self.post_message(SceneChosen(scene))

    def words(self, *texts: str, rows: int = 100) -> list[Row]:
        """Return texts on rows, the last of which ends with an ellipsis if there are more."""
        wrapper = TextWrapper(max(self.room.width, 1), break_on_hyphens=False, placeholder=" …")
        lines = [line for text in texts for line in wrapper.wrap(text)]
        if rows < len(lines):
            wrapper.max_lines = 1
            lines[rows - 1 :] = wrapper.wrap(" ".join(lines[rows - 1 :]))
        return [[(line, TEXT)] for line in lines[:rows]]

    def on_hide(self) -> None:
        self.release_mouse()  # or no mouse event would reach anything

    def on_mouse_scroll_up(self, event: events.MouseEvent) -> None:
        self.wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseEvent) -> None:
        self.wheel(event, 1.25)

    def wheel(self, event: events.MouseEvent, factor: float) -> None:
        """Zoom about the pointer, if the pane can."""

    # Computing in another process

    def compute(
        self, function: Callable[..., Iterator[Any]], *arguments: object, group: str = "default"
    ) -> None:
        """Compute in another process and `add` the results; cancel the group's earlier work."""
        from pendu_tui.tui.views.background import computed  # not needed for the first paint

        async def work() -> None:
            await asyncio.sleep(0.1)  # until the wheel stops turning
            try:
                async for result in computed(function, *arguments):
                    self.add(result)
            except Exception as error:  # the lab goes on
                self.failure = f"{computing_failed(error)} Open this view again to retry."

        self.failure = ""
        _: Worker[None] = self.run_worker(work, group=group, exclusive=True)

    def add(self, result: Any) -> None:
        """Keep a result of `compute`, to be drawn with one of the next samples."""
        raise NotImplementedError

    @property
    def settled(self) -> bool:
        """Whether all that it shows has been computed."""
        return all(worker.is_finished for worker in self.workers)

    def retry(self) -> None:
        """Compute again what failed."""
        if self.failure:
            self.failure = ""
            self.forget()

    def forget(self) -> None:
        """Forget what has been computed, and what has been asked for."""


def computing_failed(error: Exception) -> str:
    try:
        return str(explained(error))
    except Exception:
        return f"This view cannot be computed: {type(error).__name__}: {error}."


class Chooser(Pane, Generic[Place], can_focus=True):
    """A pane with a cursor to choose a start or a step from, and words about one method."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "move(-1, 0)", "move the cursor", False, "arrows"),
        Binding("right", "move(1, 0)"),
        Binding("up", "move(0, 1)"),
        Binding("down", "move(0, -1)"),
        Binding("enter", "choose", "Use", tooltip="use what is at the cursor"),
        Binding("tab", "method(1)", "describe the next method", show=False),
        Binding("escape", "cancel", "hide the cursor", False, "esc"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.cursor: Place | None = None
        self.pointer: Place | None = None  # the place under it
        self.described = "velocity_verlet"  # a method's key

    @property
    def index(self) -> int:
        """The place in the cast of the described method, or of the first that is shown."""
        shown = self.places or range(len(self.cast))
        described = (place for place in shown if self.cast[place].key == self.described)
        return next(described, shown[0])

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action in ("choose", "cancel"):
            return self.cursor is not None
        return super().check_action(action, parameters)

    def place_under(self, event: events.MouseEvent) -> Place | None:
        raise NotImplementedError

    def choose(self, place: Place) -> None:
        raise NotImplementedError

    def action_choose(self) -> None:
        if (place := self.cursor) is not None:
            self.cursor = None
            self.choose(place)

    def action_cancel(self) -> None:
        self.cursor = None
        self.draw()

    def action_method(self, down: int) -> None:
        if shown := self.places:
            place = shown[(shown.index(self.index) + down) % len(shown)]
            self.described = self.cast[place].key
            self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if (under := self.place_under(event)) != self.pointer:
            self.pointer = under
            self.draw()

    def on_leave(self) -> None:
        self.pointer = None
        self.draw()

    async def on_click(self, event: events.Click) -> None:
        if (under := self.place_under(event)) is not None:
            self.cursor = None
            self.choose(under)


class StudyView(View):
    """A view whose first pane gets the focus."""

    def retry(self) -> None:
        super().retry()
        self.screen.set_focus(self.panes[0])  # before the next key

    def on_show(self) -> None:
        self.panes[0].focus()
