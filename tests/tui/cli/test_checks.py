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
HEALTHY = {**dict.fromkeys(PLAIN, 0.0), "diverged_at": None, "verdict": "bounded"}

numbers = st.floats(allow_nan=False, allow_infinity=False)


def readings(**of_rk4: object) -> dict[str, dict[str, object]]:
    """All methods are healthy, but for what is given of RK4."""
    return {**dict.fromkeys(KEYS, HEALTHY), "rk4": HEALTHY | of_rk4}


@given(st.sampled_from(KEYS), st.sampled_from(PLAIN), st.sampled_from(SIGNS), numbers, numbers)
def test_a_comparison_is_that_of_python(key, field, sign, value, number):
    found = f"{key}.{field} is {value:g}" if eval(f"{value!r} {sign} {number!r}") else ""
    assert parse(f"{key}.{field}{sign}{number!r}")({key: HEALTHY | {field: value}}) == found


@pytest.mark.parametrize("unknown", [None, math.nan, math.inf])
@pytest.mark.parametrize("sign", SIGNS)
def test_a_failed_method_and_a_value_that_is_not_known_trip_every_comparison(unknown, sign):
    gate = parse(f"rk4.theta_error {sign} 1e9")
    assert gate(readings(theta_error=unknown)) == "rk4.theta_error is not known"
    assert gate({}) == "rk4.theta_error is not known"  # a method that was not run
    assert gate(readings(diverged_at=3.0, verdict="failed")) == "rk4 failed at 3"


@pytest.mark.parametrize("word", VERDICTS)
@pytest.mark.parametrize("verdict", VERDICTS)
def test_a_verdict_is_compared_with_one_of_its_words(word, verdict):
    values = readings(verdict=verdict)
    trips = verdict in (word, "undecided")  # what cannot be judged passes no gate
    assert bool(parse(f"rk4.verdict == {word}")(values)) is trips
    assert bool(parse(f"rk4.energy > 1 or rk4.verdict!='{word}'")(values)) is (verdict != word)
    assert parse(f"rk4.verdict == {word}")(readings(verdict=None)) == "rk4.verdict is not known"
    assert parse(None)(values) == ""


SHORT = {"verdict": "undecided", "reason": "short"}
LARGE = {"max_energy_error": 0.004, "verdict": "loses"}
TWICE_LARGE = "rk4.max_energy_error is 0.004, rk4.max_energy_error is 0.004"


@pytest.mark.filterwarnings("error")  # about odd code, such as `3or`
@pytest.mark.parametrize(
    ("expression", "of_rk4", "found"),
    [
        ("rk4.energy >= 0 or rk4.energy >= 0 and rk4.energy > 0", {}, "rk4.energy is 0"),
        ("(rk4.energy >= 0 or rk4.energy >= 0) and rk4.energy > 0", {}, ""),
        ("rk4.diverged_at >= 0", {}, ""),
        ("rk4.diverged_at >= 0", {"diverged_at": 3.0}, "rk4.diverged_at is 3"),
        ("rk4.diverged_at < 2", {"diverged_at": 3.0}, ""),
        ("velocity_verlet.theta_error > 1e9", {"diverged_at": 3.0}, ""),
        ("rk4.verdict == grows", SHORT, "rk4.verdict is undecided: short"),
        ("rk4.energy > 1", SHORT | {"slope": None}, "cannot tell: rk4 cannot be judged: short"),
        ("RK.max_energy_error > 0.3 %", LARGE, "rk4.max_energy_error is 0.004"),
        ("RK.max_energy_error > 0.5 %", LARGE, ""),
        ("RK.max_energy_error > 3e-1% and RK.max_energy_error < 0.5E0 %", LARGE, TWICE_LARGE),
        ("any.verdict == loses", LARGE, "rk4.verdict is loses"),
        ("all.verdict == bounded", LARGE, ""),
        (
            "rk4.max_energy_error > 1e-3or rk4.verdict != bounded or rk4.energy > 1",
            LARGE,
            "rk4.max_energy_error is 0.004, rk4.verdict is loses",
        ),
        ("all.energy < 1%", {}, ", ".join(f"{key}.energy is 0" for key in KEYS)),
    ],
)
def test_a_gate_says_what_trips_it_of_the_methods_that_it_names(expression, of_rk4, found):
    assert parse(expression)(readings(**of_rk4)) == found


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


@pytest.mark.parametrize(
    ("row", "found"),
    [
        ({"order": 1.94}, "order is 1.94"),
        ({"order": 2.0}, ""),
        ({"order": 1.0, "diverged_at": 3.0}, "the energy failed at 3"),
        ({"order": None, "unknown": {"order": "too short"}}, "too short"),
        ({"order": 1.9, "shown": {"order": "1.9 ± 0.2"}}, "order is 1.9 ± 0.2"),
        (
            {"order": 3.0, "slope": None} | SHORT,
            "cannot tell: the energy cannot be judged: short",
        ),
        ({"order": 3.0, "slope": 0.0} | SHORT, ""),
        ({"order": 3.0, "slope": None, "verdict": "bounded"}, ""),
    ],
)
def test_a_record_has_no_method_and_a_gate_says_what_is_known_of_it(row, found):
    assert parse("order < 2", ["order"])({"": row}) == found


def test_a_slope_that_cannot_be_told_says_how_long_a_record_would_do():
    row = {"trend": 0.0, "bound": 8e-5}
    assert "4 times as long" in parse("trend > 1e-5", ["trend"])({"": row})


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


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("rk4.verdict == lose", "there is no verdict 'lose': did you mean loses?"),
        ("rk4.verdict > loses", "verdict is a word: compare it with == or !=."),
        ("rk4.energy > loses", "'loses' is not a finite number; use, for example, 1e-2."),
        (
            "verdict != bounded",
            "for example, 'any.max_energy_error > 1e-2 or any.verdict != bounded'",
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


def test_of_a_record_the_example_names_no_method():
    with pytest.raises(InputError, match="example, 'order > 1e-2 or verdict != bounded'"):
        parse("any.order > 1", ["order"])


def test_the_failed_checks_are_counted_and_the_first_is_told(capsys):
    checks = [Check("a", ""), Check("b", "x is 1"), Check("c", "x is 2")]
    assert conclude("x > 0", checks[:1]) == 0
    assert conclude("x > 0", checks[1:2]) == conclude("x > 0", checks, "files") == 1
    assert capsys.readouterr().err == (
        "pendu-tui: the check failed: x > 0 (x is 1)\n"
        "pendu-tui: the check failed in 2 of 3 files, first at b: x > 0 (x is 1)\n"
    )
