"""Pendulum: one method's pendulum, or all on one pivot, in braille.

Dots are square in a cell twice as high as wide, so x and y have the same physical scale.  The
pivot is exactly in the middle: explicit Euler goes over the top.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from engine.methods import METHODS
from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.palette import EXACT, FRAME, faint, mark
from tui.playback.source import Source
from tui.views.view import Pane

TRAIL = 15  # samples, half a second at 30 frames a second


@dataclass(frozen=True, slots=True)
class Bob:
    """One pendulum to draw."""

    theta: float  # rad from the downward vertical
    owner: int
    trail: ArrayLike = ()  # rad; where it was, drawn faintly
    letter: str = ""  # written next to it, so that colour is not alone
    ghost: bool = False  # the exact swing: dotted and hollow
    diverged: bool = False  # its numbers ended here: crossed out


def pendulum_picture(columns: int, rows: int, bobs: Sequence[Bob]) -> Picture:
    """Pendulums on one pivot, in the middle of `columns` × `rows` cells; later ones in front."""
    canvas = Canvas(columns, rows)
    x0, y0 = canvas.width / 2, canvas.height / 2
    room = min(x0, y0)
    bob_radius = min(max(room / 9, 1.5), 3.0)
    room_for_letters = 4 if any(bob.letter for bob in bobs) else 0
    length = max(room - bob_radius - room_for_letters, 1.0)  # of the rod, in dots

    for bob in bobs:
        trail = np.asarray(bob.trail, np.float64)
        canvas.points(x0 + length * np.sin(trail), y0 + length * np.cos(trail), faint(bob.owner))
    for bob in bobs:
        right, down = np.sin(bob.theta), np.cos(bob.theta)
        x, y = x0 + length * right, y0 + length * down
        canvas.line([x0, x], [y0, y], bob.owner, dotted=bob.ghost or bob.diverged)
        if bob.diverged:
            size = bob_radius + 1
            canvas.line([x - size, x + size], [y - size, y + size], bob.owner)
            canvas.line([x - size, x + size], [y + size, y - size], bob.owner)
        else:
            canvas.disc(x, y, bob_radius, bob.owner, hollow=bob.ghost)
        column, row = int(x + (bob_radius + 2) * right) // 2, int(y + (bob_radius + 3) * down) // 4
        beside = (*range(column, column + len(bobs)), *range(column - 1, column - len(bobs), -1))
        canvas.label(next((at for at in beside if canvas.is_free(at, row)), column), row, bob.letter, bob.owner)
    canvas.points([x0 - 1, x0, x0 - 1, x0], [y0 - 1, y0 - 1, y0, y0], FRAME)
    return canvas.picture()


class Pendulum(Pane):
    """The pendulums of some methods; if there are several, with their letters."""

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
