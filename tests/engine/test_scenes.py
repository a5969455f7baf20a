"""A scene is validated where it is made, and what it tells people to watch is measured."""

import math
from dataclasses import replace
from itertools import pairwise
from statistics import fmean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.run.lockstep import Lockstep
from engine.run.stepping import Stepping
from engine.scenes import (
    DEFAULT_SCENE,
    GROUPS,
    LIMITS,
    SCENES,
    Z_LIMITS,
    Scene,
    SceneError,
    check_h,
)

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def watch(name, seconds, every=1):
    """A sample at every step, or at one of so many."""
    lockstep = Lockstep(SCENES[name])
    samples = [lockstep.sample()]
    while lockstep.t < seconds:
        lockstep.advance(every)
        samples.append(lockstep.sample())
    return samples


def over_the_top(samples, method):
    """When it first was above the pivot [s]; inf: never."""
    over = (sample.t for sample in samples if abs(sample.readings[method].theta) > math.pi)
    return next(over, math.inf)


def worst(samples, method):
    return max(abs(sample.readings[method].energy_error) for sample in samples)


@pytest.mark.parametrize("field", LIMITS)
def test_a_value_beyond_its_limits_is_refused_in_a_sentence(field):
    low, high = LIMITS[field]
    beyond = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
    for value in (*beyond, math.nan, math.inf, -math.inf):
        with pytest.raises(SceneError, match=rf"^{field} = .* is out of range; use .* to .*\.$"):
            Scene(**{field: value})


@pytest.mark.parametrize("h", [0.0, -0.05, math.nan, math.inf, -math.inf, 1e9, 1e-12])
def test_a_step_size_that_leads_nowhere_is_refused_and_a_good_one_is_named(h):
    with pytest.raises(SceneError, match=r"^h = .* is not a usable step; .* for example 0\.05\.$"):
        Scene(h=h)


@given(length=st.floats(*LIMITS["length"]), gravity=st.floats(*LIMITS["gravity"]))
def test_the_step_size_that_the_sentence_names_is_usable(length, gravity):
    w0 = math.sqrt(gravity / length)
    with pytest.raises(SceneError) as refusal:
        Scene(length=length, gravity=gravity, h=1e3 * Z_LIMITS[1] / w0)
    example = float(str(refusal.value).split()[-1].rstrip("."))
    assert Scene(length=length, gravity=gravity, h=example).h == example


@given(**{name: st.floats(*limits) for name, limits in LIMITS.items()}, z=st.floats(1e-8, 999))
def test_everything_within_the_limits_is_a_scene(z, **start):
    scene = Scene(**start, h=z / math.sqrt(start["gravity"] / start["length"]))
    assert scene.z == pytest.approx(z, rel=1e-15)  # a quotient and a product
    check_h(-scene.h, scene.w0)  # time may run backwards later


def test_a_scene_keeps_its_name_only_while_nothing_is_changed():
    scene = SCENES["spin"]
    assert scene.altered(omega=scene.omega) is scene
    changed = scene.altered(omega=9.0)
    assert (changed.name, changed.watch, changed.omega, changed.h) == ("custom", "", 9.0, scene.h)


def test_every_scene_has_its_name_and_group_and_says_what_to_watch():
    assert SCENES["drift"] == DEFAULT_SCENE
    assert [scene for group in GROUPS.values() for scene in group] == list(SCENES.values())
    for name, scene in SCENES.items():
        assert scene.name == name
        assert 20 < len(scene.watch) <= 79  # a line of the smallest terminal, and a blank


# What the scenes tell people to watch.


