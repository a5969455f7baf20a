"""Format 3: samples and events to messages and back, by name, side by side.

One topic per method and model, one message per reading: scalars that Foxglove, PlotJuggler and
pandas plot directly.  The messages of a sample are consecutive, in the order of the run's methods,
with one clock and one sequence number.  An unknown field is ignored, a missing optional one is
None; anything else that is not written here raises RecordingError.
"""

import json
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, get_args

from engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from engine.run.judgement import VERDICTS, Milestone, MilestoneKind
from engine.run.lockstep import Reading, Sample
from engine.scenes import MOST_METHODS, Scene, SceneError
from recordings.arithmetic import Arithmetic, arithmetic_here
from recordings.errors import RecordingError, printable
from recordings.events import Event, method_named, name_of, noticed
from recordings.fields import EVENT, EXTRA, EXTREMES, MOMENT, READING, Field

FORMAT_VERSION = "3"
PROFILE = "pendu"  # in the file's header
EVENTS = "/pendu/events"
ABOUT = "/pendu/about"
SOURCES = "/pendu/sources"
CLOCK_OFFSET = (
    1_000_000_000  # ns: the clock's zero in log_time; several readers mishandle a time of 0
)
EVIDENCE = ("trend", "lyapunov")  # of a verdict

_EVENT = (*MOMENT, *EVENT)
_SAMPLE = {model: (*MOMENT, *READING, *extra) for model, extra in EXTRA.items()}


def topic(method: str, model: str = DEFAULT_MODEL) -> str:
    """Return the topic of a method's readings."""
    return f"/pendu/{method}" if model == DEFAULT_MODEL else f"/pendu/{model}/{method}"


@lru_cache(256)
def keys_of(name: str) -> tuple[str, str] | None:
    """Return the model and the method of a topic; None if it holds no readings of a model here."""
    start, *keys = name.removeprefix("/").split("/")
    if name in (EVENTS, ABOUT, SOURCES) or start != PROFILE or len(keys) not in (1, 2):
        return None
    model, method = keys if len(keys) == 2 else (DEFAULT_MODEL, keys[0])
    return (model, method) if model in MODELS and _is_key(method) else None


def _is_key(text: str) -> bool:
    return text.isidentifier() and text.isprintable()


def encode_readings(sample: Sample) -> list[bytes]:
    """Return one message per method, in order, without extremes equal to the energy error."""
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
    """Return (run, step, t, reading) of a message, with the values of its model's own variables."""
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
    del fields["scene"], fields["milestone"], fields["arithmetic"]
    fields["equal_cost"] = event.equal_cost or None
    fields["text"] = event.text and printable(event.text)
    if (scene := event.scene) is not None:
        fields |= {"scene": scene.name, "watch": scene.watch, "model": scene.model}
        fields |= {name: float(value) for name, value in scene.numbers.items()}
        fields["methods"] = [name_of(method) for method in scene.cast]
        fields |= (event.arithmetic or arithmetic_here())._asdict()
    if (milestone := event.milestone) is not None:
        fields |= {
            name: getattr(milestone, name) for name in ("energy_error", "verdict", *EVIDENCE)
        }
        fields |= {"milestone": milestone.kind, "method": name_of(milestone.method)}
        fields["other"] = milestone.other and name_of(milestone.other)
    return _dumps(fields)


def decode_event(data: bytes) -> Event:
    """Return the event of a message."""
    fields = _loads(data, _EVENT)
    moment = fields["run"], fields["step"], fields["t"]
    try:
        match fields["kind"]:
            case "start":
                made = Arithmetic(fields["numerics"], fields["sin"], fields["sqrt"])
                return Event("start", *moment, scene=_scene(fields), arithmetic=made)
            case "set_h":
                return Event(
                    "set_h", *moment, h=fields["h"], equal_cost=fields.get("equal_cost", False)
                )
            case "speed":
                return Event("speed", *moment, speed=fields["speed"])
            case "mark":
                return Event("mark", *moment, text=fields.get("text") or None)
            case "noticed":
                return noticed(fields["run"], _milestone(fields))
            case "pause" | "resume" | "stop" as kind:
                return Event(kind, *moment)
            case kind:
                raise RecordingError(f"unknown kind of event {kind!r}")
    except KeyError as error:
        raise RecordingError(f"an event has no {error}") from error
    except SceneError as error:
        raise RecordingError(f"run {moment[0]} cannot have been recorded: {error}") from error


_dumps_text = json.JSONEncoder(separators=(",", ":"), allow_nan=False).encode


def _dumps(fields: dict[str, Any]) -> bytes:
    return _dumps_text(
        {name: value for name, value in fields.items() if value is not None}
    ).encode()


def _loads(data: bytes, fields: Sequence[Field]) -> dict[str, Any]:
    """Return the fields of a message that are in the table."""
    try:
        message = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise RecordingError("a message is not JSON") from error
    if type(message) is not dict or "nonfinite" in message:
        raise RecordingError("a message is not an object of finite numbers")
    return {
        field.name: field.checked(message.get(field.name))
        for field in fields
        if field.required or field.name in message
    }


def _scene(fields: dict[str, Any]) -> Scene:
    if fields["model"] not in MODELS:
        raise RecordingError(f"this version has no model {fields['model']}")
    cast = tuple(map(_method, fields["methods"]))
    if not 0 < len({method.key for method in cast}) == len(cast) <= MOST_METHODS:
        raise RecordingError(f"a start names no methods, one twice, or more than {MOST_METHODS}")
    names = ("theta", "omega", "length", "gravity", "h", "model")
    parameters = {name: fields[name] for name in PARAMETERS if name in fields}
    given = {name: fields[name] for name in names}
    return Scene(
        fields["scene"], cast=cast, parameters=parameters, watch=fields.get("watch", ""), **given
    )


def _method(name: str) -> Any:
    key, _, sha256 = name.partition("@")
    if not _is_key(key) or sha256.strip("0123456789abcdef"):
        raise RecordingError(f"{name!r} is no name of a method")
    return method_named(name)


def _milestone(fields: dict[str, Any]) -> Milestone:
    kind = fields["milestone"]
    verdict = fields.get("verdict", "too early")
    if kind not in get_args(MilestoneKind) or verdict not in VERDICTS:
        raise RecordingError(f"unknown milestone {kind!r}, {verdict!r}")
    return Milestone(
        kind=kind,
        method=_method(fields["method"]),
        step=fields["step"],
        t=fields["t"],
        energy_error=fields["energy_error"],
        verdict=verdict,
        other=_method(fields["other"]) if kind == "errors cross" else None,
        trend=fields.get("trend"),
        lyapunov=fields.get("lyapunov"),
    )
