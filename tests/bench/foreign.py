"""`judge` on series of known truth: how often its verdict is wrong, or `undecided` without need.

Each kind of series is made with 100 to 6000 samples, random scales and random zeros of energy.
`undecided` is never wrong; it is counted where the record has at least 50 independent samples, and
the effect at least 5, 8 or 10 standard deviations.  A drift over the record of less than half a
standard deviation of the fluctuation is also `bounded`.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run.record import judge_record

LIMITS = {"wrong_percent": 0.6, "undecided_percent": 8.0}
SIZES = (100, 200, 500, 2000, 6000)
SEED = 926421  # drawn after the last change of a rule or level
CLEAR = math.inf  # enough of an effect, or of samples, for a verdict
MATERIAL = 0.5  # standard deviations: a smaller drift is bounded, too
BOUNDED = {"bounded"}


class Series(NamedTuple):
    """A series and the verdicts that are right, beside `undecided`."""

    kind: str
    energies: Any
    truth: set[str] = BOUNDED
    sigmas: float = CLEAR  # the effect, in standard deviations of what could be mistaken for it
    independent: float = CLEAR  # samples


def filtered(kicks: Iterable[float], first: float, second: float = 0.0) -> Any:
    """Return the autoregressive noise that some kicks make."""
    values = [0.0, 0.0]
    for kick in kicks:
        values.append(first * values[-1] - second * values[-2] + kick)
    return np.array(values[2:])


def correlated(count: int, times: float, random: np.random.Generator) -> Any:
    """Return stationary noise of standard deviation 1, so many correlation times long."""
    keep = math.exp(-times / count)
    kicks = random.standard_normal(count) * math.sqrt(1 - keep * keep)
    kicks[0] = random.standard_normal()
    return filtered(kicks, keep)


def oscillating(count: int, times: float, random: np.random.Generator) -> tuple[Any, float]:
    """Return oscillating noise, so many decay times long, and its spectrum at frequency 0."""
    decay = math.exp(-times / count)
    angle = random.uniform(0.1, 3) * min(1.0, times / count * 3)
    first = 2 * decay * math.cos(angle)
    noise = filtered(random.standard_normal(count + 400), first, decay**2)[400:]
    size = float(noise.std())
    return noise / size, 1 / (1 - first + decay**2) ** 2 / size**2


def single(energies: Any) -> Any:
    """Return energies rounded to float32, as doubles near 0, so that no digit is lost."""
    rounded = energies.astype(np.float32).astype(float)
    return rounded - rounded[0]


class Maker:
    """Makes parts of series of `count` samples; x runs from 0 to 1."""

    def __init__(self, count: int, random: np.random.Generator) -> None:
        self.count = count
        self.random = random
        self.x = (np.arange(count) + 0.5) / count
        self.sign = int(random.choice([-1, 1]))
        self.way = {"grows" if self.sign > 0 else "loses"}
        self.fast = min(60, count / 3)  # cycles, of a wave that bins resolve

    def between(self, low: float, high: float) -> float:
        """Return a random number, with a uniform logarithm."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def size(self, low: float, high: float) -> float:
        """Return a random number with the sign of the effect."""
        return self.sign * self.between(low, high)

    def seen(self, low: float, high: float) -> float:
        """Return a size that few samples do not hide."""
        return self.size(low, high) * max(1.0, math.sqrt(200 / self.count))

    def white(self, size: float = 1.0) -> Any:
        return size * self.random.standard_normal(self.count)

    def chance(self, share: float) -> Any:
        return self.random.uniform(size=self.count) < share

    def wave(self, least: float, most: float) -> Any:
        """Return a wave of so many cycles at least and at most."""
        return np.sin(math.tau * (self.between(least, most) * self.x + self.random.uniform()))

    def relaxed(self, rate: float) -> Any:
        return -np.expm1(-rate * self.x)

    def kepler(self, orbits: float) -> Any:
        """Return 1/r³ along an orbit, as which the energy error of leapfrog goes."""
        eccentricity = self.random.uniform(0.05, 0.7)
        anomaly = mean = math.tau * (orbits * self.x + self.random.uniform())
        for _ in range(60):
            anomaly = mean + eccentricity * np.sin(anomaly)
        return (1 - eccentricity * np.cos(anomaly)) ** -3


Kinds = Iterator[tuple[Any, ...]]
"""The fields of each Series."""


def noises(make: Maker) -> Kinds:
    count = make.count
    random = make.random
    yield "white", make.white()
    yield "constant", 0 * make.x
    yield "spikes", make.white() + make.chance(0.01) * random.exponential(30, count)
    yield "Student-2", random.standard_t(2, count)
    yield "Student-1.5", random.standard_t(1.5, count)
    yield "Laplace", random.laplace(size=count)
    yield "lognormal", random.lognormal(size=count)
    for digit in (0.3, 1, 3):
        yield f"digits of {digit} sd", np.round(make.white() / digit) * digit
    yield "hardly a digit", np.round(make.white(0.2) + random.uniform())
    gap = np.abs(make.x - random.uniform(0.3, 0.7)) > 0.1
    yield "a gap", np.where(gap, make.white(), math.nan)
    switches = np.cumsum(make.chance(50 / count)) % 2
    yield "random switch", switches + make.white(0.1), BOUNDED, CLEAR, 50
    yield "walk", np.cumsum(make.white()), set(), 0
    walk = np.cumsum(make.white()) / math.sqrt(count)
    yield "walk and white", walk + make.white(make.between(0.02, 0.3)), set(), 0
    yield "rare kicks", np.cumsum(make.chance(0.3) * make.white()), set(), 0
    yield "few", make.white()[: random.integers(10, 64)], set(), 0


