"""The run before a restart, laid under the next one at the same moment of simulated time."""

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from tests.tui.harness import after

OTHER_H = DEFAULT_SCENE.altered(h=0.1)


def test_its_pendulums_and_errors_are_where_a_lab_with_its_step_size_would_have_them():
    history = after(OTHER_H, 15.0).history
    found = history.ghost()
    assert found.widest == abs(history.trails()[:, :-1, 0]).max()
    assert after(SCENES["stiff-slow"], 1.0).history.ghost().rods(0.5) == {}  # no rods
    for t in (1.0, 2.55, 7.0, 14.0):
        readings = after(OTHER_H, t).sample.readings
        assert [*found.rods(t).values()] == [reading.theta for reading in readings]
    assert found.rods(found.window(20.0).x[-1] + 0.1)  # until its next step
    assert found.rods(15.15) == found.rods(-1.0) == {}
    assert found.window(4.0).x.max() == pytest.approx(4.0, abs=0.2)
    recent = found.window(10.0, seconds=2.0)
    assert recent.x.min() == pytest.approx(10.0 - 2.0 - recent.repeats, abs=0.1)


def test_a_restart_with_another_step_leaves_the_old_run_as_a_ghost_and_the_next_one_drops_it():
    live = after(DEFAULT_SCENE, 4.0)
    old = live.history.window()
    live.change(live.stepping.next(up=True))
    live.change(live.stepping.reversed())
    live.restart()
    left = live.run_state
    last = live.sample
    assert (live.scene.h, live.scene.name) == (0.1, "drift (altered)")
    assert live.ghost.label == "dim: run before, h 0.05, 0.1 s"
    largest = live.ghost.window(3.0).high["energy_error"].max()
    assert largest == old.cut(0, 3.0).high["energy_error"].max()
    live.restart()
    assert live.ghost is None
    live.lay_under(0.01, 1.0)
    assert len(live.ghost.window(9.0).x) == 101  # with each step
    live.start(live.scene.altered(theta=2.0))
    assert (live.scene.name, live.ghost) == ("drift (altered)", None)
    live.set_speed(2.0)
    live.change(live.stepping.reversed())
    live.return_to(left)
    assert (live.playhead.speed, live.ghost, live.stepping) == (1.0, left.ghost, left.stepping)
    assert live.sample == last._replace(run=5)
    live.change(live.stepping.reversed())
    live.return_to(left)
    assert (live.sample.run, live.stepping) == (5, left.stepping)
