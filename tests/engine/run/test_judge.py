"""Verdicts and milestones of runs: true, at their step, and the same however a run is cut."""

import math
import random
from dataclasses import replace
from functools import partial
from statistics import median

import numpy as np
import pytest

from pendu_tui.engine.methods import USUAL_CAST, method_of
from pendu_tui.engine.methods.splitting import FOREST_RUTH
from pendu_tui.engine.models.pendulum import LinearOscillator, Pendulum
from pendu_tui.engine.run import levels
from pendu_tui.engine.run.judge import Judge, LookPoint, stride
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import PlainLoops, compiled
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from tests.bench.judging import exclude, holds, judgements
from tests.engine.run.test_record import noise_of
from tests.sine import needs_rounded_sine
from tests.truths import is_true, scene_at, truths, verdicts

E, S, V, R = USUAL_CAST
DRIFT = SCENES["drift"]
W0 = Scene().w0


def words(lockstep):
    return [judgement.verdict for judgement in lockstep.judgements]


def moved(scene, gaps, loops=PlainLoops):
    lockstep = Lockstep(scene, loops=loops, judged=True)
    for gap in gaps:
        lockstep.advance(gap)
        lockstep.sample()
    return lockstep


def milestones(lockstep, kind):
    return [each for each in lockstep.milestones if each.kind == kind]


