"""Format 3: samples and events to messages and back.

There is a topic for each method of a model, and a message for each reading, of scalars that
Foxglove, PlotJuggler and pandas plot directly.  The messages of a sample are consecutive, in the
order of the run's methods, with one clock and one sequence number.  Unknown fields are ignored and
missing optional ones are None; anything else unexpected raises RecordingError.
"""

import math
from collections.abc import Sequence
from operator import attrgetter
from typing import Any, get_args

import msgspec

from pendu_tui.engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from pendu_tui.engine.quantities import EXTREMES
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
from pendu_tui.recordings.fields import EVENT, EXTRA, MOMENT, READING, struct_of

FORMAT_VERSION = "3"
EVENTS = "/pendu/events"
CLOCK_OFFSET = 1_000_000_000  # ns: log_time at clock 0, as several readers mishandle 0

_Event = struct_of((*MOMENT, *EVENT))
_SAMPLES = {model: struct_of((*MOMENT, *READING, *extra)) for model, extra in EXTRA.items()}
_TEXTS = [field.name for field in EVENT if field.type == "string"]
_REQUIRED = {"set_h": "h", "speed": "speed"}
_encode = msgspec.json.Encoder().encode
_decode_event = msgspec.json.Decoder(_Event).decode
_decoders = {model: msgspec.json.Decoder(struct).decode for model, struct in _SAMPLES.items()}
_EXTRA_NAMES = {model: [field.name for field in extra] for model, extra in EXTRA.items()}
_values_of_reading = attrgetter(*(field.name for field in READING))


def topics_of(scene: Scene) -> tuple[str, ...]:
    """Return the topics of a run's readings, in the order of its methods."""
    folder = "/pendu"
    if scene.model != DEFAULT_MODEL:
        folder += f"/{scene.model}"
    return tuple(f"{folder}/{method.key}" for method in scene.cast)


def encode_readings(sample: Sample) -> list[bytes]:
    """Return a message for each method, in order, without extremes equal to the energy error.

    Raises ValueError for a number that is not finite.
    """
    messages = []
    for reading in sample.readings:
        fields = {"run": sample.run, "step": sample.step, "t": sample.t, **reading._asdict()}
        del fields["extra"]
        for name in EXTREMES:
            if fields[name] == reading.energy_error:
                del fields[name]
        messages.append(_dumps(fields | dict(reading.extra)))
    return messages


def decode_readings(messages: Sequence[bytes], model: str = DEFAULT_MODEL) -> Sample:
    """Return the sample of its messages, which are one for each method."""
    decode = _decoders[model]
    try:
        decoded: list[Any] = [decode(message) for message in messages]
    except (msgspec.DecodeError, RecursionError, ValueError) as error:
        raise _refused(error) from error
    readings = tuple(map(_reading, decoded))
    if names := _EXTRA_NAMES[model]:
        extras = ({name: getattr(message, name) for name in names} for message in decoded)
        pairs = zip(readings, extras, strict=True)
        readings = tuple(reading._replace(extra=extra) for reading, extra in pairs)
    first = decoded[0]
    return Sample(first.run, first.step, first.t, readings)


def _reading(message: Any) -> Reading:
    if message.energy_error_low is None:
        message.energy_error_low = message.energy_error
    if message.energy_error_high is None:
        message.energy_error_high = message.energy_error
    return Reading(*_values_of_reading(message))


def encode_event(event: Event) -> bytes:
    """Return the message of an event.  Raises ValueError for a number that is not finite."""
    fields = event._asdict()
    del fields["scene"], fields["milestone"], fields["arithmetic"], fields["sources"]
    fields["equal_cost"] = event.equal_cost or None
    fields["text"] = event.text and printable(event.text)
    if (scene := event.scene) is not None:
        fields |= {"scene": printable(scene.name), "watch": printable(scene.watch)}
        fields |= {"model": scene.model}
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
    """Return the event of a message, its texts printable."""
    try:
        message = msgspec.structs.asdict(_decode_event(data))
    except (msgspec.DecodeError, RecursionError, ValueError) as error:
        raise _refused(error) from error
    fields = {name: value for name, value in message.items() if value is not None}
    fields |= {name: printable(fields[name]) for name in _TEXTS if name in fields}
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
    for name, value in present.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{name} is {value}, which JSON cannot hold")  # msgspec writes null
    return _encode(present)


def _refused(error: Exception) -> RecordingError:
    """Return the error of a message that cannot be decoded: its text names the field."""
    return RecordingError(f"a message is not one of ours: {printable(str(error))}")


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
