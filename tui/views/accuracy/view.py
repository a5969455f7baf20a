"""AccuracyView: cost against accuracy for the pendulum on screen; the chart fills in as it is computed."""

from collections.abc import Sequence
from functools import partial

from textual.app import ComposeResult

from engine.accuracy.study import measured, usual
from engine.scenes import Scene
from tui.views.accuracy.pane import KEYS, MOST_STEPS, AccuracyPane
from tui.views.background import computed
from tui.views.view import View

Start = tuple[object, ...]
"""theta, omega, the model and the cast: what the chart depends on."""


class AccuracyView(View):
    """Computes all points anew for another start or pendulum, and some more for another h."""

    KEYS = KEYS

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._start: Start | None = None

    def compose(self) -> ComposeResult:
        yield AccuracyPane().data_bind(View.source, View.shown, sample=View.sample_10hz)

    def on_mount(self) -> None:
        self.query_one(AccuracyPane).focus()
        self.watch_sample_10hz()

    def watch_sample_10hz(self) -> None:
        """Compute what is missing for the run on screen, if the view is shown."""
        if self.source is None or not self.display or not self.query(AccuracyPane):
            return
        pane, scene = self.query_one(AccuracyPane), self.source.scene
        if not scene.general:
            if self._start is not None:
                self._start = None
                self.workers.cancel_node(self)
                pane.begin(0.0, ())
            return
        start = (scene.theta, scene.omega, scene.equations, scene.cast)
        if start != self._start:
            self._start = start
            self.workers.cancel_node(self)
            pane.begin(*usual(scene))
            self._measure(scene, pane.time, pane.rungs, "ladder")
        here = tuple(max(1, round(pane.time / abs(h))) for h in self.source.stepping.own)
        if here != pane.here:
            pane.here = here
            known = {*pane.rungs, *(steps for _, steps in pane.points)}
            if wanted := [steps for steps in sorted(set(here) - known) if 1 < steps <= MOST_STEPS]:
                self._measure(scene, pane.time, wanted, "here")

    def _measure(self, scene: Scene, time: float, rungs: Sequence[int], group: str) -> None:
        self.compute(partial(self._add_points, scene, time, rungs), group)

    async def _add_points(self, scene: Scene, time: float, rungs: Sequence[int]) -> None:
        async for point in computed(measured, scene, time, rungs):
            self.query_one(AccuracyPane).add(point)
