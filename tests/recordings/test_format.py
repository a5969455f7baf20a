"""The format: messages read back with the same bits, and anything else is refused."""

import json
import math
from dataclasses import replace

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import METHODS, RK4, VELOCITY_VERLET
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.run.lockstep import Reading, Sample
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.events import Event, fingerprint, noticed
from pendu_tui.recordings.files import RecordingError, printable
from pendu_tui.recordings.format import (
    EVENT_SCHEMA,
    EXTRA,
    decode_event,
    decode_readings,
    differences,
    encode_event,
    encode_readings,
    sample_schema,
    without_extremes,
)
from tests.models import EXAMPLES
from tests.recordings.examples import SCENE, start

PLAIN = Reading(1.0, 0.0, 4.0, 0.5, 0.5, 0.5, 0.5)
GOOD = json.loads(encode_readings(Sample(1, 2, 0.5, (PLAIN,)))[0])
SCHEMA = sample_schema("pendulum")
GROWS = Milestone("verdict", METHODS[0], 7, 0.7, 0.1, "grows", trend=0.5, lyapunov=0.25)
finite = st.floats(allow_nan=False, allow_infinity=False)
counts = st.integers(0, 2**53 - 1)
numbers = {
    name: st.none() | finite if name in Reading._field_defaults else finite
    for name in Reading._fields
}


def readings_of(model):
    extra = st.fixed_dictionaries({field.name: finite for field in EXTRA[model]})
    return st.builds(Reading, **numbers | {"extra": extra})


@given(st.data(), st.sampled_from([*MODELS]), counts, counts, finite)
def test_every_finite_double_of_a_sample_reads_back_with_the_same_bits(data, model, run, step, t):
    readings = data.draw(st.tuples(readings_of(model), readings_of(model)))
    messages = encode_readings(Sample(run, step, t, readings))
    again = decode_readings(messages, model)
    assert again == Sample(run, step, t, readings)
    for message, was, reading in zip(messages, readings, again.readings, strict=True):
        assert not list(differences(was, reading))  # -0.0 is not 0.0
        jsonschema.validate(json.loads(message), sample_schema(model))


@pytest.mark.parametrize(
    "event",
    [
        *(start(scene=scene) for scene in SCENES.values()),
        start(scene=SCENE.with_cast(METHODS[:6])),
        Event("set_h", 2, 2**53 - 1, 0.1, h=-5e-324, equal_cost=True),
        Event("speed", 1, 3, 0.1, speed=0.1 + 0.2),
        Event("mark", 1, 3, 0.1, text="what is this?"),
        *(Event(kind, 1, 3, 1e308) for kind in ("mark", "pause", "resume", "stop")),
        noticed(3, GROWS),
        noticed(3, Milestone("failed", RK4, 7, 0.7, -0.1)),
        noticed(3, Milestone("errors cross", RK4, 7, 0.7, 0.1, other=VELOCITY_VERLET)),
    ],
)
def test_every_event_reads_back_the_same(event):
    message = encode_event(event)
    assert decode_event(message)._replace(arithmetic=None) == event
    jsonschema.validate(json.loads(message), EVENT_SCHEMA)


@pytest.mark.parametrize(
    ("title", "schema"),
    [("Sample", SCHEMA), ("Sample.spring", sample_schema("spring")), ("Event", EVENT_SCHEMA)],
)
def test_a_schema_is_as_simple_as_the_simplest_viewer_needs(title, schema):
    jsonschema.Draft202012Validator.check_schema(schema)
    assert (schema["title"], schema["type"]) == (f"pendu.{title}", "object")
    assert set(schema["required"]) <= set(schema["properties"])
    for name, declared in schema["properties"].items():
        assert declared["type"] in ("integer", "number", "string", "boolean", "array"), name
        assert not {"anyOf", "oneOf", "$ref"} & set(declared), name
        assert ("items" in declared) == (declared["type"] == "array")
    told = {name: each.get("description") for name, each in schema["properties"].items()}
    units = {"t": "s", "theta": "rad", "trend": "s^-1", "lyapunov": "s^-1", "vx": "s^-1"}
    units |= {"speed": "times real time", "max_energy_error": "over every step so far"}
    units |= {"gravity": "m/s2", "kind": "start set_h mark pause resume speed stop noticed"}
    assert told.items() >= {name: units[name] for name in units.keys() & told.keys()}.items()


def test_extremes_equal_to_the_energy_error_are_left_out_and_no_nonfinite_number_is_written():
    wide = Sample(1, 0, 0.0, (PLAIN._replace(energy_error_low=-0.5),))
    assert b"low" in encode_readings(wide)[0]
    assert b"low" not in encode_readings(without_extremes(wide))[0]
    zeros = Sample(1, 0, 0.0, (PLAIN._replace(energy_error=0.0, energy_error_low=-0.0),))
    assert b'low":-0.0' in encode_readings(zeros)[0]
    unknown = json.dumps(GOOD | {"temperature": 300.0}).encode()  # without a field that may lack
    assert decode_readings([unknown]).readings == without_extremes(wide).readings == (PLAIN,)
    with pytest.raises(ValueError, match="omega"):
        encode_readings(Sample(1, 0, 0.0, (PLAIN._replace(omega=math.nan),)))


