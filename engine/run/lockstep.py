"""A scene's methods side by side, step by step."""

import copy
from collections.abc import Mapping
from typing import NamedTuple

from engine.models.model import NO_EXTRA
from engine.run.loops import Advance, LoopsOf, advance_with_errors, plain
from engine.run.stepping import Stepping
from engine.scenes import Scene, check_h


class Reading(NamedTuple):
    """One method at one step.  Always finite: a method that diverges stays where it last was finite.

    Energies are per unit m·L² [s⁻²]; energy errors are relative, (E - E0)/E0, or to 2 w0² where E0 = 0, or with
    friction ln(E/E_true).
    """

    theta: float  # rad, unwrapped
    omega: float  # rad/s
    energy: float
    energy_error: float
    max_energy_error: float  # largest |energy error| over every step of the run so far
    energy_error_low: float  # smallest and largest energy error over the steps since the previous sample,
    energy_error_high: float  # so that a chart of samples loses no extreme
    diverged_at: float | None = None  # s; first time at which the method's numbers were not finite
    extra: Mapping[str, float] = NO_EXTRA  # the values of the model's own variables, `Model.variables`


class Sample(NamedTuple):
    """All methods' readings at one step, in the order of the cast."""

    run: int  # counts from 1 within a recording
    step: int  # steps since the run's start
    t: float  # s, simulated; goes down while h is negative
    readings: tuple[Reading, ...]


class _Track:
    """One method's way through a run."""

    __slots__ = ("advance", "diverged_at", "energy", "error", "high", "low", "parts", "phase", "run_high", "run_low")

    def __init__(self, advance: Advance, scene: Scene, start_energy: float) -> None:
        self.advance = advance
        self.phase = scene.equations.start(scene.theta, scene.omega)
        self.energy = start_energy
        self.error = self.low = self.high = self.run_low = self.run_high = 0.0  # of the energy
        self.diverged_at: float | None = None
        self.parts = 1  # how many steps of its own it takes in one of the lockstep


class Lockstep:
    """A scene's cast in lockstep.  The same scene and stepping give the same bits, however the steps are cut.

    `scene.h` is the step size at the start, `stepping` what is in force.  Time is `t_base + n·h`, never a
    running sum.  A method whose numbers stop being finite is frozen; the others go on.
    """

    def __init__(
        self,
        scene: Scene,
        run: int = 1,
        loops: LoopsOf = plain,  # or engine.run.compiled.compiled
    ) -> None:
        self.scene = scene
        self.run = run
        self.step = 0
        self.stepping = Stepping(scene.h, cast=scene.cast)
        self._t_base, self._base_step = 0.0, 0
        self._reference = scene.equations.reference(scene.theta, scene.omega)
        start = scene.equations.observe(scene.equations.start(scene.theta, scene.omega)).extra
        self._scales = {each.name: start[each.name] or 1.0 for each in scene.equations.variables if each.relative}
        self._limit = min(1.0, self._reference.scale) * 1e300  # so that relative errors are finite, too
        self._tracks = [
            _Track(loops(method, scene.equations).advance, scene, self._reference.start) for method in scene.cast
        ]

    def copy(self) -> "Lockstep":
        """Another lockstep that goes on from here."""
        other = copy.copy(self)
        other._tracks = [copy.copy(track) for track in self._tracks]
        return other

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self._t_base + (self.step - self._base_step) * self.stepping.h

    def set_stepping(self, stepping: Stepping) -> None:
        """Step like this from the next step on.  Raises SceneError for an h that is zero, not finite or absurd."""
        check_h(stepping.h, self.scene.w0)
        self._t_base, self._base_step = self.t, self.step
        self.stepping = stepping
        for track, part in zip(self._tracks, stepping.parts, strict=True):
            track.parts = part

    def advance(self, n: int) -> None:
        if n <= 0:
            return
        for track in self._tracks:
            if track.diverged_at is not None:
                continue
            h, steps = self.stepping.h / track.parts, n * track.parts
            begin = self._t_base, (self.step - self._base_step) * track.parts
            went = advance_with_errors(track.advance, self._reference, track.phase, h, steps, self._limit, begin)
            if went.done:
                track.phase, track.energy, track.error = went.phase, went.energy, went.error
                track.low, track.high = min(track.low, went.low), max(track.high, went.high)
            if went.done < steps:
                track.diverged_at = begin[0] + (begin[1] + went.done + 1) * h
        self.step += n

    def sample(self) -> Sample:
        """The readings now.  Lows and highs of the next sample are taken from here on."""
        return Sample(self.run, self.step, self.t, tuple(self._read(track) for track in self._tracks))

    def _read(self, track: _Track) -> Reading:
        track.run_low, track.run_high = min(track.run_low, track.low), max(track.run_high, track.high)
        low, high = track.low, track.high
        track.low = track.high = track.error
        theta, omega, extra = self.scene.equations.observe(track.phase)
        if self._scales:
            extra = {**extra, **{name: extra[name] / scale for name, scale in self._scales.items()}}
        return Reading(
            theta=theta,
            omega=omega,
            energy=track.energy,
            energy_error=track.error,
            max_energy_error=max(track.run_high, -track.run_low),
            energy_error_low=low,
            energy_error_high=high,
            diverged_at=track.diverged_at,
            extra=extra,
        )
