"""Pendulum: one or all methods' pendulums on one pivot."""

from collections.abc import Sequence

from engine.methods import METHODS
from engine.run.lockstep import Sample
from tui.drawing.palette import EXACT, mark
from tui.playback.source import Source
from tui.views.lab.pendulum_picture import Bob, pendulum_picture
from tui.views.view import Pane

TRAIL = 15  # samples, half a second at 30 frames a second


class Pendulum(Pane):
    """The pendulums of some methods; more than one are told apart by their letters."""

    def __init__(self, indices: Sequence[int], id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id, classes)
        self._indices = indices
        alone = len(indices) == 1
        self.border_title = f"{mark(indices[0])} {METHODS[indices[0]].label}" if alone else "Pendulums"

    def paint(self, source: Source, sample: Sample) -> None:
        length = TRAIL if self.shown.trails else 0
        bobs = []
        if self.shown.exact:
            bobs.append(Bob(source.exact.at(sample.t).theta, EXACT, ghost=True))
        for index in self._indices:
            if self.shown.shown[index]:
                reading = sample.readings[index]
                bobs.append(
                    Bob(
                        reading.theta,
                        index,
                        trail=source.history.trail(index, length)[0],
                        letter=METHODS[index].letter if len(self._indices) > 1 else "",
                        diverged=reading.diverged_at is not None,
                    )
                )
        self.show_picture(pendulum_picture(*self.room, bobs))
