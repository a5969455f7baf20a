"""The gate of --fail-if: `velocity_verlet.max_energy_error > 1e-2 or rk4.verdict == grows`.

A gate is comparisons joined by `and`, `or` and parentheses.  Python's parser reads it; nothing is
evaluated but the nodes named here.  It fails safe: a comparison holds, whatever its sign, where its
method has diverged or its value is not known (None, missing, not finite).  Hence there is no `not`.
Only `diverged_at` is compared as it is, None meaning that the method never diverged.  `verdict` is
compared by == or != with a verdict; too_early (or 'too early') is one, so `!= bounded` is careful.

A method is named as in --methods; `any` and `all` stand for the whole cast.  1% is 0.01.
"""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from functools import partial
from typing import Any

from engine.methods import USUAL_CAST, Cast, matching
from engine.run.judgement import VERDICTS, Progress
from recordings.fields import EXTRA_NAMES, NUMBERS, OPTIONAL
from tui.cli.cast import find
from tui.cli.errors import UserError
from tui.cli.options import did_you_mean

FIELDS = (
    *NUMBERS,
    *OPTIONAL,
    "log_energy_error",
    *EXTRA_NAMES,
    "theta_error",
    "drift_per_second",
    "force_evaluations",
)
"""The fields of `run --json` that are numbers."""

Values = Mapping[str, Mapping[str, Any]]  # method key -> field -> value
Gate = Callable[[Values], str]  # the values that trip it; empty if it passes

MAX_LENGTH = 10_000  # characters of a gate
_SIGNS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_PERCENT = re.compile(r"([\d.]+)\s*%(?=\s*(?:and\b|or\b|\)|$))", re.IGNORECASE | re.ASCII)
_EXAMPLE = "velocity_verlet.max_energy_error > 1e-2"


def parse(text: str, fields: Sequence[str] = (), cast: Cast = USUAL_CAST) -> Gate:
    """Return the gate that `text` states of a cast.  Raises UserError for anything else.

    With `fields`, comparisons name one of these, or `verdict`, and no method; their values stand
    under the key "".
    """
    source = " ".join(text.split())
    if len(source) > MAX_LENGTH:
        raise _refusal(f"it is longer than {MAX_LENGTH:,} characters.")
    for verdict in VERDICTS:
        source = source.replace(verdict, verdict.replace(" ", "_"))
    source = _PERCENT.sub(_fraction, source)
    try:
        with warnings.catch_warnings(action="ignore"):  # of what is odd but legal, such as `1or`
            node = ast.parse(source, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise _no_comparison(source, fields) from None
    if "#" in source:  # a comment would hide what follows
        raise _no_comparison(source, fields)
    try:
        return _gate(node, source, fields, cast)
    except RecursionError:
        raise _no_comparison(source, fields) from None


def _fraction(percent: re.Match[str]) -> str:
    """Return a percentage as a fraction, in decimal digits; what is no number stays."""
    try:
        return str(Decimal(percent[1]).scaleb(-2))
    except ArithmeticError:
        return percent[0]


def _gate(node: ast.expr, source: str, fields: Sequence[str], cast: Cast) -> Gate:
    match node:
        case ast.BoolOp(op, parts):
            gates = [_gate(part, source, fields, cast) for part in parts]
            return partial(_all if isinstance(op, ast.And) else _any, gates)
        case ast.Compare(ast.Attribute(ast.Name(key), field), [sign], [value]) if (
            type(sign) in _SIGNS and not fields
        ):
            names = FIELDS
        case ast.Compare(ast.Name(field), [sign], [value]) if type(sign) in _SIGNS and fields:
            key = ""
            names = tuple(fields)
        case _:
            raise _no_comparison(_segment(source, node), fields)
    field = _named("field", field, (*names, "verdict"))
    limit = _value(field, sign, value, source)
    compare = _SIGNS[type(sign)]
    if key in ("any", "all"):
        gates = [partial(_found, method.key, field, compare, limit) for method in cast]
        return partial(_all if key == "all" else _any, gates)
    if key and not matching(key, cast) and matching(key):
        raise UserError(f"--fail-if: {key} is not in this run; add it with --methods.")
    method = find(key, cast, "--fail-if").key if key else ""
    return partial(_found, method, field, compare, limit)


def _all(gates: Sequence[Gate], values: Values) -> str:
    found = [gate(values) for gate in gates]
    return ", ".join(found) if all(found) else ""


def _any(gates: Sequence[Gate], values: Values) -> str:
    return ", ".join(found for found in (gate(values) for gate in gates) if found)


def _found(
    method: str, field: str, compare: Callable[[Any, Any], bool], limit: float | str, values: Values
) -> str:
    """Return the value for which a comparison is true, or why it cannot be checked."""
    reading = values.get(method, {})
    ours = reading.get(field)
    diverged_at = reading.get("diverged_at")
    name = f"{method}.{field}" if method else field
    if field == "diverged_at":
        return f"{name} is {ours:g}" if ours is not None and compare(ours, limit) else ""
    if diverged_at is not None:
        return f"{method or 'the energy'} diverged at {diverged_at:g}"
    if ours is None or not (isinstance(ours, str) or math.isfinite(ours)):
        return f"{name} is not known"
    if not compare(ours, limit):
        return ""
    text = ours if isinstance(ours, str) else format(ours, ".3g")
    progress = reading.get("progress")
    if field == "verdict" and isinstance(progress, Mapping):
        text += f": {Progress(**progress)}"
    return f"{name} is {text}"


def _segment(source: str, node: ast.expr) -> str:
    """Return the text of a node of a source in one line."""
    return source.encode()[node.col_offset : node.end_col_offset].decode()


def _value(field: str, sign: ast.cmpop, node: ast.expr, source: str) -> float | str:
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    text = str(node.value) if is_text else _segment(source, node)  # type: ignore[attr-defined]
    if field == "verdict":
        if not isinstance(sign, ast.Eq | ast.NotEq):
            raise _refusal("verdicts have no order: compare them with == or !=.")
        return _named("verdict", text.replace("_", " "), VERDICTS)
    if is_text or not _NUMBER.fullmatch(text) or not math.isfinite(number := float(text)):
        raise _refusal(f"{_quoted(text)} is not a finite number; use for example 0.05 or 1e-2.")
    return number


def _refusal(sentence: str) -> UserError:
    return UserError(f"--fail-if: {sentence}")


def _no_comparison(text: str, fields: Sequence[str]) -> UserError:
    form = "FIELD" if fields else "METHOD.FIELD"
    example = f"{fields[0]} > 1e-2" if fields else _EXAMPLE
    return _refusal(
        f"{_quoted(text)} is not a comparison; write {form} > NUMBER, for example {example!r}; "
        "comparisons are joined by and, or and parentheses."
    )


def _named(what: str, name: str, names: Sequence[str]) -> str:
    if name in names:
        return name
    longer = next((f": did you mean {each}?" for each in names if f"_{name}" in each), "")
    advice = did_you_mean(name, names) or longer or f": choose from {', '.join(names)}."
    raise _refusal(f"there is no {what} {_quoted(name)}{advice}")


def _quoted(text: str) -> str:
    """`text` in quotes, short and without control characters."""
    return repr(text if len(text) <= 60 else text[:57] + "...")
