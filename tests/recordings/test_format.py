"""The format: messages read back the same, and anything else is refused."""

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
from pendu_tui.engine.run.verdicts import VERDICTS, Milestone
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.recordings.events import Event, fingerprint, noticed
from pendu_tui.recordings.files import MAX_TEXT, RecordingError, printable
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
from tests.recordings.examples import SCENE, start
from tests.truths import LIMITS

SAMPLE_SCHEMA, PLANE_SCHEMA = sample_schema("pendulum"), sample_schema("spring")
SPRING = tuple(field.name for field in EXTRA["spring"])
finite = st.floats(allow_nan=False, allow_infinity=False)
counts = st.integers(0, 2**53 - 1)


def made(kind, *strategies, **named_strategies):
    """Like st.builds, but keep the defaults of a NamedTuple."""
    return st.builds(
        lambda *values, **named: kind(*values, **named), *strategies, **named_strategies
    )


readings = made(Reading, *[finite] * 7, diverged_at=st.none() | finite)
extras = st.fixed_dictionaries(dict.fromkeys(SPRING, finite))
readings_in_plane = st.builds(
    lambda reading, extra: reading._replace(extra=extra), readings, extras
)
readings_of_two = st.tuples(readings, readings) | st.tuples(readings_in_plane, readings_in_plane)
samples = made(Sample, run=counts, step=counts, t=finite, readings=readings_of_two)
letters = st.characters(categories=("L", "M", "N", "P", "S"), include_characters=" ")
texts = st.text(letters, max_size=MAX_TEXT).filter(str.isprintable)
methods = st.sampled_from(METHODS)


def scenes_of(model):
    suited = st.sampled_from([method for method in METHODS if model in method.models])
    casts = st.lists(suited, min_size=1, max_size=6, unique_by=lambda method: method.key)
    own = {parameter.name: st.floats(1.0, 10.0) for parameter in MODELS[model].parameters}
    return st.builds(
        Scene,
        name=texts,
        model=st.just(model),
        cast=casts.map(tuple),
        watch=texts,
        theta=st.floats(*LIMITS["theta"]),
        omega=st.floats(*LIMITS["omega"]),
        length=st.floats(0.1, 10),
        gravity=st.floats(0.1, 10),
        h=st.floats(1e-6, 1),
        parameters=st.fixed_dictionaries(own),
    )


scenes = st.sampled_from([*MODELS]).flatmap(scenes_of)
kinds = st.sampled_from(["over the top", "failed"])
verdicts = st.sampled_from([*VERDICTS])
NUMBERS = methods, counts, finite, finite
milestones = (
    made(Milestone, kinds, *NUMBERS)
    | made(Milestone, st.just("verdict"), *NUMBERS, verdicts)
    | made(Milestone, st.just("errors cross"), *NUMBERS, other=methods)
)
events = st.one_of(
    made(Event, st.just("start"), counts, st.just(0), st.just(0.0), scene=scenes),
    made(Event, st.just("set_h"), counts, counts, finite, h=finite, equal_cost=st.booleans()),
    made(Event, st.just("speed"), counts, counts, finite, speed=finite),
    made(Event, st.just("mark"), counts, counts, finite, text=st.none() | texts.filter(bool)),
    made(Event, st.sampled_from(["pause", "resume", "stop"]), counts, counts, finite),
    st.builds(noticed, counts, milestones),
)


@given(samples)
def test_every_finite_double_of_a_sample_reads_back_with_the_same_bits(sample):
    messages = encode_readings(sample)
    model, schema = "pendulum", SAMPLE_SCHEMA
    if sample.readings[0].extra:
        model, schema = "spring", PLANE_SCHEMA
    again = decode_readings(messages, model)
    assert again == sample
    for message, was, reading in zip(messages, sample.readings, again.readings, strict=True):
        assert not list(differences(was, reading))  # -0.0 is not 0.0
        fields = json.loads(message)
        jsonschema.validate(fields, schema)
        assert set(SPRING) & set(fields) == set(reading.extra)


@given(events)
def test_every_event_reads_back_the_same(event):
    message = encode_event(event)
    assert decode_event(message)._replace(arithmetic=None) == event
    jsonschema.validate(json.loads(message), EVENT_SCHEMA)


@pytest.mark.parametrize("schema", [SAMPLE_SCHEMA, PLANE_SCHEMA, EVENT_SCHEMA])
def test_a_schema_is_as_simple_as_the_simplest_viewer_needs(schema):
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["type"] == "object"
    assert set(schema["required"]) <= set(schema["properties"])
    for name, declared in schema["properties"].items():
        assert declared["type"] in ("integer", "number", "string", "boolean", "array"), name
        assert not {"anyOf", "oneOf", "$ref"} & set(declared), name


