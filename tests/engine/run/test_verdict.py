"""The verdict where the truth is known.

tests/bench/verdict.py establishes the truth by runs of 5000 to 50 000 periods over 260 cells of scenes x
methods x h; this is the part of that grid that plain Python does in seconds, and rotations that are not in it.
"""

import math
import random
from dataclasses import replace

import pytest

from engine.methods import METHODS
from engine.models.exact_pendulum import ExactMotion
from engine.run.lockstep import Lockstep
from engine.run.stepping import Stepping
from engine.run.verdict import Judgement, Trend
from engine.scenes import SCENES, Scene

BELOW_THE_LIMITS = ["grows", "bounded", "bounded", "drifts"]
TRUTH = {  # from the long runs, where it is not as below the limits
    "rk4-limit": ["grows", "grows", "grows", "drifts"],
    "rk4-limit-above": ["grows", "grows", "grows", "grows"],
}
SWINGS = ("drift", "gentle", "large-swing", "near-separatrix", "spin")
LIMITS = ("verlet-limit", "verlet-limit-above", "rk4-limit", "rk4-limit-above")
GRID = [*((name, z) for name in SWINGS for z in (0.05, 0.1, 0.2, 0.4)), *((name, SCENES[name].z) for name in LIMITS)]


def trends(scene: Scene) -> list[Trend]:
    return [Trend(ExactMotion(scene).period or math.tau / scene.w0) for _ in METHODS]


def follow(lockstep: Lockstep, steps: list[int], judges: list[Trend]) -> list[list[str]]:
    """The verdicts of each method in turn, as they change."""
    given: list[list[str]] = [[] for _ in judges]
    for n in steps:
        sample = lockstep.sample()
        for verdicts, judge, reading in zip(given, judges, sample.readings, strict=True):
            judge.read(sample.t, reading)
            if verdicts[-1:] != [judge.judgement.verdict]:
                verdicts.append(judge.judgement.verdict)
        lockstep.advance(n)
    return given


def at(name: str, z: float) -> Scene:
    return SCENES[name].altered(h=z / SCENES[name].w0)


def samples(scene: Scene, periods: float, per_second: int = 30) -> list[int]:
    """Steps between samples, as the lab takes them."""
    every = max(1, round(1 / per_second / scene.h))
    return [every] * math.ceil(periods * (ExactMotion(scene).period or 1.0) / scene.h / every)


@pytest.mark.parametrize(("name", "z"), GRID)
def test_one_verdict_is_given_it_is_true_and_it_does_not_flicker(name: str, z: float) -> None:
    scene = at(name, z)
    given = follow(Lockstep(scene), samples(scene, 100), trends(scene))
    assert given == [["too early", true] for true in TRUTH.get(name, BELOW_THE_LIMITS)]


@pytest.mark.parametrize(("omega", "z", "turns"), [(8.0, 0.005, 100), (100.0, 0.003, 600)])
def test_rk4_in_fast_rotation_drifts_slowly_and_is_not_called_bounded_before(
    omega: float, z: float, turns: int
) -> None:
    scene = Scene(theta=0.0, omega=omega, h=z / Scene().w0)
    lockstep, judges = Lockstep(scene, methods=METHODS[3:]), trends(scene)[3:]
    assert follow(lockstep, samples(scene, turns), judges) == [["too early", "drifts"]]


@pytest.mark.parametrize(
    ("theta", "turn_of_a_step", "z"),
    [(math.pi, 3.085, 0.341), (0.0, 3.1029, 0.341), (3.0, 3.2, 0.341), (0.0, 6.2, 0.1), (0.0, 6.4, 0.1)],
)
def test_a_rotation_that_beats_with_its_steps_is_never_said_to_have_left(theta, turn_of_a_step, z) -> None:
    """Half a turn a step, or a whole one: over millions of steps the symplectic errors stay below a sixth."""
    scene = Scene(theta=theta, omega=turn_of_a_step * Scene().w0 / z, h=z / Scene().w0)
    lockstep, judges = Lockstep(scene, methods=METHODS[1:3]), trends(scene)[1:3]
    per_turn = ExactMotion(scene).period / scene.h
    for n in samples(scene, 300):
        lockstep.advance(n)
        for judge, reading in zip(judges, lockstep.sample().readings, strict=True):
            judge.read(lockstep.t, reading, per_turn)
            assert judge.judgement.verdict in ("too early", "bounded")


@pytest.mark.parametrize("name", SWINGS)
def test_fast_forward_with_uneven_gaps_of_up_to_two_seconds_misleads_nobody(name: str) -> None:
    scene = at(name, 0.1)
    uneven = random.Random(1)
    steps = [uneven.randint(1, 60) for _ in range(2000)]
    assert follow(Lockstep(scene), steps, trends(scene)) == [["too early", true] for true in BELOW_THE_LIMITS]


@pytest.mark.parametrize("h", [0.02, 0.1])
def test_a_new_trend_may_begin_anywhere_in_a_swing(h: float) -> None:
    """As after a change of h: the energy error is then neither 0 nor at an end of its band."""
    scene = SCENES["large-swing"]
    for steps in (5, 13, 29, 47):
        lockstep = Lockstep(scene)
        lockstep.advance(steps)
        lockstep.set_stepping(Stepping(h))
        given = follow(lockstep, [max(1, round(1 / 30 / h))] * 6000, trends(scene))
        assert given == [["too early", true] for true in BELOW_THE_LIMITS]


