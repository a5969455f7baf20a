import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.methods import USUAL_CAST
from engine.models.model import State
from engine.models.pendulum import energy
from engine.run.lockstep import Lockstep, Reading, Sample
from engine.scenes import DEFAULT_SCENE, SCENES
from tui.drawing.palette import EXACT
from tui.playback.history import ErrorHistory
from tui.playback.shown import quantities

CAPACITY = 8  # small, so that few samples reach many levels


def sample(step, error=0.0, *, low=None, high=None, t=None, run=1, theta=0.0):
    reading = Reading(
        theta=theta,
        omega=-theta,
        energy=0.0,
        energy_error=error,
        max_energy_error=abs(error),
        energy_error_low=error if low is None else low,
        energy_error_high=error if high is None else high,
    )
    return Sample(run, step, 0.1 * step if t is None else t, (reading,) * len(USUAL_CAST))


def filled(samples, capacity=CAPACITY):
    history = ErrorHistory(DEFAULT_SCENE, capacity)
    for one in samples:
        history.add(one)
    return history


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=300))
def test_no_extreme_is_ever_lost(errors):
    window = filled(sample(step, error) for step, error in enumerate(errors)).window()
    assert window.low["energy_error"].min() == min(errors)
    assert window.high["energy_error"].max() == max(errors)


@given(st.integers(1, 1000), st.sampled_from([8, 16, 64]))
def test_every_sample_is_in_exactly_one_row_of_the_whole_run(count, capacity):
    """Each sample's error is its number, so a row's low and high are its first and last sample."""
    window = filled((sample(step, step) for step in range(count)), capacity).window()
    first, last = window.low["energy_error"][:, 0], window.high["energy_error"][:, 0]
    assert first.tolist() == [0, *(last[:-1] + 1)]
    assert last[-1] == count - 1
    assert len(window.x) <= 2 * capacity
    assert np.diff(window.x, prepend=0).max() < 0.3 + 0.1 * 2 * count / capacity


def test_recent_samples_are_kept_as_they_were_and_a_window_reaches_back_half_a_swing_more():
    window = filled((sample(step) for step in range(20_000)), capacity=64).window(1.0)
    assert np.allclose(np.diff(window.x), 0.1)
    assert window.x[-1] == pytest.approx(1999.9)
    assert window.x[0] == pytest.approx(1999.9 - 1.0 - window.repeats, abs=0.1)


def test_half_a_swing_is_what_errors_repeat_after_and_a_turn_in_rotation():
    assert filled([sample(0)]).window().repeats == pytest.approx(
        1.0696, abs=1e-4
    )  # T = 2.1391 s at 1 rad
    spin = ErrorHistory(SCENES["spin"])
    spin.add(sample(0))
    assert (
        0.7 < spin.window().repeats < 2 * math.pi / math.sqrt(64 - 4 * 9.81) * 1.01
    )  # between fastest and slowest omega
    rest = ErrorHistory(DEFAULT_SCENE.altered(theta=0.0))
    assert rest.window().repeats == 0


def test_the_same_sample_again_changes_nothing():
    history = filled([sample(0), sample(1, low=-1, high=1), sample(1, low=0, high=0)])
    assert history.window().high["energy_error"][:, 0].tolist() == [0, 1]


@given(st.integers(1, 400), st.data())
def test_an_earlier_sample_shows_the_past_and_the_way_forward_is_as_it_was(count, data):
    step = data.draw(st.integers(0, count - 1))
    capacity = data.draw(st.sampled_from([CAPACITY, 512]))
    history = filled((sample(step, step) for step in range(count)), capacity)
    whole = history.window().high["energy_error"]
    history.add(sample(step, step))
    known = history.window().high["energy_error"][:, 0]
    assert known[-1] == step
    assert np.all(np.diff(known) > 0)
    if capacity > count:
        assert known.tolist() == list(range(step + 1))
        assert history.thetas(0, 3) == [0.0] * min(3, step + 1)
    history.add(sample(count - 1, count - 1))
    assert np.array_equal(history.window().high["energy_error"], whole)


