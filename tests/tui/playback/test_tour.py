"""The tour: each truth is measured at its moment, and the pages are walked without a screen."""

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from pendu_tui.engine.methods import RK4, VELOCITY_VERLET
from pendu_tui.engine.run.lockstep import Lockstep, Reading
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.engine.studies.accuracy import Study, usual
from pendu_tui.engine.studies.recommend import reach
from pendu_tui.engine.studies.ring import Neighbourhood
from pendu_tui.tui.playback.lesson import Lesson, tour
from pendu_tui.tui.playback.live import Live
from tests.tui.harness import FPS, Clocked

EXPLICIT, SYMPLECTIC, VERLET, RK = range(4)
DRIFT = SCENES["drift"]
*PAGES, LAST = tour().pages
GAINS, WHY, SMALLER, CROSSING, REVERSED, AREA, BREAKS, COSTS = PAGES


class Walked(Clocked):
    """A lab that follows a page to its question."""

    def __init__(self, page: Scene) -> None:
        live = Live(SCENES["spin"], clock=lambda: 0.0)
        super().__init__(live)
        lesson = Lesson("Tour", [page])
        lesson.begin(live, 0)
        before = live.sample
        while not lesson.follow(live, before):
            before = live.sample
            self.run(1 / FPS)
            assert self.now < 60
        self.readings = live.sample.readings


def after(scene: Scene, seconds: float) -> tuple[Reading, ...]:
    lockstep = Lockstep(scene)
    lockstep.advance(round(seconds / scene.h))
    return tuple(lockstep.sample().readings)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_question_comes_after_about_ten_seconds_exactly_at_the_moment(page):
    walked = Walked(page)
    moment = 0.0 if page.shot.returns else page.shot.moment
    assert 6 < walked.now < 13
    assert walked.source.playhead.paused
    assert walked.source.sample.t == pytest.approx(moment, abs=1e-9)


def test_explicit_euler_gains_and_the_others_keep_their_energy_nearly():
    readings = Walked(GAINS).readings
    assert 1 + readings[EXPLICIT].energy_error == pytest.approx(5, abs=0.3)
    assert readings[SYMPLECTIC].max_energy_error == pytest.approx(0.08, abs=0.005)
    assert readings[VERLET].max_energy_error == pytest.approx(0.006, abs=5e-4)
    assert readings[RK].energy_error == pytest.approx(-2e-5, abs=5e-6)
    period = DRIFT.exact().period
    swings = [after(DRIFT, count * period) for count in range(1, 10)]
    losses = [each[RK].energy_error for each in swings]
    assert losses == sorted(losses, reverse=True)
    assert all(abs(swings[6][place].energy_error) < 0.01 for place in (SYMPLECTIC, VERLET))


def test_why_explicit_euler_gains_and_symplectic_euler_does_not():
    energies = [1 + after(WHY, steps * WHY.h)[EXPLICIT].energy_error for steps in range(1, 12)]
    assert WHY.z**2 == pytest.approx(0.25)
    ratios = [late / early - 1 for early, late in pairwise(energies)]
    assert ratios == pytest.approx([0.25] * 10, abs=0.03)
    assert energies[-1] > 10
    euler = after(WHY, 10_000)[SYMPLECTIC]
    assert euler.energy_error_low == pytest.approx(-0.20, abs=0.005)
    assert euler.energy_error_high == pytest.approx(0.33, abs=0.005)


def test_half_the_step_is_a_quarter_of_verlets_error_and_a_thirty_second_of_rk4s():
    walked, whole = Walked(SMALLER), after(DRIFT, 17.6)
    readings = walked.readings
    assert SMALLER.numbers == {**DRIFT.numbers, "h": DRIFT.h / 2}
    errors = [each[VERLET].max_energy_error for each in (whole, readings)]
    assert errors == pytest.approx([0.0057, 0.0014], abs=5e-5)
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.1)
    assert whole[RK].energy_error / readings[RK].energy_error == pytest.approx(32, abs=2)
    over = [each.t for each in walked.source.milestones if each.kind == "over the top"]
    assert over == [pytest.approx(12.45)]
    assert Walked(GAINS).source.milestones[0].t == pytest.approx(7.15)
    ghost = walked.source.ghost  # the run with the whole step
    assert ghost.scene.h == DRIFT.h
    assert ghost.rods(17.6).keys() == {method.key for method in DRIFT.cast}


