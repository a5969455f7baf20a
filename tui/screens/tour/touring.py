"""Touring: what the tour adds to the lab's screen."""

from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType

from tui.playback.live import Live
from tui.playback.shown import Shown
from tui.screens.base import SourceScreen
from tui.screens.insight_line import InsightLine
from tui.screens.keys import COMMON, TOUR
from tui.views.keys import bindings

if TYPE_CHECKING:  # imported when the tour begins
    from tui.screens.tour.panel import TourPanel
    from tui.words.tour.guide import Guide


ON_TOUR = "-tour"
"""The screen's class while the panel stands in place of the insight line."""


class Touring(SourceScreen):
    """The lab's screen, with a tour that is left and gone on with at any time."""

    BINDINGS: ClassVar[list[BindingType]] = [
        *(Binding(key.names, key.action, key.does, show=False, priority=True) for key in TOUR),
        *bindings(*(key for key in COMMON if key.names == "escape")),  # where no tour is left with it
    ]

    begins_with_tour = False
    _guide: "Guide | None" = None
    _leave: Callable[[bool], None] | None = None
    """Shows the lab as it was before, with its run or else with the step's; None while no tour is on the screen."""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action in ("tour_forward", "tour_back", "tour_leave"):
            return self._leave is not None
        return super().check_action(action, parameters)

    def on_source_screen_began(self) -> None:
        if self.begins_with_tour:
            self.action_tour()

    def frame(self) -> None:
        super().frame()
        if self._leave is not None and self._guide is not None:
            if self._guide.follow():
                self.show_now()
            self._panel.draw()

    def action_pause(self) -> None:
        """As elsewhere; but where the tour has paused the lab, go on with it."""
        if self._leave is None or self._guide is None or self._guide.stage == "watching":
            super().action_pause()
        else:
            self.action_tour_forward()

    def action_tour(self) -> None:
        """Begin the tour, go on where it was left, or leave it."""
        if self._leave is not None:
            self.action_tour_leave()
            return
        from tui.screens.tour.panel import TourPanel
        from tui.words.tour.guide import Guide

        assert isinstance(self.source, Live)
        if self._guide is None:
            self._guide = Guide(self.source)
            self.mount(TourPanel(), before=self.query_one(InsightLine))
        self._leave = self._way_out(self.source)
        self._panel.guide = self._guide
        self.add_class(ON_TOUR)
        self._guide.go_on()
        self._show_step()

    def action_tour_forward(self) -> None:
        assert self._guide is not None
        at = self._guide.at
        if not self._guide.forward():
            self._end(True, "That was the tour. Now the lab is yours: ? lists its keys.")
        elif self._guide.at != at:
            self._show_step()
        else:
            self._show_words()

    def action_tour_back(self) -> None:
        assert self._guide is not None
        self._guide.back()
        self._show_step()

    def action_tour_leave(self) -> None:
        """Leave the tour; its run goes on, and `u` brings back the one before."""
        self._end(False, "T goes on with the tour.")

    def _end(self, back: bool, notice: str) -> None:
        assert self._leave is not None
        leave, self._leave = self._leave, None
        leave(back)
        self.remove_class(ON_TOUR)
        self.notify(notice, timeout=6)
        self.show_now()

    def _show_step(self) -> None:
        assert self._guide is not None
        self.shown = self.shown._replace(hidden=frozenset(), quantity=Shown().quantity, seconds=None, stretch=None)
        if self.view != self._guide.step.view:
            self.action_view(self._guide.step.view)
        self._show_words()

    def _show_words(self) -> None:
        self.show_now()
        self._panel.draw()

    def _way_out(self, live: Live) -> Callable[[bool], None]:
        run, way_back = live.sample.run, live.way_back()
        shown, view, speed, paused = self.shown, self.view, live.playhead.speed, live.playhead.paused

        def leave(back: bool) -> None:
            self.shown = shown
            live.set_speed(speed)
            live.pause(paused)
            if self.view != view:
                self.action_view(view)
            if live.sample.run != run:
                self.remember(way_back)
                if back:
                    self._undo.pop()()  # without a notice of its own

        return leave

    @property
    def _panel(self) -> "TourPanel":
        from tui.screens.tour.panel import TourPanel

        return self.query_one(TourPanel)
