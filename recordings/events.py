"""Events: actions in the lab, milestones that it noticed, and the arithmetic of a run.

And headless runs, whose clock is the simulated time: the same run gives the same bytes.
"""

import math
import struct
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, Literal, NamedTuple

from pendu_tui.engine.methods import Method, method_of
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.models.model import Force, Phase
from pendu_tui.engine.run import NUMERICS
from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.loops import LoopsOf, PlainLoops
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.files import RecordingError

if TYPE_CHECKING:
    from pendu_tui.engine.methods.own import OwnMethod

EventKind = Literal["start", "set_h", "mark", "pause", "resume", "speed", "stop", "noticed"]
SAMPLE_EVERY = 1 / 30  # s of simulated time, headless, as often as the live lab paints
MAX_EVENTS = 50_000  # in a recording; a lesson has a few hundred
NOT_INPUTS = ("start", "stop", "noticed")
"""Kinds of events that are no action of a user in a run."""


class Arithmetic(NamedTuple):
    """The version of the numerics, and fingerprints of the library functions, that made a run.

    The simulation calls no other functions; + - * / give the same bits everywhere.
    """

    numerics: int
    sin: str
    sqrt: str

    def other_functions(self) -> tuple[str, ...]:
        """Return the names of the functions that this machine computes differently."""
        names = ("sin", "sqrt")
        return tuple(name for name in names if getattr(self, name) != fingerprint(name))


@cache
def fingerprint(function: str) -> str:
    """Return a checksum of this machine's sin or sqrt at 4096 places from 1e-8 to 1e8.

    Another libm, or the same one on another processor, rounds one sine in 1400 the other way.
    """
    import hashlib  # slow

    places = [(-1) ** i * 10 ** (i / 256 - 8) * 1.1 for i in range(4096)]
    if function == "sqrt":
        places = list(map(abs, places))
    values = map(getattr(math, function), places)
    return hashlib.sha256(struct.pack("<4096d", *values)).hexdigest()[:16]


def arithmetic_here() -> Arithmetic:
    """Return the arithmetic of this version on this machine."""
    return Arithmetic(NUMERICS, fingerprint("sin"), fingerprint("sqrt"))


class Event(NamedTuple):
    """An action or a milestone, before `step` of `run`.

    A `start` (the scene with its model and methods) and the `set_h` after it determine a run; the
    other kinds change no number.  A run that continues from an earlier step of another run begins
    with the same start and the same `set_h`.  A milestone is noticed shortly after it happens.
    """

    kind: EventKind
    run: int  # counts from 1
    step: int
    t: float  # s, simulated
    scene: Scene | None = None  # start
    h: float | None = None  # set_h [s]
    equal_cost: bool = False  # set_h
    speed: float | None = None  # speed, times real time
    text: str | None = None  # mark
    milestone: Milestone | None = None  # noticed
    arithmetic: Arithmetic | None = None  # start; None: of this version on this machine
    sources: tuple[str, ...] = ()  # start; source code of a user's own methods, never executed


class Entry(NamedTuple):
    """A sample or an event at its time in a recording."""

    clock: float  # s, running time since the recording began, pauses excluded
    value: Sample | Event | None  # None: a gap, where entries are lost


def noticed(run: int, milestone: Milestone) -> Event:
    """Return the event of a milestone."""
    return Event("noticed", run, milestone.step, milestone.t, milestone=milestone)


_own: dict[str, "OwnMethod"] = {}  # by key


def remember(own: Iterable["OwnMethod"]) -> None:
    """Use these methods where a recording names them by key; its source code is never executed."""
    _own.update({method.key: method for method in own})


def name_of(method: Method) -> str:
    """Return a method's name in recordings: its key, with the source's hash for a user's own."""
    if not is_present(method):
        return method.reference
    if sha256 := getattr(method, "sha256", ""):
        return f"{method.key}@{sha256}"
    return method.key


def method_named(name: str) -> Method:
    """Return the method of this name.

    A user's own method that was not passed to `remember` can be replayed, but not simulated.  One
    that was may have another source than the recorded one.
    """
    key, is_own, _ = name.partition("@")
    if key in _own:
        return _own[key]
    if not is_own:
        try:
            return method_of(key)
        except KeyError as error:
            raise RecordingError(f"this version has no method {key}") from error
    return Method(
        key=key,
        label=key,
        letter="?",
        phases=_no_phases,
        formula="unknown",
        order=1,
        force_evaluations=1,
        reference=name,
        models=tuple(MODELS),
    )


def is_present(method: Method) -> bool:
    """Return whether a method can be simulated."""
    return method.phases is not _no_phases


def check_present(scene: Scene, only: Iterable[str] | None = None) -> None:
    """Raise RecordingError if one of the scene's methods, or of `only`, cannot be simulated."""
    for method in scene.cast:
        if not is_present(method) and (only is None or method.key in only):
            raise RecordingError(
                f"it needs the user's own method {method.key}; give its file with "
                f"--method FILE.py:{method.key}"
            )


def _no_phases(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Yield phases of NaN, which every loop stops at."""
    while True:
        yield math.nan, math.nan


def steps_for(scene: Scene, time: float) -> int:
    """Return the number of steps in a simulated time [s]."""
    return round(time / scene.h)


def simulate(
    scene: Scene,
    time: float,
    record: Callable[[Sample | Event, float], None] | None = None,
    sample_every: int | None = None,
    loops: LoopsOf = PlainLoops,
    lockstep: Lockstep | None = None,
) -> Iterator[Sample]:
    """Run a scene for `time` [s]; record and yield its samples, the last of which is the result.

    `record` is the `add` of a Recorder, which the caller closes.  Samples are `sample_every` steps
    apart, or 1/30 s rounded to whole steps, and include the first and the last step.  Pass a
    `lockstep` to read its milestones or verdicts.
    """
    lockstep = lockstep or Lockstep(scene, loops=loops, judged=record is not None)
    last = steps_for(scene, time)
    recorded = 0  # milestones
    every = sample_every or max(1, round(SAMPLE_EVERY / scene.h))
    if record:
        record(Event("start", 1, 0, 0.0, scene=scene), 0.0)
    for step in chain(range(0, last, every), (last,)):
        lockstep.advance(step - lockstep.step)
        sample = lockstep.sample()
        if record:
            record(sample, sample.t)
            for milestone in lockstep.milestones[recorded:]:
                record(noticed(1, milestone), sample.t)
            recorded = len(lockstep.milestones)
        yield sample