def test_verdicts_wait_for_nine_periods_as_a_rule():
    """Beyond z = 0.9, or eight steps a period, resonances take thousands of steps."""
    waits = []
    # 47 and the 36 steps of a line have no divisor in common
    for method, start, z, letter in list(truths())[::94]:
        scene = scene_at(start, z)
        period = scene.exact().period or math.inf
        if 0.03 <= z <= 0.9 and period >= 8 * scene.h:
            given = verdicts(method, scene, PlainLoops, round(60 * period / scene.h))
            assert is_true(letter, given), (method.key, start, z, letter, given)
            waits += [given[0][2]] if given else [60.0]
    waits.sort()
    assert median(waits) <= 9
    assert waits[9 * len(waits) // 10] <= 25


def test_a_chaotic_orbit_gets_its_verdict_and_lyapunov_number():
    """As the standard map: Chirikov, Phys. Rep. 52 (1979) 263."""
    h = math.sqrt(20) / W0
    lockstep = moved(Scene(theta=1.0, h=h, cast=(S,)), [6000])
    (found,) = milestones(lockstep, "verdict")
    assert (found.verdict, found.lyapunov * h) == ("chaotic", pytest.approx(math.log(10), rel=0.2))
    assert lockstep.judgements[0].lyapunov * h == pytest.approx(math.log(10), rel=0.02)


LINEAR = {1.99: "bounded", 2.01: "grows"}


@pytest.mark.parametrize(
    ("method", "scene", "steps", "ends"),
    [
        (R, Scene(theta=0.0, omega=200.0, h=0.001), 30_000, ["", "undecided", "loses"]),
        (R, SCENES["rk4-limit-above"], 6000, ["grows"]),
        (R, Scene(h=1.2 / W0), 6000, ["loses"]),  # everything
        (V, SCENES["chaos-fenced"], 6000, ["chaotic"]),
        (method_of("imex_euler"), SCENES["stiff-slow"], 15_000, ["loses"]),
        (E, Scene(h=2.1 / W0), 30_000, ["", "undecided"]),
        *((V, Scene(model="linear", h=z / W0), 100, [word]) for z, word in LINEAR.items()),
        (E, scene_at("theta=2.5", 1.2), 6000, ["bounded"]),  # back at its start again and again
        (E, scene_at("omega=31.4", 2.05), 6000, ["", "undecided"]),
        *((method, Scene(theta=1.69, h=0.37036), 6000, ["", "bounded"]) for method in (S, V)),
    ],
)
def test_what_leaves_or_is_lost_is_told_at_the_end(method, scene, steps, ends):
    assert [("",), *verdicts(method, scene, PlainLoops, steps)][-1][0] in ends


@pytest.mark.parametrize("h", [0.02, 0.1, -0.05])
def test_judging_may_begin_anywhere_in_a_swing_and_go_back(h):
    """As after a change of h: the energy error is then neither 0 nor at an end of its band."""
    for steps in (5, 29):
        lockstep = moved(SCENES["large-swing"], [steps])
        lockstep.set_stepping(Stepping(h))
        lockstep.advance(round(120 / abs(h)))
        assert words(lockstep) == ["grows", "bounded", "bounded", "loses"]


look_point = partial(LookPoint, theta=0.0, omega=0.0, energy=1.0)


@pytest.mark.parametrize("error", [-0.5, 0.5])
@pytest.mark.parametrize(("share", "peak"), [(0.99, 0.0), (1.01, 0.5)])
def test_a_damped_swing_and_the_true_one_count_from_1e5_roundings_on(error, share, peak):
    model = SCENES["damped"].equations
    energy = math.exp(max(error, 0.0)) * (share * 1e5 * R.epsilon * model.w0) ** 2
    judge = Judge(h=0.1, period=2.0, method=R, model=model, start=look_point(0, 0.0, 0.0, 0.0))
    judge.look(look_point(1, error, min(error, 0.0), max(error, 0.0), energy=energy))
    assert judge.peak == peak


BAND = 0.5 - 0.5 * np.cos(math.tau * np.arange(6000) / 16)


def judge_of(errors, h=0.1, model=Pendulum(1.0), method=R):  # noqa: B008
    """Return a judge of made-up errors, 16 steps of 0.1 a period."""
    points = [look_point(step, error, error, error) for step, error in enumerate(errors)]
    judge = Judge(h=h, period=1.6, method=method, model=model, start=points[0])
    for point in points[1:]:
        judge.look(point)
    return judge


WALK = 32 * math.sqrt(5000)  # roundings: eight sigmas


@pytest.mark.parametrize(
    ("scene", "method", "error", "expected"),
    [
        ("drift", R, 0.3 * WALK * 2.0**-53, "undecided"),
        ("drift", R, 0.9 * WALK * 2.0**-53, "grows"),
        ("damped", R, 4.9e-9, "undecided"),  # five errors of the reference
        ("damped", R, 5.1e-9, "grows"),
        ("damped", replace(R, epsilon=2.0**-24), 0.3 * WALK * 2.0**-24, "undecided"),
    ],
)
def test_what_roundings_may_add_up_to_is_no_growth(scene, method, error, expected):
    judge = judge_of([0.0, *[error] * 5000], model=SCENES[scene].equations, method=method)
    assert judge.judgement.verdict == expected


@pytest.mark.parametrize(
    ("model", "error", "verdict"),
    [
        (LinearOscillator(1.0), 0.99e6, "undecided"),
        (LinearOscillator(1.0), 1.01e6, "grows"),
        (Pendulum(1.0), 1.01e6, "undecided"),
    ],
)
def test_without_a_way_over_the_top_a_million_energies_are_an_escape(model, error, verdict):
    assert judge_of([0.0, error], model=model).judgement.verdict == verdict


def test_a_judge_looks_eight_times_a_period_or_a_vibration_at_every_h():
    stiff = SCENES["stiff-slow"].equations
    for h in (0.001, -0.001):
        strides = [stride(0.8, h, model) for model in (Pendulum(1.0), stiff)]
        assert strides == [100, round(1000 * math.tau / stiff.fastest / 8)]
    assert Lockstep(Scene(theta=0.0)).period == math.tau / W0  # none, but that of small swings


@pytest.mark.parametrize(
    ("method", "turn", "is_regular"),
    [(V, 3.15, True), *((FOREST_RUTH, turn, abs(turn) < 3.14) for turn in (3.13, 3.15, -3.15))],
)
def test_beyond_order_2_no_theorem_holds_from_half_a_turn_a_step_on(method, turn, is_regular):
    judge = judge_of([0.0], h=-0.1, method=method)
    for step, rad in enumerate((turn, 0.0)):
        judge.look(look_point(step + 1, 0.0, 0.0, 0.0, omega=rad / -0.1))
    assert (judge.judgement.progress.need == 8) == is_regular


@pytest.mark.parametrize(
    ("method", "theta", "z", "is_regular"),
    [
        *((V, 3.1, z, z <= 0.25) for z in (0.249, 0.251)),  # near the top
        *((V, 1.0, z, z <= 0.9) for z in (0.899, 0.901)),
        # w0·period = 11 from 2.6077 rad
        *((V, theta, 0.5, theta < 2.6) for theta in (2.598, 2.617)),
        # the longest substep is 1.702 h
        *((FOREST_RUTH, 1.0, z, 1.702 * z <= 0.9) for z in (0.52, 0.54)),
    ],
)
def test_where_a_theorem_holds_eight_periods_are_enough(method, theta, z, is_regular):
    scene = Scene(theta=theta, h=z / W0, cast=(method,))
    period = scene.exact().period
    (judgement,) = moved(scene, [round(period / scene.h / 2)]).judgements
    assert judgement.progress.need == (8 if is_regular else math.ceil(4096 * scene.h / period))


@pytest.mark.parametrize(
    ("model", "h", "need"),
    [
        (Pendulum(1.0), 0.399, 4),
        (Pendulum(1.0), 0.401, 1027),
        (Pendulum(100.0), 0.157, 4),  # whose small swings take pi/5
        (Pendulum(100.0), 0.158, 405),
        (LinearOscillator(1.0), 0.401, 4),
    ],
)
def test_with_less_than_four_steps_a_turn_an_error_beats_and_must_be_long(model, h, need):
    assert judge_of([0.0, 0.0, 0.0], h=h, model=model).judgement.progress.need == need


@pytest.mark.parametrize(
    ("steps", "parted", "peak", "verdict"),
    [
        (1000, 18.3, 0.0, "undecided"),
        (1000, 18.4, 0.0, "chaotic"),  # by e^15 times the steps, and e^3.35 near the top
        (1000, 19.3, math.e**2 - 1, "undecided"),  # e of which is the orbit's own growth
        (1000, 19.4, math.e**2 - 1, "chaotic"),
        (4096, 4.9, 0.0, "bounded"),
        (4096, 5.1, 0.0, "undecided"),
        (4095, 4.9, 0.0, "undecided"),
    ],
)
def test_how_far_neighbours_part_tells_chaos_from_order(steps, parted, peak, verdict):
    scene = Scene(theta=1.0, h=1 / W0)
    start = look_point(0, 0.0, 0.0, 0.0)
    period = scene.exact().period  # times w0: 6.70
    orbit = Judge(-scene.h, period, method=V, model=scene.equations, start=start)._orbit
    orbit.steps = steps
    orbit.log = math.log(steps) + parted
    assert orbit.verdict("undecided", peak, periods=100.0) == verdict
    if verdict != "chaotic":
        assert orbit.verdict("bounded", peak, periods=100.0) == "bounded"
    for steps in (99_999, 100_000):  # neighbours are followed to here
        orbit.steps = steps
        orbit.look(start, start._replace(step=1))
        assert orbit.steps == 100_000


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("every", "length", "reason"), [(4, 128, levels.BEATS), (20, 128, ""), (20, 64, levels.BEATS)]
)
def test_an_error_that_beats_must_go_one_way_nine_times_in_ten(every, length, sign, reason):
    moves = np.where(np.arange(1, 49) % every, 2.0, -1.0)  # of blocks of look points
    errors = 0.01 * sign * np.repeat(moves.cumsum(), length)
    assert judge_of([0.0, *errors], h=0.401).judgement.reason == reason


