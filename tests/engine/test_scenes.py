"""Scenes are validated, and what they tell people to watch is measured."""

import math
from dataclasses import replace
from itertools import pairwise
from statistics import fmean

import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import method_of
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, GROUPS, SCENES, Scene
from tests.sine import needs_rounded_sine
from tests.truths import LIMITS

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


@pytest.mark.parametrize("field", LIMITS)
def test_a_value_beyond_its_limits_is_refused_in_a_sentence(field):
    low, high = LIMITS[field]
    beyond = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
    for value in (*beyond, math.nan, math.inf, -math.inf):
        with pytest.raises(InputError, match=rf"^{field} = .* is out of range; use .* to .*\.$"):
            Scene(**{field: value})


@pytest.mark.parametrize("h", [0.0, -0.05, math.nan, math.inf, -math.inf, 1e9, 1e-12])
def test_a_useless_step_size_is_refused_and_a_good_one_is_named(h):
    with pytest.raises(InputError, match=r"^h = .* is not a usable step; .* for example 0\.05\.$"):
        Scene(h=h)


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
        assert scene.h / scene.speed < 0.4  # s from a step to the next


# What the scenes tell people to watch.


def watch(name, seconds, every=1):
    """Samples at every step, or at one of so many."""
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


def errors(samples, method):
    return [sample.readings[method].energy_error for sample in samples]


def worst(samples, method):
    return max(map(abs, errors(samples, method)))


def lowest(samples, method):
    return min(errors(samples, method))


def highest(samples, method):
    return max(errors(samples, method))


def last(samples, method):
    return errors(samples, method)[-1]


def at(step):
    return lambda samples, method: errors(samples, method)[step]


def widest(samples, method):
    return max(abs(sample.readings[method].theta) for sample in samples)


def turns(samples, method):
    return round(samples[-1].readings[method].theta / math.tau)


def extra(name):
    return lambda samples, method: samples[-1].readings[method].extra[name]


def length(samples, method):
    return SCENES["stiff-limit"].equations.length(samples[-1].readings[method].extra)


def comes_back(samples, method):
    """How near to its start the energy comes after 100 samples."""
    return min(map(abs, errors(samples, method)[100:]))


def off(name, samples, method):
    """How far theta is from the exact one, at each sample [rad]."""
    exact = SCENES[name].exact()
    return [abs(each.readings[method].theta - exact.at(each.t).theta) for each in samples]


def farthest(name):
    return lambda samples, method: max(off(name, samples, method))


def late(name, rad):
    """When theta first is as far off [s]; inf: never."""

    def first(samples, method):
        times = zip(samples, off(name, samples, method), strict=True)
        return next((sample.t for sample, error in times if error > rad), math.inf)

    return first


