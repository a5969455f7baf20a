"""`judge` on series of known truth: how often its verdict is wrong, or `undecided` without need.

Each kind of series is made with 100 to 6000 samples, random scales and random zeros of energy.
`undecided` is never wrong; it is counted where the record has at least 50 independent samples, and
the effect at least 5, 8 or 10 standard deviations.  A drift over the record of less than half a
standard deviation of the fluctuation is also `bounded`.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run.record import judge_record

LIMITS = {"wrong_percent": 0.6, "undecided_percent": 8.0}
SIZES = (100, 200, 500, 2000, 6000)
SEED = 232253  # drawn after the last change of a rule or level
CLEAR = math.inf  # enough of an effect, or of samples, for a verdict
MATERIAL = 0.5  # standard deviations: a smaller drift is bounded, too
AWAY = {1: {"loses"}, -1: {"grows"}}  # where an energy goes that starts above or below


class Series(NamedTuple):
    """A series and the verdicts that are right."""

    kind: str
    energies: Any
    truth: set[str]
    sigmas: float = CLEAR  # the effect, in standard deviations of what could be mistaken for it
    independent: float = CLEAR  # samples


def correlated(count: int, times: float, random: np.random.Generator) -> Any:
    """Return stationary noise of standard deviation 1, so many correlation times long."""
    keep = math.exp(-times / count)
    kicks = random.standard_normal(count) * math.sqrt(1 - keep * keep)
    kicks[0] = random.standard_normal()
    values = np.empty(count)
    value = 0.0
    for at, kick in enumerate(kicks):
        value = keep * value + kick
        values[at] = value
    return values


class Maker:
    """Makes series of `count` samples; x runs from 0 to 1."""

    def __init__(self, count: int, random: np.random.Generator) -> None:
        self.count = count
        self.random = random
        self.x = (np.arange(count) + 0.5) / count
        self.sign = int(random.choice([-1, 1]))
        self.way = {"grows" if self.sign > 0 else "loses"}

    def between(self, low: float, high: float) -> float:
        """Return a random number, with a uniform logarithm."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def white(self) -> Any:
        return self.random.standard_normal(self.count)

    def wave(self, cycles: float) -> Any:
        return np.sin(math.tau * (cycles * self.x + self.random.uniform()))

    def all(self) -> Iterator[Series]:
        yield from self.levels()
        yield from self.drifts()
        yield from self.waves()
        yield from self.changes()
        yield from self.digits()
        yield from self.colours()
        yield from self.narrow_bands()
        yield from self.late_and_early()

    def levels(self) -> Iterator[Series]:
        bounded = {"bounded"}
        yield Series("white", self.white(), bounded, independent=self.count)
        for times in (200, 100, 50, 20, 10, 5):
            noise = correlated(self.count, times, self.random)
            yield Series(f"correlated T/{times}", noise, bounded, independent=times / 2)
        yield Series("constant", 0 * self.x, bounded)
        rare = self.random.uniform(size=self.count) < 0.01
        yield Series(
            "spikes", self.white() + rare * self.random.exponential(30, self.count), bounded
        )
        yield Series("Student-2", self.random.standard_t(2, self.count), bounded)
        yield Series("walk", np.cumsum(self.white()), {"undecided"}, sigmas=0)
        walk = np.cumsum(self.white()) / math.sqrt(self.count)
        yield Series(
            "walk and white", walk + self.between(0.02, 0.3) * self.white(), {"wanders"}, sigmas=0
        )
        few = self.white()[: self.random.integers(10, 64)]
        yield Series("few", few, set(), sigmas=0)

    def drifts(self) -> Iterator[Series]:
        for times in (200, 100, 50, 20, 10, 5):
            sigmas = self.between(5, 30)
            drift = self.sign * sigmas * math.sqrt(24 / times) * self.x
            noise = correlated(self.count, times, self.random)
            yield Series(f"drift, correlated T/{times}", noise + drift, self.way, sigmas, times / 2)
        for low, high in ((5, 10), (10, 300)):
            sigmas = self.between(low, high)
            drift = self.sign * sigmas * math.sqrt(12 / self.count) * self.x
            yield Series(
                f"drift {low} to {high} sigma", self.white() + drift, self.way, sigmas, self.count
            )
        noise = correlated(self.count, 20, self.random)
        yield Series(
            "drift 10 sd, correlated T/20", noise + 10 * self.sign * self.x, self.way, 9, 10
        )

    def waves(self) -> Iterator[Series]:
        most = min(60, self.count / 3)
        noise = 0.01 * self.white()
        yield Series("sine", self.wave(self.between(4.5, most)) + noise, {"bounded"})
        yield Series("slow sine", self.wave(self.between(1, 4)) + noise, {"bounded"}, sigmas=0)
        two = self.wave(self.between(5, most)) + 0.4 * self.wave(self.between(5, self.count / 3))
        yield Series("two sines", two, {"bounded"})
        drift = self.sign * self.x
        slow = self.wave(self.between(2.5, 7.7))
        yield Series("slow sine, drift of 3 amplitudes", slow + noise + 3 * drift, self.way)
        fast = self.wave(self.between(8, most))
        yield Series("sine, drift of 1 amplitude", fast + 10 * noise + drift, self.way)
        wider = self.x * np.sin(math.tau * self.between(40, 400) * self.x)
        yield Series("widening", wider, {"undecided"}, sigmas=0)

    def changes(self) -> Iterator[Series]:
        size = self.sign * self.between(5, 100)
        step = self.x > self.random.uniform(0.15, 0.85)
        yield Series("step of 5 to 100 sd", self.white() + size * step, self.way)
        size = self.sign * self.between(1, 5)
        step = self.x > self.random.uniform(0.3, 0.7)
        yield Series("step of 1 to 5 sd", self.white() + size * step, self.way, sigmas=0)
        size = self.sign * self.between(3, 100) * max(1.0, math.sqrt(200 / self.count))
        for share in (2, 3):
            curve = 1.5 * size * -np.expm1(-share * self.x)
            yield Series(f"relaxation T/{share}", self.white() + curve, self.way)
        for share in (8, 15):
            curve = size * -np.expm1(-share * self.x)
            yield Series(f"relaxation T/{share}", self.white() + curve, self.way)
        curve = size * -np.expm1(-100 * self.x)
        truth = self.way if abs(size) > 3 * math.e**2 else {"bounded", *self.way}  # a blip at first
        yield Series("relaxation T/100", self.white() + curve, truth)
        curve = size * np.log1p(self.x * self.between(3, 300)) / 3
        yield Series("logarithmic growth", self.white() + curve, self.way)
        curve = self.sign * np.expm1(self.between(4, 20) * self.x)
        yield Series("exponential growth", 0.01 * (self.white() + curve), self.way)
        start = self.white()
        start[: self.random.integers(1, max(2, self.count // 60))] += self.sign * self.between(
            8, 300
        )
        yield Series("short start", start, {"bounded", *AWAY[self.sign]})

    def digits(self) -> Iterator[Series]:
        for digit in (0.3, 1, 3):
            yield Series(
                f"digits of {digit} sd", np.round(self.white() / digit) * digit, {"bounded"}
            )
        still = np.round(0.2 * self.white() + self.random.uniform())
        yield Series("hardly a digit", still, {"bounded"})
        drift = self.sign * self.between(4, 30) * self.x + self.random.uniform()
        noise = self.between(0.01, 0.5) * self.white()
        yield Series("drift of 4 to 30 digits", np.round(drift + noise), self.way)

    def colours(self) -> Iterator[Series]:
        """Yield what the judge does not model: other noises, waves and roundings."""
        bounded = {"bounded"}
        for times in (200, 20):
            noise, at_zero = oscillating(self.count, times, self.random)
            yield Series(f"AR(2) T/{times}", noise, bounded, independent=times / 2)
            drift = self.sign * 5 * math.sqrt(12 * at_zero / self.count) * self.x
            yield Series(
                f"AR(2) T/{times}, drift of 5 sigma", noise + drift, self.way, 5, times / 2
            )
        most = min(60, self.count / 3)
        sines = sum(self.between(0.2, 1) * self.wave(self.between(5, most)) for _ in range(4))
        yield Series("four sines", sines, bounded)
        cycles = self.between(5, most) * self.x + self.random.uniform()
        yield Series("sawtooth", cycles % 1, bounded)
        yield Series("square wave", np.floor(2 * cycles) % 2 + 0.0, bounded)
        switches = np.cumsum(self.random.uniform(size=self.count) < 50 / self.count) % 2
        yield Series("random switch", switches + 0.1 * self.white(), bounded, independent=50)
        yield Series("Laplace", self.random.laplace(size=self.count), bounded)
        yield Series("lognormal", self.random.lognormal(size=self.count), bounded)
        yield Series("Student-1.5", self.random.standard_t(1.5, self.count), bounded)
        size = self.sign * self.between(10, 100) * max(1.0, math.sqrt(200 / self.count))
        fast = -np.expm1(-self.between(30, 100) * self.x)
        caught = size * (fast - np.expm1(-self.between(8, 15) * self.x))
        yield Series("two relaxations, over", self.white() + caught, self.way)
        moving = size * (fast - 1.5 * np.expm1(-self.between(1, 2.5) * self.x))
        yield Series("two relaxations, one goes on", self.white() + moving, self.way)
        near = 2.0 ** self.random.integers(10, 16) * 1.1
        rounding = float(np.spacing(np.float32(near)))
        drift = self.sign * self.between(5, 30) * rounding * self.x
        yield Series("float32, drift of 5 to 30 roundings", single(near + drift), self.way)
        noise = self.between(0.3, 10) * rounding * self.white()
        yield Series("float32 noise", single(near + noise), bounded)
        yield Series("a line alone", self.sign * self.x, self.way)
        gap = np.abs(self.x - self.random.uniform(0.3, 0.7)) > 0.1
        yield Series("a gap", np.where(gap, self.white(), math.nan), bounded)

    def narrow_bands(self) -> Iterator[Series]:
        """Yield oscillations that equal blocks alias, and slow ones."""
        bounded = {"bounded"}
        most = min(400.0, self.count / 2.5)
        fast = self.between(min(20, most / 2), most)
        yield Series("fast sine", self.wave(fast), bounded)
        blocks = min(64, self.count // 4 * 2)
        near = (blocks // 2) * int(self.random.integers(1, 7)) + self.random.normal(0, 0.3)
        near = min(near, blocks // 2 * (2 * most // blocks))
        yield Series("sine near a multiple of 32 cycles", self.wave(near), bounded)
        yield Series("the same with noise", self.wave(near) + 0.1 * self.white(), bounded)
        yield Series("Kepler", self.kepler(fast), bounded)
        yield Series("Kepler with 32k orbits", self.kepler(round(near)), bounded)
        secular = 0.05 * self.wave(self.between(0.2, 1.5))
        yield Series("a slow wave of 5 % of the band", self.wave(fast) + secular, bounded)
        drift = self.sign * self.between(0.02, 0.2) * self.x
        truth = bounded | (self.way if abs(drift[-1]) > 0.1 else set())
        yield Series("immaterial trend", self.wave(fast) + drift, truth)
        drift = self.sign * self.between(1, 30) * self.x
        yield Series("fast sine, drift of 1 to 30 amplitudes", self.wave(fast) + drift, self.way)

    def kepler(self, orbits: float) -> Any:
        """Return 1/r³ along an orbit, as which the energy error of leapfrog goes."""
        eccentricity = self.random.uniform(0.05, 0.7)
        anomaly = mean = math.tau * (orbits * self.x + self.random.uniform())
        for _ in range(60):
            anomaly = mean + eccentricity * np.sin(anomaly)
        return (1 - eccentricity * np.cos(anomaly)) ** -3

    def late_and_early(self) -> Iterator[Series]:
        size = self.sign * self.between(3, 100) * max(1.0, math.sqrt(200 / self.count))
        rise = size * -np.expm1(-self.between(30, 200) * self.x)
        truth = self.way if abs(rise[-1] - rise[self.count // 50]) > 3 else {"bounded", *self.way}
        yield Series("rise at the start", self.white() + rise, truth, sigmas=0)
        begin = self.random.uniform(0.3, 0.9)
        late = size * np.clip((self.x - begin) / (1 - begin), 0, 1)
        yield Series("late drift", self.white() + late, self.way, sigmas=0)
        stairs = sum(self.x > self.random.uniform() for _ in range(self.random.integers(4, 20)))
        yield Series("stairs", 0.2 * self.white() + self.sign * stairs, self.way, sigmas=0)
        keep = self.random.uniform(0, 1, self.count) < 0.3
        yield Series("rare kicks", np.cumsum(keep * self.white()), {"undecided"}, sigmas=0)
        cooling = self.between(20, 300) * np.exp(-self.between(8, 60) * self.x)
        floor = 1 + 0.2 * self.white()
        yield Series("cooling to a floor", floor + cooling, {"loses"}, sigmas=0)
        end = self.x > 1 - self.between(0.02, 0.12)
        ended = self.white() + self.sign * self.between(5, 50) * end
        yield Series("dead end", ended, {"undecided", *self.way}, sigmas=0)
        last = self.white()
        last[-1] += self.sign * self.between(10, 1000)
        yield Series("wrong last value", last, {"undecided", "bounded"}, sigmas=0)


def oscillating(count: int, times: float, random: np.random.Generator) -> tuple[Any, float]:
    """Return oscillating noise, so many decay times long, and its spectrum at frequency 0."""
    decay = math.exp(-times / count)
    angle = random.uniform(0.1, 3) * min(1.0, times / count * 3)
    first = 2 * decay * math.cos(angle)
    kicks = random.standard_normal(count + 400)
    values = [0.0, 0.0]
    for kick in kicks:
        values.append(first * values[-1] - decay**2 * values[-2] + kick)
    noise = np.array(values[402:])
    size = float(noise.std())
    return noise / size, 1 / (1 - first + decay**2) ** 2 / size**2


def single(energies: Any) -> Any:
    """Return energies rounded to float32, as doubles near 0, so that no digit is lost."""
    rounded = energies.astype(np.float32).astype(float)
    return rounded - rounded[0]


def all_series(share: float, seed: int = SEED) -> Iterator[tuple[Series, Any, Any]]:
    """Yield each series with times and energies, in random units with a random zero."""
    random = np.random.default_rng(seed)
    makers = (Maker(count, random) for count in SIZES for _ in range(round(22 * share)))
    for maker in makers:
        for series in maker.all():
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
    return series.truth if is_material else series.truth | {"bounded"}


def measure(share: float) -> dict[str, Any]:
    kinds: defaultdict[str, Counter[str]] = defaultdict(Counter)
    verdicts: Counter[str] = Counter()
    false: Counter[str] = Counter()
    clear: dict[int, list[bool]] = {sigmas: [] for sigmas in (5, 8, 10)}
    for series, times, energies in all_series(share):
        verdict = judge_record(times, energies).verdict
        is_open = verdict == "undecided"
        wrong = not is_open and verdict not in truth_of(series, times, energies)
        kinds[series.kind][verdict] += 1
        kinds[series.kind]["wrong"] += wrong
        verdicts[verdict] += 1
        false[verdict] += wrong
        for sigmas, found in clear.items():
            if series.sigmas >= sigmas and series.independent >= 50:
                found.append(is_open)
    return {
        "series": verdicts.total(),
        "wrong_percent": round(100 * false.total() / verdicts.total(), 2),
        "undecided_percent": round(100 * float(np.mean(clear[10])), 2),
        "undecided_percent_by_sigmas": {
            sigmas: round(100 * float(np.mean(found)), 2) for sigmas, found in clear.items()
        },
        "false_percent": {
            verdict: round(100 * false[verdict] / count, 2) for verdict, count in verdicts.items()
        },
        "kinds": {
            kind: {name: n for name, n in counts.items() if n} for kind, counts in kinds.items()
        },
    }
