"""View and Pane: what the screen shows between the status line and the key line."""

from collections.abc import Callable, Coroutine
from textwrap import wrap
from typing import Any, ClassVar, Generic, TypeVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.content import Content
from textual.reactive import var
from textual.worker import Worker, WorkerState

from engine.methods import Cast
from engine.methods.own import OwnMethodError
from engine.run.lockstep import Sample
from tui.drawing.cells import CellWidget
from tui.drawing.palette import TEXT
from tui.drawing.picture import Picture, Row
from tui.playback.shown import Shown
from tui.playback.source import Source

Place = TypeVar("Place")

DESCRIBED_FIRST = "velocity_verlet"


class Box(Container):
    """A container hidden by its children, which saves Textual a style lookup per paint."""

    BLANK = True


class View(Box):
    """A view gets source and shown from the screen with data_bind, and passes them on to its panes.

    Samples come directly: data_bind would take longer than drawing.
    """

    source: var[Source | None] = var(None)
    shown: var[Shown] = var(Shown())

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._every_frame: list[Pane] = []
        self._at_5_hz: list[Pane] = []
        self._sample: Sample | None = None
        self._is_painted = False

    def every_frame(self, pane: "Pane") -> "Pane":
        """Register a pane that moves."""
        self._every_frame.append(pane)
        return pane.data_bind(View.source, View.shown)

    def at_5_hz(self, pane: "Pane") -> "Pane":
        """Register a pane that people read."""
        self._at_5_hz.append(pane)
        return pane.data_bind(View.source, View.shown)

    def on_mount(self) -> None:
        self._follow_in(*self._every_frame, *self._at_5_hz)
        self.call_after_refresh(self._after_first_paint)

    def _after_first_paint(self) -> None:
        self._is_painted = True
        self._follow_in(*self._every_frame, *self._at_5_hz)

    def follow(self, sample: Sample, read: bool = True) -> None:
        """Show a sample in the panes that move and, if it is time to `read`, in the others.

        The latter may show the same sample again, for what else has changed.
        """
        has_moved = sample != self._sample
        self._sample = sample
        self._follow_in(*(self._every_frame if has_moved else ()), *(self._at_5_hz if read else ()))

    def _follow_in(self, *panes: "Pane") -> None:
        for pane in panes:
            if self._sample is not None and (self._is_painted or not pane.NEEDS_NUMPY):
                pane.follow(self._sample)

    def wake(self) -> None:
        """Draw what is on screen again: the view was hidden."""
        for pane in self.query(Pane):
            pane.draw()

    def zoom(self, factor: float) -> None:
        """Zoom by `factor`, in views that have a chart of time."""

    def compute(
        self, work: Callable[[], Coroutine[None, None, None]], group: str = "default"
    ) -> Worker[None]:
        """Run this in place of the group's earlier work; the function starts the work."""
        return self.run_worker(work, group=group, exclusive=True, exit_on_error=False)

    def on_worker_state_changed(self, event: Worker.StateChanged) -> None:
        """Show a user's method error in the panes; any other error ends the program."""
        if (error := event.worker.error) is not None and event.state is WorkerState.ERROR:
            if not isinstance(error, OwnMethodError):
                raise error
            for pane in self.query(Pane):
                pane.border_subtitle = Content(str(error))


