"""StabilityPane: a panel of the stability map per method, to choose h and amplitude from."""

from textual import events

from engine.run.lockstep import Sample
from engine.stability.grid import Grid
from engine.stability.outcomes import Cells
from engine.stability.study import amplitude
from tui.drawing.palette import TEXT, Palette, palette
from tui.drawing.picture import Picture, Row
from tui.playback.source import Source
from tui.views.messages import SceneChosen
from tui.views.stability.picture import MARGIN, legend, panel, place_at, side_by_side, title
from tui.views.stability.words import note, verdict
from tui.views.view import Chooser

WORDS = 2  # lines
LEGEND_SHARE = 7  # rows of the pane for a line of it


class StabilityPane(Chooser[tuple[int, int]]):
    """Draws what is known of the map.  A click, or enter at the cursor, starts a run at rest.

    Places on the map are indices of z and theta.
    """

    BINDING_GROUP_TITLE = "Stability"
    HELP = "A click starts with that h and amplitude."

    def __init__(self, grid: Grid) -> None:
        super().__init__()
        self.begin(grid)

    def begin(self, grid: Grid) -> None:
        """Show another map, none of which has been computed."""
        self.grid = grid
        self.cells: Cells = grid.unknown()
        self.pieces = 0  # of the map that have been computed
        self.complete = False
        self.title = ""
        self.cursor = self.pointer = None
        self._panels: list[list[Row]] = []
        self._drawn: object = None

    @property
    def settled(self) -> bool:
        """Whether the map is complete, and shown if there is room."""
        if self.source is not None and not self.source.scene.general:
            return True
        return self.complete and not (self.drawable and self._drawn != self._state)

    def fill(self, z: slice, method: int, cells: Cells) -> None:
        """Take in a piece of the map; it is drawn with one of the next samples."""
        self.cells[z, method] = cells
        self.pieces += 1

    def here(self, index: int) -> tuple[float, float] | None:
        """The (z, amplitude) of a method on screen, if it swings."""
        if self.source is None or (theta := amplitude(self.source.scene)) is None:
            return None
        return abs(self.source.stepping.own[index]) * self.source.scene.w0, theta

    def aim(self, index: int) -> tuple[int, int] | None:
        """The described place of a method: at the cursor, at the pointer, or nearest to here."""
        if self.cursor or self.pointer:
            return self.cursor or self.pointer
        if (here := self.here(index)) is None or here[0] > self.grid.z[-1]:
            return None
        z = abs(self.grid.z - here[0]).argmin()
        theta = abs(self.grid.theta - here[1]).argmin()
        return int(z), int(theta)

    @property
    def _state(self) -> object:
        """What the panels depend on."""
        if self.source is None:
            return None
        run = self.source.scene, self.source.stepping.own
        return run, self.pieces, self.shown, self.app.theme, self.room, self.cursor, self.index

    def picture(self, source: Source, sample: Sample) -> Picture:
        if why := source.scene.why_not_mapped:
            self.write_titles("Stability (F5)", "")
            return Picture(self.words(why))
        self.write_titles(self.title, "")
        columns, rows = self.panel_size()
        if columns <= 2 * MARGIN or self.grid.methods != self.cast:
            return Picture()
        if self._drawn != self._state:
            self._drawn = self._state
            self._panels = [self._panel(index, columns, rows) for index in self.places]
        panels = [
            [title(index, self.cast[index], columns, self._colours, self._note(index)), *lines[1:]]
            for index, lines in zip(self.places, self._panels, strict=True)
        ]
        blank: Row = [("", TEXT)]
        below = [*self.words(self._verdict()), blank, blank][:WORDS]
        return Picture([*side_by_side(panels, 2), *below, *self._legend()])

    def _panel(self, index: int, columns: int, rows: int) -> list[Row]:
        """Return a method's panel, with a mark at the cursor or at the present h."""
        assert self.source is not None
        here = self.here(index)
        if self.cursor is not None:
            here = self.grid.z[self.cursor[0]], self.grid.theta[self.cursor[1]]
        w0 = self.source.scene.w0
        return panel(self.grid, self.cells, index, columns, rows, self._colours, here=here, w0=w0)

    @property
    def _colours(self) -> Palette | None:
        return None if self.app.no_color or self.app.native_ansi_color else palette(self.app.theme)

    def panel_size(self) -> tuple[int, int]:
        """Columns of a panel and rows of its map, two panels side by side above the words."""
        lines = -(-len(self.places) // 2) or 1
        return (self.room.width - 2) // 2, max(
            1, (self.room.height - WORDS - len(self._legend())) // lines - 2
        )

    def _legend(self) -> list[Row]:
        # as if the frame were part of it
        lines = legend(self.grid.steps, self._colours, self.room.width + 2)
        return lines[: max(self.room.height // LEGEND_SHARE, 1)]

    def _note(self, index: int) -> str:
        if (aim := self.aim(index)) is None:
            return ""
        z, theta = aim
        return note(self.cells[z, index, theta])

    def _verdict(self) -> str:
        if self.source is None or not self.places or (aim := self.aim(self.index)) is None:
            return ""
        z, theta = aim
        cells = self.cells[:, self.index, theta]
        w0 = self.source.scene.w0
        return verdict(self.cast[self.index], self.grid.theta[theta], self.grid.z, cells, z, w0)

    def action_move(self, right: int, up: int) -> None:
        if self.grid.methods != self.cast:
            return
        z, theta = self.aim(self.index) or (0, 0)
        last_z = len(self.grid.z) - 1
        last_theta = len(self.grid.theta) - 1
        self.cursor = min(max(z + right, 0), last_z), min(max(theta + up, 0), last_theta)
        self.draw()

    def choose(self, place: tuple[int, int]) -> None:
        assert self.source is not None
        scene = self.source.scene
        z, theta = place
        h = float(self.grid.z[z]) / scene.w0
        start = scene.altered(theta=float(self.grid.theta[theta]), omega=0.0, h=h)
        self.post_message(SceneChosen(start))

    def place_under(self, event: events.MouseEvent) -> tuple[int, int] | None:
        """Return the place under the pointer; its method is the one described from now on."""
        columns, rows = self.panel_size()
        x, y = event.get_content_offset_capture(self)
        across, column = divmod(x, columns + 2)
        down, row = divmod(y, rows + 2)
        inside = across in (0, 1) and MARGIN <= column < columns and 1 <= row <= rows
        number = 2 * down + across
        if not inside or number not in range(len(self.places)) or self.grid.methods != self.cast:
            return None
        self.describe(self.places[number])
        return place_at(self.grid, row - 1, column - MARGIN, rows, columns - MARGIN)
