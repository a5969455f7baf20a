"""Verdicts against runs of a million steps on the grid of tests/truths.py."""

import math
import random
from statistics import median

import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run.judge import Judge, LookPoint
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import PlainLoops, available, compiled
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from tests.truths import is_true, scene_at, truths, verdicts, watch

E, S, V, R = USUAL_CAST
LOOPS = compiled if available() else PlainLoops  # the same bits
CELLS = list(truths())
SAMPLED = CELLS[::47]  # 47 and the 36 steps of a line have no divisor in common
BELOW_THE_LIMITS = ["grows", "bounded", "bounded", "loses"]


def course(method, scene: Scene, steps: int) -> list[str]:
    return [verdict for verdict, *_ in verdicts(method, scene, LOOPS, steps)]


@pytest.mark.slow
@pytest.mark.parametrize("part", range(6))
def test_no_verdict_is_wrong_or_flickers(part: int) -> None:
    for method, start, z, letter in SAMPLED[part::6]:
        scene = scene_at(start, z)
        given = verdicts(method, scene, LOOPS, watch(scene))
        assert is_true(letter, given), (method.key, start, z, letter, given)


def test_verdicts_wait_for_nine_periods_as_a_rule() -> None:
    """Where h·w0 is up to 0.9 and a period has eight steps or more; beyond, resonances take thousands of steps."""
    waits = []
    for method, start, z, _ in SAMPLED:
        scene = scene_at(start, z)
        period = scene.exact().period or math.inf
        if 0.01 <= z <= 0.9 and period >= 8 * scene.h and len(waits) < 80:
            given = verdicts(method, scene, LOOPS, round(60 * period / scene.h))
            waits += [given[0][2]] if given else [60.0]
    waits.sort()
    assert median(waits) <= 9
    assert waits[9 * len(waits) // 10] <= 25


@pytest.mark.parametrize(
    ("theta", "h"), [(1.25, 0.348011), (1.69, 0.370360), (1.3, 0.3512), (0.37, 0.459757)]
)
def test_an_orbit_that_beats_at_a_resonance_never_grows_or_loses(theta: float, h: float) -> None:
    for method in (S, V):
        assert course(method, Scene(theta=theta, h=h), 6000) in ([], ["bounded"])


@pytest.mark.parametrize(
    ("index", "theta", "h"), [(1, 0.3, 0.654514), (1, 2.3, 0.351203), (2, 2.3, 0.351203)]
)
def test_a_chaotic_orbit_gets_its_verdict_and_lyapunov_number(
    index: int, theta: float, h: float
) -> None:
    scene = Scene(theta=theta, h=h)
    assert course(USUAL_CAST[index], scene, 6000) == ["chaotic"]
    lockstep = Lockstep(scene, loops=LOOPS, judged=True)
    lockstep.advance(6000)
    lyapunov = lockstep.judgements[index].lyapunov
    assert lyapunov is not None
    assert 0.01 < lyapunov * h < 2  # per step


def test_rk4_at_200_rad_per_s_is_not_called_bounded() -> None:
    scene = Scene(theta=0.0, omega=200.0, h=0.001)
    assert "bounded" not in course(R, scene, 30_000)


def test_caught_chaotic_and_wandering_orbits_get_their_verdicts() -> None:
    assert course(R, SCENES["rk4-limit-above"], 6000)[-1] == "grows"
    # at omega h = pi
    assert course(E, SCENES["drift"].altered(h=0.16), 10_000) == ["grows"]
    assert course(R, Scene(h=1.2 / Scene().w0), 6000) == ["loses"]  # everything
    assert course(V, SCENES["chaos-fenced"], 6000) == ["chaotic"]
    assert course(E, Scene(h=2.1 / Scene().w0), 30_000)[-1:] in ([], ["undecided"])


@pytest.mark.parametrize("h", [0.02, 0.1])
def test_judging_may_begin_anywhere_in_a_swing(h: float) -> None:
    """As after a change of h: the energy error is then neither 0 nor at an end of its band."""
    scene = SCENES["large-swing"]
    for steps in (5, 13, 29, 47):
        lockstep = Lockstep(scene, loops=LOOPS, judged=True)
        lockstep.advance(steps)
        lockstep.set_stepping(Stepping(h))
        lockstep.advance(round(120 / h))
        assert [judgement.verdict for judgement in lockstep.judgements] == BELOW_THE_LIMITS


def test_backwards_in_time_the_same_methods_gain_keep_and_lose() -> None:
    scene = SCENES["drift"]
    lockstep = Lockstep(scene, loops=LOOPS, judged=True)
    lockstep.set_stepping(Stepping(-scene.h))
    lockstep.advance(2000)
    assert [judgement.verdict for judgement in lockstep.judgements] == BELOW_THE_LIMITS


def judged(errors) -> Judge:
    """Return a judge of made-up errors, 16 steps a period."""
    points = [LookPoint(step, error, error, error) for step, error in enumerate(errors)]
    judge = Judge(h=0.1, period=1.6, method=R, model=Pendulum(1.0), start=points[0])
    for point in points[1:]:
        judge.look(point)
    return judge


@pytest.mark.parametrize("seed", range(4))
def test_a_random_walk_of_roundings_is_no_trend(seed: int) -> None:
    walk, errors = random.Random(seed), [0.0]
    for _ in range(20_000):
        errors.append(errors[-1] + walk.gauss(0, 1e-15))
    assert judged(errors).judgement.verdict in ("undecided", "bounded")


def test_before_four_swings_it_is_too_early_and_there_is_no_slope() -> None:
    judgement = judged([0.0] * 60).judgement
    assert (judgement.verdict, judgement.slope, judgement.uncertainty) == ("undecided", None, None)
    assert judgement.progress is not None
    assert judgement.progress.have < judgement.progress.need


def test_a_damped_energy_is_judged_only_where_it_is_above_rounding() -> None:
    scene = SCENES["damped"].altered(theta=2.0, omega=9.0, friction=0.5)
    lockstep = Lockstep(scene, loops=LOOPS, judged=True)
    lockstep.advance(round(160 / scene.h))
    verdicts = [each.verdict for each in lockstep.judgements]
    assert verdicts == ["grows", "loses", "undecided", "grows"]


def test_a_verdict_is_taken_back_when_the_error_comes_back() -> None:
    away, back = [k * 1e-3 for k in range(640)], [1e-2 * math.sin(k / 3) for k in range(4000)]
    assert judged(away).judgement.verdict == "grows"
    assert judged(away + back).judgement.verdict != "grows"


def test_the_largest_errors_that_a_lockstep_gives_leave_no_nan() -> None:
    judgement = judged([-1.0] * 20 + [1e300 * (-1) ** k for k in range(6000)]).judgement
    assert judgement.slope is None or math.isfinite(judgement.slope)
    assert judgement.uncertainty is None or math.isfinite(judgement.uncertainty)
