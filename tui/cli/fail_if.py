"""The gate of --fail-if: `velocity_verlet.max_energy_error > 1e-2 or rk4.verdict == grows` -> true or false.

A gate is comparisons joined by `and`, `or` and parentheses.  Python's parser reads it; nothing is evaluated but the
nodes named here.  It fails safe.  A comparison holds, whatever its sign, where its method has diverged or its value
is not known (None, missing, not finite): what cannot be checked has not passed.  Hence there is no `not`.  Only
`diverged_at` is compared as it is, None meaning that the method never diverged.  `verdict` is compared by == or !=
with one of the verdicts; too_early (or 'too early') is a word like the others, so `!= bounded` is the careful gate.
"""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from engine.methods import USUAL_CAST, Cast
from engine.run.judgement import VERDICTS
from recordings.fields import NUMBERS
from tui.cli.errors import UserError
from tui.cli.options import did_you_mean

FIELDS = (
    *NUMBERS,
    "log_energy_error",
    "spring_energy",
    "theta_error",
    "drift_per_second",
    "force_evaluations",
    "diverged_at",
)
"""The fields of `run --json` that are numbers."""

Values = Mapping[str, Mapping[str, float | str | None]]  # method key -> field -> value
Gate = Callable[[Values], bool]  # whether it trips on these values

_SIGNS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_EXAMPLE = "velocity_verlet.max_energy_error > 1e-2"


def parse(text: str, fields: Sequence[str] = (), cast: Cast = USUAL_CAST) -> Gate:
    """The gate that `text` states of the methods of a cast.  Raises UserError for anything else.

    With `fields`, comparisons name one of these, or `verdict`, and no method; their values stand under the key "".
    """
    source = " ".join(text.split())
    for verdict in VERDICTS:
        source = source.replace(verdict, verdict.replace(" ", "_"))
    try:
        with warnings.catch_warnings(action="ignore"):  # of what is odd but legal, such as `1or`
            node = ast.parse(source, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _no_comparison(source, fields) from None
    if "#" in source:  # a comment would hide what follows
        raise _no_comparison(source, fields)
    return _gate(node, source, fields, [method.key for method in cast])


def _gate(node: ast.expr, source: str, fields: Sequence[str], methods: Sequence[str]) -> Gate:
    match node:
        case ast.BoolOp(op, parts):
            join = all if isinstance(op, ast.And) else any
            gates = [_gate(part, source, fields, methods) for part in parts]
            return lambda values: join(gate(values) for gate in gates)
        case ast.Compare(ast.Attribute(ast.Name(key), field), [sign], [value]) if type(sign) in _SIGNS and not fields:
            method, known = _known("method", key, methods), FIELDS
        case ast.Compare(ast.Attribute(ast.Name(), field) as named) if fields:
            ours = source.replace(ast.get_source_segment(source, named) or "", field)
            raise _refusal(
                f"{_quoted(source)} names a method, and one table of energies has none; write {_quoted(ours)}."
            )
        case ast.Compare(ast.Name(field), [sign], [value]) if type(sign) in _SIGNS and fields:
            method, known = "", tuple(fields)
        case _:
            raise _no_comparison(ast.get_source_segment(source, node) or source, fields)
    field = _known("field", field, (*known, "verdict"))
    return partial(_holds, method, field, _SIGNS[type(sign)], _value(field, sign, value, source))


def _holds(method: str, field: str, compare: Callable[[Any, Any], bool], value: float | str, values: Values) -> bool:
    """Whether a comparison is true of these values, or cannot be checked."""
    reading = values.get(method, {})
    ours, diverged_at = reading.get(field), reading.get("diverged_at")
    if field == "diverged_at":
        return ours is not None and compare(ours, value)
    unknown = ours is None or diverged_at is not None or not (isinstance(ours, str) or math.isfinite(ours))
    return unknown or compare(ours, value)


def _value(field: str, sign: ast.cmpop, node: ast.expr, source: str) -> float | str:
    quoted = node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None
    text = quoted or ast.get_source_segment(source, node) or ""
    if field == "verdict":
        if not isinstance(sign, ast.Eq | ast.NotEq):
            raise _refusal("Verdicts have no order: compare them with == or !=.")
        if text == "drifts":
            raise _refusal("The verdict 'drifts' is now called loses.")
        return _known("verdict", text.replace("_", " "), VERDICTS)
    if quoted or not _NUMBER.fullmatch(text) or not math.isfinite(number := float(text)):
        raise _refusal(f"{_quoted(text)} is not a finite number; use for example 0.05 or 1e-2.")
    return number


def _refusal(sentence: str) -> UserError:
    return UserError(f"--fail-if: {sentence}")


def _no_comparison(text: str, fields: Sequence[str]) -> UserError:
    form, example = ("FIELD", f"{fields[0]} > 1e-2") if fields else ("METHOD.FIELD", _EXAMPLE)
    return _refusal(f"{_quoted(text)} is not a comparison; write {form} > NUMBER, for example {example!r}.")


def _known(what: str, name: str, names: Sequence[str]) -> str:
    if name in names:
        return name
    longer = next((f": did you mean {each}?" for each in names if f"_{name}" in each), "")
    advice = did_you_mean(name, names) or longer or f": choose from {', '.join(names)}."
    raise _refusal(f"There is no {what} {_quoted(name)}{advice}")


def _quoted(text: str) -> str:
    """`text` in quotes, short and without control characters."""
    return repr(text if len(text) <= 60 else text[:57] + "...")
