"""Energies whose truth is known, of the project's own engine and of known make; tests/bench/judge.py has more."""

import numpy as np
import pytest

from engine.run.energies import LEAST_SAMPLES, judge
from engine.run.lockstep import Lockstep
from engine.scenes import DEFAULT_SCENE, SCENES

T = np.linspace(0, 100, 2000)
NOISE = np.random.default_rng(5).standard_normal(2000)

MAKES = {
    "noise": (NOISE, "bounded"),
    "a wobble": (np.sin(7 * T), "bounded"),
    "a wobble sampled less than twice a period": (np.sin(200 * T), "bounded"),
    "six slow beats": (np.sin(0.37 * T), "bounded"),
    "two slow beats": (np.sin(0.13 * T), "too early"),
    "a constant": (0 * T, "bounded"),
    "rounding": (1e-10 * NOISE, "bounded"),
    "last digits": (np.round(0.3 * NOISE), "bounded"),
    "a line within noise": (NOISE + T / 50, "grows"),
    "a line downwards within a wobble": (np.sin(7 * T) - T / 50, "loses"),
    "exponential growth from rounding": (1e-9 * np.exp(T / 5) + 1e-9 * NOISE, "grows"),
    "a random walk": (np.cumsum(NOISE), "wanders"),
    "a wobble that gets wider": (T * np.sin(7 * T), "wanders"),
    "relaxation to another level": (1 - np.exp(-T / 8) + 0.02 * NOISE, "caught"),
    "a jump from the first sample": (np.where(T > 0, 5 + NOISE / 10, 0), "caught"),
}


@pytest.mark.parametrize("name", MAKES)
def test_the_verdict_is_the_truth(name):
    energies, truth = MAKES[name]
    assert judge(T, 1000 + energies - energies[0]).verdict == truth


@pytest.mark.parametrize("name", MAKES)
def test_the_verdict_does_not_depend_on_units_or_on_the_origin_of_time(name):
    energies, truth = MAKES[name]
    assert judge(1e-12 * T - 3e-9, 1e-20 * (1000 + energies - energies[0])).verdict == truth


def test_uneven_sampling_changes_no_trend():
    times = np.sort(np.random.default_rng(6).uniform(0, 1, 3000)) ** 2
    found = judge(times, 1000 + NOISE[0] + np.r_[0, np.sin(100 * times[1:])] - 20 * times)
    assert found.verdict == "loses"
    assert found.slope == pytest.approx(-0.02, rel=0.05)


@pytest.mark.parametrize("seed", range(5))
def test_the_slope_of_a_line_within_noise_is_found_within_four_uncertainties(seed):
    noise = np.random.default_rng(seed).standard_normal(2000)
    found = judge(T, np.r_[1000, 1000 + noise[1:] + 0.03 * T[1:]], 1000)
    assert found.uncertainty < 1e-5
    assert abs(found.slope - 3e-5) < 4 * found.uncertainty


def test_a_forecast_contains_the_energy_that_follows():
    long = np.linspace(0, 1000, 20_001)
    energies = 100 + np.sin(5 * long) - long / 100
    found = judge(long[:2000], energies[:2000])
    assert found.forecast.time == pytest.approx(1000, rel=1e-3)
    assert found.forecast.low < (energies[-1] - energies[0]) / 100 < found.forecast.high
    assert found.forecast.high - found.forecast.low < 0.1


@pytest.mark.parametrize("name", ["a random walk", "relaxation to another level", "exponential growth from rounding"])
def test_there_is_no_forecast_where_no_line_describes_the_energy(name):
    energies, _ = MAKES[name]
    assert judge(T, 1000 + energies - energies[0]).forecast is None


def test_too_few_samples_are_too_early_and_still_have_a_largest_error():
    times = np.arange(LEAST_SAMPLES - 1.0)
    found = judge(times, 1 + times)
    assert (found.verdict, found.slope, found.max_error) == ("too early", None, LEAST_SAMPLES - 2)
    assert judge(times[:1], times[:1] + 1).verdict == "too early"


def test_energies_that_end_in_nan_grow_however_few():
    assert judge(T, 1000 + NOISE, diverged=True).verdict == "grows"
    assert judge(T[:3], 1000 + NOISE[:3], diverged=True).verdict == "grows"


def test_a_first_energy_of_zero_needs_a_scale():
    with pytest.raises(ValueError, match="first energy is zero"):
        judge(T, T)
    assert judge(T, T, scale=10.0).max_error == 10.0


@pytest.mark.parametrize("size", [1e-320, 1e-300, 1e300, 1.7e308])
def test_extreme_energies_and_times_give_finite_numbers(size):
    for times in (T, 1e-320 + T * 1e-300, T * 1e297):
        for energies in (np.where(T > 50, -size, size), np.full(2000, size), size * ((1 + np.abs(NOISE)) / 9)):
            found = judge(times, energies)
            numbers = [found.slope, found.uncertainty, found.max_error, found.last_error]
            assert np.isfinite([number for number in numbers if number is not None]).all()


@pytest.mark.parametrize(("scene", "stride"), [("drift", 1), ("drift", 7), ("crossover", 2)])
def test_the_lab_and_energies_alone_agree_on_the_methods(scene, stride):
    lockstep = Lockstep(SCENES[scene])
    energies = []
    for _ in range(3000):
        energies.append([reading.energy_error for reading in lockstep.sample().readings])
        lockstep.advance(stride)
    times = np.arange(3000) * stride * DEFAULT_SCENE.h
    found = [judge(times, 1 + np.array(column), 1.0).verdict for column in zip(*energies, strict=True)]
    assert found[1:] == ["bounded", "bounded", "loses"]
    assert found[0] in ("grows", "caught", "wanders")  # over the top, it is caught in the end
