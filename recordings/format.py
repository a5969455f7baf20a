"""The format: topics and version; samples and events to bytes and back, side by side, by the table in `fields`.

One topic per method, one message per reading: scalars that Foxglove, PlotJuggler and pandas plot directly.
The messages of one sample are consecutive, in the order of the run's methods, and share their clock.
Reading checks every field; anything that is not written here raises RecordingError.
"""

import hashlib
import json
import math
import struct
from dataclasses import replace
from functools import cache
from typing import Any, NoReturn

from engine.methods import Cast, method_of
from engine.run.lockstep import Reading, Sample
from engine.scenes import Scene, SceneError
from recordings.errors import RecordingError, printable
from recordings.events import Event
from recordings.fields import EXTREMES, NUMBERS, SCENE_NUMBERS, VALUES, left_out, values_of

FORMAT_VERSION = 1
PROFILE = "pendu"  # in the file's header
EVENTS = "/pendu/events"
METADATA = "pendu.recording"
CLOCK_OFFSET = 1_000_000_000  # ns: the clock's zero in log_time; several readers mishandle a time of 0
CLOCK_LIMIT = 1e9  # s, 30 years
MESSAGE_LIMIT = 1 << 16  # bytes; ours stay below 1 kB
STEP_LIMIT = 1 << 53

_NUMBERS = ("t", *NUMBERS)
_ENERGY_ERROR = NUMBERS.index("energy_error")


def topic(method: str) -> str:
    """The topic of a method's readings."""
    return f"/pendu/{method}"


@cache
def sin_fingerprint() -> str:
    """A checksum of this machine's sin over 4096 arguments from 1e-8 to 1e8: where it differs, so do runs' bits.

    Another libm, or the same one on another processor, rounds one value in 1400 the other way.
    """
    values = (math.sin((-1) ** i * 10 ** (i / 256 - 8) * 1.1) for i in range(4096))
    return hashlib.sha256(struct.pack("<4096d", *values)).hexdigest()[:16]


def without_extremes(sample: Sample) -> Sample:
    """The sample as the first of its run or the first after a gap, where the steps before it are unknown."""
    readings = (replace(reading, **dict.fromkeys(EXTREMES, reading.energy_error)) for reading in sample.readings)
    return replace(sample, readings=tuple(readings))


def encode_readings(sample: Sample) -> list[bytes]:
    """One message per method, in order, without the values of `left_out`."""
    messages = []
    for reading in sample.readings:
        fields = {"run": sample.run, "step": sample.step, "t": sample.t}
        fields |= zip(VALUES, values_of(reading), strict=True)
        for name, value in left_out(reading.energy_error).items():
            if fields[name] == value:
                del fields[name]
        messages.append(_dumps(fields))
    return messages


def decode_reading(data: bytes) -> tuple[int, int, float, Reading]:
    """(run, step, t, reading) of one message."""
    fields = _loads(data)
    values: list[Any] = [fields.get(name) for name in _NUMBERS]
    for value in values:
        if type(value) is not float or value - value != 0.0:  # not finite; a fast test, because hours are decoded
            values = [_number(fields, name) for name in _NUMBERS]
    t, *values = values
    absent = left_out(values[_ENERGY_ERROR])
    values += [_number(fields, name) if name in fields else value for name, value in absent.items()]
    return _count(fields, "run"), _count(fields, "step"), t, Reading(*values)


def encode_event(event: Event) -> bytes:
    """The message of an event."""
    fields: dict[str, Any] = {"run": event.run, "step": event.step, "t": event.t, "kind": event.kind}
    if event.scene is not None:
        fields["scene"] = event.scene.name
        fields |= {"watch": event.scene.watch} if event.scene.watch else {}
        fields |= {name: float(getattr(event.scene, name)) for name in SCENE_NUMBERS}
        fields["methods"] = [method.key for method in event.scene.cast]
    fields |= {name: value for name in ("h", "speed") if (value := getattr(event, name)) is not None}
    if event.text is not None:
        fields["text"] = printable(event.text)
    if event.equal_cost:
        fields["equal_cost"] = True
    return _dumps(fields)


def decode_event(data: bytes) -> Event:
    """The event of a message."""
    fields = _loads(data)
    run, step, t, kind = _count(fields, "run"), _count(fields, "step"), _number(fields, "t"), _text(fields, "kind")
    match kind:
        case "start":
            numbers: dict[str, Any] = {name: _number(fields, name) for name in SCENE_NUMBERS}
            try:
                scene = Scene(_text(fields, "scene"), watch=_text(fields, "watch", ""), cast=_cast(fields), **numbers)
            except SceneError as error:
                raise RecordingError(f"run {run} cannot have been recorded: {error}") from error
            return Event("start", run, step, t, scene=scene)
        case "set_h":
            return Event("set_h", run, step, t, h=_number(fields, "h"), equal_cost=_flag(fields, "equal_cost"))
        case "speed":
            return Event("speed", run, step, t, speed=_number(fields, "speed"))
        case "mark":
            return Event("mark", run, step, t, text=_text(fields, "text", "") or None)
        case "pause" | "resume" | "stop":
            return Event(kind, run, step, t)
    raise RecordingError(f"unknown kind of event {kind!r}")


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


def _cast(fields: dict[str, Any]) -> Cast:
    keys = fields.get("methods")
    if type(keys) is not list or not keys:
        raise RecordingError("a start names no methods")
    cast = []
    for key in keys:
        try:
            cast.append(method_of(key))
        except (KeyError, TypeError):
            raise RecordingError(f"unknown method {printable(str(key))!r}") from None
    if len(set(cast)) < len(cast):
        raise RecordingError("a start names a method twice")
    return tuple(cast)
