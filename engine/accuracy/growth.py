"""How fast the angle's error grows with time: the power of t, where it follows one.

A symplectic method's phase error grows as t, that of a method whose energy drifts as t²: Hairer, Lubich & Wanner,
Geometric Numerical Integration (2006), X.3.
"""

import numpy as np

from engine.methods import Method
from engine.phase_space.section import orbit
from engine.scenes import Scene

PERIODS, FEWEST = 100, 10  # of the motion that are followed; fewer, where the error becomes too large before
MOST_STEPS = 100_000
LARGEST = 0.4  # rad; larger errors no longer grow freely, for they begin to wrap
STRAIGHT, WHOLE = 0.05, 0.15  # largest departure of ln error from the line, and of its slope from a whole number
_LOOKS = 30  # in each period


def duration(scene: Scene) -> float | None:
    """For how long the error is followed [s]; None where the motion is not periodic or takes too many steps."""
    period = scene.exact().period
    if period is None or PERIODS * period / scene.h > MOST_STEPS or period < 4 * scene.h:
        return None
    return PERIODS * period


def growth(scene: Scene, method: Method) -> float | None:
    """The slope of ln |theta error| over ln t, of the largest error in each period; None: no one power."""
    exact, time = scene.exact(), duration(scene)
    if time is None or exact.period is None:
        return None
    steps, width = round(time / scene.h), exact.period / scene.h
    theta, _ = orbit(method, scene.equations, scene.h, (scene.theta, scene.omega), steps)
    if len(theta) <= steps:
        return None
    errors = []
    for number in range(1, PERIODS + 1):
        looks = np.linspace((number - 1) * width, min(number * width, steps), _LOOKS).astype(int).tolist()
        errors.append(max(abs(float(theta[k]) - exact.at(k * scene.h).theta) for k in looks))
        if errors[-1] >= LARGEST:
            errors.pop()
            break
    first = len(errors) * 3 // 10
    if len(errors) < FEWEST or min(errors) <= 0:
        return None
    x, y = np.log(np.arange(first, len(errors)) + 0.5), np.log(errors[first:])
    slope, start = np.polyfit(x, y, 1)
    is_power = np.abs(y - slope * x - start).max() < STRAIGHT and abs(slope - round(slope)) < WHOLE
    return float(slope) if is_power else None
