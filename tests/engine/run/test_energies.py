"""Records whose verdict is known from how they are made; tests/bench/foreign.py has thousands."""

import numpy as np
import pytest

from pendu_tui.engine.run.energies import judge_record
from pendu_tui.engine.run.judgement import MIN_INDEPENDENT, MIN_SAMPLES
from tests.bench.foreign import correlated

T = np.linspace(0, 100, 2000)
RANDOM = np.random.default_rng(5)
NOISE = RANDOM.standard_normal(2000)


def noise_of(times: float, seed: int = 1, count: int = 2000) -> np.ndarray:
    return correlated(count, times, np.random.default_rng(seed))


MAKES = {
    "noise": (NOISE, "bounded"),
    "correlated noise": (noise_of(100), "bounded"),
    "a wobble": (np.sin(7 * T), "bounded"),
    "a wobble sampled less than twice a period": (np.sin(200 * T), "bounded"),
    "six slow beats": (np.sin(0.37 * T), "bounded"),
    "two slow beats": (np.sin(0.13 * T), "undecided"),
    "a constant": (0 * T, "bounded"),
    "rounding": (1e-10 * NOISE, "bounded"),
    "last digits": (np.round(0.3 * NOISE), "bounded"),
    "spikes": (np.where(RANDOM.uniform(size=2000) < 0.01, 30, 1) * NOISE, "bounded"),
    "a line within noise": (NOISE + T / 50, "grows"),
    "a line downwards within a wobble": (np.sin(7 * T) - T / 50, "loses"),
    "a line within five slow beats": (np.sin(0.3 * T) + 0.03 * T, "grows"),
    "a line within correlated noise": (noise_of(50) + 0.1 * T, "grows"),
    "five steps of the last digit": (np.round(0.05 * T), "grows"),
    "exponential growth from rounding": (1e-9 * np.exp(T / 5) + 1e-9 * NOISE, "grows"),
    "logarithmic growth": (np.log1p(T) + 0.1 * NOISE, "grows"),
    "an approach of a third of the record": (10 - 10 * np.exp(-T / 33) + NOISE, "grows"),
    "a wobble that gets wider": (T * np.sin(7 * T), "undecided"),
    "relaxation to another level": (1 - np.exp(-T / 8) + 0.02 * NOISE, "grows"),
    "a step": (np.where(T > 40, 50, 0) + NOISE, "grows"),
    "a first sample elsewhere": (np.where(T > 0, 5 + NOISE / 10, 0), "bounded"),
}


@pytest.mark.parametrize("name", MAKES)
def test_the_verdict_is_the_truth(name):
    energies, truth = MAKES[name]
    assert judge_record(T, 1000 + energies).verdict == truth


@pytest.mark.parametrize("name", ["noise", "a line within noise", "a wobble", "a step"])
def test_the_verdict_does_not_depend_on_units_or_on_the_origin_of_time(name):
    energies, truth = MAKES[name]
    assert judge_record(1e-12 * T - 3e-9, -1e-20 * (1e4 - energies)).verdict == truth


def test_uneven_sampling_changes_no_trend():
    times = np.sort(np.random.default_rng(6).uniform(0, 1, 3000)) ** 2
    found = judge_record(times, 1000 + np.sin(100 * times) - 20 * times)
    assert found.verdict == "loses"
    assert found.slope == pytest.approx(-20, rel=0.05)


@pytest.mark.parametrize("times", [200, 50, 20])
def test_a_true_slope_lies_within_its_uncertainty_as_often_as_promised(times):
    found = [
        judge_record(T[::4], 1000 + noise_of(times, seed, 500) + 0.01 * T[::4])
        for seed in range(40)
    ]
    sigmas = np.array([(each.slope - 0.01) / each.uncertainty for each in found])
    assert 0.5 < np.mean(np.abs(sigmas) < 1) < 0.95
    assert np.mean(np.abs(sigmas) < 3) > 0.94


def test_a_walk_neither_grows_nor_is_bounded():
    random = np.random.default_rng(3)
    walks = [np.cumsum(random.standard_normal(1000)) for _ in range(40)]
    verdicts = [judge_record(T[:1000], 1e4 + walk).verdict for walk in walks]
    assert verdicts.count("undecided") >= 36


def test_an_initial_transient_is_left_out():
    found = judge_record(T, 1000 + 0.01 * NOISE - 5 * np.exp(-T))
    assert found.verdict == "bounded"
    assert 2 < found.transient < 10
    assert found.first == np.searchsorted(T, found.transient)


def test_few_samples_and_few_independent_ones_are_too_early():
    few = judge_record(T[: MIN_SAMPLES - 1], 1000 + NOISE[: MIN_SAMPLES - 1])
    assert few.progress == (MIN_SAMPLES - 1, MIN_SAMPLES, "samples")
    found = judge_record(T, 1000 + noise_of(5))
    assert found.verdict == "undecided"
    assert found.progress.have < found.progress.need == MIN_INDEPENDENT


def test_what_multiplies_is_judged_in_its_logarithm():
    assert judge_record(T, np.exp(T)).verdict == "grows"
    assert judge_record(T, np.exp(-T / 5)).verdict == "loses"
    # backward Euler at h = 0.1 in a quartic well
    assert judge_record(T, (1 + 0.06 * T) ** -2 * (1 + 0.01 * np.sin(T))).verdict == "loses"