def test_what_is_undecided_is_not_said_to_rest():
    errors = [0.0] * 1000 + [5.0] * 2000
    found = [judge_of(errors, h=h).judgement for h in (0.1, 0.401)]
    assert [(each.verdict, each.rests) for each in found] == [("grows", True), ("undecided", False)]


def test_a_symplectic_method_comes_back():
    method = method_of("verlet_compensated")
    wave = np.roll(BAND, 4) - 0.5
    found = [judge_of(each, method=method).judgement for each in (1e-3 * np.arange(6000), wave)]
    reasons = [(each.verdict, each.reason) for each in found]
    assert reasons == [("undecided", levels.RETURNS), ("bounded", "")]
    assert judge_of(1e-3 * np.arange(100), method=V).judgement.trend is None

    judge = judge_of([0.0] * 200, method=FOREST_RUTH)
    for step in range(200, 300):
        judge.look(look_point(step, 0.0, 0.0, 0.0, omega=40.0))
    assert judge.judgement.verdict == "bounded"


def test_at_equal_cost_what_lacks_at_a_step_is_what_lacked_when_its_judge_last_looked():
    lockstep = Lockstep(DRIFT, judged=True)
    lockstep.set_stepping(Stepping(0.04, True, DRIFT.cast))
    # a swing takes 53.6 steps, and there is a look point every 7 steps
    swings = [lockstep.progress(2, steps).have for steps in (6, 105, 108, 112)]
    assert swings == [0, 1, 1, 2]
    assert lockstep.judgements[2].progress == lockstep.progress(2, 0)
    lockstep.advance(112)  # counted in each method's own steps
    assert [each.progress.have for each in lockstep.judgements] == [2] * 4


