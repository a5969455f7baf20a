"""How fast the error in theta grows with time, and which power of t it follows, if any.

The phase error of a symplectic method grows as t; that of a method whose energy drifts, as t².
Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), X.3.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from pendu_tui.engine.methods import Method
from pendu_tui.engine.phase_space.section import orbit
from pendu_tui.engine.scenes import Scene

PERIODS = 100  # followed at most
LARGEST = 0.4  # rad; larger errors begin to wrap


@dataclass(frozen=True, slots=True)
class Growth:
    """How the error in theta of one method grows."""

    method: Method
    times: list[float]  # s, the middle of each period
    errors: list[float]  # rad, the largest |error| in each, while it is below LARGEST
    power: float | None  # slope of ln error over ln t; None: no single power of t

    @property
    def name(self) -> str:
        """The method's label, with its power of t if there is one."""
        if self.power is None:
            return self.method.label
        return f"{self.method.label} t^{self.power:.2f}"


def duration(scene: Scene) -> float | None:
    """Return how long to follow the error [s]; None: no period, or too many or too few steps."""
    period = scene.exact().period
    if period is None or PERIODS * period / scene.h > 100_000 or period < 4 * scene.h:
        return None
    return PERIODS * period


def growth(scene: Scene, method: Method) -> Growth:
    """Return how a method's error grows over at most PERIODS periods."""
    exact = scene.exact()
    time = duration(scene)
    if time is None or exact.period is None:
        return Growth(method, [], [], None)
    steps = round(time / scene.h)
    width = exact.period / scene.h
    theta, _ = orbit(method, scene.equations, scene.h, (scene.theta, scene.omega), steps)
    errors: list[float] = []
    for number in range(1, PERIODS + 1):
        ends = (number - 1) * width, min(number * width, steps)
        looks = np.linspace(*ends, 30).astype(int).tolist()
        if looks[-1] >= len(theta):  # the numbers have overflowed
            break
        errors.append(max(abs(float(theta[k]) - exact.at(k * scene.h).theta) for k in looks))
        if errors[-1] >= LARGEST:
            errors.pop()
            break
    times = [(number + 0.5) * exact.period for number in range(len(errors))]
    return Growth(method, times, errors, _power(times, errors))


def growths(scene: Scene, own: Sequence[float]) -> Iterator[Growth]:
    """Yield the growth of each method's error at its own h [s]; for another process."""
    return (
        growth(scene.altered(h=abs(h)), method) for method, h in zip(scene.cast, own, strict=True)
    )


def _power(times: Sequence[float], errors: Sequence[float]) -> float | None:
    """Return the slope of ln error over ln t if it is straight and near an integer."""
    first = len(errors) * 3 // 10
    if len(errors) < 10 or min(errors) <= 0:
        return None
    x = np.log(times[first:])
    y = np.log(errors[first:])
    slope, start = np.polyfit(x, y, 1)
    if np.abs(y - slope * x - start).max() >= 0.05 or abs(slope - round(slope)) >= 0.15:
        return None
    return float(slope)
