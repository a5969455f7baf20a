"""Lockstep and judges with models and methods that are not general."""

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import PlainLoops, available, compiled
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.format import without_extremes
from tests.models import EXAMPLES

NAMES = [n for n, s in SCENES.items() if s.why_not_mapped]
each_scene = pytest.mark.parametrize("scene", [SCENES[name] for name in NAMES], ids=NAMES)


def verdicts(scene, steps):
    lockstep = Lockstep(scene, judged=True)
    lockstep.advance(steps)
    return [(m.step, m.method.key, m.verdict) for m in lockstep.milestones if m.kind == "verdict"]


@each_scene
@given(cuts=st.lists(st.integers(1, 30), min_size=1, max_size=6))
def test_the_same_bits_however_the_steps_are_cut(scene, cuts):
    alone, watched = Lockstep(scene), Lockstep(scene)
    alone.advance(sum(cuts))
    for n in cuts:
        watched.advance(n)
        watched.sample()
        watched = watched.copy()
    assert without_extremes(watched.sample()) == without_extremes(alone.sample())


@each_scene
def test_readings_are_finite_and_complete_backwards_and_at_equal_cost_too(scene):
    lockstep, variables = Lockstep(scene), [each.name for each in scene.equations.variables]
    equal = Stepping(scene.h, True, scene.cast)
    for stepping, n in (
        (Stepping(scene.h, cast=scene.cast), 1000),
        (equal, 20),
        (equal.reversed(), 200),
    ):
        lockstep.set_stepping(stepping)
        lockstep.advance(n)
        for reading in lockstep.sample().readings:
            assert {type(reading.theta), type(reading.omega), type(reading.energy)} == {float}
            assert math.isfinite(reading.theta + reading.omega + reading.energy_error)
            assert list(reading.extra) == variables


@pytest.mark.parametrize(
    ("name", "seconds", "expected"),
    [
        ("damped", 60, {"explicit_euler": "grows"}),
        ("stiff-slow", 300, {"rk4": "loses", "imex_euler": "loses"}),
        (
            "halving",
            300,
            {
                "halving_verlet": "grows",
                "halving_richardson": "loses",
                "velocity_verlet": "bounded",
            },
        ),
    ],
)
def test_the_scenes_have_their_verdicts(name, seconds, expected):
    found = verdicts(SCENES[name], round(seconds / SCENES[name].h))
    assert {key: verdict for _, key, verdict in found}.items() >= expected.items()


@pytest.mark.skipif(not available(), reason="Numba is not installed")
@each_scene
def test_methods_that_are_not_general_have_plain_loops(scene):
    for method in scene.cast:
        general = method.general and not scene.equations.without_force
        assert isinstance(compiled(method, scene.equations), PlainLoops) == (not general)


@st.composite
def scenes_within_limits(draw):
    scene = EXAMPLES[draw(st.sampled_from([*MODELS]))]
    cast = tuple(method for method in METHODS if scene.model in method.models)
    own = {
        each.name: draw(st.floats(each.min, min(each.max, each.max_over_w0 * scene.w0)))
        for each in MODELS[scene.model].parameters
    }
    scene = scene.with_cast(cast).altered(
        theta=draw(st.floats(-1e9, 1e9)), omega=draw(st.floats(-1e9, 1e9)), **own
    )
    h = draw(st.floats(1e-8, 300))
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
        assert math.isfinite(reading.theta + reading.omega + reading.energy + reading.energy_error)


@pytest.mark.parametrize("scene", EXAMPLES.values(), ids=EXAMPLES)
def test_a_model_refuses_a_method_that_is_not_for_it(scene):
    for method in METHODS:
        if scene.model in method.models:
            assert scene.with_cast((method,)).cast == (method,)
        else:
            why = rf"is not for the model {scene.model}; it is for \w+"
            with pytest.raises(InputError, match=why):
                scene.with_cast((method,))


def test_a_bob_that_escapes_is_called_growing_within_half_a_second():
    ((step, key, verdict),) = verdicts(SCENES["stiff-limit"], 20)
    assert (key, verdict) == ("velocity_verlet", "grows")
    assert step <= 10
