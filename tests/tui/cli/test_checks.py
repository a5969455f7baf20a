"""--fail-if: what trips a gate, and what is none."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.tui.cli.checks import FIELDS, Check, conclude, parse

SIGNS = ["<", "<=", ">", ">=", "==", "!="]
KEYS = [method.key for method in USUAL_CAST]
PLAIN = [field for field in FIELDS if field != "diverged_at"]

numbers = st.floats(allow_nan=False, allow_infinity=False)


def reading(**values: float | str | None) -> dict[str, dict[str, float | str | None]]:
    """All methods alike, healthy but for what is given."""
    return {key: {**dict.fromkeys(PLAIN, 0.0), "diverged_at": None, **values} for key in KEYS}


@given(st.sampled_from(KEYS), st.sampled_from(PLAIN), st.sampled_from(SIGNS), numbers, numbers)
def test_a_comparison_is_that_of_python(key, field, sign, value, number):
    found = f"{key}.{field} is {value:.3g}" if eval(f"{value!r} {sign} {number!r}") else ""
    assert parse(f"{key}.{field}{sign}{number!r}")(reading(**{field: value})) == found


def test_the_failed_checks_are_counted_and_the_first_is_told(capsys):
    checks = [Check("a", ""), Check("b", "x is 1"), Check("c", "x is 2")]
    assert conclude("x > 0", checks[:1]) == 0
    assert conclude("x > 0", checks[1:2]) == conclude("x > 0", checks, "files") == 1
    assert capsys.readouterr().err == (
        "pendu-tui: the check failed: x > 0 (x is 1)\n"
        "pendu-tui: the check failed in 2 of 3 files, first at b: x > 0 (x is 1)\n"
    )


def test_parentheses_join_as_in_python():
    assert parse("rk4.energy >= 0 or rk4.energy >= 0 and rk4.energy > 0")(reading())
    assert not parse("(rk4.energy >= 0 or rk4.energy >= 0) and rk4.energy > 0")(reading())


@pytest.mark.parametrize(
    "text",
    [
        "not rk4.energy > 1",  # it would pass what cannot be checked
        "0 < rk4.energy < 1",
        "rk4.energy > 1 # or rk4.energy < 0",
        "rk4.energy in 1",
        "rk4.energy > 1 or print()",
        "-" * 9_000,
        "-" * 900 + "1",
        "\ud800",
        "",
    ],
)
def test_any_other_expression_is_refused_and_never_evaluated(text):
    with pytest.raises(InputError, match="is not understood"):
        parse(text)


@pytest.mark.parametrize("unknown", [None, math.nan, math.inf])
@pytest.mark.parametrize("sign", SIGNS)
def test_a_failed_method_and_a_value_that_is_not_known_trip_every_comparison(unknown, sign):
    gate = parse(f"rk4.theta_error {sign} 1e9")
    assert gate(reading(theta_error=unknown))
    assert gate({})  # a method that was not run
    values = reading()
    values["rk4"]["diverged_at"] = 3.0
    assert gate(values) == "rk4 failed at 3"
    assert not parse("velocity_verlet.theta_error > 1e9")(values)


def test_the_time_of_divergence_can_be_asked_for():
    diverged = reading(diverged_at=3.0)
    assert parse("rk4.diverged_at >= 0")(reading()) == ""
    assert parse("rk4.diverged_at >= 0")(diverged) == "rk4.diverged_at is 3"
    assert parse("rk4.diverged_at < 2")(diverged) == ""


@pytest.mark.parametrize("word", VERDICTS)
def test_a_verdict_is_compared_with_one_of_its_words(word):
    for verdict in VERDICTS:
        values = reading(verdict=verdict)
        trips = verdict in (word, "undecided")  # what cannot be judged passes no gate
        assert bool(parse(f"rk4.verdict == {word}")(values)) is trips
        assert bool(parse(f"rk4.energy > 1 or rk4.verdict!='{word}'")(values)) is (verdict != word)
    assert parse(f"rk4.verdict == {word}")(reading(verdict=None))
    assert parse(f"rk4.verdict == {word}")(reading(verdict="bounded", diverged_at=1.0))
    assert parse(None)(reading(verdict=word)) == ""


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rk4.verdict == lose", "there is no verdict 'lose': did you mean loses?"),
        ("rk4.verdict > loses", "verdict is a word: compare it with == or !=."),
        ("rk4.energy > loses", "'loses' is not a finite number; use for example 1e-2."),
        (
            "verdict != bounded",
            "for example 'any.max_energy_error > 1e-2 or any.verdict != bounded'",
        ),
        ("rk4.energy > 1e999", "'1e309' is not a finite number"),
        ("x" * 60, f"'{'x' * 60}' is not understood"),
        ("x" * 61, f"'{'x' * 59}…' is not understood"),
        ("velocity_verlt.energy > 1", "no method 'velocity_verlt': did you mean velocity_verlet?"),
        ("heun.energy > 1", "choose from explicit_euler, symplectic_euler, velocity_verlet, rk4."),
        ("rk4.max_enrgy_error > 1", "'max_enrgy_error': did you mean max_energy_error?"),
    ],
)
def test_an_error_is_one_sentence_that_helps(text, sentence):
    with pytest.raises(InputError) as error:
        parse(text)
    assert str(error.value).startswith("--fail-if: ")
    assert sentence in str(error.value)


def test_a_method_is_named_as_in_methods_and_any_and_all_are_the_cast():
    values = reading(max_energy_error=0.02, verdict="bounded")
    values["rk4"] |= {"max_energy_error": 0.004, "verdict": "loses"}
    assert parse("verlet.max_energy_error > 1%")(values)
    assert not parse("RK.max_energy_error > 0.5 %")(values)
    assert parse("any.verdict == loses")(values) == "rk4.verdict is loses"
    assert not parse("all.verdict == bounded")(values)
    assert parse("all.max_energy_error > 0.1%")(values).count("max_energy_error is") == 4
    gate = parse("rk4.max_energy_error > 1e-3 or rk4.verdict != bounded or rk4.energy > 1")
    assert gate(values) == "rk4.max_energy_error is 0.004, rk4.verdict is loses"


@pytest.mark.parametrize(
    ("field", "place"),
    [
        ("slope", "bound"),
        ("trend", "bound"),
        ("drift_per_second", "bound"),
        ("absolute_trend", "absolute_bound"),
        ("energy_per_ns_per_atom", "energy_bound_per_ns_per_atom"),
        ("kt_per_ns_per_atom", "kt_bound_per_ns_per_atom"),
    ],
)
@pytest.mark.parametrize(
    ("expression", "slope", "bound", "outcome"),
    [
        ("trend > 1e-5", 1e-6, 1e-5, ""),
        ("trend > 1e-5", 1e-6, 1.1e-5, "cannot tell: trend is 1e-06 ± 1e-05 at 99 %"),
        ("trend > 1e-5", 2e-5, 2e-5, "trend is 2e-05"),
        ("trend > 1e-5", 2e-5, 2.9e-5, "trend is 2e-05, above 1e-05"),
        ("trend > 1e-5", 2e-5, 3.1e-5, "cannot tell: trend is 2e-05 ± 1e-05 at 99 %"),
        ("trend > 1e-5", -2e-5, 3e-5, ""),
        ("trend < -1e-5", -1e-6, 1e-5, ""),
        ("trend >= 1e-5", 1e-6, 1.1e-5, "cannot tell: trend is 1e-06 ± 1e-05 at 99 %"),
        ("trend <= -1e-5", -1e-6, 1.1e-5, "cannot tell: trend is -1e-06 ± 1e-05 at 99 %"),
        ("trend < -1e-5", -2e-5, 2e-5, "trend is -2e-05"),
        ("trend < -1e-5", -2e-5, 2.9e-5, "trend is -2e-05, below -1e-05"),
        ("trend > 1e-5", 1e-6, None, "cannot tell: trend is not known"),
        ("trend == 1e-5", 1e-6, 1.0, ""),
    ],
)
def test_a_limit_on_a_slope_is_compared_with_its_bound(
    expression, slope, bound, outcome, field, place
):
    gate = parse(expression.replace("trend", field), [field])
    row = {"bound": 9.0, "absolute_bound": 9.0, field: slope, place: bound}
    assert gate({"": row}).partition(";")[0] == outcome.replace("trend", field)


def test_what_cannot_be_judged_does_not_pass_and_says_what_would_help():
    gate = parse("max_energy_error > 1", ["max_energy_error"])
    row = {"max_energy_error": 0.1, "verdict": "undecided", "reason": "short"}
    assert gate({"": row | {"slope": None}}) == "cannot tell: the energy cannot be judged: short"
    assert gate({"": row | {"slope": 0.0}}) == ""
    assert gate({"": row | {"slope": None, "verdict": "bounded"}}) == ""
    gate = parse("trend > 1e-5", ["trend"])
    assert "4 times as long" in gate({"": {"trend": 0.0, "bound": 8e-5}})
    values = reading(verdict="undecided", reason="short")
    assert parse("rk4.verdict == grows")(values) == "rk4.verdict is undecided: short"
    values["rk4"]["slope"] = None
    assert parse("rk4.energy > 1")(values) == "cannot tell: rk4 cannot be judged: short"


def test_a_record_has_no_method_and_says_of_an_order_what_it_knows():
    with pytest.raises(InputError, match="example 'order > 1e-2 or verdict != bounded'"):
        parse("any.order > 1", ["order"])
    gate = parse("order < 2", ["order"])
    assert gate({"": {"order": 1.0, "diverged_at": 3.0}}) == "the energy failed at 3"
    assert gate({"": {"order": None, "unknown": {"order": "too short"}}}) == "too short"
    assert gate({"": {"order": 1.9, "shown": {"order": "1.9 ± 0.2"}}}) == "order is 1.9 ± 0.2"
