"""Ghost: a recording laid under the lab, at the lab's own simulated time."""

import math
from array import array
from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

from tui.playback.history import ErrorHistory

if TYPE_CHECKING:
    from recordings.recording import Recording
    from tui.playback.rows import Window

ROWS = 1 << 14  # of the chart at full resolution, 9 minutes of the usual samples
MAX_SAMPLES = 50_000  # half an hour, read in three seconds
ROUNDING = 1e-9  # s


class Rod(NamedTuple):
    """A pendulum of the ghost."""

    theta: float  # rad
    length: float  # over that at rest


class Ghost:
    """Return the longest run, up to its time's turn or MAX_SAMPLES."""

    def __init__(self, recording: "Recording") -> None:
        run = max(recording.runs, key=lambda run: abs(run.t))
        self.scene = run.scene
        self._name = recording.path.stem
        self._history = ErrorHistory(run.scene, ROWS)
        # s; theta and length of each method in turn
        self._times, self._rods = array("d"), array("d")
        exact = run.scene.exact()
        latest = -math.inf
        for _, value in recording.samples_between(run.begin, run.end):
            if value.run > run.number or len(self._times) == MAX_SAMPLES:
                break
            if value.run < run.number or value.t == latest:
                continue
            if value.t < latest:
                break
            latest = value.t
            self._times.append(latest)
            self._history.add(value, exact.at(latest))
            for reading in value.readings:
                length = run.scene.equations.length(reading.extra)
                self._rods.extend(
                    (reading.theta if reading.diverged_at is None else math.nan, length)
                )
        thetas = [abs(theta) for theta in self._rods[::2] if not math.isnan(theta)]
        self.widest = max(thetas, default=0.0)
        """The largest angle that it comes to [rad]."""
        self._window: Window | None = None

    def label(self, room: int) -> str:
        """What it is, in so many columns: "dim: swing, h 0.1 s"."""
        short = f"dim: h {self.scene.h:.4g} s"
        text = f"dim: {self._name}, h {self.scene.h:.4g} s"
        return text if len(text) <= room else short

    def rods(self, t: float) -> dict[str, Rod]:
        """The pendulums by method key at a time [s]; failed ones and finished runs are missing."""
        if not self._times or not 0 <= t <= self._times[-1] + abs(self.scene.h):
            return {}
        count = 2 * len(self.scene.cast)
        at = bisect_right(self._times, t + ROUNDING) - 1
        row = self._rods[count * at : count * (at + 1)]
        rods = {
            method.key: Rod(*row[2 * place : 2 * place + 2])
            for place, method in enumerate(self.scene.cast)
        }
        return {key: rod for key, rod in rods.items() if not math.isnan(rod.theta)}

    def window(self, until: float, seconds: float | None = None) -> "Window":
        """Its errors up to a simulated time [s]: the last `seconds`, or all."""
        self._window = self._window or self._history.window()
        return self._window.cut(
            -math.inf if seconds is None else until - seconds - self._window.repeats, until
        )
