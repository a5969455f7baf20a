"""The lockstep has the same bits however it is driven, never sums time, and misses no extreme."""

import math

import mpmath as mp
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pendu_tui.engine.methods import METHODS, method_of
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.run.lockstep import Lockstep, _Track
from pendu_tui.engine.run.loops import compiled
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.recordings.format import without_extremes
from tests.models import EXAMPLES
from tests.truths import LIMITS

scenes = st.builds(
    Scene,
    theta=st.floats(-7, 7),
    omega=st.floats(-20, 20),
    gravity=st.sampled_from([1.62, 9.81, 24.79]),
    h=st.floats(1e-3, 2.0),
)
cuts = st.lists(st.integers(0, 30), min_size=1, max_size=6)
changes = st.lists(
    st.tuples(st.integers(0, 60), st.floats(1e-3, 2.0) | st.floats(-2.0, -1e-3)), max_size=5
)  # advance so far, then use this h


def one_by_one(scene, n):
    lockstep = Lockstep(scene)
    samples = [lockstep.sample()]
    for _ in range(n):
        lockstep.advance(1)
        samples.append(lockstep.sample())
    return samples


@pytest.mark.parametrize("scene", EXAMPLES.values(), ids=EXAMPLES)
@given(cuts=cuts)
def test_bits_do_not_depend_on_how_the_steps_are_cut_and_sampled(scene, cuts):
    whole, pieces, watched = Lockstep(scene), Lockstep(scene), Lockstep(scene)
    whole.advance(sum(cuts))
    for n in cuts:
        pieces.advance(n)
        watched.advance(n)
        watched.sample()
        watched = watched.copy()
    sample = whole.sample()
    assert pieces.sample() == sample
    assert without_extremes(watched.sample()) == without_extremes(sample)


def test_a_long_rotation_stays_in_the_band_of_its_first_turns():
    """Rounding of theta would grow with it, and carry the energy ten bands away by 5e5 steps."""
    cast = (method_of("blanes_moan_6"),)
    scene = Scene(theta=-0.538, omega=6.554, h=0.318 / Scene().w0, cast=cast)
    lockstep, largest = Lockstep(scene, loops=compiled), []
    for _ in range(2):
        lockstep.advance(250_000)
        (reading,) = lockstep.sample().readings
        largest.append(reading.max_energy_error)
    assert largest[1] < 1.01 * largest[0] + 1e-12
    assert abs(reading.theta) > 1e5  # unwrapped


@pytest.mark.parametrize(("theta", "turns"), [(6.28, 0), (6.29, 1), (-1e6, -159_155)])
def test_whole_turns_are_taken_off_with_all_digits_of_pi(theta, turns):
    track = _Track(None, (theta, 0.0), 0.0)
    track.reduce()
    with mp.workdps(40):
        rest = float(mp.mpf(theta) - 2 * mp.pi * turns)
    assert (track.turns, track.phase[0]) == (turns, pytest.approx(rest, abs=1e-15))


@given(scene=scenes, changes=changes)
def test_time_is_counted_from_the_last_change_of_h_and_never_summed(scene, changes):
    lockstep, base, h = Lockstep(scene), 0.0, scene.h
    for n, following in changes:
        for done in range(1, n + 1):
            lockstep.advance(1)
            assert lockstep.t == base + done * h
        base, h = base + n * h, following
        lockstep.set_stepping(Stepping(h))
        assert lockstep.t == base
    assert lockstep.step == sum(n for n, _ in changes)


@given(scene=scenes, cuts=cuts)
def test_no_extreme_of_the_energy_is_lost_between_samples(scene, cuts):
    lockstep, steps = Lockstep(scene), one_by_one(scene, sum(cuts))
    lockstep.sample()
    done = 0
    for n in cuts:
        lockstep.advance(n)
        for index, reading in enumerate(lockstep.sample().readings):
            errors = [sample.readings[index].energy_error for sample in steps[: done + n + 1]]
            band = min(errors[done:]), max(errors[done:])
            assert (reading.energy_error_low, reading.energy_error_high) == band
            assert reading.max_energy_error == max(map(abs, errors))
        done += n


def finite(reading):
    numbers = [value for value in (*reading[:-1], *reading.extra.values()) if value is not None]
    return all(map(math.isfinite, numbers))


def test_a_spring_energy_is_relative_to_its_start_and_an_invariants_error_the_largest_so_far():
    stiff, *_ = Lockstep(SCENES["stiff-slow"]).sample().readings
    assert (stiff.extra["spring_energy"], stiff.max_invariant_error) == (1, None)
    assert stiff.extra["y"] < 0  # not over its start
    scene = EXAMPLES["mean_field"]
    lockstep = Lockstep(scene)
    lockstep.advance(40)
    for index, reading in enumerate(lockstep.sample().readings):
        off = [step.readings[index].extra["probability_error"] for step in one_by_one(scene, 40)]
        assert reading.max_invariant_error == max(map(abs, off))


def test_from_a_tiny_start_relative_errors_stay_finite_too():
    lockstep = Lockstep(Scene(theta=1e-150, model="linear", h=100.0))
    lockstep.advance(1000)
    readings = lockstep.sample().readings
    assert all(map(finite, readings))
    assert readings[0].diverged_at is not None
    assert readings[0].energy_error > 1e290


@st.composite
def scenes_within_limits(draw):
    scene = EXAMPLES[draw(st.sampled_from([*MODELS]))]
    cast = tuple(method for method in METHODS if scene.model in method.models)
    numbers = {name: draw(st.floats(*limits)) for name, limits in LIMITS.items()}
    w0 = math.sqrt(numbers["gravity"] / numbers["length"])
    for each in MODELS[scene.model].parameters:
        numbers[each.name] = draw(st.floats(each.min, min(each.max, each.max_over_w0 * w0)))
    scene = scene.with_cast(cast).altered(**numbers, h=1e-8 / w0)
    h = draw(st.floats(1e-8, 999)) / w0
    if not scene.equations.conserves_energy:  # then each step asks for the exact motion
        _, exact_h = scene.equations.exact_step()
        h = min(h, 2000 * exact_h)
    return scene.altered(h=h)


@given(scene=scenes_within_limits())
@example(scene=EXAMPLES["spring"].altered(theta=0.0, omega=2e-313, stiffness=9.3e11, h=7.0))
def test_any_scene_within_the_limits_gives_finite_numbers(scene):
    lockstep = Lockstep(scene)
    lockstep.advance(3)
    for reading in lockstep.sample().readings:
        assert finite(reading)
        assert {type(reading.theta), type(reading.omega), type(reading.energy)} == {float}
