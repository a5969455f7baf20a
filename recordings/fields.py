"""Fields: the one table of what the messages of a recording hold, with units.

Messages, their schemas, the columns of a CSV, `verify`, `run --json` and `--fail-if` take names and units from here.
"""

import math
import struct
from collections.abc import Collection, Iterator, Sequence
from operator import attrgetter
from typing import Any, NamedTuple, get_args

from engine.models import MODELS, PARAMETERS
from engine.run.lockstep import Reading, Sample
from engine.scenes import Scene
from recordings.events import EventKind


class Field(NamedTuple):
    """One value of a message."""

    name: str
    unit: str = ""  # of a number that has one
    about: str = ""  # what a viewer shows of a value without a unit
    type: str = "number"  # of JSON
    required: bool = True  # in every message of its kind

    @property
    def column(self) -> str:
        """Its name in a table, with the unit."""
        unit = {"rad/s": "rad_per_s", "s^-1": "per_s", "s^-2": "per_s2"}.get(self.unit, self.unit)
        return f"{self.name}_{unit}" if unit else self.name

    @property
    def schema(self) -> dict[str, Any]:
        """Its JSON Schema: one type, no references, because the simplest viewer needs that."""
        about = self.unit or self.about
        items = {"items": {"type": "string"}} if self.type == "array" else {}
        return {"type": self.type, **({"description": about} if about else {}), **items}


def _ascii(unit: str) -> str:
    """Return a unit without superscripts: "s^-1" for "s⁻¹"."""
    return unit.replace("⁻", "^-").replace("¹", "1").replace("²", "2")


MOMENT = (Field("run", type="integer"), Field("step", type="integer"), Field("t", "s"))
"""Where in a recording a message belongs; in every message."""

READING = (
    Field("theta", "rad"),
    Field("omega", "rad/s"),
    Field("energy", "s^-2"),
    Field("energy_error", about="(E - E0) / E0"),
    Field("max_energy_error", about="over every step so far"),
    Field("energy_error_low", about="since the sample before", required=False),
    Field("energy_error_high", about="since the sample before", required=False),
    Field("diverged_at", "s", required=False),
)
"""One method in a sample: the attributes of a Reading but `extra`, in order.  `verify` compares all of them."""

EXTRA = {
    key: tuple(Field(each.name, _ascii(each.unit), each.about, required=False) for each in model.variables)
    for key, model in MODELS.items()
}
"""What follows of a model with variables of its own; all of them."""

SCENE_NUMBERS = ("theta", "omega", "length", "gravity", "h")
"""The attributes of a Scene that are numbers, besides its model's parameters."""

PARAMETER = tuple(Field(each.name, _ascii(each.unit), required=False) for each in PARAMETERS.values())
"""Parameters of models; only in starts, and only of those that have them."""

EVENT = (
    Field("kind", about=" ".join(get_args(EventKind)), type="string"),
    Field("scene", type="string", required=False),
    Field("model", type="string", required=False),
    Field("watch", type="string", required=False),
    Field("theta", "rad", required=False),
    Field("omega", "rad/s", required=False),
    Field("length", "m", required=False),
    Field("gravity", "m/s^2", required=False),
    Field("h", "s", required=False),
    Field("equal_cost", type="boolean", required=False),
    Field("methods", type="array", required=False),
    Field("speed", about="times real time", required=False),
    Field("text", type="string", required=False),
    Field("milestone", about="over the top, failed, verdict or errors cross", type="string", required=False),
    Field("method", about="of the milestone", type="string", required=False),
    Field("verdict", type="string", required=False),
    Field("other", about="of errors that cross, the method that was passed", type="string", required=False),
    Field("energy_error", about="(E - E0) / E0", required=False),
)
"""An event: its kind, and what that kind needs."""

SEAL = (
    Field("samples", about="so far", type="integer"),
    Field("events", about="so far", type="integer"),
    Field("sha256", about="of the metadata and of all records in chunks so far", type="string"),
    Field("end", about="whether the recording ends here", type="boolean"),
)
"""The last message of a chunk."""

EXTRA_NAMES = tuple(dict.fromkeys(field.name for fields in EXTRA.values() for field in fields))
VALUES = (*(field.name for field in READING), *EXTRA_NAMES)
NUMBERS = tuple(field.name for field in READING if field.required)
PHASE = ("theta", "omega", *(each.name for model in MODELS.values() for each in model.variables if each.is_state))
EXTREMES = ("energy_error_low", "energy_error_high")

