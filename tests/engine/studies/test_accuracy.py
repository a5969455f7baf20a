"""Speed against accuracy: errors against the exact swing, costs counted, orders as claimed."""

import dataclasses
import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import USUAL_CAST, Method
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.run.loops import PlainLoops, available, compiled
from pendu_tui.engine.scenes import SCENES
from pendu_tui.engine.studies.accuracy import (
    Study,
    compilable,
    ladder,
    orders,
    rounding_floor,
    timed,
    usual,
)

E, S, V, R = USUAL_CAST
LOOPS = compiled if available() else PlainLoops  # the same bits
DRIFT = SCENES["drift"]
STEPS = ladder(20.0, 0.2, 0.0005, 9)


@pytest.fixture(scope="module")
def points():
    return list(Study(DRIFT, 20.0).points(STEPS))


@pytest.mark.parametrize("name", ["drift", "gentle", "large-swing"])
def test_the_measured_orders_are_the_claimed_ones(name):
    for order in orders(SCENES[name], 20.0):
        # 0.05 is the worst of these three scenes; the claim itself is a whole number
        assert order.measured == pytest.approx(order.method.order, abs=0.1)


@pytest.mark.parametrize(
    ("name", "time", "method", "measured"),
    [
        ("near-separatrix", 20.0, R, 5),
        ("spin", 5.0, S, 2),  # from the bottom it has the angles of Verlet
    ],
)
def test_some_starts_read_a_higher_order_than_the_methods(name, time, method, measured):
    order = orders(SCENES[name], time)[USUAL_CAST.index(method)]
    assert order.measured == pytest.approx(measured, abs=0.1)


@given(st.floats(0.1, 1e4), st.floats(1e-3, 1), st.floats(1e-3, 1), st.integers(2, 30))
def test_a_ladder_goes_from_the_first_h_to_the_last(time, coarsest, finest, count):
    h_max, h_min = coarsest * time, coarsest * finest * time
    rungs = ladder(time, h_max, h_min, count)
    assert rungs == sorted(set(rungs))
    assert 1 <= len(rungs) <= count
    # half a step is what rounding to a whole number of steps may change
    assert (rungs[0], rungs[-1]) == pytest.approx((time / h_max, time / h_min), abs=0.51)


def test_a_study_has_a_point_with_its_cost_for_every_rung_and_method(points):
    assert [(p.steps, p.method) for p in points] == list(itertools.product(STEPS, USUAL_CAST))
    for point in points:
        assert point.h * point.steps == pytest.approx(20.0)
        assert point.force_evaluations == point.method.evaluations(point.steps)


def test_more_evaluations_buy_smaller_errors(points):
    for method, kind in itertools.product(USUAL_CAST, ("theta", "energy")):
        valid = [p for p in points if p.method is method and p.flaw(kind) is None]
        assert len(valid) >= 2
        for cheap, dear in itertools.pairwise(valid):
            assert cheap.force_evaluations < dear.force_evaluations
            assert cheap.error(kind) > dear.error(kind)


@pytest.mark.parametrize("steps", [100, 999, 5000])
def test_errors_are_the_largest_of_the_run(steps):
    point = Study(DRIFT, 10.0).run(V, steps, comparisons=steps)
    exact, energy, phase = DRIFT.exact(), DRIFT.equations.energy(), (DRIFT.theta, DRIFT.omega)
    start, path = energy(phase), []
    for _ in range(steps):
        path.append(phase := PlainLoops(V, DRIFT.equations).propagate(phase, 10.0 / steps, 1))
    off = [abs(theta - exact.at(n * (10.0 / steps)).theta) for n, (theta, _) in enumerate(path, 1)]
    assert point.theta_error == max(off)
    assert point.final_error == off[-1]
    assert point.energy_error == max(abs(energy(y) - start) / start for y in path)
    sampled = Study(DRIFT, 10.0).run(V, steps)
    # between two of 400 comparisons in 5 swings the error moves by some percent of its largest value
    assert 0.97 * point.theta_error <= sampled.theta_error <= point.theta_error
    assert sampled.energy_error == point.energy_error


