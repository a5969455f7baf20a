"""The tour on the lab's screen: TourGuide shows its shots, TourPanel its words."""

import textwrap

from rich.style import Style

from tui.drawing.cells import CellWidget
from tui.drawing.palette import EXACT, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.playback.live import Live
from tui.screens.base import SourceScreen
from tui.screens.insight_line import InsightLine
from tui.words.tour import Tour

TITLE = -10
"""The ink of the title."""

FORWARD = {
    "watching": "enter to the moment",
    "asked": "1 2 answer  enter the truth",
    "answered": "enter go on",
}


class TourGuide:
    """Shows the tour's shots on a lab's screen, and gives the screen back."""

    def __init__(self, screen: SourceScreen, live: Live) -> None:
        self.screen = screen
        self.live = live
        self.tour = Tour(live)
        self.panel = TourPanel(self.tour)
        self.is_on = False
        screen.mount(self.panel, before=screen.query_one(InsightLine))

    def toggle(self) -> None:
        """Begin the shot where the tour was left, or leave it."""
        if self.is_on:
            self._leave("T goes on with the tour; u brings back the run before it.")
            return
        self.before = self.screen.state
        self.view = self.screen.view
        self.is_on = True
        self.screen.add_class("-tour")
        self.tour.begin(self.tour.index)
        self._show_shot()

    def forward(self) -> None:
        """Go to the moment, to the truth, or to the next shot."""
        index = self.tour.index
        if not self.tour.forward():
            self._leave(
                "That was the tour. At equal cost each method has its own h; n gives all the same "
                "again."
            )
        elif self.tour.index != index:
            self._show_shot()
        else:
            self._show()

    def back(self) -> None:
        """Go back to the question, or to the shot before."""
        self.tour.back()
        self._show_shot()

    def answers(self, choice: int) -> bool:
        """Take an answer; return False where none is asked for."""
        if not self.is_on or self.tour.stage != "asked" or choice > 1:
            return False
        self.tour.answer(choice)
        self._show()
        return True

    def follow(self) -> None:
        """Look with each frame whether the moment has come."""
        if self.is_on:
            if self.tour.follow():
                self._show()
            self.panel.draw()

    def _leave(self, notice: str) -> None:
        self.is_on = False
        self.screen.remove_class("-tour")
        self.screen.keep(self.before)
        self.screen.shown = self.before.shown
        self.live.set_speed(self.before.speed)
        self.live.pause(False)
        self.screen.action_view(self.view)
        self.screen.notify(notice, timeout=6)
        self._show()

    def _show_shot(self) -> None:
        """Show the shot of the step, and its words."""
        step = self.tour.step
        self.screen.shown = self.screen.shown.through(step.scene, step.shot)
        if self.screen.view != step.shot.view:
            self.screen.action_view(step.shot.view)
        self._show()

    def _show(self) -> None:
        self.screen.show_now()
        self.screen.refresh_bindings()
        self.panel.draw()


def tour_rows(title: str, keys: str, text: tuple[str, ...], width: int, height: int) -> list[Row]:
    """Return the title and the sentences, the last of them in full."""
    room = max(width - len(title) - 4, 0)
    while len(keys) > room:
        keys = keys.rpartition("  ")[0]
    heads = [(f" {title} ", TITLE), ("  ", TEXT), (keys, EXACT)]
    wrapped = [textwrap.wrap(sentence, max(width - 2, 2)) for sentence in text]
    lines = [(line, EXACT) for sentence in wrapped[:-1] for line in sentence]
    lines += [(line, TEXT) for line in wrapped[-1]]
    return [heads, *([(f" {line}", ink)] for line, ink in lines[-(height - 1) :])]


class TourPanel(CellWidget):
    """The words of the tour, in place of the insight line; a click goes forward."""

    def __init__(self, tour: Tour) -> None:
        super().__init__()
        self.tour = tour

    def draw(self) -> None:
        if self.drawable:
            forward = "enter again" if self.tour.is_astray else FORWARD[self.tour.stage]
            keys = f"{forward}  esc leave  backspace back"
            self.show(Picture(tour_rows(self.tour.title, keys, self.tour.text, *self.room)))

    def on_click(self) -> None:
        self.app.simulate_key("enter")

    def style_of(self, ink: int, base: Style) -> Style:
        if ink == TITLE:
            return super().style_of(WARN, base) + Style(reverse=True, bold=True)
        return super().style_of(ink, base)
