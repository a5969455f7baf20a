"""Format 3: samples and events to messages and back.

There is a topic for each method of a model, and a message for each reading, of scalars that
Foxglove, PlotJuggler and pandas plot directly.  The messages of a sample are consecutive, in the
order of the run's methods, with one clock and one sequence number.  Unknown fields are ignored and
missing optional ones are None; anything else unexpected raises RecordingError.
"""

import json
from collections.abc import Sequence
from typing import Any, get_args

from pendu_tui.engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from pendu_tui.engine.run.judgement import Milestone, MilestoneKind
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.verdicts import VERDICTS, word_of_before
from pendu_tui.engine.scenes import MAX_METHODS, Scene, SceneError
from pendu_tui.recordings.errors import RecordingError, printable
from pendu_tui.recordings.events import (
    Arithmetic,
    Event,
    EventKind,
    arithmetic_here,
    method_named,
    name_of,
    noticed,
)
from pendu_tui.recordings.fields import EVENT, EXTRA, EXTREMES, MOMENT, READING, Field

FORMAT_VERSION = "3"
EVENTS = "/pendu/events"
CLOCK_OFFSET = 1_000_000_000  # ns: log_time at clock 0, as several readers mishandle 0

_EVENT = (*MOMENT, *EVENT)
_SAMPLE = {model: (*MOMENT, *READING, *extra) for model, extra in EXTRA.items()}
_REQUIRED = {"set_h": "h", "speed": "speed"}


def topics_of(scene: Scene) -> tuple[str, ...]:
    """Return the topics of a run's readings, in the order of its methods."""
    folder = "/pendu"
    if scene.model != DEFAULT_MODEL:
        folder += f"/{scene.model}"
    return tuple(f"{folder}/{method.key}" for method in scene.cast)


def encode_readings(sample: Sample) -> list[bytes]:
    """Return a message for each method, in order, without extremes equal to the energy error."""
    messages = []
    for reading in sample.readings:
        fields = {"run": sample.run, "step": sample.step, "t": sample.t, **reading._asdict()}
        del fields["extra"]
        for name in EXTREMES:
            if fields[name] == reading.energy_error:
                del fields[name]
        messages.append(_dumps(fields | dict(reading.extra)))
    return messages


def decode_reading(data: bytes, model: str = DEFAULT_MODEL) -> tuple[int, int, float, Reading]:
    """Return (run, step, t, reading) of a message."""
    fields = _loads(data, _SAMPLE[model])
    moment = fields.pop("run"), fields.pop("step"), fields.pop("t")
    for name in EXTREMES:
        fields.setdefault(name, fields["energy_error"])
    if EXTRA[model]:
        fields["extra"] = {field.name: fields.pop(field.name) for field in EXTRA[model]}
    return *moment, Reading(**fields)


def encode_event(event: Event) -> bytes:
    """Return the message of an event."""
    fields = event._asdict()
    del fields["scene"], fields["milestone"], fields["arithmetic"], fields["sources"]
    fields["equal_cost"] = event.equal_cost or None
    fields["text"] = event.text and printable(event.text)
    if (scene := event.scene) is not None:
        fields |= {"scene": scene.name, "watch": scene.watch, "model": scene.model}
        fields |= {name: float(value) for name, value in scene.numbers.items()}
        fields["methods"] = [name_of(method) for method in scene.cast]
        sources = [method.source for method in scene.cast if hasattr(method, "source")]
        fields["sources"] = list(event.sources) or sources or None
        fields |= (event.arithmetic or arithmetic_here())._asdict()
    if (milestone := event.milestone) is not None:
        fields |= milestone._asdict()
        fields |= {"milestone": milestone.kind, "kind": event.kind}
        fields["method"] = name_of(milestone.method)
        fields["other"] = milestone.other and name_of(milestone.other)
    return _dumps(fields)


def decode_event(data: bytes) -> Event:
    """Return the event of a message."""
    fields = _loads(data, _EVENT)
    kind, run, step, t = (fields[name] for name in ("kind", "run", "step", "t"))
    try:
        if kind not in get_args(EventKind):
            raise RecordingError(f"unknown kind of event {kind!r}")
        if kind == "start":
            arithmetic = Arithmetic(fields["numerics"], fields["sin"], fields["sqrt"])
            sources = tuple(fields.get("sources", ()))
            scene = _scene(fields)
            return Event(kind, run, 0, 0.0, scene, arithmetic=arithmetic, sources=sources)
        if kind == "noticed":
            return noticed(run, _milestone(fields))
        if kind in _REQUIRED and _REQUIRED[kind] not in fields:
            raise KeyError(_REQUIRED[kind])
        names = ("h", "equal_cost", "speed", "text")
        return Event(kind, run, step, t, **{name: fields[name] for name in names if name in fields})
    except KeyError as error:
        raise RecordingError(f"an event has no {error}") from error
    except SceneError as error:
        raise RecordingError(f"run {run} cannot have been recorded: {error}") from error


def _dumps(fields: dict[str, Any]) -> bytes:
    present = {name: value for name, value in fields.items() if value is not None}
    return json.dumps(present, separators=(",", ":"), allow_nan=False).encode()


def _loads(data: bytes, fields: Sequence[Field]) -> dict[str, Any]:
    """Return the fields of a message that are in the table."""
    try:
        message = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise RecordingError("a message is not JSON") from error
    if type(message) is not dict:
        raise RecordingError("a message is not an object")
    return {
        field.name: field.checked(message.get(field.name))
        for field in fields
        if field.required or field.name in message
    }


def _scene(fields: dict[str, Any]) -> Scene:
    if fields["model"] not in MODELS:
        raise RecordingError(f"this version has no model {fields['model']}")
    cast = tuple(method_named(printable(name)) for name in fields["methods"])
    if not 0 < len({method.key for method in cast}) == len(cast) <= MAX_METHODS:
        raise RecordingError(f"a start names no methods, one twice, or more than {MAX_METHODS}")
    names = ("theta", "omega", "length", "gravity", "h", "model")
    return Scene(
        fields["scene"],
        cast=cast,
        parameters={name: fields[name] for name in PARAMETERS if name in fields},
        watch=fields.get("watch", ""),
        **{name: fields[name] for name in names},
    )


def _milestone(fields: dict[str, Any]) -> Milestone:
    kind = fields["milestone"]
    method = method_named(fields["method"])
    rises = fields["energy_error"] > 0
    verdict = word_of_before(fields["verdict"], rises, method.symplectic)
    if kind not in get_args(MilestoneKind) or verdict not in VERDICTS:
        raise RecordingError(f"unknown milestone {kind!r}, {verdict!r}")
    values = {name: fields[name] for name in Milestone._fields if name in fields}
    values |= {"kind": kind, "method": method, "verdict": verdict}
    if kind == "errors cross":
        values["other"] = method_named(fields["other"])
    return Milestone(**values)
