"""Fields: the names and units of all that a recording holds.

Messages, their schemas, tables and `verify` use them.
"""

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, NamedTuple, get_args

import msgspec

from pendu_tui.engine.models import DEFAULT_MODEL, MODELS, PARAMETERS
from pendu_tui.engine.quantities import RECORDED
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.recordings.events import EventKind

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

    @property
    def column(self) -> str:
        """The head of its column in a table: name and unit."""
        if not self.unit:
            return self.name
        unit = self.unit.replace("/", "_per_").replace("s^-", "per_s").removesuffix("1")
        return f"{self.name}_{unit}"

    @property
    def member(self) -> tuple[Any, ...]:
        """Its name, type and, unless it is required, the default None, for a struct of msgspec."""
        member = (self.name, TYPES[self.type])
        return member if self.required else (*member, None)

    @property
    def schema(self) -> dict[str, Any]:
        """Its JSON Schema, with one type and no references, as the simplest viewers require."""
        schema: dict[str, Any] = {"type": self.type}
        if about := self.unit or self.about:
            schema["description"] = about
        if self.type == "array":
            schema["items"] = {"type": "string"}
        return schema


def _ascii(unit: str) -> str:
    return unit.replace("⁻", "^-").replace("¹", "1").replace("²", "2")


def _optional(type: str, *names: str) -> tuple[Field, ...]:
    return tuple(Field(name, type=type, required=False) for name in names)


MOMENT = (Field("run", type="integer"), Field("step", type="integer"), Field("t", "s"))
"""The run and the time of a sample or an event."""

READING = tuple(
    Field(each.name, _ascii(each.unit), each.about, required=each.recorded == "always")
    for each in RECORDED
)
"""The attributes of a Reading except `extra`."""

EXTRA = {
    key: tuple(Field(own.name, _ascii(own.unit), own.about) for own in model.variables)
    for key, model in MODELS.items()
}
"""The additional variables of each model."""

EVENT = (
    Field("kind", about=" ".join(get_args(EventKind)), type="string"),
    *_optional("string", "scene", "model", "watch"),
    Field("theta", "rad", required=False),
    Field("omega", "rad/s", required=False),
    Field("length", "m", required=False),
    Field("gravity", "m/s^2", required=False),
    Field("h", "s", required=False),
    *(Field(own.name, _ascii(own.unit), required=False) for own in PARAMETERS.values()),
    *_optional("array", "methods", "sources"),  # source code of a user's own methods
    *_optional("integer", "numerics"),
    *_optional("string", "sin", "sqrt"),  # fingerprints
    *_optional("boolean", "equal_cost"),
    Field("speed", about="times real time", required=False),
    *_optional("string", "text", "milestone", "method", "verdict", "other"),
    Field("energy_error", about="(E - E0) / E0", required=False),
    Field("trend", "s^-1", required=False),
    Field("lyapunov", "s^-1", required=False),
)
"""The kind of an event, and the fields of all kinds."""


def values_of(reading: Reading) -> dict[str, float | None]:
    """Return the values of a reading by name."""
    values = reading._asdict()
    del values["extra"]
    return values | dict(reading.extra)


def struct_of(fields: Sequence[Field]) -> type[msgspec.Struct]:
    """Return the type of a kind of message, in which missing optional fields are None."""
    members = [field.member for field in fields]
    # gc: a message holds no circle, and is gone before a collection
    return msgspec.defstruct("Message", members, kw_only=True, omit_defaults=True, gc=False)


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
        reading._replace(
            energy_error_low=reading.energy_error, energy_error_high=reading.energy_error
        )
        for reading in sample.readings
    )
    return sample._replace(readings=tuple(readings))
