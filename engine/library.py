"""The library: what `from pendu_tui.engine import ...` gives.  NumPy is loaded by the first call.

Arguments that cannot be used raise InputError, a ValueError with a sentence.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from functools import partial, wraps
from numbers import Integral
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from pendu_tui.engine import methods as listed
from pendu_tui.engine import scenes
from pendu_tui.engine.inputs import InputError, check_name
from pendu_tui.engine.methods import Cast, Method, all_named, matching
from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.scenes import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from pendu_tui.engine.methods.method import Measured, Phases
    from pendu_tui.engine.run.record import Order
    from pendu_tui.engine.studies.accuracy import ErrorKind
    from pendu_tui.engine.studies.recommend import Attempt

    Floats = NDArray[np.float64]

MAX_READINGS = 10_000_000  # of all methods of a run: 320 MB

T = TypeVar("T")


class ByMethod(dict[str, T]):
    """One value for each method, by any of its names, which may be shortened."""

    def __init__(self, methods: Cast, values: Iterable[T]) -> None:
        super().__init__(zip((method.key for method in methods), values, strict=True))
        self.methods = methods

    def __missing__(self, name: str) -> T:
        matches = matching(str(name), self.methods)
        if len(matches) != 1:
            raise KeyError(f"{name!r} does not name one method; use one of {', '.join(self)}.")
        return self[matches[0].key]


def _public(method: Method) -> Method:
    """Return the method for forces that may use an array again, if it takes any force."""

    @wraps(method.phases)
    def phases(force: Any, phase: Any, h: float) -> Iterator[Any]:
        if not method.general:
            raise InputError(
                f"{method.label} is made for the scenes of the lab, not for any force and arrays; "
                "use a method of METHODS with general=True."
            )

        def fresh(q: Any) -> Any:
            value = force(q)
            return value.copy() if hasattr(value, "copy") else value

        return method.phases(fresh, phase, h)

    return replace(method, phases=phases)


METHODS: Mapping[str, Method] = MappingProxyType(
    ByMethod(listed.METHODS, map(_public, listed.METHODS))
)
"""The methods by key.  `phases(force, (q, p), h)` of those with `general` yields the phases after
one step of h, after two, and so on endlessly; q, p and force(q) are numbers or arrays, and
q'' = force(q)."""

SCENES: Mapping[str, Scene] = MappingProxyType(scenes.SCENES)
"""The scenes by name, in the order of `pendu-tui scenes`."""

Methods = str | Iterable[str | Method]
"""Keys or prefixes of keys, such as "rk4,verlet", or methods."""


@dataclass(frozen=True)
class Track:
    """One method's run, with a value for each time; after an overflow, the last finite ones."""

    theta: "Floats" = field(repr=False)  # rad, not reduced to a turn
    omega: "Floats" = field(repr=False)  # rad/s
    energy: "Floats" = field(repr=False)  # s⁻², per unit m·L²
    energy_error: "Floats" = field(repr=False)  # relative
    verdict: str
    diverged_at: float | None  # s


class Run(ByMethod[Track]):
    """The methods' tracks, by any name or the prefix of a key, at the times `t` [s]."""

    def __init__(self, scene: Scene, t: "Floats", tracks: Iterable[Track]) -> None:
        super().__init__(scene.cast, tracks)
        self.scene = scene
        self.t = t


def simulate(
    scene: str | Scene = "drift",
    *,
    time: float,
    methods: Methods | None = None,
    every: int = 1,
    **numbers: float,
) -> Run:
    """Run methods side by side for `time` [s], by default those of the scene.

    `numbers` replace the scene's: theta [rad], omega [rad/s], length [m], gravity [m/s²], h [s],
    and the parameters of its model.  The arrays hold step 0, every `every`-th step, and the last.
    """
    import numpy as np

    from pendu_tui.engine.run.lockstep import Lockstep
    from pendu_tui.engine.run.loops import TieredLoops

    chosen = _scene(scene, methods, numbers)
    stops = _stops(chosen, _number("time", time), every)
    lockstep = Lockstep(chosen, loops=partial(TieredLoops, expected_steps=stops[-1]), judged=True)
    t = np.empty(len(stops))
    values = np.empty((4, len(chosen.cast), len(stops)))
    for index, stop in enumerate(stops):
        lockstep.advance(stop - lockstep.step)
        sample = lockstep.sample()
        t[index] = sample.t
        values[:, :, index] = np.transpose([reading[:4] for reading in sample.readings])
    verdicts = [judgement.verdict for judgement in lockstep.judgements]
    ends = [reading.diverged_at for reading in sample.readings]
    return Run(chosen, t, map(Track, *values, verdicts, ends))


