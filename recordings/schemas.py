"""The JSON Schemas of the two kinds of message, as they stand in every file.

As simple as the simplest viewer needs: an object at the top, one type a property, no references.
"""

import json
from typing import Any

SAMPLE_SCHEMA = {
    "title": "pendu.Sample",
    "description": "A method at a step; theta from the downward vertical, energy per m L^2.",
    "type": "object",
    "properties": {
        "run": {"type": "integer"},
        "step": {"type": "integer"},
        "t": {"type": "number", "description": "s"},
        "theta": {"type": "number", "description": "rad"},
        "omega": {"type": "number", "description": "rad/s"},
        "energy": {"type": "number", "description": "s^-2"},
        "energy_error": {"type": "number", "description": "(E - E0) / E0"},
        "max_energy_error": {"type": "number", "description": "over every step so far"},
        "energy_error_low": {"type": "number", "description": "since the sample before"},
        "energy_error_high": {"type": "number", "description": "since the sample before"},
        "diverged_at": {"type": "number", "description": "s"},
    },
    "required": ["run", "step", "t", "theta", "omega", "energy", "energy_error", "max_energy_error"],
}
EVENT_SCHEMA = {
    "title": "pendu.Event",
    "description": "What was done before this step of this run.",
    "type": "object",
    "properties": {
        "run": {"type": "integer"},
        "step": {"type": "integer"},
        "t": {"type": "number", "description": "s"},
        "kind": {"type": "string", "description": "start set_h mark pause resume speed stop"},
        "scene": {"type": "string"},
        "watch": {"type": "string"},
        "theta": {"type": "number", "description": "rad"},
        "omega": {"type": "number", "description": "rad/s"},
        "length": {"type": "number", "description": "m"},
        "gravity": {"type": "number", "description": "m/s^2"},
        "h": {"type": "number", "description": "s"},
        "equal_cost": {"type": "boolean"},
        "methods": {"type": "array", "items": {"type": "string"}},
        "speed": {"type": "number", "description": "times real time"},
        "text": {"type": "string"},
    },
    "required": ["run", "step", "t", "kind"],
}


def encode_schema(schema: dict[str, Any]) -> bytes:
    """A schema as it stands in the file."""
    return json.dumps(schema, separators=(",", ":")).encode()