@given(st.integers(1, 400), st.data())
def test_a_run_that_goes_on_from_the_past_keeps_that_past(count, data):
    step = data.draw(st.integers(1, count))
    history = filled(sample(step, step) for step in range(count))
    history.add(sample(step, 1000, run=2))
    known = history.window().high["energy_error"][:, 0]
    longest = 2 ** math.ceil(math.log2(max((count + 1) / CAPACITY, 1)))
    assert known[-1] == 1000
    assert np.all(np.diff(known) > 0)
    assert step - (known[-2] if len(known) > 1 else 0) <= longest  # samples of the row that is cut


def test_a_sample_between_rows_leaves_with_its_frame():
    history = filled([sample(0, 0), sample(10, 10)])
    history.add(sample(13, 13, low=-99), is_row=False)
    assert history.window().low["energy_error"][:, 0].tolist() == [0, 10, 13]
    assert history.trails(2).shape[0] == 2
    history.add(sample(20, 20))
    assert history.window().low["energy_error"][:, 0].tolist() == [0, 10, 20]


def test_where_time_runs_backwards_rows_stay_in_the_order_in_which_they_were_run():
    history = filled(sample(step, t=t) for step, t in enumerate([0.0, 0.1, 0.2, 0.1, 0.0]))
    window = history.window()
    assert window.x == pytest.approx([0, 0.1, 0.2, 0.3, 0.4])
    assert window.t == pytest.approx([0, 0.1, 0.2, 0.1, 0.0])
    assert window.turned
    assert not filled([sample(0), sample(1)]).window().turned


def test_theta_errors_are_taken_against_the_exact_swing_and_unknown_without_it():
    history = ErrorHistory(DEFAULT_SCENE)
    history.add(sample(0, theta=1.0), State(0.75, 0.0))
    history.add(sample(1, theta=1.0))
    assert history.window().low["theta_error"][0, 0] == 0.25
    assert np.isnan(history.window().low["theta_error"][1, 0])


@settings(max_examples=30)
@given(st.sampled_from(sorted(SCENES)), st.integers(1, 5))
def test_energies_are_those_of_the_readings_also_where_friction_takes_them_and_in_a_spring(
    name, stride
):
    scene = SCENES[name]
    lockstep, history = Lockstep(scene), ErrorHistory(scene)
    history.add(lockstep.sample())
    for _ in range(20):
        lockstep.advance(stride)
        latest = lockstep.sample()
        history.add(latest)
    window = history.window()
    for index, reading in enumerate(latest.readings):
        low, high = window.low["energy"][-1, index], window.high["energy"][-1, index]
        tolerance = 1e-14 * max(
            abs(low), abs(high), energy(scene.w0_squared, scene.theta, scene.omega)
        )  # there and back
        assert low - tolerance <= reading.energy <= high + tolerance
        for variable in scene.equations.variables:
            if not variable.is_state:
                assert window.high[variable.name][-1, index] == reading.extra[variable.name]


def test_trails_are_the_last_states_of_methods_and_of_the_exact_swing():
    history = ErrorHistory(DEFAULT_SCENE, CAPACITY)
    for step in range(20):
        history.add(sample(step, theta=step), State(-step, 0.5))
    theta, omega = history.trails(3)[:, 2].T
    assert theta.tolist() == [17, 18, 19]
    assert omega.tolist() == [-17, -18, -19]
    assert history.trails(2)[:, EXACT].T[0].tolist() == [-18, -19]
    assert len(history.trails(100)[:, 0].T[0]) == CAPACITY


def test_an_angle_in_the_plane_is_off_by_half_a_turn_at_most():
    scene = SCENES["stiff-slow"]
    history = ErrorHistory(scene)
    reading = Reading(3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, extra={"spring_energy": 1.0})
    history.add(Sample(1, 0, 0.0, (reading,) * len(scene.cast)), State(-3.0, 0.0))
    assert history.window().low["theta_error"][0, 0] == pytest.approx(6 - math.tau)


def test_an_empty_history_has_empty_windows_and_trails():
    history = ErrorHistory(DEFAULT_SCENE)
    assert history.trails(5)[:, 0].T[0].size == 0
    assert all(
        history.window(seconds).low[quantity].shape == (0, 4)
        for quantity in quantities(DEFAULT_SCENE)
        for seconds in (None, 5.0)
    )
