"""A scene's methods side by side, step by step."""

import copy
import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import permutations
from typing import Any, NamedTuple

from pendu_tui.engine.models.model import NO_EXTRA, Phase
from pendu_tui.engine.run.judge import Judge, LookPoint, stride
from pendu_tui.engine.run.levels import ROUNDING
from pendu_tui.engine.run.loops import Advance, Advanced, LoopsOf, PlainLoops
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.run.verdicts import (
    BOUNDED,
    FAILED,
    LEAVES,
    TOO_LARGE,
    Judgement,
    Milestone,
    MilestoneKind,
    Progress,
)
from pendu_tui.engine.scenes import Scene


class Reading(NamedTuple):
    """One method at one step; a diverged one stays at its last finite numbers.

    Energy errors are (E - E0)/|E0|, over 2 w0² where E0 = 0, or with friction ln(E/E_true).
    """

    theta: float  # rad, unwrapped
    omega: float  # rad/s
    energy: float  # s⁻², per unit m·L²
    energy_error: float
    max_energy_error: float  # largest |energy error| over every step of the run so far
    # smallest and largest energy error since the previous sample, so that charts miss no extreme
    energy_error_low: float
    energy_error_high: float
    diverged_at: float | None = None  # s; first time at which the method's numbers were not finite
    max_invariant_error: float | None = None  # relative, of `Model.invariant`, over the run so far
    extra: Mapping[str, float] = NO_EXTRA  # the model's own variables, `Model.variables`


TAU_REST = 2.4492935982947064e-16  # 2 pi - math.tau


class Sample(NamedTuple):
    """All methods' readings at one step, in the order of the cast."""

    run: int  # counts from 1 within a recording
    step: int  # steps since the run's start
    t: float  # s, simulated; goes down while h is negative
    readings: tuple[Reading, ...]


@dataclass
class _Track:
    """The state of one method in a run."""

    advance: Advance
    phase: Phase
    energy: float
    error: float = 0.0  # of the energy; as are the extremes
    low: float = 0.0  # since the last sample
    high: float = 0.0
    look_low: float = 0.0  # since the last look point
    look_high: float = 0.0
    largest: float = 0.0  # |error| of the run
    diverged_at: float | None = None
    parts: int = 1  # own steps in one step of the lockstep
    turns: int = 0  # subtracted from theta
    invariant_error: float = 0.0  # the largest so far
    is_watched: bool = False  # it may go over the top, where the exact motion never comes

    def reduce(self) -> None:
        """Subtract whole turns from theta beyond one turn, because its rounding grows with it.

        2 pi is the sum of math.tau and TAU_REST.  `theta + -before` keeps the compensation of
        compensated numbers.
        """
        theta, *others = self.phase
        if abs(theta) >= math.tau:
            before = float(theta)
            rest = math.remainder(before, math.tau)
            turns = round((before - rest) / math.tau)
            self.turns += turns
            self.phase = (theta + -before + (rest - turns * TAU_REST), *others)


