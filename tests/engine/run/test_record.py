"""Records whose verdict is known from how they are made; tests/bench/foreign.py has thousands."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.record import judge_record
from tests.bench.foreign import correlated

T = np.linspace(0, 100, 2000)
RANDOM = np.random.default_rng(5)
NOISE = RANDOM.standard_normal(2000)
SINE = math.sqrt(2) * np.sin(7 * T)  # standard deviation 1


def noise_of(times: float, seed: int = 1, count: int = 2000) -> np.ndarray:
    return correlated(count, times, np.random.default_rng(seed))


MAKES = {
    "noise": (NOISE, "bounded"),
    "correlated noise": (noise_of(100, seed=2), "bounded"),
    "a wobble": (SINE, "bounded"),
    "a wobble sampled less than twice a period": (np.sin(200 * T), "bounded"),
    "six slow beats": (np.sin(0.37 * T), "bounded"),
    "a constant": (0 * T, "bounded"),
    "rounding": (1e-10 * NOISE, "bounded"),
    "last digits": (np.round(0.3 * NOISE), "bounded"),
    "spikes": (np.where(RANDOM.uniform(size=2000) < 0.01, 30, 1) * NOISE, "bounded"),
    "a first sample near": (np.where(T > 0, 3 + NOISE, 0), "bounded"),
    "a trend of a hundredth of the band": (SINE + 3e-4 * T, "bounded"),
    "a line within noise": (NOISE + T / 50, "grows"),
    "a line downwards within a wobble": (SINE - T / 50, "loses"),
    "a line within five slow beats": (np.sin(0.3 * T) + 0.03 * T, "grows"),
    "a line within correlated noise": (noise_of(200) + 0.1 * T, "grows"),
    "five steps of the last digit": (np.round(0.05 * T), "grows"),
    "exponential growth from rounding": (1e-9 * np.exp(T / 5) + 1e-9 * NOISE, "grows"),
    "logarithmic growth": (np.log1p(T) + 0.1 * NOISE, "grows"),
    "an approach of a third of the record": (10 - 10 * np.exp(-T / 33) + NOISE, "grows"),
    "a drift that begins late": (NOISE + np.clip(T - 70, 0, None), "grows"),
    "a wobble that gets wider": (T * np.sin(7 * T), "undecided"),
    "a walk": (np.cumsum(NOISE), "undecided"),
    "a wrong end": (NOISE + 20 * (T > 98), "undecided"),
}
RESTING = {
    "relaxation to another level": 1 - np.exp(-T / 8) + 0.02 * NOISE,
    "a step": np.where(T > 40, 50, 0) + NOISE,
    "a first sample far from the others": np.where(T > 0, 50 + NOISE, 0),
    "a rise by 50 % in the first twentieth": 0.5 - 0.5 * np.exp(-T) + 1e-3 * NOISE,
}


@pytest.mark.parametrize("name", MAKES)
def test_the_verdict_is_the_truth(name):
    energies, truth = MAKES[name]
    assert judge_record(T, 1000 + energies).verdict == truth


@pytest.mark.parametrize("name", RESTING)
def test_what_has_left_its_start_and_rests_has_the_slope_of_the_rest(name):
    found = judge_record(T, 1000 + RESTING[name])
    assert (found.verdict, found.rests) == ("grows", True)
    assert abs(found.slope) < 3 * found.uncertainty


@pytest.mark.parametrize("name", ["noise", "a line within noise", "a wobble", "a walk"])
def test_the_verdict_does_not_depend_on_units_or_on_the_origin_of_time(name):
    energies, truth = MAKES[name]
    mirrored = {"grows": "loses"}.get(truth, truth)
    assert judge_record(1e-12 * T - 3e-9, 1e-20 * (1e4 + energies)).verdict == truth
    assert judge_record(1e12 * T, -1e20 * (1e4 + energies)).verdict == mirrored


@pytest.mark.parametrize("periods", [*range(20, 40), 50, 64, 96, 100, 128, 192, 256, 320])
@pytest.mark.parametrize("samples", [2000, 6400])
def test_an_oscillation_is_bounded_whatever_equal_blocks_make_of_it(periods, samples):
    t = np.arange(samples) * periods / samples
    assert judge_record(t, 0.5 + 1e-3 * np.cos(math.tau * t) ** 2).verdict == "bounded"


def test_uneven_sampling_changes_no_trend():
    times = np.sort(np.random.default_rng(6).uniform(0, 1, 3000)) ** 2
    found = judge_record(times, 1000 + np.sin(100 * times) - 20 * times)
    assert found.verdict == "loses"
    assert found.slope == pytest.approx(-20, rel=0.05)


@pytest.mark.parametrize("times", [200, 50, 20])
def test_a_true_slope_lies_within_uncertainty_and_bound_as_often_as_promised(times):
    found = [
        judge_record(T[::4], 1000 + noise_of(times, seed, 500) + 0.01 * T[::4])
        for seed in range(60)
    ]
    sigmas = np.array([(each.slope - 0.01) / each.uncertainty for each in found])
    assert 0.55 < np.mean(np.abs(sigmas) < 1) < 0.9
    assert np.mean([each.bound > 0.01 for each in found]) > 0.95


def sides_of(make, values, words):
    assert tuple(judge_record(T, 1000 + make(value)).verdict for value in values) == words


def test_a_trend_is_material_from_half_a_standard_deviation_on():
    sides_of(lambda move: SINE + move * T / 100, (0.4, 0.6), ("bounded", "grows"))


def test_a_move_of_a_standard_deviation_is_not_bounded_however_likely_by_chance():
    slow = noise_of(60, seed=3)
    sides_of(lambda move: slow + move * T / 100, (0.0, 2.0), ("bounded", "undecided"))


def test_a_wave_of_some_cycles_leaves_no_trend_behind():
    for cycles in (2.1, 2.3, 2.6, 3.4):
        found = judge_record(T, 1000 + np.sin(math.tau * cycles * T / 100 + 1) + 0.01 * NOISE)
        assert found.verdict == "bounded"


def test_a_band_widens_from_threefold_on():
    widths = (2.0, 8.0)  # the quarters' mean widths differ by 1.7 and by 4.8
    sides_of(lambda last: SINE * (1 + (last - 1) * T / 100), widths, ("bounded", "undecided"))


def test_a_wave_counts_from_two_cycles_on():
    one_and_a_half = judge_record(T, 1000 + np.sin(math.tau * 1.5 * T / 100 + 1.3))
    assert one_and_a_half.verdict != "bounded"
    assert judge_record(T, 1000 + np.sin(math.tau * 2.5 * T / 100 + 1.3)).verdict == "bounded"


def test_what_has_gone_five_times_its_present_band_from_the_start_has_left_it():
    swing = 0.5 * np.cos(T / 20)  # so slow that nothing else can be told
    assert judge_record(T, np.where(T < 10, 1000, 1003 + swing)).verdict == "undecided"
    assert judge_record(T, np.where(T < 10, 1000, 1007 + swing)).verdict == "grows"


def test_64_samples_are_needed():
    few = judge_record(T[:63], 1000 + NOISE[:63])
    assert (few.verdict, few.reason) == ("undecided", "64 samples are needed")
    assert judge_record(T[:64], 1000 + SINE[:64]).reason != few.reason


@pytest.mark.parametrize(
    ("energies", "reason"),
    [
        (np.cumsum(NOISE), levels.WALKS),
        (NOISE + 20 * (T > 98), levels.UNLIKE_END),
        (T * np.sin(7 * T), levels.WIDENS),
        (NOISE + 2 * np.minimum(T, 160 - T) / 100, levels.TURNED),
    ],
)
def test_undecided_has_a_reason(energies, reason):
    found = judge_record(T, 1000 + energies)
    assert (found.verdict, found.reason) == ("undecided", reason)


def test_what_multiplies_grows_or_loses():
    assert judge_record(T, np.exp(T)).verdict == "grows"
    assert judge_record(T, np.exp(-T / 5)).verdict == "loses"
    # backward Euler at h = 0.1 in a quartic well
    assert judge_record(T, (1 + 0.06 * T) ** -2 * (1 + 0.01 * np.sin(T))).verdict == "loses"


def test_what_cools_to_a_floor_loses():
    assert judge_record(T, 1 + 100 * np.exp(-T / 10) + 0.2 * noise_of(20)).verdict == "loses"
