import math
import operator
import time
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import USUAL_CAST
from engine.run.judgement import Verdict
from tui.cli.errors import UserError
from tui.cli.fail_if import FIELDS, parse

SIGNS = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
KEYS = [method.key for method in USUAL_CAST]
NO_COMPARISON = (
    "is not a comparison; write METHOD.FIELD > NUMBER, for example 'velocity_verlet.max_energy_error > 1e-2';"
    " comparisons are joined by and, or and parentheses."
)
PLAIN = [field for field in FIELDS if field != "diverged_at"]

numbers = st.floats(allow_nan=False, allow_infinity=False)
methods, signs, plain_fields = (
    st.sampled_from(KEYS),
    st.sampled_from(sorted(SIGNS)),
    st.sampled_from(PLAIN),
)


def reading(**values: float | str | None) -> dict[str, dict[str, float | str | None]]:
    """All methods alike, healthy but for what is given."""
    return {key: {**dict.fromkeys(PLAIN, 0.0), "diverged_at": None, **values} for key in KEYS}


@given(methods, plain_fields, signs, numbers, numbers)
def test_a_comparison_is_that_of_python(
    method: str, field: str, sign: str, value: float, number: float
) -> None:
    assert parse(f"{method}.{field}{sign}{number!r}")(reading(**{field: value})) == (
        f"{method}.{field} is {value:.3g}" if SIGNS[sign](value, number) else ""
    )


@given(st.lists(st.lists(st.booleans(), min_size=1, max_size=4), min_size=1, max_size=4))
def test_and_binds_tighter_than_or(truths: list[list[bool]]) -> None:
    text = " or ".join(
        " and ".join(f"rk4.energy > {-1 if truth else 1}" for truth in row) for row in truths
    )
    assert bool(parse(text)(reading(energy=0.0))) is any(all(row) for row in truths)


def test_parentheses_join_as_in_python() -> None:
    holds, fails = "rk4.energy >= 0", "rk4.energy > 0"
    assert parse(f"{holds} or {holds} and {fails}")(reading())
    assert not parse(f"({holds} or {holds}) and {fails}")(reading())


@pytest.mark.parametrize(
    "text",
    [
        "not rk4.energy > 1",  # it would pass what cannot be checked
        "0 < rk4.energy < 1",
        "rk4.energy > 1 # or rk4.energy < 0",
        "rk4.energy > 1 if 1 else 2",
        "rk4.energy in (1, 2)",
        "__import__('os').remove('x')",
        "(" * 1000,
        "-" * 9_000,
        "\0",
        "",
    ],
)
def test_any_other_expression_is_refused_and_never_evaluated(text: str) -> None:
    with pytest.raises(UserError, match="is not a comparison"):
        parse(text)


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("field", PLAIN)
def test_a_diverged_method_trips_every_comparison_that_names_it(field: str, sign: str) -> None:
    values = reading()
    values["rk4"]["diverged_at"] = 3.0
    assert parse(f"rk4.{field} {sign} 1e9")(values)
    assert not parse(f"velocity_verlet.{field} > 1e9")(values)


@pytest.mark.parametrize("unknown", [None, math.nan, math.inf])
@pytest.mark.parametrize("sign", SIGNS)
def test_a_value_that_is_not_known_trips_the_gate(unknown: float | None, sign: str) -> None:
    assert parse(f"rk4.theta_error {sign} 0.5")(reading(theta_error=unknown))


def test_a_method_that_was_not_run_trips_the_gate() -> None:
    assert parse("rk4.energy_error > 1")({})


def test_the_time_of_divergence_can_be_asked_for() -> None:
    healthy, diverged = reading(), reading(diverged_at=3.0)
    assert parse("rk4.diverged_at >= 0")(healthy) == ""
    assert parse("rk4.diverged_at >= 0")(diverged)
    assert parse("rk4.diverged_at < 2")(diverged) == ""


