"""A ring of neighbouring starts that keeps up with the run on screen."""

from collections.abc import Sequence

from engine.phase_space.area import Neighbourhood
from engine.scenes import Scene
from recordings.events import Event

RADII = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)  # rad


class Neighbours:
    """The neighbours of a run's start, carried along to the step on screen.

    They begin at the run's start and take the run's own steps, changes of h included, so what they
    show does not depend on when one began to look.  Back in time is from the start again.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius  # rad
        self.step = 0
        self._begun: tuple[Scene, int] | None = None
        self._taken: list[tuple[int, float, bool]] = []  # the changes of h that steps were taken with
        self._ring: Neighbourhood | None = None

    def follow(self, scene: Scene, run: int, step: int, events: Sequence[Event], most: int) -> Neighbourhood:
        """Come nearer to a step of a run by `most` steps or less; `events` are the sitting's."""
        changes = [
            (event.step, event.h, event.equal_cost) for event in events if event.h is not None and event.run == run
        ]
        known = [change for change in changes if change[0] < self.step]
        if self._ring is None or self._begun != (scene, run) or step < self.step or known != self._taken:
            self._ring = Neighbourhood(scene, self.radius)
            self._begun, self.step = (scene, run), 0
        target = min(step, self.step + most)
        while self.step < target:
            pitch = next(((h, equal) for at, h, equal in reversed(changes) if at <= self.step), (scene.h, False))
            stop = min([target, *(at for at, *_ in changes if at > self.step)])
            self._ring.advance(stop - self.step, *pitch)
            self.step = stop
        self._taken = [change for change in changes if change[0] < self.step]
        return self._ring
