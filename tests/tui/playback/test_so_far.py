"""Modified energies along a run, and what a return to t = 0 shows."""

import math
from pathlib import Path

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.run.rewindable import RewindableRun
from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene
from recordings.recording import Recording
from tests.tui.harness import recorded
from tui.playback.history import ErrorHistory
from tui.playback.live import Live
from tui.playback.marks import Marks
from tui.playback.replay import Replay
from tui.playback.so_far import RunSoFar

DRIFT = SCENES["drift"]
INDEX = {method.key: i for i, method in enumerate(USUAL_CAST)}


def run(scene: Scene, *stretches: tuple[int, float], equal_cost: bool = False) -> ErrorHistory:
    """The history of a run, a sample a step."""
    course = RewindableRun(scene, 1)
    so_far = RunSoFar(scene, course.changes)
    so_far.add(course.sample())
    for steps, h in stretches:
        course.set_stepping(Stepping(h, equal_cost))
        for _ in range(steps):
            course.forward(1)
            so_far.add(course.sample())
    return so_far.history


def largest(history: ErrorHistory, quantity: str) -> np.ndarray:
    window = history.window()
    return np.nanmax(np.fmax(abs(window.low[quantity]), abs(window.high[quantity]))[2:], axis=0)


@pytest.mark.filterwarnings("ignore:All-NaN")
def test_the_shadow_energy_is_flat_where_the_energy_wobbles_and_explains_it_to_fourth_order():
    energy_range, rest = {}, {}
    for h in (0.05, 0.025):
        history = run(DRIFT, (int(20 / h), h))
        energy_range[h], rest[h] = (
            largest(history, "energy_error"),
            largest(history, "shadow_error"),
        )
    for key in ("symplectic_euler", "velocity_verlet"):
        i = INDEX[key]
        assert rest[0.05][i] < energy_range[0.05][i] / 100
        # h⁴, measured 3.99 and 4.00; ±0.1 as for all orders here
        assert math.log2(rest[0.05][i] / rest[0.025][i]) == pytest.approx(4, abs=0.1)
    assert math.log2(
        energy_range[0.05][INDEX["velocity_verlet"]] / energy_range[0.025][INDEX["velocity_verlet"]]
    ) == pytest.approx(2, abs=0.1)


def test_a_method_without_a_shadow_energy_shows_none():
    window = run(DRIFT, (10, 0.05)).window()
    for key in ("explicit_euler", "rk4"):
        assert np.isnan(window.high["shadow_error"][:, INDEX[key]]).all()


@pytest.mark.filterwarnings("ignore:All-NaN")
def test_another_step_size_has_another_shadow_energy_and_begins_anew():
    history = run(DRIFT, (100, 0.05), (100, 0.1))
    alone = largest(run(DRIFT, (200, 0.1)), "shadow_error")
    i = INDEX["velocity_verlet"]
    assert (
        largest(history, "shadow_error")[i] < 3 * alone[i]
    )  # a wobble counted from an end is up to twice as large


@pytest.mark.filterwarnings("ignore:All-NaN")
def test_at_equal_cost_it_is_the_shadow_energy_of_the_steps_really_taken():
    quarter = largest(run(DRIFT, (400, 0.05)), "shadow_error")
    cut = largest(run(DRIFT, (100, 0.2), equal_cost=True), "shadow_error")
    for key in ("symplectic_euler", "velocity_verlet"):
        # the same orbit, looked at less often: the extremes of a smooth wobble are met within some percent
        assert cut[INDEX[key]] == pytest.approx(quarter[INDEX[key]], rel=0.1)


def test_a_replay_shows_what_the_lab_showed(tmp_path: Path):
    live: list[Live] = []
    path = recorded(
        tmp_path / "sitting.mcap",
        live.append,
        2.0,
        lambda lab: lab.set_stepping(Stepping(0.1, True)),
        2.0,
        lambda lab: lab.set_stepping(Stepping(0.1)),
        1.0,
    )
    replay = Replay(Recording.open(path), Marks(path), clock=lambda: 0.0)
    replay.seek(replay.length)
    for frame in range(100):
        replay.tick(frame / 30)
    shown, was = replay.history.window(), live[0].history.window()
    replay.close()
    assert np.array_equal(shown.x, was.x)
    for quantity in ("shadow_error", "energy_error"):
        assert np.array_equal(shown.high[quantity], was.high[quantity], equal_nan=True)


def test_an_overflow_is_unknown_not_infinite():
    history = run(Scene(theta=0.1, length=9.81, h=2.9), (3000, 2.9))
    assert not np.isinf(history.window().high["shadow_error"]).any()


def test_there_and_back_is_noticed_where_time_is_at_its_start_again():
    history = run(DRIFT, (200, 0.05), (199, -0.05))
    assert history.returned is None
    history = run(DRIFT, (200, 0.05), (230, -0.05))
    assert history.returned is not None
    assert history.returned.step == 400
    history.add(history.returned._replace(step=399))
    assert history.returned is None


def test_time_that_does_not_come_by_its_start_does_not_return():
    assert run(DRIFT, (10, 0.05), (40, -0.03)).returned is None
