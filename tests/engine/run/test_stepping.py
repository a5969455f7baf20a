"""How a run steps: h along 1, 2, 5, both directions of time, and equal cost."""

import math
from dataclasses import replace

import pytest

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.methods.splitting import FOREST_RUTH
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.stepping import Stepping, SteppingChange, change_before
from pendu_tui.engine.scenes import DEFAULT_SCENE

EQUAL = Stepping(0.2, equal_cost=True)


def test_h_goes_along_1_2_5():
    stepping, rungs = Stepping(0.05), []
    for up in [True] * 6 + [False] * 7:
        stepping = stepping.next(up=up)
        rungs.append(stepping.h)
    assert rungs == [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02]
    for towards, up, rung in ((0, True, 0.5), (1, False, 0.1)):  # from a rung, but for rounding
        assert Stepping(math.nextafter(0.2, towards)).next(up).h == rung


def test_at_equal_cost_the_cheap_methods_take_a_step_in_parts():
    assert EQUAL.own == (0.05, 0.05, 0.05, 0.2)
    assert (Stepping(0.05).toggled(), EQUAL.toggled()) == (EQUAL, Stepping(0.05))
    assert EQUAL.reversed().reversed() == EQUAL
    assert EQUAL.reversed().next(up=True) == Stepping(-0.4, equal_cost=True)
    assert Stepping(-0.1).with_own(USUAL_CAST[0], 0.3) == Stepping(-0.3)
    assert EQUAL.reversed().with_own(USUAL_CAST[0], 0.5) == Stepping(-2.0, equal_cost=True)
    assert EQUAL.with_own(FOREST_RUTH, 0.5) == Stepping(0.5, equal_cost=True)  # not in the cast


def test_costs_that_do_not_divide_are_rounded_to_whole_parts():
    costs = tuple(replace(USUAL_CAST[0], force_evaluations=n) for n in (1, 3, 4, 7))
    assert Stepping(0.1, True, costs).parts == (7, 2, 2, 1)


@pytest.mark.parametrize("h", [0.0, math.nan, math.inf, 1001.0, -1001.0, 9e-10, 2e-9])
def test_a_step_that_is_absurd_for_one_of_the_methods_is_refused(h):
    for usable in (2e-9, -2e-9, 1000.0, -1000.0):
        Stepping(usable).check(1.0)
    with pytest.raises(InputError, match="not a usable step"):
        Stepping(h, equal_cost=True).check(1.0)


def test_a_step_is_made_with_the_last_change_before_it():
    first, later = Stepping(0.1), Stepping(0.2)
    at = [(0, 0.0, first), (5, 0.5, later), (5, 0.5, EQUAL)]
    changes = [SteppingChange(*each) for each in at]
    found = [change_before(changes, step).stepping for step in (0, 5, 6)]
    assert found == [first, first, EQUAL]


def test_a_method_diverges_at_a_part_of_a_step_keeps_its_last_phase_and_others_go_on():
    def doubling(force, phase, h):
        theta, omega = phase
        while True:
            omega = omega * 2 + 1
            yield theta, omega

    cast = replace(USUAL_CAST[0], key="bad", phases=doubling), USUAL_CAST[3]
    lockstep = Lockstep(replace(DEFAULT_SCENE, omega=3.0, cast=cast), judged=True)
    lockstep.set_stepping(Stepping(0.2, True, cast))
    lockstep.advance(1000)
    frozen, other = lockstep.sample().readings
    alone = Lockstep(replace(lockstep.scene, cast=cast[1:], h=0.2))
    alone.advance(1000)
    assert (other,) == alone.sample().readings
    at = frozen.diverged_at
    parts = round(at / 0.05)
    assert at == parts * 0.05
    (failed,) = (each for each in lockstep.milestones if each.kind == "failed")
    assert (failed.step, failed.t) == (math.ceil(parts / 4), at)
    assert frozen.omega == 2.0 ** (parts + 1)
    # where omega²/2 leaves the range
    assert (2.0 ** (parts + 1)) ** 2 / 2 < 1e300 < (2.0 ** (parts + 2)) ** 2
    assert parts % 4 == 1  # it fails in the first part of a step
