"""Event: what was done in the lab.  Entry: a sample or an event, with its time in the recording."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

from engine.run.lockstep import Sample
from engine.scenes import Scene

EventKind = Literal["start", "set_h", "mark", "pause", "resume", "speed", "stop"]


@dataclass(frozen=True, slots=True)
class Event:
    """Something done in the lab.  It applies before `step` of `run`.

    Replay and verification need only events and samples: a `start` (the scene and the methods) and
    the `set_h` after it determine a run; the other kinds change no number.  A run that continues
    from an earlier step of another one begins with that one's start and repeats its `set_h`.
    """

    kind: EventKind
    run: int  # counts from 1
    step: int
    t: float  # s, simulated
    scene: Scene | None = None  # start
    h: float | None = None  # set_h [s]
    equal_cost: bool = False  # set_h: methods that need fewer force evaluations take the step in parts
    speed: float | None = None  # speed, times real time
    text: str | None = None  # mark


class Entry(NamedTuple):
    """A sample or an event at its time in a recording."""

    clock: float  # s, the recording clock: running time since the recording began, pauses excluded
    value: Sample | Event
