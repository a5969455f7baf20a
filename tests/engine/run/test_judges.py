"""Verdicts and milestones of a run do not depend on how it is cut."""

import math
import random
from collections.abc import Iterable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pendu_tui.engine.methods import GENERAL, USUAL_CAST
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import PlainLoops, available, compiled
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.engine.scenes import SCENES, Scene
from tests.bench.judging import exclude, judgements

DRIFT = SCENES["drift"]


def moved(scene: Scene, gaps: Iterable[int], loops=PlainLoops) -> Lockstep:
    lockstep = Lockstep(scene, loops=loops, judged=True)
    for gap in gaps:
        lockstep.advance(gap)
        lockstep.sample()
    return lockstep


def milestones(lockstep: Lockstep, kind: str) -> list[Milestone]:
    return [each for each in lockstep.milestones if each.kind == kind]


def tops(scene: Scene, steps: int) -> dict[str, tuple[int, float, float]]:
    """Step, time and energy error where each method first is over the top, by every step."""
    lockstep = Lockstep(scene)
    found: dict[str, tuple[int, float, float]] = {}
    for _ in range(steps):
        lockstep.advance(1)
        for method, reading in zip(scene.cast, lockstep.sample().readings, strict=True):
            if abs(reading.theta) > math.pi:
                found.setdefault(method.key, (lockstep.step, lockstep.t, reading.energy_error))
    return found


