"""Ghost: the run before a restart, for the pictures."""

import math

import numpy as np

from pendu_tui.tui.playback.history import History
from pendu_tui.tui.playback.rows import Window


class Ghost:
    """The run before a restart, laid under the lab at the same simulated time."""

    def __init__(self, history: History) -> None:
        self.scene = history.scene
        steps = dict.fromkeys(f"{abs(change.stepping.h):.4g}" for change in history.changes)
        self.label = f"dim: before, h {', '.join(steps)} s"
        self._window = history.window()
        recent = history.rows.recent
        failed = ~np.isfinite(recent["high"][:, 0])
        self._x = recent["x"]
        self._thetas = np.where(failed, math.nan, recent["states"][:, :-1, 0])
        self.widest = float(np.nanmax(abs(self._thetas), initial=0.0))
        """The largest angle that it comes to [rad]."""

    def rods(self, t: float) -> dict[str, float]:
        """Return the angles [rad] at a time [s] by method key, without failed methods."""
        row = int(np.searchsorted(self._x, t + 1e-9, "right")) - 1
        if not self.scene.equations.rigid or row < 0 or t > self._x[-1] + abs(self.scene.h):
            return {}
        pairs = zip(self.scene.cast, self._thetas[row].tolist(), strict=True)
        return {method.key: theta for method, theta in pairs if not math.isnan(theta)}

    def window(self, until: float, seconds: float | None = None) -> Window:
        """Return its errors up to a simulated time [s], of the last `seconds` or all."""
        back = (seconds or math.inf) + self._window.repeats
        return self._window.cut(until - back, until)
