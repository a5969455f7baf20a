"""The format: topics and version; samples and events to bytes and back, side by side, by the table in `fields`.

One topic per method and model, one message per reading: scalars that Foxglove, PlotJuggler and pandas plot directly.
The messages of one sample are consecutive, in the order of the run's methods, and share their clock.
Reading checks every field; anything that is not written here raises RecordingError.
"""

import json
import math
from collections.abc import Collection
from typing import Any, NoReturn, get_args

from engine.methods import Cast, Method
from engine.models import PARAMETERS
from engine.run.judgement import VERDICTS
from engine.run.lockstep import Reading, Sample
from engine.run.observer import Milestone, MilestoneKind
from engine.scenes import MOST_METHODS, Scene, SceneError
from recordings.errors import RecordingError, printable
from recordings.events import Event, Seal, method_named, name_of, noticed, scene_named
from recordings.fields import NUMBERS, SCENE_NUMBERS, VALUES, left_out, numbers_in, values_of

FORMAT_VERSION = 2
PROFILE = "pendu"  # in the file's header
EVENTS = "/pendu/events"
SEALS = "/pendu/seals"
METADATA = "pendu.recording"
OWN_METHOD = "pendu.method"  # the metadata record with the text of a user's own method
CLOCK_OFFSET = 1_000_000_000  # ns: the clock's zero in log_time; several readers mishandle a time of 0
CLOCK_LIMIT = 1e9  # s, 30 years
MESSAGE_LIMIT = 1 << 16  # bytes; ours stay below 1 kB
STEP_LIMIT = 1 << 53
KEY_LIMIT = 64  # characters of a method's or a model's key
MODEL = "pendulum"  # where none is named, as in format 1
MILESTONES = get_args(MilestoneKind)

_NUMBERS = ("t", *NUMBERS)
_ENERGY_ERROR = NUMBERS.index("energy_error")


def topic(method: str, model: str = MODEL) -> str:
    """The topic of a method's readings."""
    return f"/pendu/{method}" if model == MODEL else f"/pendu/{model}/{method}"


def keys_of(name: str) -> tuple[str, str] | None:
    """The model and the method of a topic; None if it holds no readings."""
    start, *keys = name.removeprefix("/").split("/")
    if name in (EVENTS, SEALS) or start != "pendu" or len(keys) not in (1, 2) or not all(map(_is_key, keys)):
        return None
    return (MODEL, keys[0]) if len(keys) == 1 else (keys[0], keys[1])


def _is_key(text: str) -> bool:
    return text.isidentifier() and text.isprintable() and len(text) <= KEY_LIMIT


def encode_readings(sample: Sample) -> list[bytes]:
    """One message per method, in order, without the values of `left_out` and those it does not have."""
    messages = []
    for reading in sample.readings:
        fields: dict[str, Any] = {"run": sample.run, "step": sample.step, "t": sample.t}
        absent = left_out(reading.energy_error)
        for name, value in zip(VALUES, values_of(reading), strict=True):
            if value is not None and value != absent.get(name):
                fields[name] = value
        messages.append(_dumps(fields))
    return messages


def decode_reading(data: bytes, extra: Collection[str] = ()) -> tuple[int, int, float, Reading]:
    """(run, step, t, reading) of one message, with the values of its model's own variables."""
    fields = _loads(data)
    values: list[Any] = [fields.get(name) for name in _NUMBERS]
    for value in values:
        if type(value) is not float or value - value != 0.0:  # not finite; a fast test, because hours are decoded
            values = [_number(fields, name) for name in _NUMBERS]
    t, *values = values
    absent = left_out(values[_ENERGY_ERROR])
    values += [_number(fields, name) if name in fields else value for name, value in absent.items()]
    if extra:
        values.append({name: _number(fields, name) for name in extra})
    return _count(fields, "run"), _count(fields, "step"), t, Reading(*values)


def encode_event(event: Event) -> bytes:
    """The message of an event."""
    fields: dict[str, Any] = {"run": event.run, "step": event.step, "t": event.t, "kind": event.kind}
    if event.scene is not None:
        fields["scene"] = event.scene.name
        fields |= {"watch": event.scene.watch} if event.scene.watch else {}
        fields |= numbers_in(event.scene)
        fields["model"] = event.scene.model
        fields["methods"] = [name_of(method) for method in event.scene.cast]
    fields |= {name: value for name in ("h", "speed") if (value := getattr(event, name)) is not None}
    if event.text is not None:
        fields["text"] = printable(event.text)
    if event.equal_cost:
        fields["equal_cost"] = True
    if (milestone := event.milestone) is not None:
        fields |= {"milestone": milestone.kind, "method": name_of(milestone.method)}
        fields["energy_error"] = milestone.energy_error
        fields |= {"verdict": milestone.verdict} if milestone.kind == "verdict" else {}
        fields |= {"other": name_of(milestone.other)} if milestone.other else {}
    return _dumps(fields)


