"""Every state of a run that goes back and forth equals that of a lockstep that goes forwards."""

import itertools
import math
from contextlib import suppress
from functools import partial

from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE

SCENE = DEFAULT_SCENE.with_cast(DEFAULT_SCENE.cast[-2:])
stepping = partial(Stepping, cast=SCENE.cast)


def straight(step, changes):
    """The sample of a lockstep that went to `step` without turning."""
    lockstep = Lockstep(SCENE)
    for at in sorted(at for at in changes if at < step):
        lockstep.advance(at - lockstep.step)
        lockstep.set_stepping(stepping(changes[at]))
    lockstep.advance(step - lockstep.step)
    return lockstep.sample()


def phases(sample):
    return [(reading.theta, reading.omega, reading.max_energy_error) for reading in sample.readings]


def test_the_way_home_is_of_whole_steps_that_lie_ahead():
    course = RewindableRun(SCENE)
    assert course.home == math.inf  # it is there
    assert course.changes[0].stepping == stepping(SCENE.h)
    course.forward(10)
    assert course.home == math.inf
    course.change(stepping(-SCENE.h))
    course.forward(4)
    assert course.home == 20
    course.forward(6)
    assert course.home == math.inf
    course.go_to(14)
    course.change(stepping(-0.04))  # it would pass 0 between two steps
    assert course.home == math.inf


def test_a_change_at_the_step_gone_back_to_is_still_ahead():
    course = RewindableRun(SCENE)
    course.forward(10)
    course.sample()
    course.change(stepping(0.1))
    assert not course.in_past
    course.go_to(5)
    course.forward(5)
    assert course.in_past  # another change here is of another run
    course.forward(5)
    course.sample()
    course.go_to(10)
    assert course.lockstep.stepping.h == SCENE.h
    course.forward(1)
    assert course.lockstep.stepping.h == 0.1
    course.forward(20)
    assert phases(course.sample()) == phases(straight(31, {10: 0.1}))


def test_a_branch_shares_the_past_and_forgets_the_future():
    course = RewindableRun(SCENE)
    course.forward(100)
    course.change(stepping(0.1))
    for _ in range(5):
        course.forward(1000)  # each of which leaves a copy
    course.change(stepping(0.3))
    course.sample()
    assert not course.in_past
    course.go_to(2000)
    course.sample()
    assert course.in_past
    course.branch(2)
    assert not course.in_past
    course.change(stepping(0.02))
    course.forward(3000)
    sample = course.sample()
    assert sample.run == 2
    for step in (5000, 4500, 1500):
        course.go_to(step)
        sample = course.sample()
        assert sample.run == 2
        assert phases(sample) == phases(straight(step, {100: 0.1, 2000: 0.02}))
        assert course.step_at(course.x) == step
    again = RewindableRun(SCENE)
    again.repeat(course.changes[1:], 4500)
    assert phases(again.sample()) == phases(straight(4500, {100: 0.1, 2000: 0.02}))


def test_an_error_on_the_way_leaves_the_run_where_it_was():
    course = RewindableRun(SCENE)
    course.forward(7)
    course.change(stepping(0.1))
    course.go_to(5)
    with suppress(KeyboardInterrupt), course.unchanged_by_errors():
        course.forward(5)
        raise KeyboardInterrupt
    course.forward(5)
    assert phases(course.sample()) == phases(straight(10, {7: 0.1}))


def test_extremes_after_going_back_count_from_the_furthest_step():
    ahead, returning = RewindableRun(SCENE), RewindableRun(SCENE)
    for course in (ahead, returning):
        course.forward(500)
        course.sample()
    returning.go_to(450)
    returning.sample()
    ahead.forward(20)
    ahead.sample(resets=False)
    ahead.forward(20)
    returning.forward(90)
    assert returning.sample() == ahead.sample()
    returning.go_to(520)
    returning.branch(2)  # of which nothing has been sampled
    returning.forward(40)
    whole = RewindableRun(SCENE, 2)
    whole.forward(560)
    assert returning.sample() == whole.sample()


def test_copies_are_few_and_closer_the_more_recent_they_are():
    course = RewindableRun(SCENE, 1)
    for _ in range(80):
        course.forward(1000)
    steps = [place.lockstep.step for place in course._copies]
    assert (steps[0], steps[-1]) == (0, course.step)
    assert len(steps) < 45  # 80 without thinning; 8 an octave of age with it
    for at, following in itertools.pairwise(steps):
        assert following - at <= max(1000, (steps[-1] - at) / 4)


def test_each_step_is_found_by_its_time_which_goes_up_even_while_time_runs_backwards():
    course = RewindableRun(SCENE)
    course.forward(7)
    for h in (0.1, -0.03):
        course.change(stepping(h))
        course.forward(300)
    assert math.isclose(course.t, 21.35)
    assert math.isclose(course.x, 39.35)
    for step in range(607):
        x = course.x_at(step)
        assert course.step_at(x) == step
        assert course.step_at(x + 0.02) == step