def test_a_failed_run_is_kept_with_its_flaw(points):
    def overflowing(force, phase, h):
        theta, omega = phase
        while True:
            theta, omega = theta + h * omega, 1e9 * (omega + force(theta))
            yield theta, omega

    lost = points[0]
    overflowed = Study(DRIFT, 10.0).run(replace(E, key="overflowing", phases=overflowing), 100)
    assert lost.method is E
    assert lost.theta_error > math.pi
    assert lost.energy_error > 1
    assert lost.flaws == ("lost", "lost", "lost")
    assert overflowed.flaws == ("diverged", "diverged", "diverged")
    assert math.isfinite(overflowed.theta_error)


@pytest.mark.parametrize("time", [2.0, 20.0])
@pytest.mark.parametrize("name", ["drift", "gentle", "large-swing", "near-separatrix", "spin"])
def test_the_rounding_floor_lies_not_far_above_rounding_errors(name, time):
    study, steps = Study(SCENES[name], time, LOOPS), 2**17
    point, floors = study.run(R, steps), rounding_floor(SCENES[name], time)
    energy_floor, theta_floor = (floor * math.sqrt(steps) for floor in floors)
    # measured 0.005 to 0.6 in theta and 0.001 to 0.5 in energy, for steps from 2^14 to 2^22
    assert 0.003 * theta_floor < point.theta_error < theta_floor
    assert 0.0005 * energy_floor < point.energy_error < energy_floor
    assert study.run(R, 2**20).flaws.energy == "rounding"


def test_at_rest_there_is_no_error():
    point = Study(DRIFT.altered(theta=0.0), 1.0).run(R, 10)
    assert (point.theta_error, point.energy_error) == (0.0, 0.0)
    assert [order.measured for order in orders(DRIFT.altered(theta=0.0), 1.0)] == [None] * 4


def test_an_error_as_large_as_the_swing_is_lost_and_one_below_the_floor_is_rounding():
    study = Study(DRIFT, 20.0)
    energy, theta = (20 * floor for floor in rounding_floor(DRIFT, 20.0))  # of 400 steps
    for share, flaw in ((1.001, None), (0.999, "rounding")):
        assert set(study.flaws((share * theta, share * energy, share * theta), 400)) == {flaw}
    assert study.sizes == pytest.approx({"theta": 1.0, "energy": 1.0, "final": 1.0})
    for share, flaw in ((0.999, None), (1.001, "lost")):
        assert set(study.flaws((share, share, share), 400)) == {flaw}
    assert Study(SCENES["spin"], 20.0).sizes["theta"] == math.pi


@pytest.mark.parametrize(("all_methods", "largest", "rungs"), [(False, 0.6, 12), (True, 2.4, 14)])
def test_by_default_ten_small_swings_take_up_to_four_thousand_steps_each(
    all_methods, largest, rungs
):
    time, steps = usual(DRIFT, all_methods)
    assert time == 20.0
    assert len(steps) == rungs
    z = [time / steps[end] * DRIFT.w0 for end in (0, -1)]
    assert z == pytest.approx([largest, 0.0015], rel=0.02)  # whole steps


def test_seconds_are_of_compiled_loops_only_if_all_methods_can_be_compiled():
    fields = {each.name: getattr(R, each.name) for each in dataclasses.fields(Method)}
    own = OwnMethod(**fields, measured=None, source="", file="")
    assert compilable((E, R)) == available()
    assert not compilable((E, own))


def test_short_runs_are_timed_many_at_a_time():
    calls = []

    class Counting:
        def __init__(self, method, model):
            pass

        def propagate(self, phase, h, n):
            calls.append(n)

    point = Study(DRIFT, 10.0).run(R, 100)
    seconds = timed(point, DRIFT, lambda: 0.01 * len(calls), Counting).seconds
    assert calls == [1, 100] + 5 * 200 * [100]  # 20 000 steps a measurement
    assert seconds == pytest.approx(0.01)


def test_seconds_are_the_shortest_of_several_runs_with_their_spread():
    ticks = itertools.chain.from_iterable((0.0, n) for n in (5.0, 3.0, 4.0, 6.0, 3.5))
    point = Study(DRIFT, 10.0).run(R, 30_000)
    assert timed(point, DRIFT, lambda: next(ticks)) == replace(point, seconds=3.0, spread=1.0)
    assert next(ticks, None) is None


def test_a_time_and_steps_that_make_no_usable_h_are_refused():
    with pytest.raises(InputError, match="not a usable step"):
        Study(DRIFT, 1e6).run(R, 1)
