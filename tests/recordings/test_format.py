"""The format: messages read back the same, and anything else is refused."""

import json
import math
from dataclasses import replace
from typing import get_args

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import METHODS
from engine.models import MODELS
from engine.run.judgement import Milestone, Verdict
from engine.run.lockstep import Reading, Sample
from engine.scenes import LIMITS, SCENES, Scene
from recordings.arithmetic import fingerprint
from recordings.errors import MAX_TEXT, RecordingError, printable
from recordings.events import Event, noticed
from recordings.fields import EVENT_SCHEMA, EXTRA, sample_schema, values_of, without_extremes
from recordings.format import decode_event, decode_reading, encode_event, encode_readings, topics_of
from tests.recordings.examples import SCENE, start

SAMPLE_SCHEMA, PLANE_SCHEMA = sample_schema("pendulum"), sample_schema("spring")
SPRING = tuple(field.name for field in EXTRA["spring"])
finite = st.floats(allow_nan=False, allow_infinity=False)
counts = st.integers(0, 2**53 - 1)


def made(kind, *values, **more):
    """Like st.builds, which would also choose what has a default in a NamedTuple."""
    return st.builds(lambda *some, **others: kind(*some, **others), *values, **more)


readings = made(
    Reading,
    theta=finite,
    omega=finite,
    energy=finite,
    energy_error=finite,
    max_energy_error=finite,
    energy_error_low=finite,
    energy_error_high=finite,
    diverged_at=st.none() | finite,
)
readings_in_plane = st.builds(
    lambda reading, extra: reading._replace(extra=extra),
    readings,
    st.fixed_dictionaries(dict.fromkeys(SPRING, finite)),
)
samples = made(
    Sample,
    run=counts,
    step=counts,
    t=finite,
    readings=st.tuples(readings, readings) | st.tuples(readings_in_plane, readings_in_plane),
)
letters = st.characters(categories=("L", "M", "N", "P", "S"), include_characters=" ")
texts = st.text(letters, max_size=MAX_TEXT).filter(str.isprintable)
methods = st.sampled_from(METHODS)


def scenes_of(model):
    suited = st.sampled_from([each for each in METHODS if model in each.models])
    return st.builds(
        Scene,
        name=texts,
        model=st.just(model),
        cast=st.lists(suited, min_size=1, max_size=6, unique_by=lambda method: method.key).map(
            tuple
        ),
        watch=texts,
        theta=st.floats(*LIMITS["theta"]),
        omega=st.floats(*LIMITS["omega"]),
        length=st.floats(0.1, 10),
        gravity=st.floats(0.1, 10),
        h=st.floats(1e-6, 1),
        parameters=st.fixed_dictionaries(
            {each.name: st.floats(1.0, 10.0) for each in MODELS[model].parameters}
        ),
    )


