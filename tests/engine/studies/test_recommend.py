"""Recommended runs hold when they are repeated and compared at every step."""

import math
from dataclasses import replace
from itertools import count

import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import TAYLOR_20, USUAL_CAST
from pendu_tui.engine.run.loops import compiled
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.accuracy import Point, Study
from pendu_tui.engine.studies.recommend import least_cost, reach

E, S, V, R = USUAL_CAST
DRIFT = SCENES["drift"]


def test_a_target_as_large_as_the_swing_is_refused():
    study = Study(DRIFT, 1.0)
    with pytest.raises(InputError, match="as large as the swing"):
        least_cost(study, "theta", study.sizes["theta"])


def test_a_method_far_dearer_than_another_is_given_up():
    study = Study(replace(DRIFT, cast=(E, R)), 10.0, compiled)
    seconds = count()  # each measurement takes one
    cheapest, dear = least_cost(study, "theta", 3e-4, clock=lambda: next(seconds))
    assert (cheapest.method, cheapest.cost, cheapest.times) == (R, cheapest.reached.seconds, 1)
    assert (dear.method, dear.cost, dear.times, dear.reached) == (E, math.inf, None, None)
    budget = 300 * cheapest.reached.force_evaluations
    assert (dear.why_not, dear.point) == (f"not within {budget:,} evaluations", None)


def test_the_cheapest_is_first_and_others_cost_a_multiple_of_it():
    study = Study(replace(DRIFT, cast=(V, R)), 10.0, compiled)
    shares = []
    best, other = least_cost(study, "energy", 1e-2, shares.append)
    steps = best.reached.steps
    runs = steps, math.ceil(1.1 * steps), math.floor(steps / 1.03)
    here, finer, coarser = (study.run(V, n, n).errors["energy"] for n in runs)
    assert max(here, finer) <= 1e-2 < coarser
    assert (best.method, best.times, other.method) == (V, 1.0, R)
    assert 1 < other.times == other.cost / best.cost
    assert shares == [0.5, 1]
    seconds = count()  # each measurement takes one
    best, other = least_cost(study, "energy", 1e-2, clock=lambda: next(seconds))
    assert best.method is R  # of the longer step, which 20 000 steps measure in more runs


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


def confirmed(*steps):
    return [(each, 10_000) for each in steps]


# the error after n steps, what is asked, the steps tried, those kept, the budget or why they fail
SEARCHES = {
    "the order predicts steps, bisected to 2 %; 10 % more do, so not by chance": (
        lambda n: 1e-3 if n in (102, 111) else n**-2, {},
        [10, 40, 100, 63, 79, 88, 93, 96, 97, 98, *confirmed(100, 111, 102, 113, 105, 116)], 105,
        None,
    ),
    "an error that falls more slowly is reached by 10 % more": (
        lambda n: 1e-2 / n, {},
        [10, 32, 57, 76, 88, 97, 107, 101, 98, 99, *confirmed(101, 112)], 101, None,
    ),
    "no step is longer than half a turn, as 9 would be": (
        lambda n: 1e-5, {"omega": -6.0}, [30, 16, 12, 10, *confirmed(10, 11)], 10, None,
    ),
    "1000 are predicted, more than twice the budget": (
        lambda n: n**-2, {"target": 1e-6, "most": 450}, [10], None, 450,
    ),
    "1000 are predicted, less than twice the budget": (
        lambda n: n**-2, {"target": 1e-6, "most": 550}, [10, 40, 160, 549], 549,
        550,
    ),
    "a series has as many terms as its order": (
        lambda n: n**-2, {"method": TAYLOR_20, "most": 270}, [10, 13], 13, 270,
    ),
    "an error of 0.2 predicts nothing": (
        lambda n: 20 * n**-2, {"target": 1e-6, "most": 450}, [10, 40], None, 450,
    ),
    "an error of 0.06 predicts the steps": (
        lambda n: 100 * n**-2, {"target": 1e-6, "most": 450}, [10, 40], None, 450,
    ),
    "rounding keeps the error from falling twice": (
        lambda n: {10: 1e-7, 40: 4e-9}.get(n, 1e-9 if n < 640 else 9e-10), {"target": 1e-12},
        [10, 40, 160, 320, 640, 1280, 2560], 640, "rounding stops it at 9.0e-10",
    ),
    "rounding keeps the first error from falling twice": (
        lambda n: 1e-9, {"target": 1e-12}, [10, 20, 40], 10, "rounding stops it at 1.0e-09",
    ),
    "rounding stops the last run of the budget": (
        lambda n: 1e-9, {"target": 1e-12, "most": 21}, [10, 20], 10, "rounding stops it at 1.0e-09",
    ),
    "a lost swing of 0.02 predicts nothing": (
        lambda n: 0.05 if n < 70 else 1e-4, {"size": 0.02, "most": 71},
        [10, 40, 70, 52, 60, 64, 66, 67, 68, 69, *confirmed(70, 77)], 70, None,
    ),
    "20 runs are not confirmed": (
        lambda n: n**-2 if n <= 100 else 2e-4, {}, confirmed(157, 173), 157,
        20_000_000,
    ),
    "the last run of the budget is not confirmed": (
        lambda n: n**-2 if n <= 100 else 2e-4, {"most": 105}, confirmed(102, 113, 104, 115), 104,
        105,
    ),
    "no shorter h is tried than a lab takes": (
        lambda n: 1e-5 / n, {"time": 1e-6, "target": 1e-9}, [1818], 1818,
        20_000_000,
    ),
    "the longest h leaves 2000 steps": (
        lambda n: 2, {"time": 1e6, "most": 2001}, [2000], 2000, 2001,
    ),
    "no h is short enough": (
        lambda n: 2, {"time": 1e6, "most": 2000}, [], None, 2000,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SEARCHES)
def test_a_search_multiplies_the_steps_then_bisects_then_confirms(name):
    """Its errors follow a law; those up to 1e-9 are rounding."""
    law, asked, tried, kept, why_not = SEARCHES[name]
    most = [value for option, value in asked.items() if option == "most"]
    asked = {"omega": 0.0, "method": V, "time": 5.0, "target": 1e-4, "size": 1, **asked}
    scene = DRIFT.altered(gravity=4.0, omega=asked["omega"], cast=(asked["method"],))  # w0 = 2
    study, found = Study(scene, asked["time"]), []

    def run(method, steps, comparisons=400):
        found.append(steps if comparisons == 400 else (steps, comparisons))
        error = law(steps)
        flaw = "lost" if error > asked["size"] else "rounding" if error <= 1e-9 else None
        return Point(method, study.time, 2.0, steps, {"theta": error}, {"theta": flaw}, 0)

    study.run = run
    (attempt,) = reach(study, "theta", asked["target"], *most)
    assert found[-len(tried) :] == tried
    assert (attempt.point and attempt.point.steps) == kept
    if isinstance(why_not, int):
        why_not = f"not within {why_not:,} evaluations"
    assert attempt.why_not == why_not