def test_drift_explicit_euler_gains_the_symplectic_ones_keep_rk4_loses():
    samples = watch("drift", 120)
    middle, last = samples[len(samples) // 2].readings, samples[-1].readings
    assert over_the_top(samples, EXPLICIT) == pytest.approx(7.15)
    assert worst(samples, SYMPLECTIC) < 0.08
    assert worst(samples, VERLET) < 0.006
    assert last[EXPLICIT].energy_error > middle[EXPLICIT].energy_error > 10
    # steadily
    assert last[RK4].energy_error == pytest.approx(2 * middle[RK4].energy_error, rel=0.05)
    assert -4e-4 < last[RK4].energy_error < -3e-4


def test_gentle_the_textbooks_formulas_hold():
    scene, samples = SCENES["gentle"], watch("gentle", 60)
    z, last = scene.z, samples[-1]
    # theta²/16 longer
    assert scene.exact().period == pytest.approx(2 * math.pi / scene.w0, rel=1e-3)
    for step in (1, 40):
        growth = samples[step].readings[EXPLICIT].energy_error
        assert growth == pytest.approx((1 + z**2) ** step - 1, rel=0.02)
    assert last.readings[RK4].energy_error / last.step == pytest.approx(-(z**6) / 72, rel=0.02)
    assert worst(samples, VERLET) == pytest.approx(z**2 / 4, rel=0.02)


def test_linear_theory_is_exact_at_any_size():
    samples, z = watch("linear", 20), 0.5
    assert SCENES["linear"].z == z
    for before, after in pairwise(samples):
        ratios = [
            now.energy / then.energy
            for then, now in zip(before.readings, after.readings, strict=True)
        ]
        assert ratios[EXPLICIT] == pytest.approx(1 + z**2, rel=1e-14)  # 25 %
        assert ratios[RK4] == pytest.approx(1 - z**6 / 72 + z**8 / 576, rel=1e-14)
    # it swings between 1 - z²/4 and 1
    assert worst(samples, VERLET) == pytest.approx(z**2 / 4, rel=0.02)
    # 1/(1 + z/2) and 1/(1 - z/2)
    assert worst(samples, SYMPLECTIC) == pytest.approx(1 / (1 - z / 2) - 1, rel=0.02)


def test_large_swing_is_slow_and_explicit_euler_never_finishes_its_first():
    scene, samples = SCENES["large-swing"], watch("large-swing", 10)
    period = scene.exact().period
    assert period * scene.w0 / math.tau == pytest.approx(1.643, abs=1e-3)
    assert math.degrees(scene.theta) == pytest.approx(143, abs=0.5)
    assert over_the_top(samples, EXPLICIT) < period
    assert {over_the_top(samples, method) for method in (SYMPLECTIC, VERLET, RK4)} == {math.inf}


def test_crossover_rk4_starts_far_ahead_of_verlet_and_falls_behind_after_half_a_minute():
    samples = watch("crossover", 60)
    errors = [[reading.max_energy_error for reading in sample.readings] for sample in samples]
    behind = [error[RK4] > error[VERLET] for error in errors]
    assert samples[behind.index(True)].t == pytest.approx(33.4)
    assert all(behind[behind.index(True) :])
    swing = [sample for sample in samples if sample.t < 2.2]
    assert worst(swing, RK4) < worst(swing, VERLET) / 10


@pytest.mark.parametrize(
    ("name", "seconds", "least", "most"),
    [("crossover", 600, 0, 1e-11), ("chaos-fenced", 200, 0.1, 100)],
)
def test_turned_round_verlet_comes_back_but_not_in_chaos(name, seconds, least, most):
    scene, lockstep = SCENES[name], Lockstep(SCENES[name])
    for h in (scene.h, -scene.h):
        lockstep.set_stepping(Stepping(h))
        lockstep.advance(round(seconds / scene.h))
    verlet = lockstep.sample().readings[VERLET]
    assert least <= math.hypot(verlet.theta - scene.theta, verlet.omega / scene.w0) < most


def test_near_separatrix_the_best_energy_does_not_mean_the_right_time():
    exact, samples = SCENES["near-separatrix"].exact(), watch("near-separatrix", 120)

    def late(method):
        off = (s.t for s in samples if abs(s.readings[method].theta - exact.at(s.t).theta) > 1)
        return next(off, math.inf)

    assert worst(samples, RK4) < 1e-6 < 1e-4 < worst(samples, VERLET) < worst(samples, SYMPLECTIC)
    assert late(RK4) == pytest.approx(29.4, abs=0.1)
    assert late(VERLET) == late(SYMPLECTIC) == math.inf


def test_spin_symplectic_euler_and_verlet_show_the_same_angle_a_turn_a_second():
    """Half a kick apart they are one method; at the bottom, where this starts, the kick is 0."""
    samples = watch("spin", 60)
    last = samples[-1].readings
    for _, euler, verlet, _ in (sample.readings for sample in samples):
        assert euler.theta == pytest.approx(verlet.theta, abs=1e-10)  # 3000 roundings
    assert abs(last[SYMPLECTIC].omega - last[VERLET].omega) > 1e-3
    assert SCENES["spin"].exact().period == pytest.approx(1, abs=0.02)
    assert [round(reading.theta / math.tau) for reading in last] == [94, 61, 61, 61]


def test_euler_caught_half_a_turn_a_step_holds_explicit_euler_near_110_times_its_energy():
    scene, lockstep = SCENES["euler-caught"], Lockstep(SCENES["euler-caught"], judged=True)
    turns, energies = [], []
    while lockstep.t < 10 * scene.speed:  # seconds of watching
        lockstep.advance(10)
        euler = lockstep.sample().readings[EXPLICIT]
        turns.append(abs(euler.omega) * scene.h / math.tau)  # a step
        energies.append(1 + euler.energy_error)
    half = len(turns) // 2
    assert max(turns[: half // 10]) < 0.3 < 0.45 < min(turns[half:])
    assert fmean(turns[half:]) == pytest.approx(0.5, abs=0.005)
    assert 100 < min(energies[half:]) < max(energies[half:]) < 120  # it wobbles
    caught = (math.pi / scene.h) ** 2 / 2 + scene.w0_squared  # as long above the pivot as below
    start = scene.equations.energy()((1.0, 0.0))
    assert fmean(energies[half:]) == pytest.approx(caught / start, rel=0.02)
    assert fmean(energies[half:]) == pytest.approx(110, abs=2)
    assert lockstep.judgements[EXPLICIT].verdict == "caught"


def test_verlet_limit_verlet_loses_98_percent_and_has_it_back_every_11_steps():
    samples = watch("verlet-limit", 2000)
    errors = [sample.readings[VERLET].energy_error for sample in samples]
    assert -0.981 < min(errors) < -0.97
    assert max(errors) == 0
    for start in range(0, 990, 11):  # a swing back to the full energy within any 11 steps, to 6 %
        assert max(errors[start : start + 11]) > -0.06


def test_verlet_limit_above_verlet_leaves_the_bottom_and_is_caught():
    samples = watch("verlet-limit-above", 4_000)
    amplitudes = [abs(sample.readings[VERLET].theta) for sample in samples]
    assert max(amplitudes) == pytest.approx(0.48, abs=0.005)
    assert max(amplitudes[:20]) > 0.45


def test_rk4_limit_rk4_loses_half_its_energy_in_four_steps_and_the_others_go_over_the_top():
    samples = watch("rk4-limit", 300)
    assert samples[4].readings[RK4].energy_error == pytest.approx(-0.5, abs=0.01)
    assert samples[8].readings[RK4].energy_error == pytest.approx(-0.74, abs=0.01)
    assert all(over_the_top(samples, method) < 20 for method in (EXPLICIT, SYMPLECTIC, VERLET))
    assert samples[-1].readings[RK4].energy_error < -0.999


def test_rk4_limit_above_rk4_gains_energy_until_it_is_caught_at_0_2_rad():
    samples = watch("rk4-limit-above", 4_000)
    late = [sample.readings[RK4] for sample in samples[100:]]
    assert max(abs(reading.theta) for reading in late) == pytest.approx(0.196, abs=0.002)
    assert min(reading.energy_error for reading in late) > 2


@pytest.mark.parametrize(
    ("name", "limit"), [("verlet-limit", 2.0), ("rk4-limit", 2 * math.sqrt(2))]
)
def test_the_limit_scenes_stand_on_either_side_of_their_limit(name, limit):
    below, above = SCENES[name], SCENES[f"{name}-above"]
    assert below.z < limit < above.z
    assert below.altered(h=1.0) == above.altered(h=1.0)


def test_resonance_verlet_doubles_its_energy_and_comes_back():
    scene = SCENES["resonance"]
    errors = [sample.readings[0].energy_error for sample in watch("resonance", 1000)]
    assert max(errors) == pytest.approx(1.15, abs=0.01)
    assert max(errors[300:]) == pytest.approx(1.15, abs=0.01)
    assert min(abs(error) for error in errors[100:]) < 0.01
    # exact; Verlet's is 4 steps
    assert scene.exact().period / scene.h == pytest.approx(4.4, abs=0.1)


@pytest.mark.parametrize("share", [(math.sqrt(5) - 1) / 2, 5 / 8])
def test_there_is_no_resonance_at_an_irrational_or_at_a_rational_part_of_h(share):
    lockstep = Lockstep(SCENES["resonance"].altered(h=share * SCENES["resonance"].h))
    lockstep.advance(10_000)
    verlet = lockstep.sample().readings[0]
    assert -0.21 < verlet.energy_error_low < -0.19  # the wobble of any step, z²/4
    assert verlet.energy_error_high < 0.001


def test_halving_gains_19_percent_a_minute_and_verlet_stays_within_8():
    samples = watch("halving", 60)
    halving, richardson, _, rk4 = samples[-1].readings
    assert halving.energy_error == pytest.approx(0.19, abs=0.005)
    assert richardson.energy_error < -0.09
    assert rk4.energy_error < -0.1
    assert worst(samples, 2) < 0.08


def test_precision_32_bits_go_over_the_top_at_five_and_a_half_seconds():
    scene, samples = SCENES["precision"], watch("precision", 100, every=8)
    exact = scene.exact()
    assert over_the_top(samples, 0) == pytest.approx(5.5, abs=0.05)
    assert over_the_top(samples, 1) == over_the_top(samples, 2) == math.inf
    for sample in samples:
        assert abs(sample.readings[1].theta - exact.at(sample.t).theta) < 0.003


def test_precision_deep_64_bits_lose_the_angle_at_35_seconds_and_compensated_sums_do_not():
    exact, off = SCENES["precision-deep"].exact(), []
    samples = watch("precision-deep", 100, every=16)
    for sample in samples:
        theta = exact.at(sample.t).theta
        off.append([abs(reading.theta - theta) for reading in sample.readings])
    late = next(sample.t for sample, errors in zip(samples, off, strict=True) if errors[1] > 0.1)
    assert late == pytest.approx(35, abs=0.5)
    float32, float64, compensated = map(max, zip(*off, strict=True))
    assert compensated < 3e-4 < 0.1 < float64 < float32


def test_damped_explicit_euler_gains_energy_against_friction_and_the_others_slow_down():
    samples = watch("damped", 60)
    reference = SCENES["damped"].equations.reference(2.0, 0.0)
    euler, *others = samples[-1].readings
    assert euler.energy > reference.start
    assert abs(euler.theta) > 10 * math.pi
    for reading in others:
        assert abs(reading.energy_error) < 0.003  # ln(E/E_true)
        assert reading.energy < reference.start / 10
    lagged, conformal, rk4 = (reading.max_energy_error for reading in others)
    assert rk4 < conformal < lagged


def test_stiff_slow_rk4_takes_the_springs_energy_and_imex_euler_all():
    verlet, rk4, respa, midpoint, imex = watch("stiff-slow", 30)[-1].readings
    assert SCENES["stiff-slow"].z == pytest.approx(1)
    assert rk4.extra["spring_energy"] < 1e-3
    assert rk4.energy_error == pytest.approx(-2 / 6.5, abs=0.01)  # the swing is left
    assert imex.energy_error == pytest.approx(-1, abs=0.01)
    assert max(verlet.max_energy_error, respa.max_energy_error, midpoint.max_energy_error) < 0.1


def test_stiff_limit_in_a_quarter_second_verlets_bob_is_gone():
    scene = SCENES["stiff-limit"]
    assert scene.z == pytest.approx(2.5)
    readings = watch("stiff-limit", 0.25)[-1].readings
    verlet, _, *others = (scene.equations.length(reading.extra) for reading in readings)
    assert verlet > 10
    assert all(length < 1.05 for length in others)


def test_stiff_resonance_respa_resonates_and_the_implicit_midpoint_holds():
    scene, samples = SCENES["stiff-resonance"], watch("stiff-resonance", 30)
    assert scene.h == pytest.approx(math.tau / 50, rel=0.01)
    _, _, respa, midpoint, *_ = samples[-1].readings
    assert respa.max_energy_error > 10
    assert midpoint.max_energy_error < 0.4
    off = [abs(s.readings[3].theta - scene.exact().at(s.t).theta) for s in samples]
    assert max(off) > 0.5  # yet at the wrong time


def test_learned_field_and_map_lose_60_percent_hamiltonian_and_sympnet_less_than_one():
    field, plain, hamiltonian, sympnet, rk4 = watch("learned", 100)[-1].readings
    assert field.energy_error == pytest.approx(-0.6, abs=0.02)
    assert plain.energy_error == pytest.approx(-0.6, abs=0.02)
    assert rk4.max_energy_error < sympnet.max_energy_error < hamiltonian.max_energy_error < 0.01


# How long one waits for it.

MOMENTS = {  # simulated seconds until what the scene says is there to be seen
    "drift": 7.15, "linear": 5.0, "crossover": 33.4, "near-separatrix": 29.4,
    "verlet-limit": 11 * 1.98, "verlet-limit-above": 11 * 2.02, "rk4-limit": 20.0,
    "rk4-limit-above": 40 * 2.86, "chaos-loose": 33_000 * 1.05, "resonance": 50 * 1.45,
    "damped": 20.0, "halving": 60.0, "stiff-slow": 10.0, "stiff-limit": 0.25,
    "stiff-resonance": 10.0, "precision": 5.5, "precision-deep": 35.0, "learned": 100.0,
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_at_its_speed_a_scene_takes_a_few_steps_a_second_and_shows_its_point_within_half_a_minute(
    name,
):
    scene = SCENES[name]
    assert scene.h / scene.speed < 0.4
    assert MOMENTS.get(name, 1.0) / scene.speed < 30


def test_a_speed_changes_no_number():
    assert replace(DEFAULT_SCENE, speed=3.0) == DEFAULT_SCENE
    assert DEFAULT_SCENE.altered(theta=2.0, speed=3.0).speed == 3.0
    for speed in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(SceneError, match="speed"):
            Scene(speed=speed)


def test_in_chaos_loose_omega_passes_2_pi_over_h_within_half_a_minute_of_the_clock():
    scene = SCENES["chaos-loose"]
    lockstep, seen = Lockstep(scene), 0.0
    while lockstep.t < 20 * scene.speed and seen <= math.tau / scene.h:
        lockstep.advance(10)
        seen = max(abs(reading.omega) for reading in lockstep.sample().readings[1:3])
    assert seen > math.tau / scene.h