def test_before_four_cycles_there_is_neither_verdict_nor_slope():
    for h, steps, known in ((0.1, 64, False), (0.1, 66, True), (1.6, 8, False), (1.6, 9, True)):
        judgement = judge_of([0.0] * steps, h=h).judgement
        assert (judgement.verdict, judgement.slope is not None) == ("undecided", known)
    assert str(judge_of([0.0] * 33).judgement) == "undecided: 2 of 4 cycles"


def test_a_run_that_has_grown_is_not_called_losing_later():
    errors = 1e-3 * np.append(np.arange(640), np.arange(640, -4000, -1))
    judge = judge_of(errors)
    assert (judge.judgement.verdict, judge.judgement.reason) == ("undecided", levels.TURNED)
    assert judge.peak == -errors[-1]
    assert judge_of(errors[:700]).peak == errors.max()


def test_the_largest_errors_that_a_lockstep_gives_leave_no_nan():
    swinging = [-1.0] * 20 + [1e300 * (-1) ** k for k in range(6000)]
    falling = [10.0 ** (200 - k) for k in range(400)]  # a spring that ran away, after a change of h
    for errors in (swinging, falling):
        judgement = judge_of(errors).judgement
        assert math.isfinite((judgement.slope or 0) + (judgement.uncertainty or 0))


def test_a_run_with_a_certain_trend_is_not_bounded_however_small_the_trend():
    wave = np.roll(BAND, 4) - 0.5  # from 0, so that its band never leaves the start
    trend = 2e-6 * np.arange(6000)  # to a hundredth of the band
    widens = -np.append(BAND, 4 * BAND[:2000])
    found = [judge_of(each).judgement.verdict for each in (wave, wave + trend, widens)]
    assert found == ["bounded", "undecided", "undecided"]
    found = judge_of(wave[:4090] + 5).judgement
    assert found.fluctuation == pytest.approx(1 / math.sqrt(8), rel=0.01)
    assert found.reason == levels.SHORT
    assert str(found.progress) in str(found)


