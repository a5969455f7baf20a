"""What is seen of a run, against the run looked at step by step."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.methods import USUAL_CAST
from engine.run.crossing import Crossings
from engine.run.judging import Seen
from engine.run.lockstep import Lockstep, Sample
from engine.run.observer import Milestone, RunObserver
from engine.run.stepping import Stepping, SteppingChange
from engine.scenes import SCENES, Scene

DRIFT = SCENES["drift"]


def watched(scene: Scene, seconds: float, every: int = 1, equal_cost: bool = False) -> RunObserver:
    """An observer of a run, with a sample every so many steps."""
    observer, lockstep = RunObserver(scene), Lockstep(scene)
    lockstep.set_stepping(Stepping(scene.h, equal_cost).with_smallest(scene.h))
    change = SteppingChange(0, 0.0, lockstep.stepping)
    observer.add(lockstep.sample(), change)
    while lockstep.t < seconds:
        lockstep.advance(every)
        observer.add(lockstep.sample(), change)
    return observer


def told(observer: RunObserver, kind: str, step: int = 10**9) -> dict[str, Milestone]:
    return {each.method.key: each for each in observer.milestones(step) if each.kind == kind}


def tops(scene: Scene, seconds: float, parts: int = 1) -> dict[str, tuple[float, float]]:
    """When each method is first over the top, and its energy error there, looking at every step."""
    lockstep, found = Lockstep(scene.altered(h=scene.h / parts)), {}
    while lockstep.t < seconds:
        lockstep.advance(1)
        sample = lockstep.sample()
        for method, reading in zip(USUAL_CAST, sample.readings, strict=True):
            if abs(reading.theta) > math.pi:
                found.setdefault(method.key, (sample.t, reading.energy_error))
    return found


@pytest.mark.parametrize("name", ["drift", "crossover", "near-separatrix", "rk4-limit", "chaos-loose"])
@pytest.mark.parametrize("every", [1, 7, 400])
def test_the_step_over_the_top_is_found_however_far_apart_the_samples_are(name, every):
    seconds = 30.0
    expected = tops(SCENES[name], seconds)
    found = told(watched(SCENES[name], seconds, every), "over the top")
    assert {key for key, (t, _) in expected.items() if t < seconds - 400 * SCENES[name].h} <= set(found)
    for key, (t, error) in expected.items():
        if every == 1 or (key in found and name != "chaos-loose"):  # chaos may be back below between two samples
            # the time is a sum of rounded steps; the energy has the rounding of the steps taken again
            assert found[key].t == pytest.approx(t, abs=1e-9)
            assert found[key].energy_error == pytest.approx(error, rel=1e-6)


def test_at_equal_cost_the_parts_of_a_step_count():
    found = told(watched(DRIFT, 60, every=5, equal_cost=True), "over the top")
    assert found["explicit_euler"].t == pytest.approx(tops(DRIFT, 60)["explicit_euler"][0], abs=1e-9)
    assert found["explicit_euler"].step == math.ceil(found["explicit_euler"].t / (4 * DRIFT.h) - 1e-9)


def test_if_steps_cannot_be_taken_again_the_milestone_is_at_the_sample():
    lockstep = Lockstep(DRIFT)
    observer = RunObserver(DRIFT)
    lockstep.advance(100)
    observer.add(lockstep.sample())
    lockstep.advance(20)
    lockstep.set_stepping(Stepping(0.02))  # nobody says so
    lockstep.advance(100)
    sample = lockstep.sample()
    observer.add(sample)
    top = told(observer, "over the top")["explicit_euler"]
    assert (top.step, top.t, top.energy_error) == (sample.step, sample.t, sample.readings[0].energy_error)


def test_a_pendulum_that_spins_goes_over_no_top():
    assert not told(watched(SCENES["spin"], 20), "over the top")


def test_a_rotation_that_beats_with_its_steps_gets_no_early_verdict():
    scene = Scene(theta=0.0, omega=6.2 * Scene().w0 / 0.1, h=0.1 / Scene().w0)
    observer, lockstep = RunObserver(scene), Lockstep(scene)
    for _ in range(700):
        lockstep.advance(1)
        observer.add(lockstep.sample())
    assert {judgement.verdict for judgement in observer.judgements[1:3]} <= {"too early", "bounded"}


def test_a_method_beyond_the_top_at_the_first_sample_has_no_milestone_there():
    lockstep = Lockstep(DRIFT)
    lockstep.advance(200)
    observer = RunObserver(DRIFT)
    observer.add(lockstep.sample())
    lockstep.advance(1)
    observer.add(lockstep.sample())
    assert not told(observer, "over the top")


def test_verdicts_happen_when_they_are_given():
    observer = RunObserver(DRIFT)
    lockstep = Lockstep(DRIFT)
    changes = []
    observer.add(lockstep.sample())
    for _ in range(1200):
        before = [judgement.verdict for judgement in observer.judgements]
        lockstep.advance(1)
        observer.add(lockstep.sample())
        after = [judgement.verdict for judgement in observer.judgements]
        changes += [(lockstep.step, m, after[i]) for i, m in enumerate(USUAL_CAST) if after[i] != before[i]]
    verdicts = [(each.step, each.method, each.verdict) for each in observer.milestones(1200) if each.kind == "verdict"]
    assert verdicts == changes
    assert {(method.key, verdict) for _, method, verdict in changes} >= {
        ("explicit_euler", "grows"),
        ("symplectic_euler", "bounded"),
        ("velocity_verlet", "bounded"),
        ("rk4", "loses"),
    }


@pytest.mark.parametrize("every", [1, 7, 400])
def test_rk4s_error_passes_verlets_once_and_at_the_same_step_whatever_the_samples(every):
    observer = watched(SCENES["crossover"], 120, every)
    (passing,) = [each for each in observer.milestones(600) if each.kind == "errors cross"]
    assert (passing.method.key, passing.other.key, passing.step) == ("rk4", "velocity_verlet", 167)
    assert passing.t == pytest.approx(33.4)
    assert {"rk4", "velocity_verlet"} <= set(told(observer, "verdict", 167))  # it is known that this is for good


def test_errors_cross_where_one_that_leaves_passes_one_that_is_bounded_after_it_was_below():
    bounded = Seen(0, 0.0, 0.3, "bounded", news=False)
    for others, passed in [
        ([("loses", 0.2), ("loses", 0.3), ("loses", 0.4), ("loses", 0.2), ("loses", 0.4)], [2]),  # once
        ([("grows", 0.2), ("grows", 0.4)], [1]),
        ([("loses", 0.4), ("loses", 0.5)], []),  # it was never below
        ([("too early", 0.2), ("loses", 0.4)], []),  # nor was it known to leave then
        ([("bounded", 0.2), ("bounded", 0.4)], []),
        ([("loses", 0.2), ("caught", 0.4)], []),
    ]:
        crossings = Crossings()
        found = [crossings.add({0: bounded, 1: Seen(0, 0.0, peak, verdict, False)}) for verdict, peak in others]
        assert found == [[(1, 0)] if look in passed else [] for look in range(len(others))]


def test_a_method_fails_once_at_the_time_at_which_its_numbers_ended():
    observer = RunObserver(DRIFT)
    samples = [Lockstep(DRIFT).sample()]
    euler, *others = samples[0].readings
    failed = (euler._replace(diverged_at=0.15), *others)
    samples += [Sample(1, step, step * 0.05, failed) for step in (4, 5, 6)]
    for sample in samples:
        observer.add(sample)
    (failure,) = [each for each in observer.milestones(6) if each.kind == "failed"]
    assert (failure.method.key, failure.step, failure.t) == ("explicit_euler", 4, 0.15)
    assert not told(observer, "verdict")  # to fail is enough


@settings(max_examples=20)
@given(back=st.integers(0, 240))
def test_after_a_step_back_only_earlier_milestones_remain(back):
    observer, lockstep = RunObserver(DRIFT), Lockstep(DRIFT)
    samples = [lockstep.sample()]
    for _ in range(240):
        lockstep.advance(1)
        samples.append(lockstep.sample())
    for sample in samples:
        observer.add(sample)
    everything = observer.milestones(240)
    for sample in samples[back:]:
        observer.add(sample)  # forward again: known already
    assert observer.milestones(240) == everything
    assert observer.milestones(back) == [each for each in everything if each.step <= back]
    observer.judge_anew(back)  # a change there: the future has never been
    assert observer.milestones(240) == [each for each in everything if each.step <= back]
    assert all(judgement.verdict == "too early" for judgement in observer.judgements)
