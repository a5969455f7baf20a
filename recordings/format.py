"""Format 3: samples and events to messages and back, by name, side by side.

One topic per method and model, one message per reading: scalars that Foxglove, PlotJuggler and pandas plot
directly.  The messages of a sample are consecutive, in the order of the run's methods, with one clock and
one sequence number.  An unknown field is ignored, a missing optional one is None, anything else that
is not written here raises RecordingError.
"""

import json
import math
from functools import lru_cache
from typing import Any, NoReturn, get_args

from engine.methods import Cast
from engine.models import MODELS, PARAMETERS
from engine.run.judgement import VERDICTS, Milestone, MilestoneKind
from engine.run.lockstep import Reading, Sample
from engine.scenes import MOST_METHODS, Scene, SceneError
from recordings.arithmetic import FUNCTIONS, Arithmetic, arithmetic_here
from recordings.errors import RecordingError, printable
from recordings.events import Event, method_named, name_of, noticed
from recordings.fields import EXTRA, EXTREMES, MOMENT, READING

FORMAT_VERSION = "3"
PROFILE = "pendu"  # in the file's header
EVENTS = "/pendu/events"
ABOUT = "/pendu/about"
SOURCES = "/pendu/sources"
CLOCK_OFFSET = 1_000_000_000  # ns: the clock's zero in log_time; several readers mishandle a time of 0
MAX_STEP = 1 << 53
SCENE_NUMBERS = ("theta", "omega", "length", "gravity", "h")
MAX_KEY = 64  # characters of a method's or a model's key
MODEL = "pendulum"  # the one that topics do not name
MILESTONES = get_args(MilestoneKind)
EVIDENCE = ("trend", "lyapunov")  # of a verdict


def topic(method: str, model: str = MODEL) -> str:
    """Return the topic of a method's readings."""
    return f"/pendu/{method}" if model == MODEL else f"/pendu/{model}/{method}"


@lru_cache(256)
def keys_of(name: str) -> tuple[str, str] | None:
    """Return the model and the method of a topic; None if it holds no readings of a model here."""
    start, *keys = name.removeprefix("/").split("/")
    if name in (EVENTS, ABOUT, SOURCES) or start != PROFILE or len(keys) not in (1, 2):
        return None
    model, method = keys if len(keys) == 2 else (MODEL, keys[0])
    return (model, method) if model in MODELS and _is_key(method) else None


def _is_key(text: str) -> bool:
    return text.isidentifier() and text.isprintable() and len(text) <= MAX_KEY


def encode_readings(sample: Sample) -> list[bytes]:
    """Return one message per method, in order, without extremes equal to the energy error."""
    messages = []
    for reading in sample.readings:
        fields = {"run": sample.run, "step": sample.step, "t": sample.t, **reading._asdict()}
        del fields["extra"]
        for name in EXTREMES:
            if fields[name] == reading.energy_error:
                del fields[name]
        if reading.diverged_at is None:
            del fields["diverged_at"]
        messages.append(_dumps(fields | dict(reading.extra)))
    return messages


def decode_reading(data: bytes, model: str = MODEL) -> tuple[int, int, float, Reading]:
    """Return (run, step, t, reading) of a message, with the values of its model's own variables."""
    message = _loads(data)
    error = _number(message, "energy_error")
    values: dict[str, Any] = dict.fromkeys(EXTREMES, error)
    for field in READING:
        if field.required or field.name in message:
            values[field.name] = _number(message, field.name)
    if EXTRA[model]:
        values["extra"] = {field.name: _number(message, field.name) for field in EXTRA[model]}
    return *_moment(message), Reading(**values)


def encode_event(event: Event) -> bytes:
    """Return the message of an event."""
    fields: dict[str, Any] = {"run": event.run, "step": event.step, "t": event.t, "kind": event.kind}
    if event.scene is not None:
        fields |= {"scene": event.scene.name, "watch": event.scene.watch}
        fields |= {name: float(value) for name, value in event.scene.numbers.items()}
        fields["model"] = event.scene.model
        fields["methods"] = [name_of(method) for method in event.scene.cast]
        fields |= (event.arithmetic or arithmetic_here())._asdict()
    for name in ("h", "speed"):
        if getattr(event, name) is not None:
            fields[name] = getattr(event, name)
    if event.text is not None:
        fields["text"] = printable(event.text)
    if event.equal_cost:
        fields["equal_cost"] = True
    if event.milestone is not None:
        fields |= _milestone_fields(event.milestone)
    return _dumps(fields)


def _milestone_fields(milestone: Milestone) -> dict[str, Any]:
    fields: dict[str, Any] = {
        "milestone": milestone.kind,
        "method": name_of(milestone.method),
        "energy_error": milestone.energy_error,
    }
    if milestone.kind == "verdict":
        fields["verdict"] = milestone.verdict
    if milestone.other:
        fields["other"] = name_of(milestone.other)
    for name in EVIDENCE:
        if getattr(milestone, name) is not None:
            fields[name] = getattr(milestone, name)
    return fields