@pytest.mark.parametrize("quote", ["", " ", "'", '"'])
@pytest.mark.parametrize("word", get_args(Verdict))
def test_a_verdict_is_compared_with_one_of_its_words(word: str, quote: str) -> None:
    written = (
        f"{quote}{word}{quote}" if quote else word.replace(" ", "_")
    )  # and with a blank, as it is
    for verdict in get_args(Verdict):
        values = reading(verdict=verdict)
        assert bool(parse(f"rk4.verdict == {written}")(values)) is (verdict == word)
        assert bool(parse(f"rk4.energy > 1 or rk4.verdict!={written}")(values)) is (verdict != word)
    assert parse(f"rk4.verdict == {written}")(reading(verdict=None))
    assert parse(f"rk4.verdict == {written}")(reading(verdict="bounded", diverged_at=1.0))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rk4.verdict == lose", "there is no verdict 'lose': did you mean loses?"),
        ("rk4.verdict > loses", "verdicts have no order: compare them with == or !=."),
        ("rk4.energy > loses", "'loses' is not a finite number; use for example 0.05 or 1e-2."),
        ("rk4.energy > '1'", "\"'1'\" is not a finite number; use for example 0.05 or 1e-2."),
        (
            "velocity_verlt.energy > 1",
            "there is no method 'velocity_verlt': did you mean velocity_verlet?",
        ),
        (
            "rk4.max_enrgy_error > 1",
            "there is no field 'max_enrgy_error': did you mean max_energy_error?",
        ),
        ("rk4.energy > 1e999", "'1e309' is not a finite number; use for example 0.05 or 1e-2."),
        ("rk4.energy > 1 +", f"'rk4.energy > 1 +' {NO_COMPARISON}"),
        ("rk4.energy > 1 or print()", f"'print()' {NO_COMPARISON}"),
    ],
)
def test_an_error_is_one_sentence_that_helps(text: str, sentence: str) -> None:
    with pytest.raises(UserError) as error:
        parse(text)
    assert str(error.value) == f"--fail-if: {sentence}"


@given(
    st.text()
    | st.lists(
        st.sampled_from([*KEYS, *FIELDS, "verdict", *SIGNS, "'", ".", "and", "or", "1", "(", " "])
    ).map("".join)
)
def test_any_text_is_a_gate_or_one_printable_sentence(text: str) -> None:
    sentence = ""
    try:
        assert callable(parse(text))
    except UserError as error:
        sentence = str(error)
    assert sentence.isprintable()
    assert len(sentence) < 800  # at most 60 quoted characters, ten each when escaped


def test_a_method_is_named_as_in_methods_and_any_and_all_are_the_cast() -> None:
    values = reading(max_energy_error=0.02, verdict="bounded")
    values["rk4"] |= {"max_energy_error": 0.004, "verdict": "loses"}
    assert parse("verlet.max_energy_error > 1%")(values)
    assert not parse("RK.max_energy_error > 0.5 %")(values)
    assert parse("any.verdict == loses")(values) == "rk4.verdict is loses"
    assert not parse("all.verdict == bounded")(values)
    assert parse("all.max_energy_error > 0.1%")(values).count("max_energy_error is") == 4


def test_the_values_that_trip_a_gate_are_given() -> None:
    values = reading(max_energy_error=0.057, verdict="too early")
    gate = parse("rk4.max_energy_error > 1e-2 or rk4.verdict != bounded or rk4.energy > 1")
    assert gate(values) == "rk4.max_energy_error is 0.057, rk4.verdict is too early"
    values["rk4"]["diverged_at"] = 3.0
    assert parse("rk4.verdict != failed")(values) == "rk4 diverged at 3"


@pytest.mark.parametrize(
    "text", [" or ".join(["rk4.energy > 1"] * 3000), "rk4." + "x" * 9000 + " > 1"]
)
def test_long_gates_are_refused_at_once(text: str) -> None:
    began = time.process_time()
    with pytest.raises(UserError):
        parse(text)
    assert time.process_time() - began < 1