NEVER = (math.inf, math.inf)
FACTS = {  # seconds, steps from a sample to the next, and what of which method is between what
    "drift": (120, 1, [
        (over_the_top, EXPLICIT, 7.1, 7.2), (last, EXPLICIT, 10, 100), (worst, SYMPLECTIC, 0, 0.08),
        (worst, VERLET, 0, 0.006), (at(1200), RK4, -1.8e-4, -1.7e-4), (last, RK4, -3.6e-4, -3.4e-4),
    ]),
    "large-swing": (10, 1, [
        (over_the_top, EXPLICIT, 0, 3.29), *((over_the_top, each, *NEVER) for each in (SYMPLECTIC, VERLET, RK4)),
    ]),
    "near-separatrix": (120, 2, [
        (worst, RK4, 0, 1e-6), (worst, VERLET, 1e-4, 1e-3), (worst, SYMPLECTIC, 1e-3, 1e-1),
        (late("near-separatrix", 1.0), RK4, 29.3, 29.5), (late("near-separatrix", 1.0), VERLET, *NEVER),
        (late("near-separatrix", 1.0), SYMPLECTIC, *NEVER),
    ]),
    "spin": (60, 1, [(turns, EXPLICIT, 94, 94), *((turns, each, 61, 61) for each in (SYMPLECTIC, VERLET, RK4))]),
    "verlet-limit": (2000, 1, [(lowest, VERLET, -0.981, -0.97), (highest, VERLET, 0, 0)]),
    "verlet-limit-above": (4000, 1, [(widest, VERLET, 0.475, 0.485)]),
    "rk4-limit": (300, 1, [
        (at(4), RK4, -0.51, -0.49), (at(8), RK4, -0.75, -0.73), (last, RK4, -1, -0.999),
        *((over_the_top, each, 0, 20) for each in (EXPLICIT, SYMPLECTIC, VERLET)),
    ]),
    "rk4-limit-above": (4000, 1, [(widest, RK4, 0.194, 0.198), (last, RK4, 2, 4)]),
    "resonance": (1000, 1, [(highest, 0, 1.14, 1.16), (comes_back, 0, 0, 0.01)]),
    "damped": (60, 1, [  # ln(E/E_true), and E_true falls to e⁻³
        (last, EXPLICIT, 3, 9), (turns, EXPLICIT, -99, -5), *((worst, each, 0, 0.003) for each in (1, 2, 3)),
    ]),
    "halving": (60, 1, [(last, 0, 0.185, 0.195), (last, 1, -0.2, -0.09), (worst, 2, 0, 0.08), (last, 3, -1, -0.1)]),
    "precision": (40, 8, [
        (over_the_top, 0, 5.45, 5.55), *((over_the_top, each, *NEVER) for each in (1, 2)),
        (farthest("precision"), 1, 0, 0.003),
    ]),
    "precision-deep": (40, 32, [
        (late("precision-deep", 0.1), 1, 34.5, 35.5), (farthest("precision-deep"), 2, 0, 3e-4),
    ]),
    "stiff-slow": (30, 1, [
        (extra("spring_energy"), 1, 0, 1e-3), (last, 1, -0.32, -0.3), (last, 4, -1.01, -0.99),
        *((worst, each, 0, 0.1) for each in (0, 2, 3)),
    ]),
    "stiff-limit": (0.25, 1, [(length, 0, 10, math.inf), *((length, each, 0, 1.05) for each in (1, 2, 3, 4))]),
    "stiff-resonance": (30, 1, [
        (worst, 2, 10, math.inf), (worst, 3, 0, 0.4), (farthest("stiff-resonance"), 3, 0.5, math.tau),
    ]),
    "learned": (100, 10, [*((last, each, -0.62, -0.58) for each in (0, 1)), *((worst, each, 0, 0.01) for each in (2, 3))]),
}  # fmt: skip


WITH_MARKS = [
    pytest.param(name, marks=needs_rounded_sine if name == "precision-deep" else ())
    for name in FACTS
]


@pytest.mark.parametrize("name", WITH_MARKS)
def test_what_a_scene_tells_people_to_watch_happens(name):
    seconds, every, facts = FACTS[name]
    samples = watch(name, seconds, every)
    for what, method, least, most in facts:
        assert least <= what(samples, method) <= most, (what, method)


def test_gentle_the_textbooks_formulas_hold():
    z, samples = SCENES["gentle"].z, watch("gentle", 60)
    last = samples[-1]
    for step in (1, 40):
        growth = samples[step].readings[EXPLICIT].energy_error
        assert growth == pytest.approx((1 + z**2) ** step - 1, rel=0.02)
    assert last.readings[RK4].energy_error / last.step == pytest.approx(-(z**6) / 72, rel=0.02)
    assert worst(samples, VERLET) == pytest.approx(z**2 / 4, rel=0.02)


def test_linear_theory_is_exact_at_any_size():
    samples, z = watch("linear", 20), 0.5
    assert SCENES["linear"].z == z
    for before, after in pairwise(samples):
        for method, factor in ((EXPLICIT, 1 + z**2), (RK4, 1 - z**6 / 72 + z**8 / 576)):
            ratio = after.readings[method].energy / before.readings[method].energy
            assert ratio == pytest.approx(factor, rel=1e-14)