def test_a_run_is_bounded_if_it_stays_in_its_band_for_ten_times_its_length():
    noise = noise_of(200, seed=1, count=6000)
    noise[0] = 0
    found = [judge_of(BAND + size * noise).judgement for size in (0.06, 0.07)]
    shares = [each.bound * each.share / each.slope for each in found]
    assert 0.09 < shares[0] < 0.1 < shares[1] < 0.11
    assert [each.verdict for each in found] == ["bounded", "undecided"]


each_way = pytest.mark.parametrize(("sign", "word"), [(1, "grows"), (-1, "loses")])


@each_way
def test_a_band_has_left_the_start_by_half_its_width(sign, word):
    step = np.arange(6000)
    near = "undecided", levels.NEAR
    # the last judgement is of step 5248, and so of a present from step 3936 on
    for middle, narrow_from, expected in (
        (1.95, 4400, near),
        (1.95, 3600, (word, "")),
        (2.05, 6000, (word, "")),
    ):
        errors = sign * (middle + np.where(step < narrow_from, 1, 0.9) * np.sin(step / 3))
        found = judge_of([0.0, *errors[1:]]).judgement
        assert (found.verdict, found.reason) == expected
        assert found.rests == (word == found.verdict)
    errors[5000:] += 0.6 * sign  # the end is unlike the rest
    found = judge_of([0.0, *errors[1:]]).judgement
    assert (str(found), found.rests) == (word, True)


@each_way
@pytest.mark.parametrize("share", [0.24, 0.26])
def test_a_word_is_kept_until_a_quarter_of_its_band_is_beyond_the_start(share, sign, word):
    rise = 3e-3 * np.arange(640)
    amplitude = rise[-1] / (1 - share) / 2
    wave = rise[-1] - amplitude + amplitude * np.cos(math.tau * np.arange(700) / 100)
    found = judge_of(sign * np.append(rise, wave)).judgement
    assert str(found) == word if share < 0.25 else found.verdict == "undecided"


def test_a_run_is_judged_when_it_is_an_eighth_longer():
    judge = judge_of([0.0])
    judgements = []
    for step in range(1, 160):
        slope = judge.judgement.slope
        judge.look(look_point(step, step**2, 0.0, 2.0 * step**2))
        if judge.judgement.slope != slope:
            judgements.append(step)
    assert judgements == [64, 72, 82, 94, 106, 120, 136, 156]  # with bins of 2, then 4 looks
    assert judge.judgement.slope == pytest.approx(156 / 0.1, rel=0.03)  # which rounding decides


@needs_rounded_sine
def test_a_bob_thrown_by_turns_a_step_loses_energy_while_it_rests_below_its_start():
    start = {"theta": 1.581580747099299, "omega": 18.124266099091454}
    thrown = Scene(**start, h=0.6112206380406671, cast=(E,))
    lockstep = moved(thrown, [1000])
    (judgement,) = lockstep.judgements
    assert (judgement.verdict, judgement.rests, holds(lockstep)) == ("loses", True, True)
    assert not holds(moved(thrown, [100]))


@pytest.mark.parametrize("name", ["gentle", "crossover", "spin", "damped", "stiff-limit"])
def test_a_run_and_its_energies_alone_do_not_exclude_each_other(name):
    found = list(judgements(SCENES[name], 60.0, PlainLoops))
    assert not [method.key for method, of_run, alone in found if exclude(of_run, alone)]
    assert all(of_run.slope is not None or of_run.verdict == "failed" for _, of_run, _ in found)


@pytest.mark.parametrize("name", ["drift", "rk4-limit", "chaos-loose"])
def test_a_method_is_over_the_top_at_its_first_step_beyond_it(name):
    scene = SCENES[name]
    expected = {}
    lockstep = Lockstep(scene)
    for _ in range(math.ceil(30 / scene.h)):
        lockstep.advance(1)
        for method, reading in zip(scene.cast, lockstep.sample().readings, strict=True):
            if abs(reading.theta) > math.pi:
                at = (lockstep.step, lockstep.t, reading.energy_error)
                expected.setdefault(method.key, at)
    assert lockstep.milestones == []
    found = milestones(moved(scene, [lockstep.step]), "over the top")
    assert {each.method.key: (each.step, each.t, each.energy_error) for each in found} == expected


