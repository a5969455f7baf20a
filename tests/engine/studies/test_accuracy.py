"""Speed against accuracy: errors against the exact swing, costs counted."""

import dataclasses
import math
from dataclasses import replace
from itertools import islice, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import GENERAL, TAYLOR_20, USUAL_CAST, Method, method_of
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.run.loops import PlainLoops, compiled, count_evaluations
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies import accuracy
from pendu_tui.engine.studies.accuracy import (
    Point,
    Study,
    compilable,
    cost_at,
    front,
    ladder,
    measured,
    rounding_floor,
    timed,
    usual,
    with_all_methods,
)

E, S, V, R = USUAL_CAST
BM6 = method_of("blanes_moan_6")
DRIFT = SCENES["drift"]


@given(st.floats(0.1, 1e4), st.floats(1e-3, 1), st.floats(1e-3, 1), st.integers(2, 30))
def test_a_ladder_goes_from_the_first_h_to_the_last(time, coarsest, finest, count):
    h_max, h_min = coarsest * time, coarsest * finest * time
    rungs = ladder(time, h_max, h_min, count)
    assert rungs == sorted(set(rungs))
    assert 1 <= len(rungs) <= count
    # half a step is what rounding to a whole number of steps may change
    assert (rungs[0], rungs[-1]) == pytest.approx((time / h_max, time / h_min), abs=0.51)


@pytest.mark.parametrize("steps", [100, 999, 5000])
def test_errors_are_the_largest_of_the_run(steps):
    point = Study(DRIFT, 10.0).run(V, steps, comparisons=steps)
    exact, energy, phase = DRIFT.exact(), DRIFT.equations.energy(), (DRIFT.theta, DRIFT.omega)
    start, path = energy(phase), []
    for _ in range(steps):
        path.append(phase := PlainLoops(V, DRIFT.equations).propagate(phase, 10.0 / steps, 1))
    off = [abs(theta - exact.at(n * (10.0 / steps)).theta) for n, (theta, _) in enumerate(path, 1)]
    largest = max(abs(energy(y) - start) / start for y in path)
    assert point.errors == {"theta": max(off), "energy": largest, "final": off[-1]}
    assert point.seconds is point.spread is None


@pytest.mark.parametrize("steps", [799, 800, 1199, 5000])
def test_a_run_is_compared_at_400_times_or_more_below_800(steps):
    study, times = Study(DRIFT, 10.0), []
    study.exact = DRIFT.exact()._replace(at=lambda t: times.append(t) or DRIFT.exact().at(t))
    study.run(V, steps)
    assert 400 <= len(times) < 800


def test_a_failed_run_is_kept_with_its_flaw():
    def failing(force, phase, h):
        yield from islice(V.phases(force, phase, h), 50)
        yield math.nan, math.nan

    lost = Study(DRIFT, 20.0).run(E, 100)
    failed = Study(DRIFT, 1.0).run(replace(V, key="failing", phases=failing, varies=True), 1000)
    assert lost.errors["theta"] > math.pi
    assert lost.errors["energy"] > 1 > failed.errors["energy"]
    for point in (lost, failed):
        assert set(point.flaws.values()) == {"lost"}
        assert all(map(math.isfinite, point.errors.values()))


@pytest.mark.parametrize(
    ("name", "time"), [("drift", 20.0), ("gentle", 2.0), ("near-separatrix", 2.0), ("spin", 20.0)]
)
def test_the_rounding_floor_lies_not_far_above_rounding_errors(name, time):
    study, steps = Study(SCENES[name], time, compiled), 2**17
    point, floors = study.run(R, steps), rounding_floor(SCENES[name], time)
    energy_floor, theta_floor = (floor * math.sqrt(steps) for floor in floors)
    # measured 0.005 to 0.6 in theta and 0.001 to 0.5 in energy, for steps from 2^14 to 2^22
    assert 0.003 * theta_floor < point.errors["theta"] < theta_floor
    assert 0.0005 * energy_floor < point.errors["energy"] < energy_floor
    assert study.run(R, 2**20).flaws["energy"] == "rounding"


def test_an_error_as_large_as_the_swing_is_lost_and_one_below_the_floor_is_rounding():
    study = Study(DRIFT, 20.0)
    energy, theta = (20 * floor for floor in rounding_floor(DRIFT, 20.0))  # of 400 steps
    assert study.sizes == pytest.approx({"theta": 1.0, "energy": 1.0, "final": 1.0})
    for kind, floor in (("theta", theta), ("energy", energy), ("final", theta)):
        errors = (0.999 * floor, 1.001 * floor, 0.999, 1.001)
        flaws = [study.flaw(kind, error, 400) for error in errors]
        assert flaws == ["rounding", None, None, "lost"]
    assert Study(SCENES["spin"], 20.0).sizes["theta"] == math.pi
    assert Study(DRIFT.altered(theta=-1.0), 0.1).sizes["final"] == 1.0
    _, late = rounding_floor(SCENES["near-separatrix"], 20.0)
    assert late == pytest.approx(1.556e-9, rel=0.01)  # where a change of energy delays it most


@pytest.mark.parametrize(("all_methods", "largest", "rungs"), [(False, 0.6, 12), (True, 2.4, 14)])
def test_by_default_ten_small_swings_take_up_to_four_thousand_steps_each(
    all_methods, largest, rungs
):
    time, steps = usual(DRIFT, all_methods)
    assert time == 20.0
    assert len(steps) == rungs
    z = [time / steps[end] * DRIFT.w0 for end in (0, -1)]
    assert z == pytest.approx([largest, 0.0015], rel=0.02)  # whole steps
    short = ladder(0.01, 0.01, 0.0015 / DRIFT.w0, rungs)
    assert usual(DRIFT, all_methods, 0.01) == (0.01, short)