class Lockstep:
    """A scene's cast in lockstep; its bits depend on scene and stepping alone.

    `scene.h` is the step size at the start, `stepping` the present one.  Time is `t_base + n·h`,
    never a running sum.  A method whose numbers stop being finite is frozen; the others go on.

    Every `stride` steps since the last change of the stepping there is a look point: theta is
    reduced, and judges, if there are any, look at their methods.
    """

    def __init__(
        self,
        scene: Scene,
        run: int = 1,
        loops: LoopsOf = PlainLoops,  # or engine.run.loops.compiled
        judged: bool = False,
    ) -> None:
        self.scene = scene
        self.run = run
        self.step = 0
        self.stepping = Stepping(scene.h, cast=scene.cast)
        self._t_base = 0.0
        self._base_step = 0
        self._model = model = scene.equations
        self._reference = model.reference(scene.theta, scene.omega)
        start_phase = model.start(scene.theta, scene.omega)
        self._invariant = model.invariant()
        self._invariant_start = 0.0
        if self._invariant:
            self._invariant_start = self._invariant(start_phase)
        start = model.observe(start_phase).extra
        self._scales = {
            each.name: start[each.name] or 1.0 for each in model.variables if each.relative
        }
        # of energies: relative errors must be finite, too
        self._limit = min(1.0, self._reference.scale) * TOO_LARGE
        self._tracks = [
            _Track(loops(method, model).advance, start_phase, self._reference.start)
            for method in scene.cast
        ]
        exact = scene.exact()
        self.period = exact.period or math.tau / model.w0  # s
        self.milestones: list[Milestone] = []  # up to this step; none without judges
        self._judged = judged
        self._bottom = math.tau * round(scene.theta / math.tau)  # rad
        for track in self._tracks:
            track.is_watched = judged and model.turns and exact.regime == "libration"
        self._restart()

    def copy(self) -> "Lockstep":
        """Return another lockstep that goes on from here."""
        other = copy.copy(self)
        other._tracks = [copy.copy(track) for track in self._tracks]
        other._judges = [judge.copy() for judge in self._judges]
        other.milestones = self.milestones.copy()
        return other

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return self._t_base + (self.step - self._base_step) * self.stepping.h

    @property
    def judgements(self) -> list[Judgement]:
        """Judgements since the last change of the stepping, by method; none without judges."""
        return [judge.judgement for judge in self._judges]

    def progress(self, index: int, steps: int) -> Progress | None:
        """Return what the verdict on a method lacks, so many steps after the last change."""
        looked = steps - steps % self._stride
        return self._judges[index].progress_at(looked * self.stepping.parts[index])

    def set_stepping(self, stepping: Stepping) -> None:
        """Step like this from the next step on; `Stepping.check` has approved it."""
        self._t_base = self.t
        self._base_step = self.step
        self.stepping = stepping
        for track, part in zip(self._tracks, stepping.parts, strict=True):
            track.parts = part
        self._restart()

    def _restart(self) -> None:
        """Count look points, and judge, from here on."""
        self._stride = stride(self.period, self.stepping.h, self._model)
        self._judges: list[Judge] = []
        # (leaving, bounded) methods, of which the bounded one still has the larger error
        self._below: frozenset[tuple[int, int]] = frozenset()
        if self._judged:
            methods = zip(self.scene.cast, self._tracks, self.stepping.own, strict=True)
            for method, track, h in methods:
                start = self._take_look_point(track)
                judge = Judge(h, self.period, method=method, model=self._model, start=start)
                if track.diverged_at is not None:
                    judge.fail()
                self._judges.append(judge)
        self._next_stop = self._following_stop()

    def advance(self, n: int) -> None:
        """Take n steps."""
        last = self.step + n
        while self.step < last:
            self._move(min(last, self._next_stop) - self.step)
            if self.step == self._next_stop:
                self._stop()

    def _move(self, n: int) -> None:
        for index, track in enumerate(self._tracks):
            if track.diverged_at is not None:
                continue
            h = self.stepping.h / track.parts
            begin = (self.step - self._base_step) * track.parts
            done = self._walk(track, h, begin, n * track.parts)
            if done < n * track.parts:
                track.diverged_at = self._t_base + (begin + done + 1) * h
                track.is_watched = False
                if self._judged:
                    self._judges[index].fail()
                    step = self.step + math.ceil((done + 1) / track.parts)
                    self._note(FAILED, index, step=step, t=track.diverged_at)
        self.step += n

    def _walk(self, track: _Track, h: float, begin: int, n: int) -> int:
        """Take n steps of a method, or as many as succeed, and note its errors; return how many.

        Invariants and energies that are not conserved are looked at after each step.
        """
        stride = n if self._invariant is None and self._reference.true is None else 1
        done = 0
        while done < n:
            moved = track.advance(track.phase, h, stride, self._limit)
            if moved.done:
                done += moved.done
                self._take_in(track, moved, self._t_base + (begin + done) * h)
            if moved.done < stride:
                break
        return done

    def _take_in(self, track: _Track, moved: Advanced, t: float) -> None:
        track.phase = moved.phase
        track.energy = moved.energy
        track.error, low, high = self._reference.errors(t, moved.energy, moved.low, moved.high)
        track.low = min(track.low, low)
        track.high = max(track.high, high)
        track.look_low = min(track.look_low, low)
        track.look_high = max(track.look_high, high)
        track.largest = max(track.largest, high, -low)
        if self._invariant:
            off = abs(self._invariant(moved.phase) - self._invariant_start) / self._invariant_start
            track.invariant_error = max(track.invariant_error, off)

    def _stop(self) -> None:
        """Do what is due at a stop, and choose the next stop."""
        is_look_point = (self.step - self._base_step) % self._stride == 0
        if is_look_point and self._model.turns:
            for track in self._tracks:
                track.reduce()
        if is_look_point and self._judged:
            self._look()
        self._note_tops()
        self._next_stop = self._following_stop()

    def _look(self) -> None:
        """Show each judge its method, and note new verdicts."""
        for index, (track, judge) in enumerate(zip(self._tracks, self._judges, strict=True)):
            if track.diverged_at is not None:
                continue
            previous = judge.judgement.verdict
            judge.look(self._take_look_point(track))
            now = judge.judgement
            if now.verdict != previous:
                self._note(
                    "verdict", index, verdict=now.verdict, trend=now.trend, lyapunov=now.lyapunov
                )
        self._note_crossings()

    def _note_crossings(self) -> None:
        """Note where a method whose energy leaves overtakes a bounded one in largest error.

        In other pairs the first might overtake again.
        """
        for (index, leaving), (other, bounded) in permutations(enumerate(self._judges), 2):
            leaves = leaving.judgement.verdict in LEAVES
            stays = bounded.judgement.verdict == BOUNDED and bounded.peak > ROUNDING
            if not (leaves and stays):
                continue
            pair = {(index, other)}
            if leaving.peak <= bounded.peak:
                self._below |= pair
            elif self._below & pair:
                self._below -= pair
                self._note("errors cross", index, other=self.scene.cast[other])

    def _note(self, kind: MilestoneKind, index: int, **more: Any) -> None:
        """Note what a method does, at the present step if `more` says no other."""
        more = {"step": self.step, "t": self.t, **more}
        error = self._tracks[index].error
        self.milestones.append(Milestone(kind, self.scene.cast[index], energy_error=error, **more))

    def _take_look_point(self, track: _Track) -> LookPoint:
        """Return a method's look point; the extremes of the next one count from here."""
        theta, omega, _ = self._model.observe(track.phase)
        point = LookPoint(
            step=(self.step - self._base_step) * track.parts,
            error=track.error,
            low=track.look_low,
            high=track.look_high,
            theta=theta,
            omega=omega,
            energy=track.energy,
        )
        track.look_low = track.look_high = track.error
        return point

    def _following_stop(self) -> int:
        """Return the next look point, or an earlier step where a method may be over the top."""
        done = (self.step - self._base_step) // self._stride + 1
        stop = self._base_step + done * self._stride
        for track in self._tracks:
            if track.is_watched:
                stop = min(stop, self.step + self._steps_below_top(track, stop - self.step))
        return stop

    def _note_tops(self) -> None:
        """Note the methods that have gone over the top, where the exact motion never comes."""
        for index, track in enumerate(self._tracks):
            if track.is_watched and self._below_top(track) < 0:
                self._note("over the top", index)
                track.is_watched = False

    def _below_top(self, track: _Track) -> float:
        """Return how far below the top a method is [rad]."""
        theta = self._model.observe(track.phase).theta + track.turns * math.tau
        return math.pi - abs(theta - self._bottom)

    def _steps_below_top(self, track: _Track, most: int) -> int:
        """Return a number of steps, at least 1, in which a method does not go over the top."""
        distance = self._below_top(track)
        omega = abs(self._model.observe(track.phase).omega)
        h = abs(self.stepping.h)
        # twice the way under full gravity, because methods overshoot
        while most > 1 and 2 * (omega + self._model.w0_squared * most * h) * most * h > distance:
            most //= 2
        return most

    def sample(self, resets: bool = True) -> Sample:
        """Return the present readings; with `resets`, extremes count from here on."""
        readings = tuple(self._read(track) for track in self._tracks)
        if resets:
            for track in self._tracks:
                track.low = track.high = track.error
        return Sample(self.run, self.step, self.t, readings)

    def _read(self, track: _Track) -> Reading:
        theta, omega, extra = self._model.observe(track.phase)
        if track.turns:
            theta += track.turns * math.tau
        if self._scales:
            extra = {**extra, **{name: extra[name] / scale for name, scale in self._scales.items()}}
        return Reading(
            theta=theta,
            omega=omega,
            energy=track.energy,
            energy_error=track.error,
            max_energy_error=track.largest,
            energy_error_low=track.low,
            energy_error_high=track.high,
            diverged_at=track.diverged_at,
            max_invariant_error=None if self._invariant is None else track.invariant_error,
            extra=extra,
        )