@pytest.mark.parametrize(
    "name", ["drift", "crossover", "near-separatrix", "rk4-limit", "chaos-loose"]
)
def test_the_step_over_the_top_does_not_depend_on_samples(name: str) -> None:
    steps = math.ceil(30 / SCENES[name].h)
    expected = tops(SCENES[name], steps)
    for gap in (1, 7, 400):
        found = milestones(moved(SCENES[name], [gap] * (steps // gap)), "over the top")
        last = steps // gap * gap
        assert {each.method.key: (each.step, each.t, each.energy_error) for each in found} == {
            key: top for key, top in expected.items() if top[0] <= last
        }


def test_a_pendulum_that_spins_goes_over_no_top() -> None:
    assert not milestones(moved(SCENES["spin"], [2000]), "over the top")


def test_a_rotation_that_beats_with_its_steps_gets_no_early_verdict() -> None:
    scene = Scene(theta=0.0, omega=6.2 * Scene().w0 / 0.1, h=0.1 / Scene().w0)
    lockstep = Lockstep(scene, judged=True)
    lockstep.advance(700)
    assert {judgement.verdict for judgement in lockstep.judgements[1:3]} <= {"undecided", "bounded"}


def test_verdicts_happen_when_they_are_given() -> None:
    lockstep = Lockstep(DRIFT, judged=True)
    changes = []
    for _ in range(1200):
        before = [judgement.verdict for judgement in lockstep.judgements]
        lockstep.advance(1)
        after = [judgement.verdict for judgement in lockstep.judgements]
        changes += [
            (lockstep.step, m, after[i]) for i, m in enumerate(USUAL_CAST) if after[i] != before[i]
        ]
    verdicts = milestones(lockstep, "verdict")
    assert [(each.step, each.method, each.verdict) for each in verdicts] == changes
    assert {(method.key, verdict) for _, method, verdict in changes} >= {
        ("explicit_euler", "grows"),
        ("symplectic_euler", "bounded"),
        ("velocity_verlet", "bounded"),
        ("rk4", "loses"),
    }


def test_rk4s_error_passes_verlets_once_for_good() -> None:
    lockstep = moved(SCENES["crossover"], [7] * 86)
    (passing,) = milestones(lockstep, "errors cross")
    assert passing.other is not None
    assert (passing.method.key, passing.other.key, passing.step) == ("rk4", "velocity_verlet", 167)
    assert passing.t == pytest.approx(33.4)
    verdicts = {each.method.key for each in milestones(lockstep, "verdict") if each.step <= 167}
    assert {"rk4", "velocity_verlet"} <= verdicts


def test_a_method_fails_once_at_the_time_at_which_its_numbers_ended() -> None:
    lockstep = Lockstep(Scene(model="linear", h=1.0), judged=True)
    lockstep.advance(2000)
    failed = {each.method.key: each.t for each in milestones(lockstep, "failed")}
    readings = lockstep.sample().readings
    ends = {
        m.key: r.diverged_at
        for m, r in zip(USUAL_CAST, readings, strict=True)
        if r.diverged_at is not None
    }
    assert failed == ends
    assert failed
    for method, judgement in zip(USUAL_CAST, lockstep.judgements, strict=True):
        assert (judgement.verdict == "failed") == (method.key in failed)


@pytest.mark.parametrize(
    "name",
    ["drift", "large-swing", "spin", "verlet-limit-above", "chaos-loose", "damped", "stiff-slow"],
)
def test_verdicts_and_milestones_do_not_depend_on_samples_or_loops(name: str) -> None:
    scene, uneven = SCENES[name], random.Random(1)
    steps = min(30_000, math.ceil(40 * (scene.exact().period or 1.0) / scene.h))
    whole = moved(scene, [steps])
    gaps = [uneven.randint(1, 400) for _ in range(steps // 400)]
    cut = moved(scene, [*gaps, steps - sum(gaps)])
    assert cut.milestones == whole.milestones
    assert cut.judgements == whole.judgements
    assert whole.milestones
    if available():
        fast = moved(scene, [steps], compiled)
        assert (fast.milestones, fast.judgements) == (whole.milestones, whole.judgements)


@pytest.mark.parametrize("name", ["drift", "gentle", "crossover", "spin", "damped", "learned"])
def test_a_run_and_its_energies_alone_do_not_exclude_each_other(name: str) -> None:
    found = list(judgements(SCENES[name], 60.0))
    assert not [method.key for method, of_run, alone in found if exclude(of_run, alone)]
    assert all(of_run.slope is not None for _, of_run, _ in found)


@settings(max_examples=10, deadline=None, derandomize=True)  # tests/bench/judging.py: 200
@given(theta=st.floats(0.05, 2.5), z=st.floats(0.02, 1.5), method=st.sampled_from(GENERAL))
def test_a_random_run_and_its_energies_do_not_exclude_each_other(theta, z, method) -> None:
    """Over twenty swings: an unfinished one of few is a slope in a run's bins."""
    scene = Scene(theta=theta, h=z / Scene().w0, cast=(method,))
    ((_, of_run, alone),) = judgements(scene, 60.0)
    assert not exclude(of_run, alone)


@settings(max_examples=20, deadline=None)
@given(back=st.integers(0, 1500), at=st.integers(0, 1500))
def test_after_a_way_back_verdicts_are_those_of_their_step(back: int, at: int) -> None:
    run = RewindableRun(DRIFT, loops=PlainLoops)
    run.forward(1500)
    run.go_to(back)
    run.forward(max(0, at - back))
    alone = Lockstep(DRIFT, judged=True)
    alone.advance(run.step)
    assert run.lockstep.judgements == alone.judgements
    assert list(run.lockstep.milestones) == list(alone.milestones)


def test_a_change_of_the_stepping_in_the_past_forgets_what_came_later() -> None:
    run = RewindableRun(DRIFT, loops=PlainLoops)
    run.forward(1200)
    everything = list(run.lockstep.milestones)
    run.go_to(300)
    run.branch(2)
    run.change(Stepping(0.02, cast=DRIFT.cast))
    assert list(run.lockstep.milestones) == [each for each in everything if each.step <= 300]
    assert {judgement.verdict for judgement in run.lockstep.judgements} == {"undecided"}
    run.forward(1500)
    verdicts = [judgement.verdict for judgement in run.lockstep.judgements]
    assert verdicts == ["grows", "bounded", "bounded", "loses"]


@pytest.mark.parametrize("name", ["drift", "near-separatrix", "crossover"])
def test_nothing_is_simulated_for_the_judge(name: str) -> None:
    """Velocity Verlet evaluates the force once a step, and once more where it begins."""
    verlet = USUAL_CAST[2]
    calls = []

    def counting(force, phase, h):
        return verlet.phases(lambda theta: calls.append(theta) or force(theta), phase, h)

    scene = SCENES[name].with_cast((replace(verlet, phases=counting),))
    Lockstep(scene, judged=True).advance(600)
    assert sum(type(theta) is float for theta in calls) == 601  # tangent maps take complex numbers