def test_it_ends_with_a_fresh_run_to_play_with_that_is_not_called_astray():
    lesson = Lesson("Tour", [LAST])
    live = Live(SCENES["spin"], clock=lambda: 0.0)
    lesson.begin(live, 0)
    assert (live.scene.numbers, live.ghost) == (DRIFT.numbers, None)
    live.start(DRIFT.altered(theta=2.0))
    assert not lesson.is_astray(live)


def test_the_crossing_is_for_good_and_a_smaller_step_puts_it_off():
    def ratio(h: float, seconds: float) -> float:
        readings = after(replace(CROSSING, h=h), seconds)
        return readings[RK].max_energy_error / readings[VERLET].max_energy_error

    passed = [each.t for each in Walked(CROSSING).source.milestones if each.other]
    assert passed == [pytest.approx(33, abs=1)]
    assert ratio(CROSSING.h, 5) < 1 / 5
    assert all(ratio(CROSSING.h, seconds) > 1.4 for seconds in (50, 200))
    assert ratio(0.05, 31 * 60) < 1 < ratio(0.05, 34 * 60)


def test_time_reversed_brings_verlet_home_and_no_other():
    walked = Walked(REVERSED)
    misses = [
        math.hypot(each.theta - REVERSED.theta, (each.omega - REVERSED.omega) / REVERSED.w0)  # rad
        for each in walked.readings
    ]
    assert misses[VERLET] < 1e-14
    assert misses[RK] == pytest.approx(4e-5, abs=5e-6)
    assert misses[SYMPLECTIC] > 0.1
    assert misses[EXPLICIT] > 1


def test_two_methods_keep_area():
    t = AREA.shot.moment
    assert t == pytest.approx(2 * AREA.exact().period, abs=AREA.h)
    ring = Neighbourhood(AREA, 0.1)
    ring.advance(round(t / AREA.h), Stepping(AREA.h))
    ratios = ring.area_ratios
    assert ratios[SYMPLECTIC] == pytest.approx(1, abs=1e-12)
    assert ratios[VERLET] == pytest.approx(1, abs=1e-12)
    assert ratios[EXPLICIT] == pytest.approx(2.4, abs=0.05)
    assert 1 - 1e-4 < ratios[RK] < 1


def test_above_its_limit_verlet_is_held_by_the_pendulum_and_not_by_the_spring():
    walked = Walked(BREAKS)
    assert BREAKS.theta == 0.1
    assert walked.source.sample.step == 10
    assert abs(walked.readings[VERLET].theta) == pytest.approx(0.47, abs=0.01)
    assert BREAKS.z > VELOCITY_VERLET.linear_limit == 2
    lockstep, largest = Lockstep(BREAKS), 0.0
    for _ in range(1000):
        lockstep.advance(1)
        largest = max(largest, abs(lockstep.sample().readings[VERLET].theta))
    assert largest == pytest.approx(0.48, abs=0.005)
    slower = math.tau / replace(BREAKS, theta=0.48).exact().period
    assert BREAKS.h * slower < 2
    assert abs(after(replace(BREAKS, model="linear"), 200)[VERLET].theta) > 1e9


def test_which_method_is_cheaper_depends_on_the_accuracy():
    walked = Walked(COSTS)
    verlet, rk4 = (walked.source.stepping.own[place] for place in (VERLET, RK))
    assert rk4 == 4 * verlet
    time, _ = usual(COSTS, all=False)
    cost = {}
    for method in (VELOCITY_VERLET, RK4):
        for target in (1e-2, 1e-6):
            study = Study(COSTS.with_cast((method,)), time)
            (attempt,) = reach(study, "energy", target)
            cost[method, target] = attempt.point.force_evaluations
    assert cost[VELOCITY_VERLET, 1e-2] / cost[RK4, 1e-2] == pytest.approx(1 / 2, abs=0.05)
    assert cost[RK4, 1e-6] / cost[VELOCITY_VERLET, 1e-6] == pytest.approx(1 / 8, abs=0.01)
