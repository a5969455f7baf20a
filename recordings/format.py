"""Format 3: samples and events to messages and back.

There is a topic for each method of a model, and a message for each reading, of scalars that
Foxglove, PlotJuggler and pandas plot directly.  The messages of a sample are consecutive, in the
order of the run's methods, with one clock and one sequence number.  Unknown fields are ignored and
missing optional ones are None; anything else unexpected raises RecordingError.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from typing import Annotated, Any, Literal, NamedTuple, get_args

import msgspec

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.models import COMMON, DEFAULT_MODEL, MODELS, NUMBERS
from pendu_tui.engine.models.model import Number
from pendu_tui.engine.quantities import ENERGY_ERROR, EXTREMES, RECORDED, Quantity
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.verdicts import (
    CHAOTIC,
    UNDECIDED,
    VERDICTS,
    Milestone,
    MilestoneKind,
    direction,
)
from pendu_tui.engine.scenes import MAX_METHODS, Scene
from pendu_tui.recordings.events import (
    Arithmetic,
    Event,
    EventKind,
    arithmetic_here,
    method_named,
    name_of,
    noticed,
)
from pendu_tui.recordings.files import RecordingError, printable

FORMAT_VERSION = "3"
EVENTS = "/pendu/events"
CLOCK_OFFSET = 1_000_000_000  # ns: log_time at clock 0, as several readers mishandle 0

TYPES: dict[str, Any] = {
    "number": float,
    "integer": Annotated[int, msgspec.Meta(ge=0, lt=1 << 53)],  # JSON readers have doubles
    "boolean": bool,
    "string": str,
    "array": list[str],
}
"""What the types of JSON are read as."""


class Field(NamedTuple):
    """A field of a message."""

    name: str
    unit: str = ""
    about: str = ""  # shown by viewers in place of a unit
    type: str = "number"  # in JSON
    required: bool = True
    values: tuple[str, ...] = ()  # all that it may have

    @property
    def member(self) -> tuple[Any, ...]:
        """Its name, type and, unless it is required, the default None, for a struct of msgspec."""
        type = Literal[self.values] if self.values else TYPES[self.type]
        if self.required:
            return self.name, type
        return self.name, type, None

    @property
    def schema(self) -> dict[str, Any]:
        """Its JSON Schema, with one type and no references, as the simplest viewers require."""
        schema: dict[str, Any] = {"type": self.type}
        if about := self.unit or self.about or " ".join(self.values):
            schema["description"] = about
        if self.type == "array":
            schema["items"] = {"type": "string"}
        return schema


def _field(number: Quantity | Number, required: bool = True) -> Field:
    unit = number.unit.replace("⁻", "^-").replace("¹", "1").replace("²", "2")
    return Field(number.name, unit, number.about, required=required)


def _optional(type: str, *names: str) -> tuple[Field, ...]:
    return tuple(Field(name, type=type, required=False) for name in names)


MOMENT = (Field("run", type="integer"), Field("step", type="integer"), Field("t", "s"))
"""The run and the time of a sample or an event."""

READING = tuple(_field(each, required=each.recorded == "always") for each in RECORDED)
"""The attributes of a Reading except `extra`."""

EXTRA = {key: tuple(map(_field, model.variables)) for key, model in MODELS.items()}
"""The additional variables of each model."""

EVENT = (
    Field("kind", type="string", values=get_args(EventKind)),
    *_optional("string", "scene", "model", "watch"),
    *(_field(each, required=False) for each in NUMBERS.values()),
    *_optional("array", "methods", "sources"),  # source code of a user's own methods
    *_optional("integer", "numerics"),
    *_optional("string", "sin", "sqrt"),  # fingerprints
    *_optional("boolean", "equal_cost"),
    Field("speed", about="times real time", required=False),
    *_optional("string", "text", "milestone", "method", "verdict", "other"),
    _field(ENERGY_ERROR, required=False),
    Field("trend", "s^-1", required=False),
    Field("lyapunov", "s^-1", required=False),
)
"""The kind of an event, and the fields of all kinds."""


def decoder_of(fields: Sequence[Field]) -> Callable[[bytes], Any]:
    """Return a decoder of a kind of message, in which missing optional fields are None."""
    members = [field.member for field in fields]
    # gc: a message holds no circle, and is gone before a collection
    message = msgspec.defstruct("Message", members, kw_only=True, gc=False)
    return msgspec.json.Decoder(message).decode


def schema_of(title: str, fields: Sequence[Field]) -> dict[str, Any]:
    """Return the JSON Schema of a kind of message."""
    return {
        "title": title,
        "type": "object",
        "properties": {field.name: field.schema for field in fields},
        "required": [field.name for field in fields if field.required],
    }


EVENT_SCHEMA = schema_of("pendu.Event", (*MOMENT, *EVENT))


def sample_schema(model: str) -> dict[str, Any]:
    """Return the schema of the samples of a model."""
    title = "pendu.Sample"
    if model != DEFAULT_MODEL:
        title += f".{model}"
    return schema_of(title, (*MOMENT, *READING, *EXTRA[model]))


_TEXTS = [field.name for field in EVENT if field.type == "string"]
_decode_event = decoder_of((*MOMENT, *EVENT))
_decoders = {model: decoder_of((*MOMENT, *READING, *extra)) for model, extra in EXTRA.items()}
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
        fields = {"run": sample.run, "step": sample.step, "t": sample.t, **values_of(reading)}
        for name in EXTREMES:
            if repr(fields[name]) == repr(reading.energy_error):  # -0.0 is not 0.0
                del fields[name]
        messages.append(_dumps(fields))
    return messages


def decode_readings(messages: Sequence[bytes], model: str = DEFAULT_MODEL) -> Sample:
    """Return the sample of its messages, which are one for each method."""
    decode = _decoders[model]
    try:
        decoded: list[Any] = [decode(message) for message in messages]
    except (RecursionError, ValueError) as error:
        raise _refused(error) from error
    readings = tuple(map(_reading, decoded))
    if extra := EXTRA[model]:
        readings = tuple(
            reading._replace(extra={own.name: getattr(message, own.name) for own in extra})
            for reading, message in zip(readings, decoded, strict=True)
        )
    first = decoded[0]
    return Sample(first.run, first.step, first.t, readings)


def _reading(message: Any) -> Reading:
    for name in EXTREMES:
        if getattr(message, name) is None:
            setattr(message, name, getattr(message, ENERGY_ERROR.name))
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
    except (RecursionError, ValueError) as error:
        raise _refused(error) from error
    fields = {name: value for name, value in message.items() if value is not None}
    fields |= {name: printable(fields[name]) for name in _TEXTS if name in fields}
    kind, run, step, t = (fields[name] for name in ("kind", "run", "step", "t"))
    try:
        if kind == "start":
            arithmetic = Arithmetic(fields["numerics"], fields["sin"], fields["sqrt"])
            sources = tuple(fields.get("sources", ()))
            scene = _scene(fields)
            return Event(kind, run, 0, 0.0, scene, arithmetic=arithmetic, sources=sources)
        if kind == "noticed":
            return noticed(run, _milestone(fields))
        names = ("h", "equal_cost", "speed", "text")
        return Event(kind, run, step, t, **{name: fields[name] for name in names if name in fields})
    except KeyError as error:
        raise RecordingError(f"an event has no {error}") from error
    except InputError as error:
        raise RecordingError(f"run {run} cannot have been recorded: {error}") from error


def _dumps(fields: dict[str, Any]) -> bytes:
    present = {name: value for name, value in fields.items() if value is not None}
    for name, value in present.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{name} is {value}, which JSON cannot hold")  # msgspec writes null
    return msgspec.json.encode(present)


def _refused(error: Exception) -> RecordingError:
    """Return the error of a message that cannot be decoded: its text names the field."""
    return RecordingError(f"a message is not one of pendu-tui's: {printable(str(error))}")


def _scene(fields: dict[str, Any]) -> Scene:
    if fields["model"] not in MODELS:
        raise RecordingError(f"this version has no model {fields['model']}")
    cast = tuple(method_named(printable(name)) for name in fields["methods"])
    if not 0 < len({method.key for method in cast}) == len(cast) <= MAX_METHODS:
        raise RecordingError(f"a start names no methods, one twice, or more than {MAX_METHODS}")
    names = [each.name for each in COMMON]
    others = fields.keys() & NUMBERS.keys() - {*names}
    return Scene(
        fields["scene"],
        model=fields["model"],
        cast=cast,
        parameters={name: fields[name] for name in others},
        watch=fields.get("watch", ""),
        **{name: fields[name] for name in names},
    )


def _milestone(fields: dict[str, Any]) -> Milestone:
    kind = fields["milestone"]
    method = method_named(fields["method"])
    error = fields[ENERGY_ERROR.name]
    verdict = _word_of_today(fields["verdict"], error, method.symplectic)
    if kind not in get_args(MilestoneKind) or verdict not in VERDICTS:
        raise RecordingError(f"unknown milestone {kind!r}, {verdict!r}")
    values = {name: fields[name] for name in Milestone._fields if name in fields}
    values |= {"kind": kind, "method": method, "verdict": verdict}
    if kind == "errors cross":
        values["other"] = method_named(fields["other"])
    return Milestone(**values)


def _word_of_today(word: str, change: float, symplectic: bool) -> str:
    """Return today's word for a verdict of an older recording; other words as they are."""
    if word == "caught":
        return direction(change)
    if word == "wanders":
        return CHAOTIC if symplectic else UNDECIDED
    if word == "too early":
        return UNDECIDED
    return word


def values_of(reading: Reading) -> dict[str, float | None]:
    """Return the values of a reading by name."""
    values = reading._asdict()
    del values["extra"]
    return values | dict(reading.extra)


def differences(a: Reading, b: Reading) -> Iterator[tuple[str, float | None, float | None]]:
    """Yield the name and both numbers of each value whose bits differ."""
    values_a = values_of(a)
    values_b = values_of(b)
    if values_a == values_b and 0.0 not in values_a.values():  # 0.0 == -0.0
        return
    for name in values_a | values_b:
        x = values_a.get(name)
        y = values_b.get(name)
        if repr(x) != repr(y):
            yield name, x, y


def without_extremes(sample: Sample) -> Sample:
    """Return the sample as the first of a run or after a gap, where no steps precede it."""
    readings = (
        reading._replace(**dict.fromkeys(EXTREMES, getattr(reading, ENERGY_ERROR.name)))
        for reading in sample.readings
    )
    return sample._replace(readings=tuple(readings))
