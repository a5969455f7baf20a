"""Each level of the judge has a case on both sides; the levels stand here once more, as numbers."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run import core, levels
from pendu_tui.engine.run.judge import LookPoint
from pendu_tui.engine.run.record import bins_of, judge_record, resolution
from pendu_tui.engine.run.slope import student
from tests.engine.run.test_record import T, noise_of
from tests.engine.run.test_verdict import judged


def sized(noise, chance):
    """Return noise with a trend that is so unlikely by chance."""
    low, high = 0.0, 100.0
    for _ in range(40):
        middle = (low + high) / 2
        energies = noise + middle * T / 100
        whole = core.whole_of(bins_of(T, energies - energies[0], 1e-12))[1]
        if whole.slope.chance > chance:
            low = middle
        else:
            high = middle
    return energies


@pytest.mark.parametrize(
    ("level", "times", "words"),
    [(1e-3, 60, ["undecided", "grows"]), (0.05, 200, ["bounded", "undecided"])],
    ids=["MOVES", "SUSPECT"],
)
def test_a_material_trend_counts_from_a_level_of_significance_on(level, times, words):
    noise = noise_of(times, seed=2)
    assert [judge_record(T, sized(noise, x * level)).verdict for x in (1.4, 0.7)] == words


def test_growth_that_slows_down_counts_by_its_ranks_from_1e_5_on():
    """The chance of its slope is 0.02, that of its ranks 4e-6 or 2e-5."""
    growth = np.log1p(10 * T) / math.log(1001)
    noise = noise_of(200, seed=1)
    words = [judge_record(T, growth + size * noise).verdict for size in (0.06, 0.08)]
    assert words == ["grows", "undecided"]


def test_an_end_is_unlike_the_rest_at_a_chance_of_1e_3():
    values = np.random.default_rng(1).standard_normal(64)
    *others, _ = core.blocks_of(values, 2)
    spread = np.std(others) * math.sqrt(32 / 30)
    shifts = np.linspace(0, 5, 1000) * spread
    chances = np.array([2 - 2 * student(shift, spread, 30) for shift in shifts])
    reasons = []
    for chance in (1.3e-3, 0.75e-3):
        values[-2:] = np.mean(others) + shifts[np.argmin(abs(chances - chance))]
        half = np.full(64, 0.5)
        bins = core.Bins(np.arange(64.0), values, values - half, values + half, half, 1e-12)
        reasons.append(core.judge_bins(bins).reason)
    assert reasons == ["", levels.UNLIKE_END]


@pytest.mark.parametrize(("height", "expected"), [(0.42, True), (0.46, False)])
def test_an_end_is_new_by_half_of_its_move_beyond_what_was_before(height, expected):
    ramp = np.linspace(0, 1, 32)  # the last eighth of which is at 0.95
    assert core.is_new(np.append(np.full(8, height), ramp), ramp, 1.0) == expected


@pytest.mark.parametrize(("height", "expected"), [(0.71, True), (0.74, False)])
def test_an_end_is_new_by_a_quarter_of_its_move_beyond_the_first_half(height, expected):
    values = np.append(np.full(32, height), np.linspace(0, 1, 32))  # whose last eighth is at 0.89
    assert core.is_new(values, values, 0.65) == expected


def test_a_digit_is_a_jump_that_comes_three_times():
    energies = np.zeros(100)
    energies[40:50] = 1
    assert resolution(energies) < 1e-12
    energies[60:] = 1
    assert resolution(energies) == 1


def test_a_run_is_bounded_if_it_stays_in_its_band_for_ten_times_its_length():
    steps = np.arange(6000)
    band = 0.5 - 0.5 * np.cos(math.tau * steps / 16)
    noise = noise_of(200, seed=1, count=6000) * (steps > 0)
    found = [judged(band + size * noise).judgement for size in (0.06, 0.07)]
    shares = [each.bound * each.share / each.slope for each in found]
    assert 0.09 < shares[0] < 0.1 < shares[1] < 0.11
    assert [each.verdict for each in found] == ["bounded", "undecided"]


@pytest.mark.parametrize(("middle", "verdict"), [(1.95, "undecided"), (2.05, "grows")])
def test_a_band_has_left_the_start_by_half_its_width(middle, verdict):
    errors = middle + np.sin(np.arange(6000) / 3)
    errors[0] = 0
    assert judged(errors).judgement.verdict == verdict


@pytest.mark.parametrize(("share", "verdict"), [(0.24, "grows"), (0.26, "undecided")])
def test_what_has_grown_keeps_its_word_until_a_quarter_of_its_band_is_below_the_start(
    share, verdict
):
    rise = 3e-3 * np.arange(640)
    amplitude = rise[-1] / (1 - share) / 2
    wave = rise[-1] - amplitude + amplitude * np.cos(math.tau * np.arange(1400) / 100)
    assert judged(np.append(rise, wave)).judgement.verdict == verdict


def test_a_run_is_judged_when_it_is_an_eighth_longer():
    judge = judged([0.0])
    judgements = []
    for step in range(1, 4000):
        slope = judge.judgement.slope
        judge.look(LookPoint(step, 1e-3 * step, 1e-3 * step, 1e-3 * step))
        if judge.judgement.slope != slope:
            judgements.append(step)
    factors = np.divide(judgements[1:], judgements[:-1])
    assert factors.min() == 9 / 8
    assert np.median(factors) < 1.16
