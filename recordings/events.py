"""Event: what was done to a sitting.  Entry: anything in a recording, with its place on the clock."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

from engine.run.lockstep import Sample
from engine.scenes import Scene

EventKind = Literal["start", "set_h", "mark", "pause", "resume", "speed", "stop"]


@dataclass(frozen=True, slots=True)
class Event:
    """Something done to a sitting.  It applies before `step` of `run`.

    With the samples it is all that replay and verification need: a run is its `start` (the scene
    and the methods) and its `set_h`; the other kinds change no number.  A run that goes on from
    the past of another one begins with that one's start and repeats its `set_h` up to there.
    """

    kind: EventKind
    run: int  # counts from 1
    step: int
    t: float  # s, simulated
    scene: Scene | None = None  # start
    methods: tuple[str, ...] = ()  # start: keys of METHODS, in order
    h: float | None = None  # set_h [s]
    equal_cost: bool = False  # set_h: methods that need fewer force evaluations take the step in parts
    speed: float | None = None  # speed, times real time
    text: str | None = None  # mark


class Entry(NamedTuple):
    """A sample or an event at its place in a recording."""

    clock: float  # s, the recording clock: running time since the sitting began, pauses excluded
    value: Sample | Event