numbers_of = attrgetter(*NUMBERS)
"""The values of a Reading that are always there."""
_scalars_of = attrgetter(*(field.name for field in READING))


def values_of(reading: Reading) -> tuple[float | None, ...]:
    """The values of a Reading, in the order of VALUES; None for those that it does not have."""
    return *_scalars_of(reading), *map(reading.extra.get, EXTRA_NAMES)


def extra_names(model: str) -> tuple[str, ...]:
    """The names of the variables that the readings of a model have besides the common ones."""
    return tuple(field.name for field in EXTRA.get(model, ()))


def reading_fields(*models: str) -> tuple[Field, ...]:
    """What the readings of these models have."""
    extra = (field for key, fields in EXTRA.items() if key in models for field in fields)
    return *READING, *dict.fromkeys(extra)


def numbers_in(scene: Scene) -> dict[str, float]:
    """The numbers of a scene, with the parameters that its model has."""
    return {name: float(value) for name, value in scene.numbers.items()}


COLUMNS = ("clock_s", *(field.column for field in MOMENT), "method", *(field.column for field in READING))
"""Of a table of samples: names with their units; energies are per unit m·L²."""


def columns(*models: str) -> tuple[str, ...]:
    """Those of a table of these models: some have more."""
    return (*COLUMNS, *(field.column for field in reading_fields(*models)[len(READING) :]))


def rows(clock: float, sample: Sample, methods: Sequence[str], width: int) -> Iterator[tuple[object, ...]]:
    """A sample as rows of such a table with so many columns, one for each method."""
    for method, reading in zip(methods, sample.readings, strict=True):
        yield (clock, sample.run, sample.step, sample.t, method, *values_of(reading))[:width]


def left_out(energy_error: float) -> dict[str, float | None]:
    """Values that a message leaves out: extremes equal to the energy error, and that the method has not diverged."""
    return {"energy_error_low": energy_error, "energy_error_high": energy_error, "diverged_at": None}


def schema_of(title: str, about: str, fields: tuple[Field, ...]) -> dict[str, Any]:
    """The JSON Schema of a kind of message."""
    return {
        "title": title,
        "description": about,
        "type": "object",
        "properties": {field.name: field.schema for field in fields},
        "required": [field.name for field in fields if field.required],
    }


def event_schema(parameters: Collection[str] = ()) -> dict[str, Any]:
    """The schema of the events of a recording that begins with a model of these parameters."""
    fields = (*MOMENT, *EVENT, *(field for field in PARAMETER if field.name in parameters))
    return schema_of("pendu.Event", "What was done before this step of this run.", fields)


SEAL_SCHEMA = schema_of("pendu.Seal", "What the recording holds so far.", SEAL)


def sample_schema(model: str) -> dict[str, Any]:
    """The schema of the samples of a model."""
    title = "pendu.Sample" if model == "pendulum" else f"pendu.Sample.{model}"
    about = f"A method at a step of the model {model}; theta from the downward vertical, energy per m L^2."
    return schema_of(title, about, (*MOMENT, *reading_fields(model)))


_pack = struct.Struct(f"<{len(NUMBERS)}d").pack


def same_bits(a: Reading, b: Reading) -> bool:
    """Whether two readings have the same bits, quickly.  (0.0 == -0.0, hence the second half.)"""
    return (
        a == b
        and _pack(*numbers_of(a)) == _pack(*numbers_of(b))
        and all(value.hex() == b.extra[name].hex() for name, value in a.extra.items())
    )


def distance(a: float | None, b: float | None) -> float:
    """How far apart two numbers are; infinite if only one is there."""
    return 0.0 if a == b else math.inf if a is None or b is None else abs(a - b)


def ulps(a: float | None, b: float | None) -> int | None:
    """How many doubles lie between them, and one; 1 for 0.0 and -0.0; None if one is missing."""
    return None if a is None or b is None else abs(_ordinal(a) - _ordinal(b))


def _ordinal(value: float) -> int:
    """The position of a double among all doubles in order; -0.0 comes just before 0.0."""
    bits = int.from_bytes(struct.pack(">d", value), "big", signed=True)
    return bits if bits >= 0 else -(bits & (1 << 63) - 1) - 1


def without_extremes(sample: Sample) -> Sample:
    """The sample as the first of its run or the first after a gap, where the steps before it are unknown."""
    readings = (
        reading._replace(energy_error_low=reading.energy_error, energy_error_high=reading.energy_error)
        for reading in sample.readings
    )
    return sample._replace(readings=tuple(readings))