def test_crossover_rk4_starts_far_ahead_of_verlet():
    swing = watch("crossover", 2.2)
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


def test_spin_symplectic_euler_and_verlet_have_the_same_angle():
    """Half a kick apart they are one method; at the bottom, where this starts, the kick is 0."""
    samples = watch("spin", 60)
    for _, euler, verlet, _ in (sample.readings for sample in samples):
        assert euler.theta == pytest.approx(verlet.theta, abs=1e-10)  # 3000 roundings
    assert abs(euler.omega - verlet.omega) > 1e-3


def test_step_doubling_gains_less_in_the_second_minute():
    scene = SCENES["halving"]
    lockstep = Lockstep(scene)
    lockstep.advance(round(120 / scene.h))
    assert lockstep.sample().readings[0].energy_error == pytest.approx(0.296, abs=0.002)


def test_euler_caught_is_held_near_110_times_its_energy_by_half_a_turn_a_step():
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
    assert fmean(energies[half:]) == pytest.approx(110, abs=2)
    lockstep.advance(1000)
    judgement = lockstep.judgements[EXPLICIT]
    assert (judgement.verdict, judgement.rests) == ("grows", True)


def test_verlet_limit_verlet_has_its_energy_back_every_11_steps():
    found = errors(watch("verlet-limit", 2000), VERLET)
    assert all(max(found[start : start + 11]) > -0.06 for start in range(0, 990, 11))


@pytest.mark.parametrize(
    ("name", "limit"), [("verlet-limit", 2.0), ("rk4-limit", 2 * math.sqrt(2))]
)
def test_the_limit_scenes_stand_on_either_side_of_their_limit(name, limit):
    below, above = SCENES[name], SCENES[f"{name}-above"]
    assert below.z < limit < above.z
    assert below.altered(h=1.0) == above.altered(h=1.0)


@pytest.mark.parametrize("share", [(math.sqrt(5) - 1) / 2, 5 / 8])
def test_a_rational_part_of_h_avoids_the_resonance_like_an_irrational_one(share):
    lockstep = Lockstep(SCENES["resonance"].altered(h=share * SCENES["resonance"].h))
    lockstep.advance(10_000)
    verlet = lockstep.sample().readings[0]
    assert -0.21 < verlet.energy_error_low < -0.19  # the wobble of any step, z²/4
    assert verlet.energy_error_high < 0.001


def test_a_speed_changes_no_number():
    assert replace(DEFAULT_SCENE, speed=3.0) == DEFAULT_SCENE
    assert DEFAULT_SCENE.altered(theta=2.0, speed=3.0).speed == 3.0
    for speed in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="speed"):
            Scene(speed=speed)


@pytest.mark.parametrize(
    ("gravity", "most"), [(9.81, 100.0), (0.04, 20.0)]
)  # 100 s⁻¹, and 100 w0, w0 being 0.2 rad/s
def test_the_limit_of_friction_goes_with_the_frequency(gravity, most):
    def damped(friction):
        cast = (method_of("rk4"),)
        parameters = {"friction": friction}
        return Scene(model="damped", gravity=gravity, cast=cast, parameters=parameters)

    assert damped(0.999 * most).parameters["friction"] == 0.999 * most
    with pytest.raises(InputError, match="friction = "):
        damped(1.001 * most)


def test_a_parameter_that_the_model_lacks_may_be_0_only():
    assert Scene(parameters={"friction": 0.0}).parameters == {}
    with pytest.raises(InputError, match="has no friction"):
        Scene(parameters={"friction": 0.1})


def test_what_to_watch_stays_while_all_its_methods_do():
    more = (*DEFAULT_SCENE.cast, method_of("heun"))
    assert DEFAULT_SCENE.with_cast(more).watch == DEFAULT_SCENE.watch
    assert DEFAULT_SCENE.with_cast(more[1:]).watch == ""
