"""Ghost: an earlier run laid under the lab, at the lab's own simulated time."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from engine.scenes import Scene
from tui.playback.history import ErrorHistory

if TYPE_CHECKING:
    from recordings.recording import Recording
    from tui.playback.rows import Window

MAX_ROWS = 1 << 14  # of a recording, 9 minutes of the usual samples, read in a second
ROUNDING = 1e-9  # s


class Ghost:
    """A run that ended."""

    def __init__(self, name: str, scene: Scene, history: ErrorHistory, steps: Sequence[float]):
        """`steps` are the sizes of its steps [s], in order."""
        self.scene = scene
        sizes = ", ".join(f"{abs(h):.4g}" for h in steps[:3])
        self._step = f"h {sizes}{' …' * (len(steps) > 3)} s"
        self._name = name
        self._window = history.window()
        self._x, self._thetas = history.rows.thetas()
        self.widest = float(np.nanmax(abs(self._thetas), initial=0.0))
        """The largest angle that it comes to [rad]."""

    @classmethod
    def recorded(cls, recording: "Recording") -> "Ghost":
        """The longest run of a recording, until time turns or MAX_ROWS are read."""
        run = max(recording.runs, key=lambda run: abs(run.t))
        history = ErrorHistory(run.scene, MAX_ROWS)
        exact = run.scene.exact()
        latest = -math.inf
        rows = 0
        for _, value in recording.samples_between(run.begin, run.end):
            if value.run > run.number or rows == MAX_ROWS:
                break
            if value.run < run.number or value.t == latest:
                continue
            if value.t < latest:
                break
            latest = value.t
            rows += 1
            history.add(value, exact.at(latest))
        return cls(recording.path.stem, run.scene, history, [run.scene.h])

    def label(self, room: int) -> str:
        """What it is: "dim: swing, h 0.1 s"."""
        text = f"dim: {self._name}, {self._step}"
        return text if len(text) <= room else f"dim: {self._step}"

    def rods(self, t: float) -> dict[str, float]:
        """Return the angles [rad] at a time [s] by method key, without those that failed."""
        row = int(np.searchsorted(self._x, t + ROUNDING, "right")) - 1
        if not self.scene.equations.rigid or row < 0 or t > self._x[-1] + abs(self.scene.h):
            return {}
        pairs = zip(self.scene.cast, self._thetas[row].tolist(), strict=True)
        return {method.key: theta for method, theta in pairs if not math.isnan(theta)}

    def window(self, until: float, seconds: float | None = None) -> "Window":
        """Its errors up to a simulated time [s]: the last `seconds`, or all."""
        return self._window.cut(
            -math.inf if seconds is None else until - seconds - self._window.repeats, until
        )