WRONG = ["null", '"1.0"', "NaN", "Infinity", "1e999", "true", "[1.0]"]


@pytest.mark.parametrize("name", SCHEMA["properties"])
def test_a_field_that_is_missing_or_not_a_finite_number_is_refused(name):
    message = {**GOOD, name: "HERE"}
    more = ["-1", str(2**53), "1.0"] if name in ("run", "step") else []
    for value in WRONG + more:
        with pytest.raises(RecordingError):
            decode_readings([json.dumps(message).replace('"HERE"', value).encode()])
    del message[name]
    if name in SCHEMA["required"]:
        with pytest.raises(RecordingError, match=name):
            decode_readings([json.dumps(message).encode()])


@pytest.mark.parametrize("scene", EXAMPLES.values())
def test_the_start_of_a_run_made_elsewhere_with_a_method_that_is_not_here_is_kept(scene):
    elsewhere = {"methods": ["mine@0a"], "sources": ["text"], "sin": "another", "numerics": 1}
    message = json.loads(encode_event(start(scene=scene))) | elsewhere
    event = decode_event(json.dumps(message).encode())
    assert json.loads(encode_event(event)) == message
    (method,) = event.scene.cast
    assert (method.label, method.letter) == ("mine", "?")


def test_an_unexpected_message_is_refused():
    for data in (
        b"",
        b"{",
        b"[]",
        b"null",
        b"\xff",
        b"{} {}",
        b'{"x": ' + b"[" * 60_000,
        b'{"run": 1}',
    ):
        for decode in (decode_event, lambda message: decode_readings([message])):
            with pytest.raises(RecordingError):
                decode(data)


IMPOSSIBLE = {
    start(): {
        "kind": ["x" * 300, ...], "h": [0.0, -0.1], "length": [-1.0], "gravity": [1e300],
        "theta": [None, ...], "scene": [3], "numerics": [...], "model": [1, "kepler"],
        "methods": [[], "rk4", [["rk4"]], ["\x1b[2J"], ["rk4", "rk4"], [m.key for m in METHODS[:7]]],
    },
    start(scene=SCENES["damped"]): {"friction": [None, -1.0], "stiffness": [9.0]},
    noticed(1, GROWS): {
        "milestone": ["under the top"], "method": [..., "\x1b[2J"],
        "verdict": ["explodes", {}], "energy_error": [...],
    },
}  # fmt: skip


@pytest.mark.parametrize("event", IMPOSSIBLE)
def test_an_impossible_event_is_refused(event):
    for field, values in IMPOSSIBLE[event].items():
        for value in values:
            message = json.loads(encode_event(event)) | {field: value}
            if value is ...:  # missing
                del message[field]
            with pytest.raises(RecordingError) as caught:
                decode_event(json.dumps(message).encode())
            assert str(caught.value).isprintable()
            assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    "text", ["\x1b[2J", "\x9b31m", "a\nb", "\u202egpj.exe", "\ud800", "\x00", "é\u0301\x7f"]
)
def test_texts_of_a_file_cannot_control_a_terminal_and_end_after_200_characters(text):
    assert printable(text).isprintable()
    assert printable(40 * "four,") == 40 * "four,"
    assert printable(40 * "four," + "!") == (40 * "four,")[:-1] + "…"
    mark = Event("mark", 1, 0, 0.0, text=text)
    assert decode_event(encode_event(mark)).text == printable(text)
    named = decode_event(encode_event(start(scene=replace(SCENE, name=text, watch=text)))).scene
    assert named.name == named.watch == printable(text)


@pytest.mark.parametrize("function", ["sin", "sqrt"])
def test_a_fingerprint_differs_if_one_value_does(monkeypatch, function):
    right = getattr(math, function)
    places = []

    def wrong(x):
        places.append(x)
        if len(places) == 1234:
            return math.nextafter(right(x), 2)
        return right(x)

    monkeypatch.setattr(math, function, wrong)
    assert fingerprint.__wrapped__(function) != fingerprint(function)
    monkeypatch.undo()
    sign = -1 if function == "sin" else 1
    assert (places[0], places[-1]) == pytest.approx((1.1e-8, sign * 1.0901e8), rel=1e-4)
    assert len(fingerprint(function)) == 16
    assert fingerprint.__wrapped__(function) == fingerprint(function)


@pytest.mark.parametrize(
    ("word", "method", "error", "today"),
    [
        ("caught", RK4, 0.5, "grows"),
        ("caught", RK4, -0.5, "loses"),
        ("wanders", VELOCITY_VERLET, 0.5, "chaotic"),
        ("wanders", RK4, 0.5, "undecided"),
        ("too early", RK4, 0.5, "undecided"),
    ],
)
def test_verdicts_of_before_read_as_those_of_today(word, method, error, today):
    milestone = Milestone("verdict", method, 7, 0.7, error, word)
    event = decode_event(encode_event(noticed(1, milestone)))
    assert event.milestone.verdict == today
