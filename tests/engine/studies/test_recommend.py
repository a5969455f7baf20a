"""Recommended runs hold when they are repeated and compared at every step."""

import math
from dataclasses import replace
from itertools import count

import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import USUAL_CAST, method_of
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import compiled
from pendu_tui.engine.scenes import SCENES, Z_LIMITS
from pendu_tui.engine.studies.accuracy import Study
from pendu_tui.engine.studies.recommend import least_cost, reach

E, S, V, R = USUAL_CAST
DRIFT = SCENES["drift"]


def recommended(scene, time, kind, target):
    best = least_cost(Study(scene, time, compiled), kind, target)[0]
    assert best.succeeded
    return best.point


def largest_error(scene, point, kind):
    """Of every step, by the lockstep and the exact swing alone."""
    lockstep = Lockstep(scene.altered(h=point.h, cast=(point.method,)))
    errors = []
    for _ in range(point.steps):
        lockstep.advance(1)
        (reading,) = lockstep.sample().readings
        off = reading.theta - scene.exact().at(lockstep.t).theta
        errors.append(abs(reading.energy_error if kind == "energy" else off))
    return errors[-1] if kind == "final" else max(errors)


@pytest.mark.parametrize(
    ("name", "time", "target", "kind"),
    [
        ("large-swing", 3.0, 1e-5, "theta"),
        ("large-swing", 5.0, 1e-2, "final"),
        ("spin", 3.0, 1e-2, "energy"),
    ],
)
def test_the_recommended_run_reaches_its_target(name, time, kind, target):
    point = recommended(SCENES[name], time, kind, target)
    largest = largest_error(SCENES[name], point, kind)
    # 10,000 comparisons are every step of these runs, so not even rounding differs
    assert largest == pytest.approx(point.errors[kind], rel=1e-9)
    finer = Study(SCENES[name], time).run(point.method, math.ceil(1.1 * point.steps))
    assert max(largest, finer.errors[kind]) <= target  # no chance crossing of zero
    coarser = Study(SCENES[name], time).run(point.method, math.floor(point.steps / 1.03))
    assert coarser.errors[kind] > target


def test_a_target_as_large_as_the_swing_is_refused():
    study = Study(DRIFT, 1.0)
    with pytest.raises(InputError, match="as large as the swing"):
        least_cost(study, "theta", study.sizes["theta"])


def test_a_target_near_the_rounding_floor_is_reached():
    point = recommended(DRIFT, 20.0, "theta", 2e-13)
    assert point.method is R
    assert point.errors["theta"] <= 2e-13


def test_a_method_far_dearer_than_another_is_given_up():
    attempts = list(reach(Study(replace(DRIFT, cast=(E, R)), 10.0, compiled), "theta", 3e-4))
    assert [attempt.method for attempt in attempts] == [R, E]  # the higher order first
    cheapest, dear = attempts
    assert cheapest.succeeded
    assert not dear.succeeded
    assert (cheapest.cost, dear.cost) == (cheapest.point.force_evaluations, math.inf)
    budget = 300 * cheapest.point.force_evaluations
    assert dear.why_not == f"not within {budget} evaluations"
    assert dear.point.force_evaluations <= budget


def test_the_cheapest_is_first_and_others_cost_a_multiple_of_it():
    study = Study(replace(DRIFT, cast=(V, R)), 10.0, compiled)
    shares = []
    best, other = least_cost(study, "energy", 1e-2, shares.append)
    assert (best.method, best.times, other.method) == (V, 1.0, R)
    assert 1 < other.times == other.cost / best.cost
    assert shares == [0.5, 1]
    seconds = count()  # each measurement takes one
    best, other = least_cost(study, "energy", 1e-2, clock=lambda: next(seconds))
    assert best.method is R  # of the longer step, which 20 000 steps measure in more runs


def test_if_no_method_reaches_the_target_each_has_its_reason():
    study = Study(replace(DRIFT, cast=(V, R)), 2.0, compiled)
    reasons = {each.method: each.why_not for each in reach(study, "theta", 1e-17, 400_000)}
    assert reasons[R].startswith("rounding stops it at ")
    assert reasons[V] == "not within 400000 evaluations"
    (euler,) = reach(Study(replace(DRIFT, cast=(E,)), 10.0, compiled), "theta", 1e-9)
    assert euler.why_not == "not within 20000000 evaluations"


def test_a_method_is_given_up_only_if_its_order_predicts_twice_the_limit():
    scene = replace(DRIFT, cast=(V,))
    needed = recommended(scene, 2.0, "theta", 1e-9).force_evaluations
    for share, reached in ((0.7, False), (0.45, False), (1.05, True)):
        (attempt,) = reach(Study(scene, 2.0, compiled), "theta", 1e-9, round(share * needed))
        assert attempt.succeeded == reached
        tried = attempt.point.force_evaluations / needed
        assert tried == pytest.approx(share, rel=0.1) if share > 0.5 else tried < 0.1


@pytest.mark.parametrize(
    ("quarter", "half", "flaw"),
    [(8.2, 4.05, None), (8.2, 3.95, "rounding"), (8.0, 4.05, "rounding")],
)
def test_an_error_falls_if_both_halvings_of_h_reduce_it_by_half_of_what_the_order_promises(
    quarter, half, flaw
):
    class Scripted(Study):
        def _errors(self, method, steps, comparisons):
            share = {100: quarter, 200: half, 400: 2.0}[steps]
            return dict.fromkeys(("theta", "energy", "final"), 1e-17 * share), False

    assert set(Scripted(DRIFT, 20.0).run(V, 400).flaws.values()) == {flaw}


def test_steps_are_doubled_where_rounding_hides_the_order():
    tried = []

    class Watched(Study):
        def run(self, method, steps, comparisons=400):
            tried.append(steps)
            return super().run(method, steps, comparisons)

    study = Watched(replace(DRIFT, cast=(R,)), 2.0, compiled)
    (attempt,) = reach(study, "theta", 1e-17)
    assert attempt.why_not.startswith("rounding")
    assert tried[-2:] == [2 * attempt.point.steps, 4 * attempt.point.steps]


@pytest.mark.parametrize(("time", "most"), [(1e-6, 10_000), (1e6, 10)])
def test_an_h_that_no_lab_would_take_is_not_tried(time, most):
    for attempt in reach(Study(DRIFT, time), "theta", 1e-30, most):
        assert attempt.point is None or Z_LIMITS[0] <= attempt.point.z <= Z_LIMITS[1]


@pytest.mark.parametrize(
    ("theta", "omega", "kind", "target"),
    [(0.02, 0.0, "theta", 1e-2), (0.02, 0.0, "energy", 1e-2), (0.0, 30.0, "energy", 0.1)],
)
def test_no_recommended_step_is_longer_than_half_a_swing_or_turn(theta, omega, kind, target):
    cast = (V, R, method_of("implicit_midpoint"))
    scene = replace(DRIFT, theta=theta, omega=omega, cast=cast)
    for attempt in least_cost(Study(scene, 20.0, compiled), kind, target):
        assert attempt.succeeded
        assert attempt.point.h * max(scene.w0, omega) <= math.pi