def test_backwards_in_time_the_same_methods_gain_keep_and_lose() -> None:
    scene = SCENES["drift"]
    lockstep = Lockstep(scene)
    lockstep.set_stepping(Stepping(-scene.h))
    given = follow(lockstep, samples(scene, 40), trends(scene))
    assert given == [["too early", true] for true in BELOW_THE_LIMITS]


def test_before_four_swings_it_is_too_early_and_there_is_no_slope() -> None:
    scene = SCENES["drift"]
    judges = trends(scene)
    follow(Lockstep(scene), samples(scene, 3.9), judges)
    assert [judge.judgement for judge in judges] == [Judgement("too early", None, None, 0.0)] * 4


def test_the_slope_is_that_of_a_long_run() -> None:
    scene = SCENES["drift"]
    lockstep, judges = Lockstep(scene), trends(scene)
    follow(lockstep, samples(scene, 30), judges)
    early = judges[3].judgement.slope
    lockstep.advance(40_000)  # 2000 s
    assert early is not None
    # RK4 loses 0.6 % of its energy on the way, and its rate changes by a few times that: 2 %.
    assert early == pytest.approx(lockstep.sample().readings[3].energy_error / lockstep.t, rel=0.02)


@pytest.mark.parametrize(("memory", "least"), [(0.0, 180), (0.6, 170)])
def test_the_uncertainty_is_honest(memory: float, least: int) -> None:
    """The true slope lies within two uncertainties in about 95 % of 200 noisy lines.

    It takes noise that lasts over several bins (autocorrelation 0.6 from bin to bin) for what it is, too,
    as well as 40 bins can tell; with the formula for independent residuals, 60 % would lie there.
    """
    hits = 0
    for seed in range(200):
        noise, trend, slow = random.Random(seed), Trend(1.0), 0.0
        for k in range(16 * 40):
            if k % 16 == 0:
                slow = memory * slow + noise.gauss(0, 0.1 if memory else 0.0)
            trend.add(k / 16, 1e-3 * k / 16 + slow + noise.gauss(0, 0.1 * (1 - memory)))
        judgement = trend.judgement
        assert judgement.slope is not None
        assert judgement.uncertainty is not None
        hits += abs(judgement.slope - 1e-3) < 2 * judgement.uncertainty
    assert least <= hits <= 199


@pytest.mark.parametrize("seed", range(8))
def test_a_random_walk_of_roundings_is_no_trend(seed: int) -> None:
    """1e-16 a step, a million steps: it strays by 1e-13, but nothing pulls it."""
    walk, trend = random.Random(seed), Trend(2.0)
    error = 0.0
    for k in range(20_000):
        error += walk.gauss(0, 1e-16 * math.sqrt(50))
        trend.add(k / 30, error)
        assert trend.judgement.verdict in ("too early", "bounded")
    assert trend.judgement.verdict == "bounded"


def test_rounding_that_strays_far_while_theta_winds_up_is_no_trend_either() -> None:
    """Beside the separatrix at a tiny step the wandering of theta's last bit is 1e-11 of the energy."""
    walk, trend = random.Random(3), Trend(2.0)
    error = 0.0
    for k in range(40_000):
        error += walk.gauss(0, 1e-13)
        trend.add(k / 30, error)
        assert trend.judgement.verdict in ("too early", "bounded")


def test_what_loses_all_its_energy_at_once_drifts() -> None:
    trend = Trend(6.3)
    for k in range(200):
        trend.add(2.6 * k, 0.3**k - 1)
    assert trend.judgement.verdict == "drifts"


def test_what_has_diverged_grows_from_the_first_reading_on() -> None:
    reading = Lockstep(SCENES["drift"]).sample().readings[0]
    trend = Trend(2.0)
    trend.read(0.0, reading)
    trend.read(0.1, replace(reading, diverged_at=0.05))
    assert trend.judgement.verdict == "grows"


def test_extremes_from_before_its_time_are_none_of_a_trends_business() -> None:
    """The first reading after a change of h still carries the extremes of the steps before."""
    burdened, fresh = Trend(1.0), Trend(1.0)
    burdened.add(0.0, 0.5, low=-9.0, high=9.0)
    fresh.add(0.0, 0.5)
    for k in range(1, 200):
        for trend in (burdened, fresh):
            trend.add(k / 16, 0.5)
    assert burdened.judgement == fresh.judgement


def test_memory_is_constant() -> None:
    trend = Trend(1.0)
    for k in range(100_000):
        trend.add(k / 16, math.sin(k))
    assert len(trend._bins) < 64


def test_the_largest_errors_that_a_lockstep_gives_leave_no_nan() -> None:
    trend = Trend(1.0)
    for k in range(300):
        trend.add(k / 16, -1.0 if k < 20 else 1e300 * (-1) ** k)
    judgement = trend.judgement
    assert judgement.slope is None or math.isfinite(judgement.slope)
    assert judgement.uncertainty is None or math.isfinite(judgement.uncertainty)