def decode_event(data: bytes) -> Event:
    """Return the event of a message."""
    fields = _loads(data)
    run, step, t = _moment(fields)
    kind = fields.get("kind")
    match kind:
        case "start":
            made = Arithmetic(_count(fields, "numerics"), *(_text(fields, name) for name in FUNCTIONS))
            return Event("start", run, step, t, scene=_scene(fields), arithmetic=made)
        case "set_h":
            equal_cost = fields.get("equal_cost", False) is True
            return Event("set_h", run, step, t, h=_number(fields, "h"), equal_cost=equal_cost)
        case "speed":
            return Event("speed", run, step, t, speed=_number(fields, "speed"))
        case "mark":
            return Event("mark", run, step, t, text=_text(fields, "text", "") or None)
        case "noticed":
            return noticed(run, _milestone(fields, step, t))
        case "pause" | "resume" | "stop":
            return Event(kind, run, step, t)
    raise RecordingError(f"unknown kind of event {printable(str(kind))!r}")


def decode_about(data: bytes) -> dict[str, str]:
    """Return where and how a recording was made."""
    return {printable(name): printable(str(value)) for name, value in _loads(data).items()}


_dumps_text = json.JSONEncoder(separators=(",", ":"), allow_nan=False).encode


def _dumps(fields: dict[str, Any]) -> bytes:
    return _dumps_text(fields).encode()


def _not_a_number(literal: str) -> NoReturn:
    raise RecordingError(f"{literal} is not a finite number")


_loads_text = json.JSONDecoder(parse_constant=_not_a_number).decode


def _loads(data: bytes) -> dict[str, Any]:
    try:
        fields = _loads_text(data.decode())
    except (ValueError, RecursionError) as error:
        raise RecordingError("a message is not JSON") from error
    if type(fields) is not dict:
        raise RecordingError("a message is not a JSON object")
    if "nonfinite" in fields:
        raise RecordingError("a message holds numbers that are not finite")
    return fields


def _moment(fields: dict[str, Any]) -> tuple[int, int, float]:
    run, step, t = (field.name for field in MOMENT)
    return _count(fields, run), _count(fields, step), _number(fields, t)


def _number(fields: dict[str, Any], name: str) -> float:
    value = fields.get(name)
    if type(value) is int and abs(value) < MAX_STEP:  # other writers drop the ".0"
        return float(value)
    if type(value) is not float or not math.isfinite(value):
        raise RecordingError(f"{name!r} of a message is not a finite number")
    return value


def _count(fields: dict[str, Any], name: str) -> int:
    value = fields.get(name)
    if type(value) is not int or not 0 <= value < MAX_STEP:
        raise RecordingError(f"{name!r} of a message is not a whole number")
    return value


def _text(fields: dict[str, Any], name: str, default: str | None = None) -> str:
    value = fields.get(name, default)
    if type(value) is not str:
        raise RecordingError(f"{name!r} of a message is not a text")
    return printable(value)


def _one_of(fields: dict[str, Any], name: str, values: tuple[Any, ...], default: Any = None) -> Any:
    value = fields.get(name, default)
    if value not in values:
        raise RecordingError(f"{name!r} of a message is none of {', '.join(values)}")
    return value


def _scene(fields: dict[str, Any]) -> Scene:
    numbers: dict[str, Any] = {name: _number(fields, name) for name in SCENE_NUMBERS}
    parameters = {name: _number(fields, name) for name in PARAMETERS if name in fields}
    model = _text(fields, "model")
    if model not in MODELS:
        raise RecordingError(f"this version has no model {model}")
    try:
        watch = _text(fields, "watch", "")
        return Scene(
            _text(fields, "scene"),
            watch=watch,
            model=model,
            cast=_cast(fields),
            parameters=parameters,
            **numbers,
        )
    except SceneError as error:
        raise RecordingError(f"run {fields['run']} cannot have been recorded: {error}") from error


def _cast(fields: dict[str, Any]) -> Cast:
    names = fields.get("methods")
    if type(names) is not list or not 0 < len(names) <= MOST_METHODS:
        raise RecordingError(f"a start names no methods, or more than {MOST_METHODS}")
    cast = tuple(method_named(_method_name(name)) for name in names)
    if len({method.key for method in cast}) < len(cast):
        raise RecordingError("a start names a method twice")
    return cast


def _method_name(name: object) -> str:
    """Return a name in which nothing is but a key, and perhaps @ and a hash."""
    key, _, sha256 = name.partition("@") if type(name) is str else ("", "", "")
    if not _is_key(key) or sha256.strip("0123456789abcdef"):
        raise RecordingError(f"{printable(str(name))!r} is no name of a method")
    return str(name)


def _milestone(fields: dict[str, Any], step: int, t: float) -> Milestone:
    kind = _one_of(fields, "milestone", MILESTONES)
    return Milestone(
        kind=kind,
        method=method_named(_method_name(fields.get("method"))),
        step=step,
        t=t,
        energy_error=_number(fields, "energy_error"),
        verdict=_one_of(fields, "verdict", VERDICTS, "too early"),
        other=method_named(_method_name(fields.get("other"))) if kind == "errors cross" else None,
        **{name: _number(fields, name) for name in EVIDENCE if name in fields},
    )