def test_the_top_is_where_the_start_puts_it():
    for scene in (SCENES["spin"], SCENES["linear"].altered(theta=4.0)):
        assert not milestones(moved(scene, [2000]), "over the top")
    found = []
    for theta, h in ((-1.0, 0.05), (math.tau - 1, 0.05), (-math.tau - 1, 0.05), (1.0, -0.05)):
        lockstep = Lockstep(DRIFT.altered(theta=theta), judged=True)
        lockstep.set_stepping(Stepping(h))
        lockstep.advance(400)
        found.append([(each.method, each.step) for each in milestones(lockstep, "over the top")])
    assert found[0]
    assert found[1:] == 3 * found[:1]


def test_verdicts_happen_when_they_are_given():
    given = milestones(moved(DRIFT, [1200]), "verdict")
    assert len(given) == 4
    for each in given:
        index = USUAL_CAST.index(each.method)
        before, now = (moved(DRIFT, [n]).judgements[index] for n in (each.step - 1, each.step))
        assert (before.verdict, now.verdict) == ("undecided", each.verdict)
        assert each.trend == now.trend


def test_rk4s_error_passes_verlets_once_for_good():
    lockstep = moved(SCENES["crossover"], [7] * 86)
    (passing,) = milestones(lockstep, "errors cross")
    assert (passing.method, passing.other, passing.step) == (R, V, 167)
    assert passing.t == pytest.approx(33.4)
    assert {R, V} <= {each.method for each in milestones(lockstep, "verdict") if each.step <= 167}


def test_a_method_fails_once_and_for_good():
    lockstep = moved(Scene(model="linear", h=1.0), [600])
    assert [each.method for each in milestones(lockstep, "failed")] == [S, V, E, R]
    lockstep.set_stepping(Stepping(0.5, cast=USUAL_CAST))
    assert words(lockstep) == ["failed"] * 4

    def jumping(force, phase, h):
        yield 4.0, 0.0  # over the top
        yield math.nan, 0.0

    lost = moved(DRIFT.with_cast((replace(V, key="jumping", phases=jumping), V)), [600])
    noted = [(each.kind, each.step, each.t) for each in lost.milestones]
    assert noted[:-1] == [("failed", 2, 2 * DRIFT.h)]
    assert words(lost) == ["failed", "bounded"]  # the other is still judged


@pytest.mark.parametrize(
    "name",
    ["drift", "large-swing", "spin", "verlet-limit-above", "chaos-loose", "damped", "stiff-slow"],
)
def test_verdicts_and_milestones_do_not_depend_on_samples_or_loops(name):
    scene, uneven = SCENES[name], random.Random(1)
    steps = min(8000, math.ceil(40 * (scene.exact().period or 1.0) / scene.h))
    whole = moved(scene, [steps])
    assert whole.milestones
    gaps = [uneven.randint(1, 400) for _ in range(steps // 400)]
    loops = compiled if name == "drift" else PlainLoops
    cut = moved(scene, [*gaps, steps - sum(gaps)], loops)
    assert (cut.milestones, cut.judgements) == (whole.milestones, whole.judgements)


def test_after_a_way_back_verdicts_are_those_of_their_step():
    run = RewindableRun(SCENES["chaos-loose"])
    run.forward(1500)
    for back, at in ((1400, 1500), (100, 700)):
        run.go_to(back)
        run.forward(at - back)
        alone = moved(run.scene, [at])
        assert run.lockstep.judgements == alone.judgements
        assert run.lockstep.milestones == alone.milestones
