"""What it takes to turn numbers into characters, beside a plain loop; and random charts that must not end the process.

Prints one JSON object.  Times are the least of several, in ms.
"""

import json
import sys
import time
from collections.abc import Callable

import numpy as np

from engine.methods import USUAL_CAST
from engine.run.lockstep import Lockstep
from engine.scenes import DEFAULT_SCENE
from tui.drawing.canvas import Canvas
from tui.drawing.picture import Picture
from tui.drawing.time_chart import time_chart
from tui.playback.history import ErrorHistory
from tui.playback.levels import Window
from tui.playback.shown import Shown
from tui.views.lab.pendulums import Bob, pendulum_picture

REACH = {  # times a plain loop in the same run, as milliseconds differ from machine to machine and from hour to hour
    "canvas_4x3000_points": 6.0,  # of inks at random: nearly each cell is a span of its own
    "chart_80x20": 8.0,
    "chart_160x40": 14.0,
}
FRAMES = 20_000
FUZZED = 3000
COUNT = len(USUAL_CAST)


def least(work: Callable[[], object], repeats: int = 30) -> float:
    """The shortest of some runs [ms]."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1e3 * min(times)


def scattered(random: np.random.Generator) -> Callable[[], Picture]:
    """Four times 3000 points on a canvas of 120×40 cells."""
    x, y = 240 * random.random((4, 3000)), 160 * random.random((4, 3000))

    def draw() -> Picture:
        canvas = Canvas(120, 40)
        for ink in range(4):
            canvas.scatter(x[ink], y[ink], ink)
        return canvas.picture()

    return draw


def long_run() -> tuple[ErrorHistory, float]:
    """A history of many frames, and what adding one took on average [ms]."""
    lockstep, exact, history = (
        Lockstep(DEFAULT_SCENE),
        DEFAULT_SCENE.exact(),
        ErrorHistory(DEFAULT_SCENE),
    )
    samples = []
    for _ in range(FRAMES):
        samples.append(lockstep.sample())
        lockstep.advance(1)
    states = [exact.at(sample.t) for sample in samples]
    began = time.perf_counter()
    for sample, state in zip(samples, states, strict=True):
        history.add(sample, state)
    return history, 1e3 * (time.perf_counter() - began) / FRAMES


def fuzz(random: np.random.Generator, builds: int) -> None:
    """Charts of whatever numbers, of whatever size."""
    awkward = np.array([np.nan, np.inf, -np.inf, 0.0, -0.0, 1e308, -1e308, 5e-324, 1e-17, 1.0])
    for _ in range(builds):
        count = int(random.integers(0, 300))
        values = random.normal(size=(2, count, COUNT)) * 10.0 ** random.integers(
            -20, 20, size=(1, 1, COUNT)
        )
        values = np.where(
            random.random(values.shape) < random.random() / 3,
            random.choice(awkward, values.shape),
            values,
        )
        x = np.cumsum(random.random(count) * 10.0 ** random.integers(-3, 6))
        window = Window(
            x=x,
            t=x,
            low={"energy_error": values.min(axis=0)},
            high={"energy_error": values.max(axis=0)},
            repeats=float(random.random()),
            turned=False,
        )
        width, height = (int(size) for size in random.integers(1, (200, 60)))
        log, seconds = (
            bool(random.integers(2)),
            None if random.integers(3) == 0 else float(10.0 ** random.uniform(-1, 6)),
        )
        assert time_chart(
            window, USUAL_CAST, Shown(log=log, seconds=seconds), width, height
        ).picture.rows


def main() -> None:
    """Measure and print."""
    random = np.random.default_rng(1)
    history, add = long_run()
    window, whole = history.window(20.0), history.window()
    trail = history.levels.trails(40)[:, 0].T[0].tolist()
    milliseconds = {
        "canvas_4x3000_points": least(scattered(random)),
        "chart_80x20": least(lambda: time_chart(window, USUAL_CAST, Shown(seconds=20.0), 80, 20)),
        "chart_160x40": least(lambda: time_chart(window, USUAL_CAST, Shown(seconds=20.0), 160, 40)),
        "chart_160x40_whole_run": least(lambda: time_chart(whole, USUAL_CAST, Shown(), 160, 40)),
        "chart_160x40_linear": least(
            lambda: time_chart(window, USUAL_CAST, Shown(seconds=20.0, log=False), 160, 40)
        ),
        "pendulum_23x18": least(lambda: pendulum_picture(23, 18, [Bob(1.0, 0, trail=trail)])),
        "history_add": add,
        "history_window_20_s": least(lambda: history.window(20.0)),
        "history_window_whole_run": least(lambda: history.window()),
    }
    fuzz(random, FUZZED)
    loop = least(lambda: sum(number * number for number in range(10_000)))
    ratios = {name: round(milliseconds[name] / loop, 2) for name in REACH}
    over = [name for name, most in REACH.items() if ratios[name] > most]
    print(
        json.dumps(
            {
                "bench": "pictures",
                "milliseconds": {name: round(value, 3) for name, value in milliseconds.items()},
                "milliseconds_of_a_plain_loop": round(loop, 3),
                "times_a_plain_loop": ratios,
                "reach": REACH,
                "over": over,
                "frames_in_history": FRAMES,
                "fuzzed_charts": FUZZED,
            }
        )
    )
    sys.exit(1 if over else 0)


if __name__ == "__main__":
    main()
