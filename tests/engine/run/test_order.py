"""The order of a simulation, from the fluctuation of its energies at two step sizes."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.record import Fluctuation, Order, fluctuation, order_of

TIMES = np.arange(4000.0)


def noise(seed, size=1.0, memory=0.0):
    """Return noise of a standard deviation; a sample remembers `memory` of the one before."""
    random = np.random.default_rng(seed)
    values = random.normal(size=len(TIMES))
    for index in range(1, len(values)):
        values[index] = memory * values[index - 1] + math.sqrt(1 - memory**2) * values[index]
    return size * values


def test_the_fluctuation_is_that_about_a_line_in_the_unit_of_the_energies():
    found = fluctuation(TIMES, 50.0 + 0.01 * TIMES + noise(1, size=3.0))
    assert found.size == pytest.approx(3.0, rel=0.05)
    assert fluctuation(TIMES, np.full(4000, 7.0)) == (0.0, 0.0)


@pytest.mark.parametrize("memory", [0.0, 0.9])
def test_the_uncertainty_of_a_fluctuation_is_the_spread_of_repetitions(memory):
    found = [fluctuation(TIMES, noise(seed, memory=memory)) for seed in range(60)]
    spread = np.std([each.size for each in found], ddof=1)
    # 60 repetitions give a standard deviation to 9 %, 16 batches to 18 %.
    assert np.mean([each.uncertainty for each in found]) == pytest.approx(spread, rel=0.3)


@pytest.mark.parametrize("power", [0.0, 1.0, 2.0, 4.0])
def test_the_order_is_the_power_of_the_step_within_its_uncertainty(power):
    steps = (0.1, 0.2, 0.4)
    missed = 0
    for seed in range(40):
        fluctuations = [
            fluctuation(TIMES, noise((seed, place), size=step**power))
            for place, step in enumerate(steps)
        ]
        found = order_of(steps, fluctuations)
        missed += abs(found.power - power) > 2 * found.uncertainty
        assert found.uncertainty == pytest.approx(0.011, rel=0.7)
    assert missed <= 6  # 2 of 40 are expected, and 7 in one of a hundred such tests


def test_a_precise_fluctuation_counts_more():
    steps = (1.0, 2.0, 4.0)
    precise = [Fluctuation(1.0, 0.001), Fluctuation(4.0, 0.004), Fluctuation(4.0, 2.0)]
    assert order_of(steps, precise).power == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize(
    ("steps", "sizes", "reason"),
    [
        ((0.1, 0.1), (1.0, 2.0), "not all the same"),
        ((0.1, 0.0), (1.0, 2.0), "above zero"),
        ((0.1, 0.2), (1.0, 0.0), "never changes"),
    ],
)
def test_what_has_no_order_is_refused(steps, sizes, reason):
    with pytest.raises(ValueError, match=reason):
        order_of(steps, [Fluctuation(size, 0.1) for size in sizes])


def test_too_few_samples_are_refused():
    assert fluctuation(TIMES[: levels.MIN_SAMPLES], noise(1)[: levels.MIN_SAMPLES]).size > 0
    with pytest.raises(ValueError, match="too few"):
        fluctuation(TIMES[: levels.MIN_SAMPLES - 1], noise(1)[: levels.MIN_SAMPLES - 1])


@pytest.mark.parametrize(("uncertainty", "highest"), [(0.49, 2.98), (0.5, None)])
def test_runs_tell_one_order_from_the_next_or_not_at_all(uncertainty, highest):
    assert Order(2.0, uncertainty).highest == (highest and pytest.approx(highest))
    assert "about 2 times as long" in Order(2.0, uncertainty).advice
