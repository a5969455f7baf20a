"""AccuracyView: error over cost and over time, charted while it is computed."""

from collections.abc import Callable, Iterator
from functools import partial

from engine.accuracy.growth import Growth, growths
from engine.accuracy.study import Point, measured, usual, with_all_methods
from tui.playback.source import Source
from tui.views.accuracy.pane import MAX_STEPS, AccuracyPane, AccuracyPoints
from tui.views.background import computed
from tui.views.view import StudyView


class AccuracyView(StudyView[AccuracyPane]):
    """Computes all points anew for another start or pendulum, and some more for another h."""

    def __init__(self, id: str) -> None:
        super().__init__(AccuracyPane(), id)
        self._start: object = None  # what the points over cost are for
        self._grown: object = None  # what the errors over time are for

    def compute_missing(self, source: Source) -> None:
        pane = self.pane
        scene = source.scene
        own = source.stepping.own
        if not scene.general:
            return
        every = with_all_methods(scene) if pane.all else scene
        start = (scene.theta, scene.omega, scene.equations, every.cast, pane.all)
        if start != self._start:
            self._start = start
            self._grown = None
            self.workers.cancel_node(self)
            pane.begin(AccuracyPoints(*usual(scene, pane.all)))
            self._begin_work("ladder", measured, every, pane.study.time, pane.study.steps)
        study = pane.study
        here = tuple(max(1, round(study.time / abs(h))) for h in own)
        if here != study.here:
            study.here = here
            known = {*study.steps, *(steps for _, steps in study.points)}
            if wanted := [steps for steps in sorted(set(here) - known) if 1 < steps <= MAX_STEPS]:
                self._begin_work("here", measured, scene, study.time, wanted)
        if pane.over_time and self._grown != (start, own):
            self._grown = (start, own)
            pane.growths = []
            self._begin_work("growth", growths, scene, own)

    def _begin_work(
        self, group: str, function: Callable[..., Iterator[Point | Growth]], *arguments: object
    ) -> None:
        self.compute(partial(self._fill, function, *arguments), group)

    async def _fill(
        self, function: Callable[..., Iterator[Point | Growth]], *arguments: object
    ) -> None:
        async for found in computed(function, *arguments):
            self.pane.add(found)
