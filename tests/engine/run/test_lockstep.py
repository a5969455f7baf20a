"""The lockstep as a machine: the same bits however it is driven, time that is never summed, nothing lost."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import USUAL_CAST, method_of
from engine.models.model import Phase
from engine.models.pendulum import acceleration, energy
from engine.run.compiled import available, compiled
from engine.run.lockstep import Lockstep
from engine.run.loops import PlainLoops
from engine.run.stepping import Stepping
from engine.scenes import LIMITS, SCENES, Scene, SceneError

scenes = st.builds(
    Scene,
    theta=st.floats(-7, 7),
    omega=st.floats(-20, 20),
    gravity=st.sampled_from([1.62, 9.81, 24.79]),
    h=st.floats(1e-3, 2.0),
)
h_values = st.floats(1e-3, 2.0) | st.floats(-2.0, -1e-3)
cuts = st.lists(st.integers(0, 60), min_size=1, max_size=8)
changes = st.lists(
    st.tuples(st.integers(0, 60), h_values), max_size=5
)  # advance so far, then use this h


def one_by_one(scene, n):
    lockstep = Lockstep(scene)
    samples = [lockstep.sample()]
    for _ in range(n):
        lockstep.advance(1)
        samples.append(lockstep.sample())
    return samples


def without_extremes(sample):
    """What does not depend on when the previous sample was taken."""
    readings = (
        reading._replace(energy_error_low=0.0, energy_error_high=0.0) for reading in sample.readings
    )
    return sample._replace(readings=tuple(readings))


@given(scene=scenes, cuts=cuts)
def test_the_steps_may_be_cut_anyhow_the_bits_are_the_same(scene, cuts):
    whole, pieces = Lockstep(scene), Lockstep(scene)
    whole.advance(sum(cuts))
    for n in cuts:
        pieces.advance(n)
    assert pieces.sample() == whole.sample()


@given(scene=scenes, cuts=cuts)
def test_looking_changes_nothing_but_since_when_extremes_are_taken(scene, cuts):
    watched, alone = Lockstep(scene), Lockstep(scene)
    for n in cuts:
        watched.advance(n)
        watched.sample()
    alone.advance(sum(cuts))
    assert without_extremes(watched.sample()) == without_extremes(alone.sample())


@given(scene=scenes, n=st.integers(0, 200))
def test_each_method_goes_where_the_textbooks_loop_goes_to_the_bit(scene, n):
    lockstep = Lockstep(scene)
    lockstep.advance(n)
    force = acceleration(scene.w0_squared)
    for method, reading in zip(USUAL_CAST, lockstep.sample().readings, strict=True):
        phase: Phase = (scene.theta, scene.omega)
        for _ in range(n):
            if abs(phase[0]) >= math.tau:
                return  # from there on theta is reduced
            phase = method.step(force, phase, scene.h)
        assert (reading.theta, reading.omega) == phase
        assert reading.energy == energy(scene.w0_squared, *phase)


@pytest.mark.parametrize("key", ["blanes_moan_6", "blanes_moan_4"])
def test_a_long_rotation_stays_in_the_band_of_its_first_turns(key):
    """Rounding of theta would grow with it: within 5e5 steps it carried these energies ten bands away."""
    scene = Scene(theta=-0.538, omega=6.554, h=0.318 / Scene().w0, cast=(method_of(key),))
    lockstep = Lockstep(scene, loops=compiled if available() else PlainLoops)
    bands = []
    for _ in range(2):
        lockstep.advance(250_000)
        (reading,) = lockstep.sample().readings
        bands.append((reading.energy_error_low, reading.energy_error_high))
    (low, high), (late_low, late_high) = bands
    assert late_low > low - 1e-12
    assert late_high < high + 0.01 * (high - low) + 1e-12
    assert abs(reading.theta) > 1e5  # unwrapped


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
            between = [sample.readings[index].energy_error for sample in steps[done : done + n + 1]]
            so_far = [abs(sample.readings[index].energy_error) for sample in steps[: done + n + 1]]
            assert (reading.energy_error_low, reading.energy_error_high) == (
                min(between),
                max(between),
            )
            assert reading.max_energy_error == max(so_far)
        done += n


def test_errors_are_relative_to_the_start_and_to_the_separatrix_from_rest():
    moving = Lockstep(Scene(theta=0.0, omega=1.0))
    moving.advance(10)
    reading = moving.sample().readings[0]
    assert reading.energy_error == (reading.energy - 0.5) / 0.5
    resting = Lockstep(Scene(theta=0.0))
    resting.advance(10)
    assert {reading.energy_error for reading in resting.sample().readings} == {0.0}


def test_time_reversed_verlet_comes_back_and_its_run_counts_on():
    scene = SCENES["drift"]
    lockstep = Lockstep(scene)
    lockstep.advance(200)
    lockstep.set_stepping(Stepping(-scene.h))
    lockstep.advance(200)
    sample = lockstep.sample()
    explicit, symplectic, verlet, rk4 = (
        abs(reading.theta - scene.theta) for reading in sample.readings
    )
    assert (sample.step, sample.t) == (400, 0)
    assert verlet < 1e-13  # rounding
    assert 1e-7 < rk4 < 1e-3 < 0.05 < symplectic < explicit


@pytest.mark.parametrize("h", [0.0, math.nan, math.inf, 1e9, -1e9, 1e-12])
def test_a_useless_step_size_is_refused_and_the_old_one_stays(h):
    lockstep = Lockstep(SCENES["drift"])
    lockstep.advance(3)
    with pytest.raises(SceneError, match="not a usable step"):
        lockstep.set_stepping(Stepping(h))
    assert (lockstep.stepping.h, lockstep.t) == (0.05, 3 * 0.05)


def exploding(force, phase, h):
    theta, omega = phase
    while True:
        theta, omega = theta + h * omega, omega + h * force(theta) + omega * omega * omega
        yield theta, omega


def falling_into_nan(force, phase, h):
    theta, omega = phase
    while True:
        theta, omega = (
            theta + h * omega,
            (omega + h * force(theta)) * (math.nan if abs(theta) < 0.5 else 1.0),
        )
        yield theta, omega


@pytest.mark.parametrize("phases", [exploding, falling_into_nan])
@given(cuts=cuts)
def test_a_method_that_diverges_stays_where_it_last_was_finite_and_the_others_go_on(phases, cuts):
    scene, n = SCENES["drift"], sum(cuts) + 100
    bad = replace(USUAL_CAST[0], key="bad", phases=phases)
    lockstep, others = Lockstep(replace(scene, cast=(bad, *USUAL_CAST))), Lockstep(scene)
    for cut in (*cuts, 100):
        lockstep.advance(cut)
    others.advance(n)
    sample = lockstep.sample()
    assert sample.readings[1:] == others.sample().readings

    frozen, phase, force = (
        sample.readings[0],
        (scene.theta, scene.omega),
        acceleration(scene.w0_squared),
    )
    assert frozen.diverged_at is not None
    last = round(frozen.diverged_at / scene.h) - 1
    for _ in range(last):
        phase = bad.step(force, phase, scene.h)
    assert (frozen.theta, frozen.omega) == phase
    assert frozen.diverged_at == (last + 1) * scene.h
    beyond = bad.step(force, phase, scene.h)
    assert (
        not all(map(math.isfinite, beyond)) or not abs(beyond[1]) < 1e149
    )  # a square beyond 1e300 is out, too
    assert all(map(math.isfinite, numbers(frozen)))


def numbers(reading):
    return [value for value in (*reading[:-1], *reading.extra.values()) if value is not None]


@given(
    **{name: st.floats(*limits) for name, limits in LIMITS.items()},
    z=st.floats(1e-8, 999),
    n=st.integers(1, 60),
)
def test_no_legal_start_gives_anything_but_finite_numbers(theta, omega, length, gravity, z, n):
    h = z / math.sqrt(gravity / length)
    lockstep = Lockstep(Scene(theta=theta, omega=omega, length=length, gravity=gravity, h=h))
    for step_size in (h, -h / 2):
        lockstep.set_stepping(Stepping(step_size))
        lockstep.advance(n)
        sample = lockstep.sample()
        assert all(
            math.isfinite(number)
            for reading in sample.readings
            for number in (sample.t, *numbers(reading))
        )