def test_a_nonfinite_number_is_never_written():
    reading = Reading(1.0, math.nan, 0.0, 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(ValueError, match="omega"):
        encode_readings(Sample(1, 0, 0.0, (reading,)))


def test_extremes_equal_to_the_energy_error_are_left_out():
    wide = Sample(1, 0, 0.0, (PLAIN._replace(energy_error_low=-0.5),))
    assert b"low" in encode_readings(wide)[0]
    assert without_extremes(wide).readings == (PLAIN,)
    assert b"low" not in encode_readings(without_extremes(wide))[0]


PLAIN = Reading(1.0, 0.0, 4.0, 0.5, 0.5, 0.5, 0.5)
GOOD = json.loads(encode_readings(Sample(1, 2, 0.5, (PLAIN,)))[0])


WRONG = ["null", '"1.0"', "NaN", "Infinity", "1e999", "true", "[1.0]", "{}", "1" + 400 * "0"]


@pytest.mark.parametrize("name", list(SAMPLE_SCHEMA["properties"]))
def test_a_field_that_is_not_a_finite_number_is_refused(name):
    more = ["-1", str(2**53), "1.0"] if name in ("run", "step") else []
    for value in WRONG + more:
        text = json.dumps(GOOD | {name: "HERE"}).replace('"HERE"', value)
        with pytest.raises(RecordingError):
            decode_readings([text.encode()])


def test_a_missing_field_is_refused():
    for name in SAMPLE_SCHEMA["required"]:
        message = dict(GOOD)
        del message[name]
        with pytest.raises(RecordingError, match=name):
            decode_readings([json.dumps(message).encode()])


def test_an_unknown_field_is_ignored_and_a_missing_optional_one_is_none():
    later = decode_readings([json.dumps(GOOD | {"temperature": 300.0}).encode()])
    assert later == decode_readings([json.dumps(GOOD).encode()])
    assert later.readings[0].diverged_at is None


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"[]", b"null", b"\xff", b"{} {}", b"[" * 60_000, b'{"run": 1}'],
    ids=["empty", "cut", "list", "null", "not text", "two", "deep", "lacking"],
)
def test_an_unexpected_message_is_refused(data):
    with pytest.raises(RecordingError):
        decode_readings([data])
    with pytest.raises(RecordingError):
        decode_event(data)


GROWS = Milestone("verdict", METHODS[0], 7, 0.7, 0.1, "grows")
IMPOSSIBLE = {
    start(): {
        "kind": ["explode", None], "h": [0.0, -0.1], "length": [-1.0], "gravity": [1e300],
        "theta": [None], "scene": [3], "numerics": [None], "model": [1, "kepler"],
        "methods": [[], "rk4", ["rk 4"], [["rk4"]], ["rk5"], ["rk4", "rk4"]],
    },
    start(scene=SCENES["damped"]): {"friction": [None, -1.0], "stiffness": [9.0]},
    noticed(1, GROWS): {
        "milestone": ["under the top", ["failed"]], "method": [None, "\x1b[2J"],
        "verdict": ["explodes", {}], "energy_error": [None],
    },
}  # fmt: skip


@pytest.mark.parametrize(
    ("event", "field", "value"),
    [
        (event, field, value)
        for event, fields in IMPOSSIBLE.items()
        for field, values in fields.items()
        for value in values
    ],
)
def test_an_impossible_event_is_refused(event, field, value):
    message = json.loads(encode_event(event))
    with pytest.raises(RecordingError):
        decode_event(json.dumps(message | {field: value}).encode())


@pytest.mark.parametrize(
    "text", ["\x1b[2J", "\x9b31m", "a\nb", "\u202egpj.exe", "\ud800", "\x00", "é\u0301\x7f"]
)
def test_texts_of_a_file_cannot_control_a_terminal(text):
    assert printable(text).isprintable()
    mark = Event("mark", 1, 0, 0.0, text=text)
    assert decode_event(encode_event(mark)).text == printable(text)
    named = decode_event(encode_event(start(scene=replace(SCENE, name=text, watch=text)))).scene
    assert named.name == named.watch == printable(text)


def test_a_text_that_is_too_long_is_cut_off_with_an_ellipsis_at_the_limit():
    assert printable("x" * MAX_TEXT) == "x" * MAX_TEXT
    assert printable("x" * (MAX_TEXT + 1)) == "x" * (MAX_TEXT - 1) + "…"


@pytest.mark.parametrize("function", ["sin", "sqrt"])
def test_a_fingerprint_is_reproducible_and_differs_if_one_value_does(monkeypatch, function):
    right = getattr(math, function)
    values = []

    def wrong(x):
        values.append(right(x))
        if len(values) == 1234:
            return math.nextafter(values[-1], 2)
        return values[-1]

    here = fingerprint.__wrapped__(function)
    assert fingerprint.__wrapped__(function) == here
    monkeypatch.setattr(math, function, wrong)
    assert fingerprint.__wrapped__(function) != here


@pytest.mark.parametrize(
    ("word", "method", "error", "today"),
    [
        ("caught", RK4, 0.5, "grows"),
        ("caught", RK4, -0.5, "loses"),
        ("wanders", VELOCITY_VERLET, 0.5, "chaotic"),
        ("wanders", RK4, 0.5, "undecided"),
        ("too early", RK4, 0.5, "undecided"),
        ("bounded", RK4, 0.5, "bounded"),
    ],
)
def test_verdicts_of_before_read_as_those_of_today(word, method, error, today):
    milestone = Milestone("verdict", method, 7, 0.7, error, word)
    event = decode_event(encode_event(noticed(1, milestone)))
    assert event.milestone.verdict == today
