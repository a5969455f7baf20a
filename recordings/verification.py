"""Verification: re-simulate a recording's runs from their events, and compare every sample.

Samples must agree in every bit, or within TOLERANCE where this machine's sin differs.  And
recovery: save the intact chunks of a damaged or unfinished recording as a complete one.
"""

import math
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import Any

from pendu_tui.engine.quantities import ENERGY_ERROR, EXTREMES
from pendu_tui.engine.run import NUMERICS
from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.loops import TieredLoops
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.recordings.events import Event, check_present
from pendu_tui.recordings.files import RecordingError, named
from pendu_tui.recordings.format import differences
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording, Run

TOLERANCE = 1e-6  # relative, above 1; another sin moves regular swings by 1e-8 in 1500 steps
MAX_STEPS = 1_000_000  # of a file, about three seconds, or
MAX_STEPS_PER_SAMPLE = 100  # if that is more; the lab at h = 0.001 s has 33


@dataclass(frozen=True, slots=True)
class Difference:
    """A recorded number that the re-simulation did not reproduce."""

    run: int
    step: int
    t: float  # s, simulated
    method: str  # "" for the time itself
    field: str
    recorded: float | None
    computed: float | None


@dataclass(slots=True)
class Verification:
    """The result of `verify`.  If complete and identical, nothing was changed or lost."""

    file: Path
    complete: bool = False  # finished, with every checksum right
    reason: str | None = None  # why not, a clause
    runs: int = 0
    samples: int = 0
    numerics: int = NUMERICS  # the version of the numerics
    methods: tuple[str, ...] = ()  # keys
    other_functions: tuple[str, ...] = ()  # that this machine computes differently
    changed_sources: tuple[str, ...] = ()  # keys of own methods whose file is not as recorded
    identical: bool = False  # every sample, or within the tolerance where sin differs; no damage
    first_difference: Difference | None = None


def verify(
    path: Path,
    progress: Callable[[float, float], None] = lambda done, total: None,
    max_steps: int | None = None,
    only: Collection[str] | None = None,
) -> Verification:
    """Verify a recording up to the first damage, all methods or `only` those of these keys.

    `progress` is called with the seconds done and those in all.  Raises RecordingError if the
    recording cannot be read, or has more than `max_steps` steps.
    """
    result = Verification(path)
    with Recording.open(path, check=True) as recording, named(path):
        steps = sum(run.steps for run in recording.runs)
        limit = max_steps or MAX_STEPS
        if steps > limit and max_steps is None:
            limit = max(limit, MAX_STEPS_PER_SAMPLE * recording.samples)
        if steps > limit:
            raise RecordingError(
                f"it claims {steps} steps, more than the limit of {limit}; if you trust the file,"
                f" use --max-steps {steps}"
            )

        def intact() -> Iterator[Event | Sample]:
            for clock, value in recording.entries():
                if value is None:
                    return
                progress(clock, recording.length)
                yield value

        for number, values in groupby(intact(), attrgetter("run")):
            _rerun(recording.run_of(number), values, result, only)
        result.complete = recording.complete
        result.reason = recording.reason
        result.identical = result.first_difference is None and not recording.damaged
    return result


def _rerun(
    run: Run,
    values: Iterable[Event | Sample],
    result: Verification,
    only: Collection[str] | None,
) -> None:
    """Simulate a run again, and compare its samples."""
    cast = run.scene.cast
    check_present(run.scene, only)
    if only is not None and not any(method.key in only for method in cast):
        raise RecordingError(f"run {run.number} has none of the methods {', '.join(only)}")
    result.runs += 1
    result.methods = tuple(dict.fromkeys((*result.methods, *(method.key for method in cast))))
    result.numerics = run.arithmetic.numerics
    result.other_functions = run.arithmetic.other_functions()
    recorded = {source for _, event in run.events for source in event.sources}
    changed = [
        method.key for method in cast if getattr(method, "source", None) not in {None, *recorded}
    ]
    result.changed_sources = tuple(dict.fromkeys((*result.changed_sources, *changed)))
    lockstep = Lockstep(run.scene, run.number, TieredLoops)
    for value in values:
        if isinstance(value, Event) and (value.h is None or value.step > run.steps):
            continue  # it changes no recorded number
        if not lockstep.step <= value.step <= run.steps:
            raise RecordingError(f"the steps of run {run.number} are not in order")
        lockstep.advance(value.step - lockstep.step)
        if isinstance(value, Sample):
            result.samples += 1
            computed = lockstep.sample()
            if result.first_difference is None:
                differing = _differences(run, value, computed, only)
                result.first_difference = next(differing, None)
        elif value.h is not None:
            lockstep.set_stepping(Stepping(value.h, value.equal_cost, cast))


def _differences(
    run: Run, recorded: Sample, computed: Sample, only: Collection[str] | None
) -> Iterator[Difference]:
    """Yield what differs in a sample."""
    is_exact = not run.arithmetic.other_functions()
    place = (recorded.run, recorded.step, recorded.t)
    if recorded.t != computed.t:
        yield Difference(*place, "", "t", recorded.t, computed.t)
    for method, was, now in zip(run.scene.cast, recorded.readings, computed.readings, strict=True):
        if only is not None and method.key not in only:
            continue
        error = getattr(was, ENERGY_ERROR.name)
        for field, a, b in differences(was, now):
            is_implied = field in EXTREMES and a == error  # see without_extremes
            is_newer = a is None and field != "diverged_at"  # than the recording
            is_close = False
            if not (is_exact or a is None or b is None):
                is_close = math.isclose(a, b, rel_tol=TOLERANCE, abs_tol=TOLERANCE)
            if not (is_implied or is_newer or is_close):
                yield Difference(*place, method.key, field, a, b)


def recover(path: Path, out: Path, overwrite: bool = False) -> dict[str, Any]:
    """Write what is intact of `path` to `out`, which appears only when it is complete.

    No number is repaired, guessed or changed, but the extremes of the first sample after a gap: the
    steps before it are lost.  Returns the fields of the report.  `damaged` is False if the
    recording was only unfinished; `runs_lost` counts runs whose start is lost.  Raises
    RecordingError if nothing can be saved, DiskError if `out` cannot be written.
    """
    with Recording.open(path, check=True) as recording:
        recorder = Recorder(out, overwrite)
        try:
            for clock, value in recording.entries():
                recorder.add(value, clock)
            recorder.close()
        finally:
            recorder.abandon(delete=True)
        return {
            "file": str(path),
            "out": str(recorder.path),
            "damaged": recording.damaged,
            "reason": recording.reason,
            "samples_kept": recorder.samples,
            "entries_lost": recording.entries_lost,
            "runs_lost": len(recording.lost_runs),
        }
