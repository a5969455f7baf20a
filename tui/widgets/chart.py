"""TimeChart: a quantity of all methods over time."""

import asyncio
from functools import partial

from textual.reactive import var

from engine.lockstep import Sample
from tui.charts import time_chart
from tui.history import Quantity
from tui.look import Look
from tui.source import Source
from tui.widgets.rows import Rows

NAMES: dict[Quantity, str] = {
    "energy_error": "energy error dE/E0",
    "theta_error": "theta - exact theta [rad]",
    "shadow_error": "shadow energy error",
    "energy": "energy per m L² [1/s²]",
}


class TimeChart(Rows):
    """The chart.  It is built in a thread, always from the newest data; what comes too quickly is left out."""

    source: var[Source | None] = var(None)
    sample: var[Sample | None] = var(None)
    look: var[Look] = var(Look())

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id)
        self._wanted = asyncio.Event()
        self._building = False

    @property
    def settled(self) -> bool:
        """Whether the chart shows the newest data."""
        return not (self._building or self._wanted.is_set())

    def on_mount(self) -> None:
        """Build from the first paint on: plotext takes as long to import as all else takes to paint."""
        self.call_after_refresh(self._start)

    def _start(self) -> None:
        self.run_worker(self._build_on_demand(), group="chart")

    def watch_sample(self) -> None:
        """Follow the sample."""
        self.draw()

    def watch_look(self) -> None:
        """Follow the settings."""
        look = self.look
        name, span = NAMES[look.quantity], "whole run" if look.seconds is None else f"{look.seconds:g} s"
        self.border_title = f"{f'|{name}|, log' if look.log else name} - {span}"
        self.draw()

    def draw(self) -> None:
        """Ask for a chart."""
        if self.source is not None and self.drawable:
            self._wanted.set()

    async def _build_on_demand(self) -> None:
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            if self.source is None or not self.drawable:
                continue
            self._building = True
            look, (width, height) = self.look, self.room
            build = partial(time_chart, log=look.log, seconds=look.seconds, shown=look.indices)
            window = self.source.history.window(look.seconds)
            self.show_picture(await asyncio.to_thread(build, window, look.quantity, width, height))
            self._building = False