def _stops(scene: Scene, time: float, every: int) -> list[int]:
    steps = round(min(time, 1e15) / scene.h)
    if steps < 1:
        raise InputError(f"time = {time:g} s is shorter than one step of {scene.h:g} s.")
    if steps / _whole("every", every) * len(scene.cast) > MAX_READINGS:
        raise InputError(f"{steps} steps are too many to keep; use every={steps // 10_000}.")
    return [*range(0, steps, every), steps]


@dataclass(frozen=True)
class Judged:
    """The verdict on a series of energies; `pendu-tui judge --help` explains its word."""

    verdict: str
    reason: str  # of `undecided`: what is missing, and whether a longer record helps
    slope: float | None  # of the energies over the scale, per unit of time; None: nothing to fit
    uncertainty: float | None  # of the slope: 68 % lie within
    bound: float | None  # |slope| is below it with a probability of 99 %
    share: float | None  # what the slope adds up to, over the width of the band
    rests: bool  # the energy stays in another band than at first; the slope is of that part
    error: float  # the distance of the last energy from the first, over the scale
    max_error: float  # the largest such distance
    fluctuation: float | None  # standard deviation about a line, over the scale
    independent: float  # samples
    scale: float  # in the energies' unit
    diverged_at: float | None  # the time of the first energy that has failed

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self, time_unit: str = "", energy_unit: str = "", step: str = "") -> list[str]:
        """Return the answer in lines, with these units, per `step` where time has none."""
        per = f"per {time_unit or step or 'unit of time'}"
        verdict = self.verdict
        if self.rests:
            verdict += ", then settles"
        if self.reason:
            verdict += f": {self.reason}"
        if self.diverged_at is not None:
            verdict += f": the energies break down at {self.diverged_at:g} {time_unit}".rstrip()
        lines = [f"verdict       {verdict}"]
        if self.slope is not None and self.uncertainty is not None:
            relative = f"relative {self.slope:+.2e} ± {self.uncertainty:.0e} {per}"
            absolute = f"{self.slope * self.scale:+.2e} ± {self.uncertainty * self.scale:.0e}"
            absolute = f"absolute {absolute} {energy_unit}".rstrip()
            share = self.share or 0.0
            band = f"{100 * share:+.2g} % of" if abs(share) < 1 else f"{share:+.3g} times"
            lines.append(f"trend         {relative}, {absolute} {per}")
            lines.append(f"bound         relative {self.bound:.2e} {per} at 99 %")
            lines.append(f"share         {band} the band over this record")
        error = "too large for a number"
        if math.isfinite(self.max_error):
            error = f"{self.error:+.2e} at the end, {self.max_error:.2e} at most, relative to "
            error += f"{self.scale:.6g} {energy_unit}".rstrip()
        return [*lines, f"energy error  {error}"]


def judge(times: "ArrayLike", energies: "ArrayLike", scale: float | str = "first") -> Judged:
    """Judge the energies of any program at increasing times.

    Errors and trend are relative to `scale`: "first", the first energy, "std", the standard
    deviation of the energies, or a number.  If one is nan, inf or 1e300, the verdict is `failed`.
    """
    import numpy as np

    from pendu_tui.engine.run.record import judge_record
    from pendu_tui.engine.run.verdicts import TOO_LARGE

    t, e = _series(times, energies)
    finite = (np.abs(e) < TOO_LARGE).cumprod().sum()
    diverged_at = None
    if finite < len(e):
        diverged_at = float(t[finite])
    e = _finite("energies", e[: max(finite, 1)])
    size = _size(e, scale)
    found = judge_record(t[: len(e)], e, failed=diverged_at is not None).scaled(1 / size)
    if not math.isfinite(found.bound or 0):  # beyond doubles
        found = found._replace(slope=None, uncertainty=None, bound=None)
    judged = found._asdict()
    return Judged(
        **{each.name: judged[each.name] for each in fields(Judged) if each.name in judged},
        error=float(e[-1] - e[0]) / size,
        max_error=float(np.abs(e - e[0]).max()) / size,
        scale=size,
        diverged_at=diverged_at,
    )