@pytest.mark.parametrize(("steps", "runs"), [(100, 200), (15_000, 1), (30_000, 1)])
def test_seconds_are_the_shortest_of_five_of_20000_steps_or_more_with_their_spread(steps, runs):
    calls, lengths = [], [5.0, 3.0, 4.0, 6.0, 3.5]

    class Counting:
        def __init__(self, method, model):
            pass

        def propagate(self, phase, h, n):
            calls.append(n)

    def clock():
        done = (len(calls) - 1) / runs
        return sum(lengths[: int(done)])

    found = timed(at(R, steps, 0.1), DRIFT, clock, Counting)
    assert calls == (5 * runs + 1) * [steps]
    assert (found.seconds, found.spread) == pytest.approx((3.0 / runs, 1.0))


def test_with_all_methods_each_general_one_is_there_once_and_the_cast_first():
    cast = with_all_methods(replace(DRIFT, cast=(R, E))).cast
    assert cast[:2] == (R, E)
    assert sorted(cast, key=GENERAL.index) == list(GENERAL)


def test_a_scene_at_rest_has_no_errors():
    rest = DRIFT.altered(theta=0.0)
    points = list(measured(rest, 1.0, [10, 20]))
    assert [(p.steps, p.method) for p in points] == [*product([10, 20], USUAL_CAST)]
    assert {error for point in points for error in point.errors.values()} == {0.0}


def test_only_if_all_methods_can_be_compiled_are_they_timed_so(monkeypatch):
    fields = {each.name: getattr(R, each.name) for each in dataclasses.fields(Method)}
    assert compilable((E, R))
    assert not compilable((E, OwnMethod(**fields, measured=None, source="", file="")))
    monkeypatch.setattr(accuracy, "available", lambda: False)
    assert not compilable((E, R))


def at(method, steps, error, seconds=None, flaw=None):
    errors = {"theta": error}
    return Point(
        method, 10.0, 3.0, steps, errors, {"theta": flaw}, method.evaluations(steps), seconds
    )


LINES = [at(R, 10**n, 10.0 ** (4 - 4 * n), 1e-4 * 10**n) for n in range(1, 5)] + [
    at(BM6, 10**n, 10.0 ** (2 - 6 * n + 4), 3e-4 * 10**n) for n in range(1, 4)
]


def test_a_point_knows_its_step_in_each_unit():
    point = at(R, 20, 1e-5)
    assert (point.h, point.z) == (0.5, 1.5)
    assert point.steps_per_swing == pytest.approx(math.tau / 1.5)


def cost(line, target, of="evaluations"):
    return cost_at(line, "theta", of, target)


def test_an_error_that_no_useful_point_reaches_has_no_cost():
    assert cost(LINES[:4], 1e-13) is None
    assert cost(LINES[:4], 1.0) == 4 * 10
    assert cost([at(R, 10, 0.1)], 1.0, "seconds") is None  # not timed
    for coarser, finer in ((0.1, 0.0), (math.inf, 1e-3)):
        assert cost([at(R, 10, coarser), at(R, 20, finer)], 0.01) == 80
    lost = [at(R, 10, 1e-5, flaw="lost"), at(R, 20, 1e-3), at(R, 40, 1e-7, flaw="rounding")]
    assert cost(lost, 1e-4) > 4 * 20
    assert cost(lost, 1e-7) == 4 * 40
    assert cost(lost, 1e-2) == 4 * 20  # not between lost and found
    lucky = [at(R, 10, 1e-5), at(R, 20, 1e-2)]
    assert cost(lucky, 1e-3) == 4 * 10  # not between first and last


def test_the_order_decides_which_method_is_cheapest_and_by_how_much():
    found = front(LINES[::-1], "theta", "evaluations")
    assert [cut.target for cut in found] == pytest.approx([10.0**-n for n in range(1, 13)])
    for one in found:
        rk4, bm6 = 40 * one.target ** -(1 / 4), 11 * 10 * one.target ** -(1 / 6)
        assert one.method is (R if rk4 < bm6 else BM6)
        assert one.cost == pytest.approx(min(rk4, bm6), rel=0.01)  # BM6 has one more in all
        assert one.saves == pytest.approx(rk4 / one.cost, rel=1e-6)
    # an error that the coarsest run of one reaches is left out
    lines = [at(S, 10, 1e-4), at(S, 100, 1e-17), at(V, 10, 1.0), at(V, 100, 1e-2)]
    found = front(lines, "theta", "evaluations")
    assert [one.target for one in found] == pytest.approx([10.0**-n for n in range(5, 16)])
    assert {one.saves for one in found} == {None}


def test_a_series_counts_seconds_and_no_evaluations():
    lines = [*LINES, at(TAYLOR_20, 10, 1.0, 5e-3), at(TAYLOR_20, 40, 1e-13, 6e-3)]
    assert TAYLOR_20 not in {one.method for one in front(lines, "theta", "evaluations")}
    found = front(lines, "theta", "seconds")
    assert {one.method for one in found} == {R, TAYLOR_20}
    assert {one.saves for one in found if one.method is TAYLOR_20} == {None}


def test_evaluations_that_vary_are_those_of_2000_steps_extrapolated():
    method = method_of("backward_euler")
    point = Study(DRIFT, 10.0, compiled).run(method, 4000)
    counted = count_evaluations(method, DRIFT.equations, (1.0, 0.0), point.h, 4000)
    assert point.force_evaluations == pytest.approx(counted, rel=0.02)
    assert Study(DRIFT, 10.0).run(method, 100).force_evaluations == 730
    assert Study(DRIFT, 10.0, compiled).run(V, 4000).force_evaluations == 4001
