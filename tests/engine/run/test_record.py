"""Records whose verdict is known from how they are made; tests/bench/foreign.py has thousands."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run import core, levels
from pendu_tui.engine.run.record import (
    Fluctuation,
    Order,
    bins_of,
    fluctuation,
    judge_record,
    order_of,
    resolution,
)
from pendu_tui.engine.run.slope import Slope, student
from pendu_tui.engine.run.verdicts import FAILED, VERDICTS, Judgement, not_within
from tests.bench.foreign import correlated

T = np.linspace(0, 100, 2000)
NOISE = np.random.default_rng(5).standard_normal(2000)
END = T[-62] <= T  # the last of 32 parts
SINE = math.sqrt(2) * np.sin(7 * T)  # standard deviation 1


def noise_of(times: float, seed: int = 1, count: int = 2000):
    return correlated(count, times, np.random.default_rng(seed))


MAKES = {
    "noise": (NOISE, "bounded"),
    "a wobble": (SINE, "bounded"),
    "last digits": (np.round(0.3 * NOISE), "bounded"),
    "a line within noise": (NOISE + T / 50, "grows"),
    "a line within five slow beats": (np.sin(0.3 * T) + 0.03 * T, "grows"),
    "a line within correlated noise": (noise_of(200) + 0.1 * T, "grows"),
    "exponential decay": (np.exp(-T / 5) - 1000, "loses"),
    "an approach of a third of the record": (10 - 10 * np.exp(-T / 33) + NOISE, "grows"),
    "cooling to a floor": (100 * np.exp(-T / 10) + 0.2 * noise_of(20), "loses"),
    "backward Euler in a quartic well": ((1 + 0.06 * T) ** -2 * (1 + 0.01 * SINE), "loses"),
    "a walk": (
        np.cumsum(NOISE),
        "the energy cannot be distinguished from a random walk; a longer record may not help",
    ),
    "a wrong end": (NOISE + 20 * (T > 98), levels.UNLIKE_END),
    "a wobble that gets wider": (T * np.sin(7 * T), levels.WIDENS),
    "a wobble that gets wider in turns": (NOISE * np.repeat((1, 3, 2, 4), 500), "bounded"),
    "a line that turns back": (NOISE + 2 * np.minimum(T, 160 - T) / 100, levels.TURNED),
}
RESTING = {
    "a first sample far from the others": np.where(T > 0, 50 + NOISE, 0),
    "a rise by 50 % in the first twentieth": 0.5 - 0.5 * np.exp(-T) + 1e-3 * NOISE,
}


def bins_around(values, half=0.5):
    return core.Bins(
        np.arange(64.0), values, values - half, values + half, half + 0 * values, 1e-12
    )


def told(energies):
    """Return the verdict on energies about 1000, or why there is none."""
    found = judge_record(T, 1000 + energies)
    return found.reason or found.verdict


@pytest.mark.parametrize("name", MAKES)
def test_the_verdict_or_the_reason_is_the_truth(name):
    energies, truth = MAKES[name]
    assert told(energies) == truth


@pytest.mark.parametrize("name", RESTING)
def test_what_has_left_its_start_and_rests_has_the_slope_of_the_rest(name):
    for sign, verdict in ((1, "grows"), (-1, "loses")):
        found = judge_record(T, 1000 + sign * RESTING[name])
        assert (found.verdict, found.rests) == (verdict, True)
        assert abs(found.slope) < 3 * found.uncertainty
    decays = judge_record(T, 1000 + MAKES["exponential decay"][0])
    assert decays.slope == pytest.approx(-0.01, rel=0.2)  # of the whole record


@pytest.mark.parametrize("name", ["noise", "a line within noise", "a wobble", "a walk"])
def test_the_verdict_does_not_depend_on_units_or_on_the_origin_of_time(name):
    energies = 1e4 + MAKES[name][0]
    truth = judge_record(T, energies)
    mirrored = {"grows": "loses"}.get(truth.verdict, truth.verdict)
    for time, unit, verdict in ((1e-12, 1e-20, truth.verdict), (1e12, -1e20, mirrored)):
        found = judge_record(time * (T - 3000), unit * energies)
        assert found.verdict == verdict
        rate = abs(unit) / time
        sizes = rate * truth.uncertainty, rate * truth.bound, abs(unit) * truth.fluctuation
        assert (found.uncertainty, found.bound, found.fluctuation) == pytest.approx(sizes, rel=1e-3)
        assert found.slope == pytest.approx(truth.slope * unit / time, rel=1e-3)


def test_times_that_count_from_1970_make_a_slope_no_less_exact():
    times = 1.7e12 + T  # ms
    assert judge_record(times, times - 1.7e12).slope == pytest.approx(1.0, rel=1e-11)


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


def with_chance(noise, chance):
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


OPEN = levels.OPEN.partition(";")[0]
SIDES = {
    # the chance of the slope is 0.02, that of its ranks 4e-6 or 2e-5
    "MOVES_BY_RANK": (
        lambda size: np.log1p(10 * T) / math.log(1001) + size * noise_of(200),
        {0.06: "grows", 0.08: OPEN},
    ),
    "MOVES": (lambda chance: with_chance(noise_of(60, 2), chance), {1.4e-3: OPEN, 7e-4: "grows"}),
    # of an eighth of the record, times that share
    "WINDOWS": (
        lambda size: noise_of(1e6, 2) + size * np.clip(T - 87.5, 0, None),
        {0.19: levels.UNLIKE_END, 0.23: "grows"},
    ),
    "SUSPECT": (
        lambda chance: with_chance(noise_of(200, 2), chance),
        {0.07: "bounded", 0.035: levels.TURNED},
    ),
    "MATERIAL": (lambda move: SINE + move * T / 100, {0.4: "bounded", 0.6: "grows"}),
    "LARGE": (lambda move: noise_of(60, 3) + move * T / 100, {0.0: "bounded", 2.0: levels.TURNED}),
    "MIN_CYCLES": (lambda n: np.sin(math.tau * n * T / 100 + 1.3), {1.5: OPEN, 2.5: "bounded"}),
    "WIDENING": (
        lambda last: NOISE * np.repeat((1, 2, 2.5, last), 500),
        {2.7: "bounded", 2.85: levels.WIDENS},
    ),
    "UNLIKE": (
        lambda shift: noise_of(100, 3) + shift * END,
        {3.5: "bounded", 3.68: levels.UNLIKE_END},
    ),
    "UNLIKE_START": (
        lambda shift: noise_of(400, 4) - shift * (T < 6.25),
        {0.7: "bounded", 0.76: "grows"},
    ),
    "MATERIAL of an end": (
        lambda shift: SINE + shift * END,
        {0.38: "bounded", 0.398: levels.UNLIKE_END},
    ),
    # beside a swing so slow that nothing else can be told
    "GONE": (
        lambda far: np.where(T < 10, 0, far + 0.5 * np.cos(T / 20)),
        {3: levels.WALKS, 7: "grows"},
    ),
}


@pytest.mark.parametrize("name", SIDES)
def test_each_level_has_a_case_on_both_sides(name):
    make, words = SIDES[name]
    for value, word in words.items():
        assert told(make(value)).startswith(word)


@pytest.mark.parametrize(
    ("freedom", "t", "chance"),  # of printed tables
    [(6, 2.447, 0.975), (10, 3.169, 0.995), (120, 2.617, 0.995)],
)
def test_students_distribution_is_that_of_tables(freedom, t, chance):
    assert student(2 * t, 2.0, freedom) == pytest.approx(chance, abs=2e-4)
    assert student(-2 * t, 2.0, freedom) == pytest.approx(1 - chance, abs=2e-4)


@pytest.mark.parametrize(
    ("rise", "verdict"),
    [
        (0.45e-12 * T / T[-1], "bounded"),
        (0.6e-12 * T / T[-1], "grows"),
        (0.4e-12 * (T > 10), "bounded"),
    ],
)
def test_what_roundings_may_add_up_to_is_no_trend(rise, verdict):
    assert judge_record(T, 1 + rise).verdict == verdict


@pytest.mark.parametrize("size", [8, 4, 2])
def test_an_end_of_any_size_up_to_an_eighth_may_be_unlike_the_rest(size):
    values = NOISE[128:192].copy()
    values[-size:] += 2.5  # blocks of the two other sizes do not show it
    assert core.Part(bins_around(values), values).why_not_bounded() == levels.UNLIKE_END


@pytest.mark.parametrize("share", [0.75, 0.625, 0.5, 0.375, 0.25])
def test_an_energy_rests_in_the_longest_part_that_is_level(share):
    count = round(64 * share)
    at = np.arange(64) - (64 - count)
    values = np.where(at < 0, 0, 50) + 0.1 * NOISE[:64]
    found = core.judge_bins(bins_around(values, np.where(at == 0, 5, 0.5)))  # wide where it begins
    assert found.rests
    assert found.fluctuation == pytest.approx(math.sqrt((25 + (count - 1) / 4) / count), rel=0.01)


@pytest.mark.parametrize(
    ("before", "length", "move", "new", "old"),
    [(8, 32, 1.0, 0.69, 0.71), (32, 64, 0.65, 0.71, 0.74)],
)
def test_an_end_is_new_a_quarter_of_its_move_beyond_all_before(before, length, move, new, old):
    ramp = np.linspace(0, 1, 32)
    for height, expected in ((new, True), (old, False)):
        values = np.append(np.full(before, height), ramp)
        assert core.is_new(values, values[-length:], move) == expected


@pytest.mark.parametrize(("before", "way"), [(10.9, 10), (11.1, 0), (-0.9, 10), (-1.1, 0)])
def test_an_energy_has_not_left_if_it_was_half_its_band_beyond_start_and_rest(before, way):
    for sign in (1, -1):
        values = sign * np.repeat([0.0, before, 10.0], [4, 12, 48])
        whole = core.Part(bins_around(values, 1.0), values)
        assert core._way_from_start(whole, whole.last(0.75)) == pytest.approx(sign * way)


def test_noise_models_are_weighted_by_their_likelihoods():
    """By integrals over slope and variance, and over those of the octaves beyond the edge."""
    n = 40
    j = np.arange(1.0, n)
    cosines = np.cos(np.pi * np.outer(j, np.arange(n) + 0.5) / n) / math.sqrt(n / 2)
    values = 0.1 * NOISE[:n].cumsum() + NOISE[n : 2 * n]
    v, x = cosines @ np.arange(n), cosines @ values
    slopes = (v @ x / (v @ v)) + np.linspace(-2, 2, 2001)
    variances = np.exp(np.linspace(-10, 10, 401))
    likelihoods = {}
    knees = {f"knee {k}": 1 / (1 + (j / k) ** 2) for k in (7, 15, 31)}
    for name, shape in {"white": j**0, "pink": 1 / j, "walk": 1 / j**2, **knees}.items():
        for edge in (7, 15, 31, 39):
            s = shape[:edge]
            rests = (((x - slopes[:, None] * v)[:, :edge] ** 2) / s).sum(axis=1)
            known = (math.tau * variances) ** (-edge / 2) / np.sqrt(s.prod())
            likelihood = (known * np.exp(-rests[:, None] / 2 / variances)).sum() * (edge + 1) / 2
            for begin in (begin for begin in (8, 16, 32) if begin > edge):
                rest = (x - slopes[1000] * v)[begin - 1 : 2 * begin - 1] ** 2
                known = (math.tau * variances) ** (-len(rest) / 2)
                octave = known * np.exp(-rest.sum() / 2 / variances)
                likelihood *= octave.sum() * 0.05 / (2 * math.log(1000))
            likelihoods[name, edge] = likelihood * (0.3 if name == "pink" else 1)
    walks = sum(likelihoods["walk", edge] for edge in (7, 15, 31, 39))
    found = Slope(np.arange(n), values, 0.0).walk
    assert found == pytest.approx(walks / sum(likelihoods.values()), rel=0.02)
    rests = ((x - slopes[:, None] * v) ** 2).sum(axis=1)
    known = math.tau**-19.5 * np.exp(-rests / 2).sum() * 20
    likelihoods["known"] = known * 2 * math.log(1000) / 0.05
    found = Slope(np.arange(n), values, 0.0, white=1.0).walk
    assert found == pytest.approx(walks / sum(likelihoods.values()), rel=0.02)


def test_in_white_noise_of_a_known_size_a_slope_is_normal():
    times = np.arange(64) - 31.5
    noise = NOISE[:64] - NOISE[:64].mean()
    noise = noise - times * (times @ noise) / (times @ times)
    slope = Slope(times, noise / noise.std(), 0.0, white=1.0)
    sigma = 1 / math.sqrt(times @ times)
    assert slope.uncertainty == pytest.approx(sigma, rel=0.05)
    assert slope.bound == pytest.approx(2.576 * sigma, rel=0.05)  # of 99 %


@pytest.mark.parametrize(("chance", "is_evident"), [(3.5e-3, False), (2.5e-3, True)])
def test_a_trend_of_three_sigmas_is_evident(chance, is_evident):
    found = judge_record(T, 1000 + with_chance(noise_of(60, 2), chance))
    assert (found.is_evident, found.trend is not None) == (is_evident, is_evident)


@pytest.mark.parametrize(("other", "is_wave"), [(0.2, True), (0.26, False)])
def test_a_wave_explains_95_percent_of_what_a_line_leaves(other, is_wave):
    t = np.arange(64) / 64
    values = 3 * t + np.sin(5 * math.pi * t) + other * np.sin(40 * math.pi * t)
    assert (core.without_wave(t, values) is not values) == is_wave
    wave = np.cos(math.tau * 2.62 * t / t[-1] + 1)  # of any frequency, to a hundredth of a cycle
    assert np.abs(core.without_wave(t, wave)).max() < 1e-3


def test_bins_are_blocks_of_equally_many_samples():
    assert core.blocks_of(np.arange(7.0), 3).tolist() == [2, 5]  # to the end
    bins = bins_of(np.arange(128.0), 3 * (-1.0) ** np.arange(128), 1e-12)
    assert bins.times == pytest.approx(2 * np.arange(64) + 0.5)
    for column, value in zip(bins[1:5], (0, -3, 3, 3), strict=True):
        assert column == pytest.approx([value] * 64)
    assert bins.white == pytest.approx(3)  # of two samples, 3 sqrt(2)/sqrt(2)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("times", "least", "most"), [(1e6, 1900, 2000), (400, 100, 300)])
def test_samples_are_as_independent_as_the_noise_forgets(seed, times, least, most):
    assert least < judge_record(T, 1000 + noise_of(times, seed)).independent <= most


@pytest.mark.parametrize(
    ("energies", "factor"),
    [
        (np.sin(math.tau * 1.5 * T / 100 + 1.3), 2.3),
        (noise_of(20, 3), 1.5),  # at least
        (noise_of(60, 1), 2),  # if a trend is suspected
    ],
)
def test_an_open_trend_says_how_much_longer_would_decide(energies, factor):
    assert told(energies).endswith(f"; a record {factor} times as long would settle it")


UNEVEN = {
    "ever longer steps": np.geomspace(1, 1000, 2000),
    "ever shorter steps": 1001 - np.geomspace(1, 1000, 2000)[::-1],
    "a solver that starts carefully": np.cumsum(np.minimum(1e-6 * 1.05 ** np.arange(2000), 1)),
}


@pytest.mark.parametrize("name", UNEVEN)
def test_a_wobble_is_bounded_at_uneven_times(name):
    times = UNEVEN[name]
    for cycles in (5.3, 11, 23, 40, 70, 120.5):
        wobble = np.cos(math.tau * cycles * (times - times[0]) / np.ptp(times))
        assert judge_record(times, wobble).verdict == "bounded"


def test_a_long_pause_leaves_as_many_blocks():
    assert len(bins_of(T + 1000 * (T > 50), NOISE, 1e-12).means) == 64


def test_nobody_is_told_to_compute_a_hundred_times_as_long():
    part = core.Part(bins_around(NOISE[:64]), NOISE[:64])
    ratio = 3 * part.slope.uncertainty * part.length / part.width
    for factor, longer in ((0.98, levels.UNKNOWN), (98, "98 times"), (102, levels.UNKNOWN)):
        assert longer in part.why_not_bounded(ahead=math.sqrt(factor) / ratio)


def test_a_digit_is_a_jump_that_comes_three_times_or_never_back():
    assert resolution(NOISE) < 1e-14
    assert resolution(np.arange(100) // 50) == 1
    slow = judge_record(T, np.round(1000 + T / 150))
    assert slow.bound > 1 / 600  # half the true slope
    energies = np.zeros(100)
    energies[40:50] = 1
    assert resolution(energies) < 1e-14
    energies[60:] = 1
    assert resolution(energies) == 1
    assert resolution(np.tile([0.0, 3.0, 1.0], 30)) == 1
    found = [resolution(np.arange(100) // every) for every in (2, 1.9)]
    assert (found[0], found[1] < 1e-14) == (1, True)  # half of them repeat, or fewer
    digits = judge_record(T, np.round(T))
    t = 100 * np.arange(64) / 64
    assert digits.uncertainty == pytest.approx(1 / math.sqrt(12) / t.std() / 8, rel=0.2)


def test_64_samples_are_needed():
    few = judge_record(T[:63], 1000 + SINE[:63])
    assert (few.verdict, few.reason) == ("undecided", "64 samples are needed")
    assert few.independent == 63
    assert judge_record(T[:64], 1000 + SINE[:64]).reason != few.reason
    assert fluctuation(T[:64], NOISE[:64]).size > 0
    with pytest.raises(ValueError, match=r"63 energies .* give 64 or"):
        fluctuation(T[:63], NOISE[:63])


@pytest.mark.parametrize(
    ("slope", "bound", "limit", "expected"),
    [
        (1.0, 2.0, 2.0, ""),
        (1.0, 2.0, 1.999, "cannot tell: it is 1 ± 1 at 99 %"),
        (5.0, 6.0, 3.999, "it is 5, above 3.999"),
        (5.0, 6.0, 4.001, "cannot tell: it is 5"),
        (6.58e-7, 6.64e-7, 6.6e-7, "cannot tell: it is 6.58e-07 ± 6e-09 at 99 %"),
        (-5.0, 6.0, -4.0, ""),
        (0.0, 0.0, 0.0, ""),
        (2.0, 1.0, 1.5, "it is 2, above 1.5"),
        (None, 0.1, 1.0, "cannot tell: it is not known"),
        (0.1, None, 1.0, "cannot tell: it is not known"),
        (math.nan, 0.1, 1.0, "cannot tell: it is not known"),
        (0.0, math.inf, 1.0, "cannot tell: it is not known"),
        # the length at which white noise would tell
        (0.0, 16.0, 2.0, "cannot tell: it is 0 ± 2e+01 at 99 %; a record about 4 times as long"),
        (0.0, 9e5, 1.0, "cannot tell: it is 0 ± 9e+05 at 99 %; a record about 9322 times"),
        (0.0, 2e6, 1.0, "cannot tell: it is 0 ± 2e+06 at 99 %; a longer record may not"),
        (1.0, 2.0, 1.0, "cannot tell: it is 1 ± 1 at 99 %; a longer record may not"),
    ],
)
def test_a_slope_is_within_a_limit_beyond_it_or_not_known(slope, bound, limit, expected):
    found = not_within(limit, "it", slope, bound)
    assert found.startswith(expected)
    assert bool(found) == bool(expected)
    other = not_within(-limit, "it", slope and -slope, bound, sign=-1.0)
    assert ("below" in other) == ("above" in found)


def test_a_verdict_has_a_sign_and_an_ink_and_perhaps_no_numbers():
    shown = [(each.sign, each.ink) for each in VERDICTS.values()]
    moves = [("+", "text"), ("-", "text"), ("!", "text")]
    assert shown == [("=", "good"), *moves, ("!", "warn"), ("", "quiet")]
    assert Judgement(FAILED).scaled(2.0) == Judgement(FAILED)
    level = {word for word in VERDICTS if not Judgement(word, slope=1.0, is_evident=True).trend}
    assert level == {"bounded", "chaotic"}


def test_the_fluctuation_is_that_about_a_line_in_the_unit_of_the_energies():
    noisy = fluctuation(T, 1e250 * (50 + 0.1 * T + 3 * NOISE))
    assert noisy.size == pytest.approx(3e250, rel=0.05)
    assert fluctuation(T, 7 + 0 * T) == fluctuation(T, 0 * T) == (0.0, 0.0)
    squares = np.repeat([1.0, 3.0] * 8, 100)  # of a sixteenth of a record each
    found = fluctuation(np.arange(1600.0), np.sqrt(squares) * (-1.0) ** np.arange(1600))
    error = math.sqrt(16 / 15) / 4  # of their mean, 2
    assert found == pytest.approx((math.sqrt(2), error / math.sqrt(8)), rel=1e-3)


@pytest.mark.parametrize("power", [0, 2, 4])
def test_the_order_is_a_slope_of_logarithms_in_which_precise_runs_count_more(power):
    steps = (1.0, 2.0, 4.0)
    fluctuations = [Fluctuation(step**power, 0.1 * step**power) for step in steps]
    found = order_of(steps, fluctuations)
    assert found == pytest.approx((power, 0.1 / (math.sqrt(2) * math.log(2))))
    vague = Fluctuation(1000.0, 1e6)
    assert order_of(steps, [*fluctuations[:2], vague]).power == pytest.approx(power, abs=0.01)


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


@pytest.mark.parametrize(
    ("uncertainty", "highest", "longer"), [(0.49, 2.98, 2), (0.5, None, 2), (1.0, None, 5)]
)
def test_runs_tell_one_order_from_the_next_or_not_at_all(uncertainty, highest, longer):
    assert str(Order(2.0, 0.25)) == "h^(2.00 ± 0.25)"
    assert Order(2.0, uncertainty).highest == (highest and pytest.approx(highest))
    assert f"about {longer} times as long" in Order(2.0, uncertainty).doubt