def measure(step: "Phases") -> "Measured":
    """Return the measured properties of a method: order, cost, symplectic, reversible, limit.

    `step(force, phase, h)` is a generator function that yields the phase (q, p) after one step of
    h, after two, and so on; q'' = force(q).
    """
    from pendu_tui.engine.methods.measure import examined
    from pendu_tui.engine.methods.own import OwnMethodError, guarded

    name = getattr(step, "__name__", "step")
    file = getattr(getattr(step, "__code__", None), "co_filename", name)
    try:
        return examined(guarded(step, file), name)
    except OwnMethodError as error:
        raise InputError(str(error)) from None


def fluctuation_order(runs: "Iterable[tuple[float, ArrayLike, ArrayLike]]") -> "Order":
    """Return the power of h with which the energy fluctuates in runs (h, times, energies).

    The runs differ in their step size h alone.  The energies of a method of order 2 that solves the
    right equation fluctuate as h².
    """
    from pendu_tui.engine.run.record import fluctuation, order_of

    steps = []
    fluctuations = []
    for h, times, energies in runs:
        steps.append(_number("h", h))
        name = f"energies at h = {h:g}"
        t, e = _series(times, energies, name)
        _finite(name, e)
        try:
            fluctuations.append(fluctuation(t, e))
        except ValueError as error:
            raise InputError(f"h = {h:g}: {error}") from None
    return order_of(steps, fluctuations)


@dataclass(frozen=True)
class Limit:
    """Where a method loses a swing; z = h·sqrt(g/L)."""

    linear: float | None  # z: the limit of small swings; 0: none is stable, None: no single number
    z: float | None  # the smallest at which the swing is lost; None: held up to z = 3.2
    h: float | None  # s, the same for this scene
    reason: str  # over the top, grows, loses or chaotic; "" if it is held


def limits(
    scene: str | Scene = "drift",
    *,
    methods: Methods | None = None,
    steps: int = 1000,
    **numbers: float,
) -> ByMethod[Limit]:
    """Return where each method, by default every general one, loses the swing of a scene.

    Step sizes are tried in increments of 1 %, with `steps` steps each: `pendu-tui stability --steps
    1000` finds the same limits; more steps find lower ones.  `pendu_tui.engine.studies.LOST` says
    when a swing is lost.  `numbers` are those of `simulate`.
    """
    from pendu_tui.engine.studies.stability import amplitude, ladder_of, table

    chosen = _general(scene, methods, numbers)
    theta = amplitude(chosen)
    if theta is None or chosen.equations.is_linear:
        raise InputError(
            "limits are those of a pendulum that swings; use another initial state or scene."
        )
    grid = ladder_of(chosen, [theta], None, _whole("steps", steps))
    found = []
    for row in table(chosen, grid, grid.cells()):
        h = row.z and row.z / chosen.w0
        found.append(Limit(row.method.linear_limit, row.z, h, row.reason or ""))
    return ByMethod(chosen.cast, found)


def recommend(
    target: float,
    scene: str | Scene = "drift",
    *,
    time: float | None = None,
    methods: Methods | None = None,
    error: "ErrorKind" = "theta",
    **numbers: float,
) -> "list[Attempt]":
    """Return the cheapest run of each method with an error up to `target`, the cheapest first.

    By default all general methods are tried, over ten small-amplitude periods.  See `method.key`,
    `point.h` [s], `point.z`, `point.steps_per_swing`, `point.force_evaluations` and `times`, the
    cost over the cheapest's.  `error` is "theta" [rad], "energy" or "final" (theta at the
    end).  Raises ValueError if no method reaches the target.
    """
    from pendu_tui.engine.run.loops import TieredLoops
    from pendu_tui.engine.studies.accuracy import Study, usual
    from pendu_tui.engine.studies.recommend import least_cost

    chosen = _general(scene, methods, numbers)
    if chosen.theta == chosen.omega == 0:
        raise InputError("the pendulum hangs at rest; use another theta or omega.")
    check_name("kind of error", error, ("theta", "energy", "final"))
    seconds, _ = usual(chosen, all=True)
    if time is not None:
        seconds = _positive("time", time)
    wanted = _positive("target", target)
    attempts = least_cost(Study(chosen, seconds, TieredLoops), error, wanted)
    successes = [attempt for attempt in attempts if attempt.reached]
    if not successes:
        raise InputError(
            f"no method keeps its {error} error within {wanted:g} over {seconds:g} s; "
            f"{attempts[0].method.label}: {attempts[0].why_not}."
        )
    return successes


