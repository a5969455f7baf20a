"""Scenes are validated, and what they tell people to watch is measured."""

import math
import re
from dataclasses import astuple, replace

import numpy as np
import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import TAYLOR_20, learned, method_of
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import (
    DEFAULT_SCENE,
    GROUPS,
    MAX_METHODS,
    SCENES,
    Line,
    Scene,
    Shot,
    check_h,
)
from tests.sine import needs_rounded_sine
from tests.truths import LIMITS

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


@pytest.mark.parametrize("field", LIMITS)
def test_a_value_beyond_its_limits_is_refused_in_a_sentence(field):
    low, high = LIMITS[field]
    assert [getattr(Scene(**{field: value}), field) for value in (low, high)] == [low, high]
    beyond = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
    for value in (*beyond, math.nan, math.inf, -math.inf):
        with pytest.raises(InputError, match=rf"^{field} = .* is out of range; use .* to .*\.$"):
            Scene(**{field: value})


def test_a_number_is_for_the_model_that_has_it_and_within_limits():
    damped = SCENES["damped"].altered(friction=0.1)
    assert damped.equations.friction == damped.fields()["friction"] == 0.1
    assert Scene(parameters={"friction": 0.0}).parameters == {}
    with pytest.raises(
        InputError, match=r"^the model pendulum has no friction; damped does: choose "
    ):
        Scene(parameters={"friction": 0.1})
    with pytest.raises(InputError, match=r"^stiffness = 0 s⁻² is out of range; use 1 to 1e\+18 "):
        Scene(model="spring", cast=())
    with pytest.raises(InputError, match=r"^Symplectic Euler is not for .* is for pendulum or lin"):
        damped.with_cast(DEFAULT_SCENE.cast)


@pytest.mark.parametrize(
    ("key", "name", "gravity", "most"),
    [
        ("damped", "friction", 9.81, 100),
        ("damped", "friction", 0.04, 20),  # 100 w0
        ("mean-field", "level_frequency", 0.04, 200),  # 1000 w0
    ],
)
def test_a_frequency_is_limited_beside_w0_too(key, name, gravity, most):
    scene = SCENES[key].altered(gravity=gravity)
    assert scene.altered(**{name: 0.999 * most}).parameters[name] == 0.999 * most
    with pytest.raises(InputError, match=rf"{name} = .* out of range; use .* to {most} s"):
        scene.altered(**{name: 1.001 * most})


def test_a_step_is_measured_by_the_fastest_motion():
    found = [SCENES[name].z for name in ("linear", "stiff-slow", "stiff-limit", "mean-field")]
    assert found == pytest.approx([0.5, 1.0, 2.5, 1.0])  # the latter three swing more slowly


@pytest.mark.parametrize("h", [0.0, -0.05, math.nan, math.inf, -math.inf, 5001, 4.9e-9])
def test_a_useless_step_size_is_refused_and_a_good_one_is_named(h):
    for usable in (4999, 5.001e-9):
        assert Scene(gravity=0.04, h=usable).z == pytest.approx(0.2 * usable)
        check_h(-usable, 0.2)  # time may run back
    assert [Scene(gravity=1.0, h=h).z for h in (1e-9, 1e3)] == [1e-9, 1e3]
    with pytest.raises(
        InputError, match=r"not a usable step; use 5e-09 to 5e\+03 s, for example 0\.7\.$"
    ):
        Scene(gravity=0.04, h=h)


def test_a_scene_keeps_its_name_only_while_nothing_is_changed():
    scene = SCENES["spin"]
    assert scene.altered(omega=scene.omega) is scene
    changed = scene.altered(omega=9.0, theta=scene.theta)
    assert (changed.name, changed.watch, changed.omega, changed.h) == ("custom", "", 9.0, scene.h)
    assert changed.shot == Shot() != scene.shot
    damped = SCENES["damped"].altered(theta=1.1)
    assert (damped.often_said, damped.parameters) == ("", SCENES["damped"].parameters)
    fields = {"name": "spin", **scene.numbers, "watch": scene.watch, "model": "pendulum"}
    assert scene.fields() == {**fields, "methods": [method.key for method in scene.cast]}
    assert damped.altered(model="pendulum", cast=scene.cast).parameters == {}
    assert damped.altered(model="spring", stiffness=5, cast=()).parameters == {"stiffness": 5}
    levels = SCENES["mean-field"].altered(level_frequency=30).altered(coupling=3)
    assert levels.parameters == {"coupling": 3, "level_frequency": 30}