def drifts(make: Maker) -> Kinds:
    """Yield noise with and without a drift of so many standard deviations of its slope."""
    for times in (200, 100, 50, 20, 10, 5):
        noise = correlated(make.count, times, make.random)
        yield f"correlated T/{times}", noise, BOUNDED, CLEAR, times / 2
        sigmas = make.size(5, 30)
        drift = sigmas * math.sqrt(24 / times) * make.x
        yield f"drift, correlated T/{times}", noise + drift, make.way, abs(sigmas), times / 2
    noise = correlated(make.count, 20, make.random)
    yield "drift 10 sd, correlated T/20", noise + 10 * make.sign * make.x, make.way, 9, 10
    for times in (200, 20):
        noise, at_zero = oscillating(make.count, times, make.random)
        yield f"AR(2) T/{times}", noise, BOUNDED, CLEAR, times / 2
        drift = 5 * make.sign * math.sqrt(12 * at_zero / make.count) * make.x
        yield f"AR(2) T/{times}, drift of 5 sigma", noise + drift, make.way, 5, times / 2
    for low, high in ((5, 10), (10, 300)):
        sigmas = make.size(low, high)
        drifting = make.white() + sigmas * math.sqrt(12 / make.count) * make.x
        yield f"drift {low} to {high} sigma", drifting, make.way, abs(sigmas)
    yield "a line alone", make.sign * make.x, make.way
    drift = make.size(4, 30) * make.x + make.random.uniform()
    noise = make.white(make.between(0.01, 0.5))
    yield "drift of 4 to 30 digits", np.round(drift + noise), make.way


def waves(make: Maker) -> Kinds:
    fast = make.fast
    yield "sine", make.wave(4.5, fast) + make.white(0.01)
    yield "slow sine", make.wave(1, 4) + make.white(0.01), BOUNDED, 0
    yield "two sines", make.wave(5, fast) + 0.4 * make.wave(5, make.count / 3)
    yield "four sines", sum(make.between(0.2, 1) * make.wave(5, fast) for _ in range(4))
    cycles = make.between(5, fast) * make.x + make.random.uniform()
    yield "sawtooth", cycles % 1
    yield "square wave", np.floor(2 * cycles) % 2 + 0.0
    drift = make.sign * make.x
    slow = make.wave(2.5, 7.7) + make.white(0.01)
    yield "slow sine, drift of 3 amplitudes", slow + 3 * drift, make.way
    noise = make.white(0.1)
    yield "sine, drift of 1 amplitude", make.wave(8, fast) + noise + drift, make.way
    yield "widening", make.x * np.sin(math.tau * make.between(40, 400) * make.x), set(), 0


