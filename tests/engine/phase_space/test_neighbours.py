"""A ring of neighbours that keeps up with a run."""

import numpy as np

from engine.phase_space.area import Neighbourhood
from engine.phase_space.neighbours import Neighbours
from engine.scenes import SCENES
from tui.playback.live import Live

DRIFT = SCENES["drift"]


def rings(neighbours: Neighbours, live: Live, most: int = 10_000) -> np.ndarray:
    ring = neighbours.follow(live.scene, live.sample.run, live.sample.step, live.events, most)
    return np.array(ring.rings)


def expected(*stretches: tuple[int, float]) -> np.ndarray:
    ring = Neighbourhood(DRIFT, 0.1)
    for steps, h in stretches:
        ring.advance(steps, h)
    return np.array(ring.rings)


def test_it_takes_the_steps_of_the_run_changes_of_h_included():
    live = Live(DRIFT)
    live.step(7)
    live.set_h(0.02)
    live.step(5)
    live.set_h(-0.02)
    live.step(3)
    assert np.array_equal(rings(Neighbours(0.1), live), expected((7, 0.05), (5, 0.02), (3, -0.02)))


def test_it_does_not_matter_when_one_began_to_look_nor_how_often():
    live, early = Live(DRIFT), Neighbours(0.1)
    for _ in range(10):
        live.step(3)
        rings(early, live)
    assert np.array_equal(rings(early, live), rings(Neighbours(0.1), live))


def test_it_comes_nearer_by_no_more_steps_than_a_frame_has_time_for():
    live, neighbours = Live(DRIFT), Neighbours(0.1)
    live.step(250)
    for step in (100, 200, 250):
        rings(neighbours, live, most=100)
        assert neighbours.step == step
    assert np.array_equal(rings(neighbours, live), expected((250, 0.05)))


def test_it_goes_back_with_the_run_and_begins_again_with_another():
    live, neighbours = Live(DRIFT), Neighbours(0.1)
    live.step(20)
    rings(neighbours, live)
    live.step(-5)
    assert np.array_equal(rings(neighbours, live), expected((15, 0.05)))
    live.set_h(0.1)  # in the past: a run of its own, that shares the first 15 steps
    live.step(2)
    assert np.array_equal(rings(neighbours, live), expected((15, 0.05), (2, 0.1)))
    live.start(SCENES["gentle"])
    live.step(4)
    gentle = Neighbourhood(SCENES["gentle"], 0.1)
    gentle.advance(4, SCENES["gentle"].h)
    assert np.array_equal(rings(neighbours, live), np.array(gentle.rings))


def test_a_change_of_h_just_after_the_last_step_counts_for_the_next_one():
    live, neighbours = Live(DRIFT), Neighbours(0.1)
    live.step(5)
    rings(neighbours, live)
    live.set_h(0.01)
    rings(neighbours, live)
    live.step(1)
    assert np.array_equal(rings(neighbours, live), expected((5, 0.05), (1, 0.01)))
