"""Rows, trails and modified energies along a run, and where time is back at its start."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Scene
from pendu_tui.tui.playback.history import History

DRIFT = SCENES["drift"]
EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def run(
    scene: Scene, *stretches: tuple[int, float], equal_cost: bool = False, capacity: int = 4096
) -> History:
    """The history of a run with a sample each step: stretches of so many steps with this h."""
    course = RewindableRun(scene, 1)
    history = History(scene, course.changes, capacity)
    history.add(course.sample())
    for steps, h in stretches:
        course.change(Stepping(h, equal_cost, scene.cast))
        for _ in range(steps):
            course.forward(1)
            history.add(course.sample())
    return history


def sample(step, error=0.0, *, low=None, high=None, run=1):
    reading = Reading(
        theta=step,
        omega=-step,
        energy=0.0,
        energy_error=error,
        max_energy_error=abs(error),
        energy_error_low=error if low is None else low,
        energy_error_high=error if high is None else high,
    )
    return Sample(run, step, 0.1 * step, (reading,) * 4)


def filled(count, capacity=64, sign=1):  # small, so that few samples reach many levels
    """A history of so many samples; each one's error is its number, or less than 0."""
    history = History(DEFAULT_SCENE, RewindableRun(DEFAULT_SCENE).changes, capacity)
    for step in range(count):
        history.add(sample(step, sign * step))
    return history


def errors(history: History) -> list[float]:
    return history.window().high["energy_error"][:, 0].tolist()


@given(st.integers(1, 1000), st.sampled_from([64, 128]), st.sampled_from([1, -1]))
def test_every_sample_is_in_exactly_one_row_of_the_whole_run(count, capacity, sign):
    window = filled(count, capacity, sign).window()
    extremes = window.low["energy_error"][:, 0], window.high["energy_error"][:, 0]
    first, last = [sign * each for each in extremes[::sign]]
    assert first.tolist() == [0, *(last[:-1] + 1)]
    assert last[-1] == count - 1
    assert len(window.x) <= 2 * capacity
    assert np.diff(window.x, prepend=0).max() < 0.3 + 0.1 * 2 * count / capacity


def test_recent_samples_are_kept_as_they_were_and_a_window_reaches_back_half_a_swing_more():
    history = filled(2000)
    assert not np.isnan(history.window().low["shadow_error"][:, VERLET]).any()  # but of one sample
    window = history.window(1.0)
    assert window.x[[0, -1]] == pytest.approx([199.9 - 1.0 - window.repeats, 199.9], abs=0.1)
    assert np.allclose(np.diff(window.x), 0.1)


def test_errors_repeat_after_half_a_swing_and_a_turn_in_rotation():
    spin = SCENES["spin"]
    fastest, slowest = (math.tau / math.sqrt(64 - fall * 9.81) for fall in (0, 4))
    assert run(DRIFT).window().repeats == pytest.approx(2.1391 / 2, abs=1e-4)
    assert fastest < run(spin).window().repeats < slowest
    assert run(DRIFT.altered(theta=0.0)).window().repeats == 0


@given(st.integers(1, 1000), st.sampled_from([64, 1024]), st.data())
def test_an_earlier_sample_shows_the_past_and_the_way_forward_is_as_it_was(count, capacity, data):
    step = data.draw(st.integers(0, count - 1))
    history = filled(count, capacity)
    whole = errors(history)
    history.add(sample(step, step))
    known = errors(history)
    assert known[-1] == step
    assert np.all(np.diff(known) > 0)
    if capacity > count:
        assert known == list(range(step + 1))
        assert history.thetas(3)[0] == known[:-1][-3:]
    history.add(sample(count - 1, count - 1))
    assert errors(history) == whole


@given(st.integers(1, 1000), st.data())
def test_a_run_that_goes_on_from_the_past_keeps_that_past(count, data):
    step = data.draw(st.integers(1, count))
    history = filled(count)
    history.add(sample(step, step, low=-9, run=2))
    known = errors(history)
    longest = 2 * (count + 1) / 64 + 1
    assert known[-1] == step
    assert np.all(np.diff(known) > 0)
    assert step - max([0, *known[-2:-1]]) <= longest  # samples of the row that is cut
    for later in range(step + 1, step + 500):
        history.add(sample(later, later, run=2))
    assert errors(history)[-1] == step + 499
    assert history.window().low["energy_error"].min() >= 0  # without those of the whole run
    assert np.all(np.diff(history.window().x) > 0)


def test_a_sample_between_rows_leaves_with_its_frame():
    history = filled(1)
    history.add(sample(10, low=-9, high=10))
    history.add(sample(10))  # again
    history.add(sample(13, -13, low=-99), is_row=False)
    low = history.between(0.0, 99.0).low
    assert low["energy_error"][:, 0].tolist() == [0, -9, -13]
    start = DEFAULT_SCENE.equations.reference(DEFAULT_SCENE.theta, DEFAULT_SCENE.omega).start
    assert low["energy"][:, 0] == pytest.approx([start, -8 * start, -12 * start])
    assert len(history.trails()) == 3
    history.add(sample(20, 20))
    assert errors(history) == [0, 10, 20]


