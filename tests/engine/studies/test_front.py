"""The cheapest method at each accuracy, interpolated between made-up points."""

import pytest

from pendu_tui.engine.methods import TAYLOR_20, method_of
from pendu_tui.engine.studies.accuracy import Flaws, Point, cost_at, front, ranges

RK4, BM6 = method_of("rk4"), method_of("blanes_moan_6")


def at(method, steps, error, seconds=None, flaw=None):
    return Point(method, 10.0, 3.0, steps, error, error, error, Flaws(flaw, flaw, flaw), seconds)


LINES = [at(RK4, 10**n, 10.0 ** (4 - 4 * n), 1e-4 * 10**n) for n in range(1, 5)] + [
    at(BM6, 10**n, 10.0 ** (2 - 6 * n + 4), 3e-4 * 10**n) for n in range(1, 4)
]


@pytest.mark.parametrize("target", [1e-1, 1e-5, 3e-7])
def test_between_two_points_the_cost_follows_the_slope(target):
    steps = 10 * target ** -(1 / 4)  # the line of RK4 above
    assert cost_at(LINES[:4], "theta", "evaluations", target) == pytest.approx(4 * steps)
    assert cost_at(LINES[:4][::-1], "theta", "seconds", target) == pytest.approx(1e-4 * steps)


def test_an_error_that_no_useful_point_reaches_has_no_cost():
    assert cost_at(LINES[:4], "theta", "evaluations", 1e-13) is None
    lost = [at(RK4, 10, 1e-5, flaw="lost"), at(RK4, 20, 1e-3), at(RK4, 40, 1e-7, flaw="rounding")]
    assert cost_at(lost, "theta", "evaluations", 1e-4) > 4 * 20
    assert cost_at(lost, "theta", "evaluations", 1e-7) == 4 * 40


def test_the_order_decides_which_method_is_cheapest_and_by_how_much():
    found = front(LINES, "theta", "evaluations")
    assert [cut.target for cut in found] == pytest.approx([10.0**-n for n in range(1, 13)])
    for one in found:
        rk4, bm6 = 40 * one.target ** -(1 / 4), 11 * 10 * one.target ** -(1 / 6)
        assert one.method is (RK4 if rk4 < bm6 else BM6)
        assert one.cost == pytest.approx(min(rk4, bm6), rel=0.01)  # BM6 has one more in all
        assert one.saves == pytest.approx(rk4 / one.cost, rel=1e-6)
    assert [(method, len(some)) for method, some in ranges(found)] == [(RK4, 5), (BM6, 7)]


def test_a_series_counts_seconds_and_no_evaluations():
    lines = [*LINES, at(TAYLOR_20, 10, 1.0, 5e-3), at(TAYLOR_20, 40, 1e-13, 6e-3)]
    assert TAYLOR_20 not in {one.method for one in front(lines, "theta", "evaluations")}
    found = front(lines, "theta", "seconds")
    assert {one.method for one in found} == {RK4, TAYLOR_20}
    assert {one.saves for one in found if one.method is TAYLOR_20} == {None}


def test_an_error_that_the_coarsest_run_reaches_is_left_out():
    found = front([at(RK4, 10, 1e-4), at(RK4, 100, 1e-8)], "theta", "evaluations")
    assert [one.target for one in found] == pytest.approx([1e-5, 1e-6, 1e-7, 1e-8])
    assert ranges([]) == []