def _scene(scene: str | Scene, methods: Methods | None, numbers: Mapping[str, float]) -> Scene:
    if not isinstance(scene, Scene):
        check_name("scene", str(scene), SCENES)
        scene = SCENES[str(scene)]
    for name in numbers:
        check_name("number", name, NUMBERS)
    scene = scene.altered(**{name: _number(name, value) for name, value in numbers.items()})
    if methods is None:
        return scene
    return scene.with_cast(_cast(methods))


def _general(scene: str | Scene, methods: Methods | None, numbers: Mapping[str, float]) -> Scene:
    """Return a scene for a study, by default with all general methods."""
    chosen = _scene(scene, listed.GENERAL if methods is None else methods, numbers)
    if chosen.why_not_mapped:
        raise InputError(chosen.why_not_mapped)
    return chosen


def _cast(methods: Methods) -> Cast:
    given: Iterable[Any] = [methods]
    if isinstance(methods, str):
        given = methods.split(",")
    elif isinstance(methods, Iterable):
        given = methods
    return all_named([getattr(each, "key", str(each)) for each in given])


def _number(name: str, value: Any) -> float:
    try:
        if not isinstance(value, str | bool) and math.isfinite(value):
            return float(value)
    except (TypeError, OverflowError):
        pass
    raise InputError(f"{name} = {value!r:.60} is not a finite number.")


def _positive(name: str, value: Any) -> float:
    number = _number(name, value)
    if number <= 0:
        raise InputError(f"{name} = {number:g} is not above zero.")
    return number


def _whole(name: str, value: Any) -> int:
    if not isinstance(value, Integral) or int(value) < 1:  # numpy's are integral, too
        raise InputError(f"{name} = {value!r} is not a whole number above zero.")
    return int(value)


def _array(name: str, values: Any) -> "Floats":
    import numpy as np

    if np.ma.is_masked(values):
        raise InputError(f"{name} has masked values; leave those samples out.")
    array = np.empty(0)
    with suppress(TypeError, ValueError, OverflowError):
        if not np.iscomplexobj(values):
            array = np.asarray(values, dtype=float)
    if array.ndim != 1 or not array.size:
        raise InputError(f"{name} must be a list of numbers or an array, one for each sample.")
    return array


def _finite(name: str, array: "Floats") -> "Floats":
    import numpy as np

    if not np.isfinite(array).all():
        place = np.argmin(np.isfinite(array))
        raise InputError(f"{name}[{place}] is {array[place]}, which is not a finite number.")
    return array


def _series(
    times: "ArrayLike", energies: "ArrayLike", name: str = "energies"
) -> tuple["Floats", "Floats"]:
    """Return arrays of times, which increase, and of as many energies, named so in errors."""
    import numpy as np

    t = _finite("times", _array("times", times))
    e = _array(name, energies)
    if len(t) != len(e):
        raise InputError(f"{len(t)} times and {len(e)} energies: give one energy for each time.")
    later = np.diff(t) > 0
    if not later.all():
        place = np.argmin(later) + 1
        raise InputError(f"times[{place}] is not later than the one before; times must increase.")
    span = t[-1] - t[0]
    if len(t) > 1 and not 1e-100 < span < 1e100:  # else squares are beyond doubles
        raise InputError(f"times span {span:.3g}; give them in a unit closer to that.")
    return t, e


def _size(energies: Any, scale: float | str) -> float:
    """Return the energy that errors are relative to."""
    if not isinstance(scale, str):
        size = _number("scale", scale)
    elif scale == "std":
        largest = float(abs(energies).max()) or 1.0
        return float((energies / largest).std()) * largest or largest
    else:
        check_name("scale", scale, ("first", "std"))
        size = abs(float(energies[0]))
    if size <= 0:
        raise InputError(f"scale = {scale!r} is {size:g}; give a typical energy above zero.")
    return size