def test_the_largest_error_since_a_change_may_be_negative_and_lie_between_samples():
    history = filled(4)
    for later in (sample(4, low=-9, high=2), sample(5)):
        history.add(later)
    errors, _ = history.since(SteppingChange(3, 0.3, Stepping(0.1), 0.3))
    assert errors == [9] * 4
    history.add(sample(6, -7))
    errors, _ = history.since(SteppingChange(6, 0.6, Stepping(0.1), 0.65))
    assert errors == [7] * 4
    assert history.since(SteppingChange(-1, -0.1, Stepping(0.1), -0.1)) is None


def test_what_came_since_a_change_begins_behind_the_sample_at_it():
    until = run(DRIFT, (40, 0.05))
    history = run(DRIFT, (40, 0.05), (2, 0.2))
    _, thetas = history.since(history.changes[-1])
    assert thetas == until.window().high["theta_error"][-1].tolist()


def test_rows_that_merge_change_nothing_of_what_came_since_a_change():
    stretches = (40, 0.2), (400, 0.02)
    whole = run(DRIFT, *stretches)
    change = whole.changes[-1]
    assert run(DRIFT, *stretches, capacity=64).since(change) == whole.since(change)


def test_where_time_runs_backwards_rows_stay_in_the_order_in_which_they_were_run():
    window = run(DRIFT, (2, 0.1), (2, -0.1)).window()
    assert window.x == pytest.approx([0, 0.1, 0.2, 0.3, 0.4])
    assert window.t == pytest.approx([0, 0.1, 0.2, 0.1, 0.0])
    assert window.turned
    assert not run(DRIFT, (2, 0.1)).window().turned
    assert run(DRIFT, (40, 0.1), (1, -0.1)).window().turned


@pytest.mark.parametrize("name", ["drift", "damped", "mean-field", "spin", "stiff-slow"])
def test_rows_have_the_readings_energies_variables_and_theta_errors(name):
    scene = SCENES[name]
    model = scene.equations
    history = run(scene, (40, scene.h))
    window = history.window()
    exact = history.exact.at(history.sample.t)
    for index, reading in enumerate(history.sample.readings):
        low, high = window.low["energy"][-1, index], window.high["energy"][-1, index]
        start = model.reference(scene.theta, scene.omega).start
        tolerance = 1e-14 * max(abs(low), abs(high), start)  # there and back
        assert low - tolerance <= reading.energy <= high + tolerance
        off = model.theta_error(reading.theta, exact.theta)
        assert window.high["theta_error"][-1, index] == off
        for variable in model.variables:
            if variable.chart.title:
                assert window.high[variable.name][-1, index] == reading.extra[variable.name]


def test_trails_are_the_last_states_of_methods_and_of_the_exact_swing():
    history = filled(20)
    theta, omega = history.trails()[-3:, 2].T
    assert (theta.tolist(), omega.tolist()) == ([17, 18, 19], [-17, -18, -19])
    exact = [history.exact.at(0.1 * step) for step in (18, 19)]
    assert history.trails()[-2:, -1].tolist() == [list(state) for state in exact]
    assert len(history.trails()) == 20
    assert len(filled(400, capacity=512).trails()) == 300  # ten seconds


def largest(history: History, quantity: str = "shadow_error") -> np.ndarray:
    window = history.window()
    extremes = np.fmax(abs(window.low[quantity]), abs(window.high[quantity]))
    return np.fmax.reduce(extremes[2:], axis=0)


def test_a_modified_energy_is_flat_where_the_energy_wobbles():
    history = run(DRIFT, (400, 0.05))
    wobble, rest = (largest(history, quantity) for quantity in ("energy_error", "shadow_error"))
    for index in (SYMPLECTIC, VERLET):
        assert 0 < rest[index] < wobble[index] / 100
        known = history.window().high["shadow_error"][:, index]
        assert np.flatnonzero(np.isnan(known)).tolist() == [0]
        assert np.nanmin(known) == pytest.approx(-2.38e-5, rel=0.01)
    assert np.isnan(rest[[EXPLICIT, RK4]]).all()


def test_another_step_size_has_another_modified_energy_and_begins_anew():
    changed = largest(run(DRIFT, (100, 0.05), (100, 0.1)))
    alone = largest(run(DRIFT, (200, 0.1)))
    assert changed[VERLET] < 3 * alone[VERLET]  # counted from an end it is up to twice as large


def test_at_equal_cost_it_is_the_modified_energy_of_the_steps_really_taken():
    quarter = largest(run(DRIFT, (400, 0.05)))
    cut = largest(run(DRIFT, (100, 0.2), equal_cost=True))
    for index in (SYMPLECTIC, VERLET):  # the same orbit, looked at less often
        assert cut[index] == pytest.approx(quarter[index], rel=0.1)


def test_the_last_angles_before_a_row_are_known_without_numpy():
    history = filled(6)
    assert history.thetas(3)[0] == [2, 3, 4]
    history.add(sample(2))
    assert history.thetas(9)[0] == [0, 1]
    assert history._rows is None


def test_a_stretch_holds_both_its_ends():
    history = filled(200)
    window = history.between(15.0, 16.0)
    assert window.x[[0, -1]] == pytest.approx([15.0 - window.repeats, 16.0], abs=0.4)
    window = filled(20).window()
    assert window.cut(window.x[3], window.x[7]).x.tolist() == window.x[3:8].tolist()
    assert not window.cut(3.0, 2.0).turned
