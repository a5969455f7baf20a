"""AccuracyView: error over cost and over time for the pendulum on screen; the charts fill in as they are computed."""

import time
from collections.abc import Callable, Iterator
from functools import partial

from textual.app import ComposeResult

from engine.accuracy.growth import Growth, growths
from engine.accuracy.references import References, measured_front, with_all_methods
from engine.accuracy.study import Point, measured, usual
from engine.run.lockstep import Sample
from tui.views.accuracy.pane import MAX_STEPS, AccuracyPane, AccuracyPoints
from tui.views.background import computed
from tui.views.view import View

Found = Iterator[Point | References | Growth]
Start = tuple[object, ...]
"""theta, omega, the model and the methods: what the chart over cost depends on."""


class AccuracyView(View):
    """Computes all points anew for another start or pendulum, and some more for another h."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._start: Start | None = None
        self._grown: object = None  # what the errors over time are for

    def compose(self) -> ComposeResult:
        yield self.at_5_hz(AccuracyPane())

    def on_show(self) -> None:
        self.query_one(AccuracyPane).focus()

    def follow(self, sample: Sample, read: bool = True) -> None:
        if read:
            self._compute_missing()
        super().follow(sample, read)

    def _compute_missing(self) -> None:
        """Compute what is missing for the run on screen, if the view is shown."""
        if self.source is None or not self.display or not self.query(AccuracyPane):
            return
        pane, scene = self.query_one(AccuracyPane), self.source.scene
        if not scene.general:
            if self._start is not None:
                self._start = None
                self.workers.cancel_node(self)
                pane.begin(AccuracyPoints())
            return
        own, every = self.source.stepping.own, with_all_methods(scene) if pane.all else scene
        clock = (time.perf_counter,) if pane.all else ()
        start = (scene.theta, scene.omega, scene.equations, every.cast, pane.all)
        if start != self._start:
            self._start, self._grown = start, None
            self.workers.cancel_node(self)
            pane.begin(AccuracyPoints(*usual(scene, pane.all)))
            work = measured_front if pane.all else measured
            self._begin_work("ladder", work, every, pane.study.time, pane.study.steps, *clock)
        study = pane.study
        here = tuple(max(1, round(study.time / abs(h))) for h in own)
        if here != study.here:
            study.here = here
            known = {*study.steps, *(steps for _, steps in study.points)}
            if wanted := [steps for steps in sorted(set(here) - known) if 1 < steps <= MAX_STEPS]:
                self._begin_work("here", measured, scene, study.time, wanted, *clock)
        if pane.over_time and self._grown != (start, own):
            self._grown, pane.growths = (start, own), []
            self._begin_work("growth", growths, scene, own)

    def _begin_work(self, group: str, function: Callable[..., Found], *arguments: object) -> None:
        self.compute(partial(self._fill, function, *arguments), group)

    async def _fill(self, function: Callable[..., Found], *arguments: object) -> None:
        async for found in computed(function, *arguments):
            self.query_one(AccuracyPane).add(found)