def narrow_bands(make: Maker) -> Kinds:
    """Yield oscillations that equal blocks alias, and slow ones."""
    most = min(400.0, make.count / 2.5)
    least = min(20, most / 2)
    yield "fast sine", make.wave(least, most)
    half = min(64, make.count // 4 * 2) // 2  # of the blocks
    near = half * int(make.random.integers(1, 7)) + make.random.normal(0, 0.3)
    near = min(near, half * (most // half))
    yield "sine near a multiple of 32 cycles", make.wave(near, near)
    yield "the same with noise", make.wave(near, near) + make.white(0.1)
    yield "Kepler", make.kepler(make.between(least, most))
    yield "Kepler with 32k orbits", make.kepler(round(near))
    secular = 0.05 * make.wave(0.2, 1.5)
    yield "a slow wave of 5 % of the band", make.wave(least, most) + secular
    drift = make.size(0.02, 0.2)
    truth = BOUNDED | make.way if abs(drift) > 0.1 else BOUNDED
    yield "immaterial trend", make.wave(least, most) + drift * make.x, truth
    drift = make.size(1, 30) * make.x
    yield "fast sine, drift of 1 to 30 amplitudes", make.wave(least, most) + drift, make.way


def changes(make: Maker) -> Kinds:
    x = make.x
    way = make.way
    uniform = make.random.uniform
    step = make.size(5, 100) * (x > uniform(0.15, 0.85))
    yield "step of 5 to 100 sd", make.white() + step, way
    step = make.size(1, 5) * (x > uniform(0.3, 0.7))
    yield "step of 1 to 5 sd", make.white() + step, way, 0
    stairs = sum(x > uniform() for _ in range(make.random.integers(4, 20)))
    yield "stairs", make.white(0.2) + make.sign * stairs, way, 0
    curve = make.seen(3, 100) * np.log1p(x * make.between(3, 300)) / 3
    yield "logarithmic growth", make.white() + curve, way
    curve = make.sign * np.expm1(make.between(4, 20) * x)
    yield "exponential growth", 0.01 * (make.white() + curve), way
    begin = uniform(0.3, 0.9)
    late = make.seen(3, 100) * np.clip((x - begin) / (1 - begin), 0, 1)
    yield "late drift", make.white() + late, way, 0
    end = x > 1 - make.between(0.02, 0.12)
    yield "dead end", make.white() + make.size(5, 50) * end, way, 0
    few = make.random.integers(1, max(2, make.count // 60))
    start = make.size(8, 300) * (x < few / make.count)
    yield "short start", make.white() + start, BOUNDED | {"grows", "loses"} - way
    last = make.size(10, 1000) * (x == x[-1])
    yield "wrong last value", make.white() + last, BOUNDED, 0


def relaxations(make: Maker) -> Kinds:
    size = make.seen(3, 100)
    for rate, part in ((2, 1.5), (3, 1.5), (8, 1), (15, 1)):
        rise = part * size * make.relaxed(rate)
        yield f"relaxation T/{rate}", make.white() + rise, make.way
    rises = ("relaxation T/100", 100, CLEAR), ("rise at the start", make.between(30, 200), 0)
    for name, rate, sigmas in rises:
        rise = make.seen(3, 100) * make.relaxed(rate)
        truth = make.way if abs(rise[-1] - rise[make.count // 50]) > 3 else BOUNDED | make.way
        yield name, make.white() + rise, truth, sigmas
    size = make.seen(10, 100)
    fast = make.relaxed(make.between(30, 100))
    caught = size * (fast + make.relaxed(make.between(8, 15)))
    yield "two relaxations, over", make.white() + caught, make.way
    moving = size * (fast + 1.5 * make.relaxed(make.between(1, 2.5)))
    yield "two relaxations, one goes on", make.white() + moving, make.way
    cooling = make.between(20, 300) * np.exp(-make.between(8, 60) * make.x)
    yield "cooling to a floor", make.white(0.2) + cooling, {"loses"}, 0


def roundings(make: Maker) -> Kinds:
    near = 2.0 ** make.random.integers(10, 16) * 1.1
    rounding = float(np.spacing(np.float32(near)))
    drift = make.size(5, 30) * rounding * make.x
    yield "float32, drift of 5 to 30 roundings", single(near + drift), make.way
    yield "float32 noise", single(near + make.white(make.between(0.3, 10) * rounding))


GROUPS = (noises, drifts, waves, narrow_bands, changes, relaxations, roundings)


def all_series(share: float, seed: int = SEED) -> Iterator[tuple[Series, Any, Any]]:
    """Yield each series with times and energies, in random units with a random zero."""
    random = np.random.default_rng(seed)
    makers = (Maker(count, random) for count in SIZES for _ in range(max(1, round(22 * share))))
    for series in (Series(*made) for make in makers for group in GROUPS for made in group(make)):
        length = len(series.energies)
        times = 10 ** random.uniform(-2, 4) * (np.arange(length) + 0.5) / length
        zero = round(10 ** random.uniform(1, 4)) * random.choice([-1, 1])
        scale = 10.0 ** random.integers(-3, 3)
        energies = np.round((zero + series.energies) * scale, 8)
        kept = np.isfinite(energies)
        yield series, times[kept], energies[kept]


def truth_of(series: Series, times: Any, energies: Any) -> set[str]:
    """Return the right verdicts: a drift that nobody would see in a plot is `bounded`, too."""
    if not 0 < series.sigmas < CLEAR:
        return series.truth
    slope, level = np.polyfit(times, energies, 1)
    fluctuation = float(np.std(energies - slope * times - level))
    is_material = abs(slope) * np.ptp(times) >= MATERIAL * fluctuation
    return series.truth if is_material else series.truth | BOUNDED


def percent(some: Any) -> float:
    """Return the mean of truths or counts, in percent."""
    return round(100 * float(np.mean(some)), 2)


def measure(share: float) -> dict[str, Any]:
    kinds: defaultdict[str, Counter[str]] = defaultdict(Counter)
    wrongs = []
    clear: dict[int, list[bool]] = {sigmas: [] for sigmas in (5, 8, 10)}
    for series, times, energies in all_series(share):
        verdict = judge_record(times, energies).verdict
        is_open = verdict == "undecided"
        wrong = not is_open and verdict not in truth_of(series, times, energies)
        kinds[series.kind].update([verdict, *["wrong"] * wrong])
        wrongs.append(wrong)
        for sigmas, found in clear.items():
            if series.sigmas >= sigmas and series.independent >= 50:
                found.append(is_open)
    return {
        "series": len(wrongs),
        "wrong_percent": percent(wrongs),
        "undecided_percent": percent(clear[10]),
        "undecided_percent_by_sigmas": {sigmas: percent(found) for sigmas, found in clear.items()},
        "kinds": kinds,
    }