def decode_event(data: bytes) -> Event:
    """The event of a message."""
    fields = _loads(data)
    run, step, t, kind = _count(fields, "run"), _count(fields, "step"), _number(fields, "t"), _text(fields, "kind")
    match kind:
        case "start":
            return Event("start", run, step, t, scene=_scene(fields))
        case "set_h":
            return Event("set_h", run, step, t, h=_number(fields, "h"), equal_cost=_flag(fields, "equal_cost"))
        case "speed":
            return Event("speed", run, step, t, speed=_number(fields, "speed"))
        case "mark":
            return Event("mark", run, step, t, text=_text(fields, "text", "") or None)
        case "noticed":
            return noticed(run, _milestone(fields, step, t))
        case "pause" | "resume" | "stop":
            return Event(kind, run, step, t)
    raise RecordingError(f"unknown kind of event {kind!r}")


def encode_seal(seal: Seal) -> bytes:
    """The message of a seal."""
    return _dumps(seal._asdict())


def decode_seal(data: bytes) -> Seal:
    """The seal of a message."""
    fields = _loads(data)
    counts = _count(fields, "samples"), _count(fields, "events")
    return Seal(*counts, _text(fields, "sha256"), _flag(fields, "end"))


_dumps_text = json.JSONEncoder(separators=(",", ":"), allow_nan=False).encode


def _dumps(fields: dict[str, Any]) -> bytes:
    data = _dumps_text(fields).encode()
    if len(data) > MESSAGE_LIMIT:
        raise ValueError(f"a message of {len(data)} bytes is longer than any reader accepts")
    return data


def _not_a_number(literal: str) -> NoReturn:
    raise RecordingError(f"{literal} is not a finite number")


_loads_text = json.JSONDecoder(parse_constant=_not_a_number).raw_decode


def _loads(data: bytes) -> dict[str, Any]:
    if len(data) > MESSAGE_LIMIT:
        raise RecordingError(f"unexpected message of {len(data)} bytes")
    try:
        fields, end = _loads_text(text := data.decode())
    except (ValueError, RecursionError) as error:
        raise RecordingError("a message is not JSON") from error
    if type(fields) is not dict or text[end:].strip():
        raise RecordingError("a message is not a JSON object")
    if "nonfinite" in fields:
        raise RecordingError("a message holds numbers that are not finite")
    return fields


def _number(fields: dict[str, Any], name: str) -> float:
    value = fields.get(name)
    if type(value) is int and abs(value) < STEP_LIMIT:  # other writers drop the ".0"
        value = float(value)
    if type(value) is not float or not math.isfinite(value):
        raise RecordingError(f"{name!r} of a message is not a finite number")
    return value


def _count(fields: dict[str, Any], name: str) -> int:
    value = fields.get(name)
    if type(value) is not int or not 0 <= value < STEP_LIMIT:
        raise RecordingError(f"{name!r} of a message is not a whole number")
    return value


def _text(fields: dict[str, Any], name: str, default: str | None = None) -> str:
    value = fields.get(name, default)
    if type(value) is not str:
        raise RecordingError(f"{name!r} of a message is not a text")
    return printable(value)


def _flag(fields: dict[str, Any], name: str) -> bool:
    value = fields.get(name, False)
    if type(value) is not bool:
        raise RecordingError(f"{name!r} of a message is neither true nor false")
    return value


def _one_of(fields: dict[str, Any], name: str, values: tuple[Any, ...], default: Any = None) -> Any:
    value = fields.get(name, default)
    if value not in values:
        raise RecordingError(f"{name!r} of a message is none of {', '.join(values)}")
    return value


def _key(value: object) -> str:
    if type(value) is not str or not _is_key(value):
        raise RecordingError(f"a start or a milestone has an impossible name, {printable(str(value))!r}")
    return value


def _scene(fields: dict[str, Any]) -> Scene:
    parameters = (name for name in PARAMETERS if name in fields)
    numbers: dict[str, Any] = {name: _number(fields, name) for name in (*SCENE_NUMBERS, *parameters)}
    try:
        texts = {"watch": _text(fields, "watch", ""), "model": _key(fields.get("model", MODEL))}
        return scene_named(_text(fields, "scene"), cast=_cast(fields), **texts, **numbers)
    except SceneError as error:
        raise RecordingError(f"run {fields['run']} cannot have been recorded: {error}") from error


def _cast(fields: dict[str, Any]) -> Cast:
    keys = fields.get("methods")
    if type(keys) is not list or not 0 < len(keys) <= MOST_METHODS:
        raise RecordingError(f"a start names no methods, or more than {MOST_METHODS}")
    cast = tuple(map(_method, keys))
    if len({method.key for method in cast}) < len(cast):
        raise RecordingError("a start names a method twice")
    return cast


def _method(name: Any) -> Method:
    """The method of a key, or of a key, @ and the hash of a user's text."""
    key, at, sha256 = name.partition("@") if type(name) is str else (name, "", "")
    return method_named(_key(key) + at + printable(sha256))


def _milestone(fields: dict[str, Any], step: int, t: float) -> Milestone:
    return Milestone(
        kind=(kind := _one_of(fields, "milestone", MILESTONES)),
        method=_method(_text(fields, "method")),
        step=step,
        t=t,
        energy_error=_number(fields, "energy_error"),
        verdict=_one_of(fields, "verdict", VERDICTS, "too early"),
        other=_method(_text(fields, "other")) if kind == "errors cross" else None,
    )