scenes = st.sampled_from([*MODELS]).flatmap(scenes_of)
milestones = made(
    Milestone, st.sampled_from(["over the top", "failed"]), methods, counts, finite, finite
) | made(
    Milestone,
    st.just("verdict"),
    methods,
    counts,
    finite,
    finite,
    st.sampled_from(get_args(Verdict)),
)
milestones |= made(
    Milestone, st.just("errors cross"), methods, counts, finite, finite, other=methods
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
    for message, reading in zip(messages, sample.readings, strict=True):
        run, step, t, again = decode_reading(message, "spring" if reading.extra else "pendulum")
        assert (run, step, t) == (sample.run, sample.step, sample.t)
        assert again == reading
        assert repr(values_of(again)) == repr(
            values_of(reading)
        )  # -0.0 == 0.0, but their texts differ
        jsonschema.validate(json.loads(message), PLANE_SCHEMA if reading.extra else SAMPLE_SCHEMA)
        assert set(SPRING) & set(json.loads(message)) == set(reading.extra)


@given(events)
def test_every_event_reads_back_the_same(event):
    message = encode_event(event)
    assert decode_event(message)._replace(arithmetic=None) == event
    jsonschema.validate(json.loads(message), EVENT_SCHEMA)


@pytest.mark.parametrize("schema", [SAMPLE_SCHEMA, PLANE_SCHEMA, EVENT_SCHEMA])
def test_a_schema_is_as_simple_as_the_simplest_viewer_needs(schema):
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["type"] == "object"
    for name, declared in schema["properties"].items():
        assert declared["type"] in ("integer", "number", "string", "boolean", "array"), name
        assert not {"anyOf", "oneOf", "$ref"} & set(declared), name
    assert set(schema["required"]) <= set(schema["properties"])


def test_a_nonfinite_number_is_never_written():
    reading = Reading(1.0, math.nan, 0.0, 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(ValueError, match="JSON compliant"):
        encode_readings(Sample(1, 0, 0.0, (reading,)))


def test_extremes_equal_to_the_energy_error_are_left_out():
    plain = Reading(1.0, 0.0, 4.0, 0.5, 0.5, 0.5, 0.5)
    assert b"low" not in encode_readings(Sample(1, 0, 0.0, (plain,)))[0]
    wide = plain._replace(energy_error_low=-0.5)
    assert b"low" in encode_readings(Sample(1, 0, 0.0, (wide,)))[0]
    assert without_extremes(Sample(1, 0, 0.0, (wide,))).readings == (plain,)


GOOD = json.loads(
    encode_readings(Sample(1, 2, 0.5, (Reading(1.0, 0.0, 4.0, 0.5, 0.5, 0.5, 0.5),)))[0]
)


@pytest.mark.parametrize("name", list(SAMPLE_SCHEMA["properties"]))
@pytest.mark.parametrize(
    "value", ["null", '"1.0"', "NaN", "Infinity", "1e999", "true", "[1.0]", "{}", "1" + 400 * "0"]
)
def test_a_field_that_is_not_a_finite_number_is_refused(name, value):
    text = json.dumps(GOOD | {name: "HERE"}).replace('"HERE"', value)
    with pytest.raises(RecordingError):
        decode_reading(text.encode())


@pytest.mark.parametrize("name", SAMPLE_SCHEMA["required"])
def test_a_missing_field_is_refused(name):
    with pytest.raises(RecordingError, match=name):
        decode_reading(
            json.dumps({key: value for key, value in GOOD.items() if key != name}).encode()
        )


def test_an_unknown_field_is_ignored_and_a_missing_optional_one_is_none():
    later = decode_reading(json.dumps(GOOD | {"temperature": 300.0}).encode())
    assert later == decode_reading(json.dumps(GOOD).encode())
    assert later[3].diverged_at is None


def test_a_topic_names_a_method_and_a_model():
    assert topics_of(SCENE)[3] == "/pendu/rk4"
    assert topics_of(SCENES["stiff-slow"])[0] == "/pendu/spring/velocity_verlet"


@pytest.mark.parametrize("name", ["run", "step"])
@pytest.mark.parametrize("value", [-1, 2**53, 1.0])
def test_a_count_is_a_whole_number_in_range(name, value):
    with pytest.raises(RecordingError, match=name):
        decode_reading(json.dumps(GOOD | {name: value}).encode())


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"[]", b"null", b"\xff", b"{} {}", b"[" * 60_000, b'{"run": 1}'],
    ids=["empty", "cut", "list", "null", "not text", "two", "deep", "lacking"],
)
def test_an_unexpected_message_is_refused(data):
    with pytest.raises(RecordingError):
        decode_reading(data)
    with pytest.raises(RecordingError):
        decode_event(data)


START = json.loads(encode_event(start()))


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "explode"},
        {"kind": None},
        {"h": 0.0},
        {"h": -0.1},
        {"length": -1.0},
        {"gravity": 1e300},
        {"theta": None},
        {"scene": 3},
        {"methods": []},
        {"methods": "rk4"},
        {"methods": ["rk 4"]},
        {"methods": [["rk4"]]},
        {"model": 1},
        {"model": "kepler"},
        {"methods": ["rk5"]},
        {"numerics": None},
        {"methods": ["rk4", "rk4"]},
    ],
)
def test_an_impossible_start_is_refused(wrong):
    with pytest.raises(RecordingError):
        decode_event(json.dumps(START | wrong).encode())


@pytest.mark.parametrize(
    "text", ["\x1b[2J", "\x9b31m", "a\nb", "\u202egpj.exe", "\ud800", "\x00", "é\u0301\x7f"]
)
def test_texts_of_a_file_cannot_control_a_terminal(text):
    assert printable(text).isprintable()
    mark = Event("mark", 1, 0, 0.0, text=text)
    assert decode_event(encode_event(mark)).text == printable(text)
    named = decode_event(encode_event(start(scene=replace(SCENE, name=text, watch=text)))).scene
    assert named.name == named.watch == printable(text)


NOTICED = json.loads(
    encode_event(noticed(1, Milestone("verdict", METHODS[0], 7, 0.7, 0.1, "grows")))
)


@pytest.mark.parametrize(
    "wrong",
    [
        {"milestone": "under the top"},
        {"milestone": ["failed"]},
        {"method": None},
        {"method": "\x1b[2J"},
        {"verdict": "explodes"},
        {"verdict": {}},
        {"energy_error": None},
    ],
)
def test_an_impossible_milestone_is_refused(wrong):
    assert decode_event(json.dumps(NOTICED).encode()).milestone.verdict == "grows"
    with pytest.raises(RecordingError):
        decode_event(json.dumps(NOTICED | wrong).encode())


@pytest.mark.parametrize("function", ["sin", "sqrt"])
def test_a_fingerprint_is_the_same_each_time_and_differs_where_one_value_does(
    monkeypatch, function
):
    here = fingerprint(function)
    fingerprint.cache_clear()
    assert fingerprint(function) == here
    fingerprint.cache_clear()
    right, calls = getattr(math, function), iter(range(10_000))

    def wrong(x):
        value = right(x)
        return math.nextafter(value, 2) if next(calls) == 1234 else value

    monkeypatch.setattr(math, function, wrong)
    assert fingerprint(function) != here
    monkeypatch.undo()
    fingerprint.cache_clear()