class Pane(CellWidget):
    """Draws a source at one sample; redraws when the source or what is shown changes."""

    NEEDS_NUMPY: ClassVar[bool] = False
    """Whether to draw after the first paint: importing NumPy takes as long as the rest."""

    source: var[Source | None] = var(None)
    sample: Sample | None = None
    shown: var[Shown] = var(Shown())
    _titles = ("", "")

    def follow(self, sample: Sample) -> None:
        """Show a sample."""
        self.sample = sample
        self.draw()

    def watch_source(self) -> None:
        self.draw()

    def watch_shown(self) -> None:
        self.draw()

    @property
    def cast(self) -> Cast:
        """The methods of the run on screen."""
        return self.source.scene.cast if self.source is not None else ()

    @property
    def places(self) -> list[int]:
        """The places in the cast of the methods that are shown."""
        return self.shown.places(self.cast)

    @property
    def is_live(self) -> bool:
        """Whether the source is the lab, where runs can be started, and not a recording."""
        return self.source is not None and self.source.kind == "LIVE"

    def write_titles(self, above: str, below: str) -> None:
        """Write on the border.  A new title has Textual paint all of the pane."""
        if (above, below) != self._titles:
            self._titles = above, below
            self.border_title = Content(above)  # not markup: units stand in brackets
            self.border_subtitle = Content(below)

    def draw(self) -> None:
        source = self.source
        sample = self.sample
        if source is None or sample is None or not self.drawable:
            return
        if sample.run == source.sample.run:  # else another has begun, maybe with other methods
            self.show(self.picture(source, sample))

    def picture(self, source: Source, sample: Sample) -> Picture:
        """Return the sample as a picture of `room`; called when there is any."""
        raise NotImplementedError


class Chooser(Pane, Generic[Place], can_focus=True):
    """A pane with a cursor that chooses how the lab goes on.  It describes one method.

    In a replay there is nothing to choose: the arrows, enter and esc are the replay's.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "move(-1, 0)", "cursor, to choose", False, "arrows"),
        Binding("right", "move(1, 0)"),
        Binding("up", "move(0, 1)"),
        Binding("down", "move(0, -1)"),
        Binding("enter", "choose", "Use", tooltip="use what is at the cursor"),
        Binding("tab", "method(1)", "the next method in words", show=False),
        Binding("escape", "cancel", "leave the cursor", False, "esc"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.cursor: Place | None = None
        self.pointer: Place | None = None  # what is under it
        self._described = DESCRIBED_FIRST  # key of a method

    @property
    def index(self) -> int:
        """The index of the described method, one of those shown if there are any."""
        shown = self.places or range(len(self.cast))
        return next(
            (place for place in shown if self.cast[place].key == self._described),
            shown[0] if shown else 0,
        )

    def describe(self, place: int) -> None:
        self._described = self.cast[place].key

    def words(self, *texts: str) -> list[Row]:
        """Return wrapped lines of text."""
        width = max(self.room.width - 2, 1)
        return [[(f" {line}", TEXT)] for text in texts for line in wrap(text, width)]

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action in ("choose", "cancel"):
            return self.is_live and self.cursor is not None
        return self.is_live or action != "move"

    def place_under(self, event: events.MouseEvent) -> Place | None:
        """Return what can be chosen at the pointer."""
        raise NotImplementedError

    def choose(self, place: Place) -> None:
        """Ask for what is at this place."""
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
            self.describe(shown[(shown.index(self.index) + down) % len(shown)])
            self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if (under := self.place_under(event)) != self.pointer:
            self.pointer = under
            self.draw()

    def on_leave(self) -> None:
        self.pointer = None
        self.draw()

    def on_click(self, event: events.Click) -> None:
        if self.is_live and (under := self.place_under(event)) is not None:
            self.cursor = None
            self.choose(under)


AnyChooser = TypeVar("AnyChooser", bound=Chooser[Any])


class StudyView(View, Generic[AnyChooser]):
    """A view around a chooser, whose content another process computes while it is shown."""

    def __init__(self, pane: AnyChooser, id: str | None = None) -> None:
        super().__init__(id=id)
        self.pane = pane

    def compose(self) -> ComposeResult:
        yield self.at_5_hz(self.pane)

    def on_show(self) -> None:
        self.pane.focus()

    def follow(self, sample: Sample, read: bool = True) -> None:
        if read and self.display and self.source is not None:
            self.compute_missing(self.source)
        super().follow(sample, read)

    def compute_missing(self, source: Source) -> None:
        """Compute what is missing for the run on screen."""
        raise NotImplementedError