def test_a_scene_says_why_there_is_no_map_of_it_and_no_ring():
    found = {name: (scene.why_not_mapped, scene.why_no_ring) for name, scene in SCENES.items()}
    methods = "Step doubling, Richardson Verlet"
    assert found["halving"][0].endswith(f"to methods that take any force, not to {methods}.")
    assert found["halving"][1] == f"No ring with {methods} among the methods."
    assert "no friction" in found["damped"][0]
    assert found["damped"][1] == found["drift"][0] == found["drift"][1] == ""
    assert replace(DEFAULT_SCENE, cast=(TAYLOR_20,)).why_not_mapped == ""  # it takes no force
    assert "no curves" in found["stiff-slow"][1]
    for method in learned.FAMILY:
        assert method.label in replace(DEFAULT_SCENE, cast=(method,)).why_no_ring


TOLD = (
    r"\b(?:RK4|Verlet|RESPA|IMEX|\w+plicit|symplectic|bits|gains?|loses?|\w+est|below|above|beyond"
    r"|over|holds?|energy|falls by)\b|\b[\d.]*\d"
)


def shown(scene):
    """Speed, edge [rad], seconds, pause, line; what is unusual; cast, front; what it tells."""
    shot, line = scene.shot, scene.shot.line or Line("", 0.0, "")
    numbers = scene.speed, shot.theta, shot.seconds, shot.moment, line.value
    words = [scene.name, *(f"{each:.4g}" for each in numbers if each), line.name, line.quantity]
    words += [shot.view, shot.quantity, shot.log or "linear", scene.often_said and "belief"]
    if scene.cast != DEFAULT_SCENE.cast:
        words += ["".join(method.letter for method in scene.cast)]
    words += ["".join(method_of(key).letter for key in shot.front)]
    words += re.findall(TOLD, scene.watch)
    return " ".join(word for word in words if word not in ("", True, "lab", "energy_error"))


SHOWN = """
first look:
drift 1 3.142 Explicit gains energy RK4 loses symplectic
gentle 1 evr explicit 72 RK4
linear 2 3.142 explicit gains 25 energy
large-swing 1 143 1.64 explicit over
crossover 4 50 linear vr RK4 energy below Verlet
near-separatrix 4 theta_error RK4 smallest energy
spin 1 sv symplectic
stability:
euler-caught 60 3.142 110 110 E0 Explicit energy 110
verlet-limit 16 60 43.56 linear v below 2 11 Verlet loses 98 energy
verlet-limit-above 16 0.6 60 21.62 0.48 rad linear v above 2 Verlet 0.48
rk4-limit 8 60 22.4 -0.5 half linear r below 2 2 RK4 energy 4 over
rk4-limit-above 8 0.25 linear r above 2 2 RK4 holds 0.2
chaos-fenced 64 3.142 3.223 pi/h omega phase sv 0.95
chaos-loose 2048 3.142 5.991 2 pi/h omega phase sv 1.1 2
resonance 16 linear belief vs v 4 Verlet energy
structure:
damped 2 belief elcr explicit gains energy
halving 4 linear belief havr hav energy 19 1 29.6 2 Verlet 8
stiffness:
stiff-slow 0.5 spring_energy linear belief vrpiu riu 1 RK4 IMEX
stiff-limit 0.25 vrpiu vriu 2.5 beyond Verlet 2 1 4
stiff-resonance 0.5 belief vrpiu RESPA implicit
precision:
precision 1 theta_error nvk 32 bits Verlet over 5.5 64 0.003
precision-deep 4 theta_error nvk 64 bits 0.1 35 3 4
learning:
learned 8 belief jzgtr ztr lose 60 100 1
mean field:
mean-field 4 probability_error linear rx RK4 energy 4 4 15
"""


def test_each_scene_is_shown_with_what_its_sentence_is_about():
    rows = (row for name, group in GROUPS.items() for row in (f"{name}:", *map(shown, group)))
    known = SHOWN.split("\n")[1:-1]
    assert [row for row in rows if row in known] == known
    for scene in SCENES.values():
        assert len(scene.cast) <= MAX_METHODS == 6
        assert 20 < len(scene.watch) <= 79  # a line of the smallest terminal, and a blank
        for told in re.findall(r"K = z² = ([\d.]+\d)", scene.watch):
            assert (scene.theta, scene.z**2) == pytest.approx((3.14, float(told)))


# What the scenes tell people to watch.


class Track:
    """What a method did in a scene, with arrays over time."""

    def __init__(self, scene, samples, method):
        self.scene = scene
        self.t = np.array([sample.t for sample in samples])
        readings = [sample.readings[method] for sample in samples]
        self.theta, self.omega, self.energy, self.error = np.array(
            [each[:4] for each in readings]
        ).T
        self.last = readings[-1]

    @property
    def off(self):
        """How far theta is from the exact one [rad]."""
        exact = self.scene.exact()
        return abs(self.theta - [exact.at(t).theta for t in self.t])

    def first(self, where):
        """Return the first of these times [s]; inf: never."""
        return min([*self.t[where], math.inf])

    def late(self, values):
        return values[len(values) // 2 :]


def watch(name, seconds, every=1):
    """Return what each method does, at every step or at one of so many."""
    lockstep = Lockstep(SCENES[name])
    samples = [lockstep.sample()]
    while lockstep.t < seconds:
        lockstep.advance(every)
        samples.append(lockstep.sample())
    return [Track(SCENES[name], samples, method) for method in range(len(lockstep.scene.cast))]


def over_the_top(track):
    return track.first(abs(track.theta) > math.pi)


def wrong_by(rad):
    return lambda track: track.first(track.off > rad)


def farthest(track):
    return track.off.max()


def worst(track):
    return abs(track.error).max()


def highest(track):
    return track.error.max()


def at(sample):
    return lambda track: track.error[sample]


def widest(track):
    return abs(track.theta).max()


def turns(track):
    return round(track.theta[-1] / math.tau)


def extra(name):
    return lambda track: track.last.extra[name]


def length(track):
    return track.scene.equations.length(track.last.extra)


def every_11_steps(track):
    """The least of the highest energies of 11 steps each."""
    return track.error[:990].reshape(-1, 11).max(axis=1).min()


def late_energy(measure):
    return lambda track: measure(1 + track.late(track.error))


NEVER = (math.inf, math.inf)
_Z2 = SCENES["gentle"].z ** 2
FACTS = {  # seconds, steps from a sample to the next, and what of which method is between what
    "drift": (120, 1, [
        (over_the_top, EXPLICIT, 7.1, 7.2), (at(-1), EXPLICIT, 10, 100), (worst, SYMPLECTIC, 0, 0.08),
        (worst, VERLET, 0, 0.006), (at(1200), RK4, -1.8e-4, -1.7e-4), (at(-1), RK4, -3.6e-4, -3.4e-4),
    ]),
    "large-swing": (10, 1, [
        (over_the_top, EXPLICIT, 0, 3.29), *((over_the_top, each, *NEVER) for each in (SYMPLECTIC, VERLET, RK4)),
    ]),
    "near-separatrix": (120, 2, [
        (worst, RK4, 0, 1e-6), (worst, VERLET, 1e-4, 1e-3), (worst, SYMPLECTIC, 1e-3, 1e-1),
        (wrong_by(1.0), RK4, 29.3, 29.5), (wrong_by(1.0), VERLET, *NEVER),
        (wrong_by(1.0), SYMPLECTIC, *NEVER),
    ]),
    "spin": (60, 1, [
        (turns, EXPLICIT, 94, 94), *((turns, each, 61, 61) for each in (SYMPLECTIC, VERLET, RK4)),
    ]),
    "gentle": (60, 1, [
        (worst, VERLET, 0.98 * _Z2 / 4, 1.02 * _Z2 / 4), (at(1), EXPLICIT, 0.98 * _Z2, 1.02 * _Z2),
        (at(40), EXPLICIT, 0.98 * ((1 + _Z2) ** 40 - 1), 1.02 * ((1 + _Z2) ** 40 - 1)),
        (at(-1), RK4, -1.02 * 1200 * _Z2**3 / 72, -0.98 * 1200 * _Z2**3 / 72),
    ]),
    "verlet-limit": (2000, 1, [
        (worst, VERLET, 0.97, 0.981), (highest, VERLET, 0, 0), (every_11_steps, VERLET, -0.06, 0),
    ]),
    "verlet-limit-above": (4000, 1, [(widest, VERLET, 0.475, 0.485)]),
    "rk4-limit": (300, 1, [
        (at(4), RK4, -0.51, -0.49), (at(8), RK4, -0.75, -0.73), (at(-1), RK4, -1, -0.999),
        *((over_the_top, each, 0, 20) for each in (EXPLICIT, SYMPLECTIC, VERLET)),
    ]),
    "rk4-limit-above": (4000, 1, [(widest, RK4, 0.194, 0.198), (at(-1), RK4, 2, 4)]),
    "resonance": (1000, 1, [(highest, 0, 1.14, 1.16), (lambda track: abs(track.error[100:]).min(), 0, 0, 0.01)]),
    "damped": (60, 1, [  # ln(E/E_true), and E_true falls to e⁻³
        (at(-1), EXPLICIT, 3, 9), (turns, EXPLICIT, -99, -5), *((worst, each, 0, 0.003) for each in (1, 2, 3)),
    ]),
    "crossover": (50, 1, [
        (worst, VERLET, 0.09, 0.091), (at(11), RK4, -0.009, 0),
        (lambda track: max(track.t[abs(track.error) < 0.091]), RK4, 33, 33.5),
    ]),
    "euler-caught": (600, 10, [(late_energy(min), EXPLICIT, 100, 110), (late_energy(max), EXPLICIT, 110, 120),
        (lambda track: abs(track.late(track.omega)).mean() * track.scene.h / math.tau, EXPLICIT, 0.495, 0.505),
    ]),
    "halving": (120, 1, [
        (at(300), 0, 0.185, 0.195), (at(-1), 0, 0.294, 0.298), (at(300), 1, -0.2, -0.09), (worst, 2, 0, 0.08),
        (at(300), 3, -1, -0.1),
    ]),
    "mean-field": (60, 1, [
        (worst, 0, 4.2e-4, 4.4e-4), (extra("probability_error"), 0, -0.149, -0.147),
        (worst, 1, 6.7e-3, 7.1e-3), (extra("probability_error"), 1, -1e-13, 1e-13),
    ]),
    "precision": (40, 8, [
        (over_the_top, 0, 5.45, 5.55), *((over_the_top, each, *NEVER) for each in (1, 2)),
        (farthest, 1, 0, 0.003),
    ]),
    "precision-deep": (40, 32, [
        (wrong_by(0.1), 1, 34.5, 35.5), (farthest, 2, 0, 3e-4),
    ]),
    "stiff-slow": (30, 1, [
        (extra("spring_energy"), 1, 0, 1e-3), (at(-1), 1, -0.32, -0.3), (at(-1), 4, -1.01, -0.99),
        *((worst, each, 0, 0.1) for each in (0, 2, 3)),
    ]),
    "stiff-limit": (0.25, 1, [(length, 0, 10, math.inf), *((length, each, 0, 1.05) for each in (1, 2, 3, 4))]),
    "stiff-resonance": (30, 1, [
        (worst, 2, 10, math.inf), (worst, 3, 0, 0.4), (farthest, 3, 0.5, math.tau),
    ]),
    "learned": (100, 10, [*((at(-1), each, -0.62, -0.58) for each in (0, 1)), *((worst, each, 0, 0.01) for each in (2, 3))]),
}  # fmt: skip


WITH_MARKS = [
    pytest.param(name, marks=needs_rounded_sine if name == "precision-deep" else ())
    for name in FACTS
]


@pytest.mark.parametrize("name", WITH_MARKS)
def test_what_a_scene_tells_people_to_watch_happens(name):
    seconds, every, facts = FACTS[name]
    tracks = watch(name, seconds, every)
    for what, method, least, most in facts:
        assert least <= what(tracks[method]) <= most, (what, method)


def test_a_spin_of_symplectic_euler_is_half_a_kick_off_in_omega_not_in_theta():
    off, equal = re.search("Euler's (.*), not its (.*), is", SCENES["spin"].watch).groups()
    _, euler, verlet, _ = (vars(track) for track in watch("spin", 60))
    assert euler[equal] == pytest.approx(verlet[equal], rel=0, abs=1e-10)
    assert 1e-3 < abs(euler[off] - verlet[off]).max() < 1


def test_linear_theory_is_exact_at_any_size():
    tracks, z = watch("linear", 20), 0.5
    for method, factor in ((EXPLICIT, 1 + z**2), (RK4, 1 - z**6 / 72 + z**8 / 576)):
        energy = tracks[method].energy
        assert energy[1:] / energy[:-1] == pytest.approx(factor, rel=1e-14)


RESONANCE = SCENES["resonance"]


@pytest.mark.parametrize(
    "h",
    [
        Stepping(RESONANCE.h).next(up="Press + to avoid" in RESONANCE.watch).h,
        (math.sqrt(5) - 1) / 2 * RESONANCE.h,
        5 / 8 * RESONANCE.h,
    ],
)
def test_the_step_of_the_key_and_a_part_of_h_avoid_the_resonance_if_rational_or_not(h):
    lockstep = Lockstep(RESONANCE.altered(h=h))
    lockstep.advance(10_000)
    verlet = lockstep.sample().readings[0]
    assert -0.25 < verlet.energy_error_low < -0.19  # the wobble of any step, z²/4
    assert verlet.energy_error_high < 0.001


def test_how_a_run_is_shown_changes_no_number():
    shown = replace(DEFAULT_SCENE, speed=3.0, often_said="It holds.", shot=Shot(log=False))
    assert {shown, DEFAULT_SCENE} == {shown}
    usual = ("lab", None, "energy_error", True, None, None, (), False, None, None)
    assert astuple(Shot()) == (*usual, "", "", (), 1, "", False, False)
    assert DEFAULT_SCENE.altered(theta=2.0, speed=3.0).speed == 3.0
    for speed in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="speed"):
            Scene(speed=speed)


def test_what_to_watch_stays_while_all_its_methods_do():
    more = (*DEFAULT_SCENE.cast, method_of("heun"))
    found = [DEFAULT_SCENE.with_cast(cast).watch for cast in (more[:-1], more, more[1:])]
    assert found == [DEFAULT_SCENE.watch, DEFAULT_SCENE.watch, ""]
