"""The expression of --fail-if, and its exit code.

An expression, `velocity_verlet.FIELD > 1e-2 or rk4.verdict == grows`, joins comparisons
by `and`, `or` and parentheses.  Python's parser reads it, but only the nodes named here are
evaluated.  It fails safe: every comparison holds if its method has failed or its value is unknown
(None, missing, not finite, or another verdict than undecided asked of what cannot be judged).
Hence there is no `not`.  A slope keeps a limit only if its bound does.  Only `diverged_at` is
compared as it is; None means that the method never failed.  A field that is a word, such as
`verdict`, is compared by == or !=, so `!= bounded` is strict.

A method is named as in --methods; `any` and `all` stand for the whole cast.  1% is 0.01.
"""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from pendu_tui.engine.inputs import InputError, check_name
from pendu_tui.engine.methods import USUAL_CAST, Cast, named
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.quantities import LARGEST, QUANTITIES
from pendu_tui.engine.run.verdicts import UNDECIDED, VERDICTS, not_within
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.errors import Exit, warn
from pendu_tui.tui.cli.options import given_by

_OWN = dict.fromkeys(each.name for model in MODELS.values() for each in model.variables)
FIELDS = (*(each.name for each in QUANTITIES if each.in_gate), *_OWN)
"""The fields of `run --json` that are numbers."""

JUDGED = (
    *(LARGEST.name, "trend", "slope", "bound", "share", "absolute_trend", "fluctuation"),
    *("energy_per_ns_per_atom", "kt_per_ns_per_atom", "samples", "skipped"),
    *("independent_samples", "fluctuation_order", "drift_order"),
)
"""The fields of `judge --json` that its gate compares."""

MEASURED_NUMBERS = ("order", "force_evaluations")
MEASURED_WORDS = dict.fromkeys(("symplectic", "reversible"), ("yes", "no"))
"""The fields of `methods --json` that its gate compares."""

Values = Mapping[str, Mapping[str, Any]]  # method key -> field -> value
Gate = Callable[[Values], str]  # returns the values that trip it, "" if it passes

_SIGNS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}


BOUNDS = {
    "slope": "bound",
    "trend": "bound",
    "drift_per_second": "bound",
    "absolute_trend": "absolute_bound",
    "energy_per_ns_per_atom": "energy_bound_per_ns_per_atom",
    "kt_per_ns_per_atom": "kt_bound_per_ns_per_atom",
}
"""The fields that are slopes, and where their bounds stand."""

Words = Mapping[str, Sequence[str]]  # field -> its words
VERDICT: Words = {"verdict": tuple(VERDICTS)}


def parse(
    text: str | None,
    fields: Sequence[str] = (),
    cast: Cast = USUAL_CAST,
    words: Words = VERDICT,
) -> Gate:
    """Return the gate in `text` for a cast; None passes everything.  Raises InputError.

    With `fields`, comparisons name one of these, or of `words`, and no method; their values are
    under the key "".
    """
    if text is None:
        return lambda values: ""
    source = " ".join(text.split())
    grammar = _Grammar(fields, cast, words)
    with given_by("--fail-if"):
        source = re.sub(r"([\d.])(?:[eE]([-+]?\d{1,3}))?\s*%", _hundredth, source)
        if "#" in source:  # a comment would hide what follows
            raise grammar.no_comparison(source)
        try:
            with warnings.catch_warnings(action="ignore"):  # about odd code, such as `1or`
                node = ast.parse(source, mode="eval").body
            return grammar.gate(node)
        except InputError:
            raise
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise grammar.no_comparison(source) from None


@dataclass(frozen=True)
class _Grammar:
    """What comparisons may name."""

    fields: Sequence[str]
    cast: Cast
    words: Words

    def gate(self, node: ast.expr) -> Gate:
        """Return the gate of a node.  Raises InputError."""
        match node:
            case ast.BoolOp(op, parts):
                return partial(_joined, [self.gate(part) for part in parts], type(op) is ast.And)
            case ast.Compare(ast.Name() | ast.Attribute(ast.Name()) as left, [sign], [value]) if (
                type(sign) in _SIGNS and isinstance(left, ast.Name) == bool(self.fields)
            ):
                key, _, field = ast.unparse(left).rpartition(".")
            case _:
                raise self.no_comparison(ast.unparse(node))
        check_name("field", field, (*(self.fields or FIELDS), *self.words))
        if field in self.words:
            limit: float | str = _word(sign, value, field, self.words[field])
        else:
            limit = _number(value)
        methods = [""]
        if key in ("any", "all"):
            methods = [method.key for method in self.cast]
        elif key:
            methods = [named(key, self.cast).key]
        found = [partial(_found, method, field, _SIGNS[type(sign)], limit) for method in methods]
        return partial(_joined, found, key == "all")

    def no_comparison(self, text: str) -> InputError:
        word, (right, *_) = next(iter(self.words.items()))
        example = f"'any.{LARGEST.name} > 1e-2 or any.{word} != {right}'"
        example += ": each field needs any. or a method before it"
        if self.fields:
            example = f"'{self.fields[0]} > 1e-2 or {word} != {right}'"
        return InputError(f"{_quoted(text)} is not understood; use, for example, {example}.")


def _word(sign: ast.cmpop, node: ast.expr, field: str, words: Sequence[str]) -> str:
    if not isinstance(sign, ast.Eq | ast.NotEq):
        raise InputError(f"{field} is a word: compare it with == or !=.")
    word = ast.unparse(node).strip("'")
    check_name(field, word, words)
    return word


def _hundredth(percent: re.Match[str]) -> str:
    return f"{percent[1]}e{int(percent[2] or 0) - 2}"


def _number(node: ast.expr) -> float:
    text = ast.unparse(node)
    value = math.nan
    with suppress(ValueError):
        value = float(text)
    if not math.isfinite(value):
        raise InputError(f"{_quoted(text)} is not a finite number; use, for example, 1e-2.")
    return value


def _joined(gates: Sequence[Gate], joined_by_and: bool, values: Values) -> str:
    found = [gate(values) for gate in gates]
    if joined_by_and and not all(found):
        return ""
    return ", ".join(filter(None, found))


def _found(
    method: str, field: str, compare: Callable[[Any, Any], bool], limit: float | str, values: Values
) -> str:
    """Return the value that makes a comparison true, or why it cannot be checked, else ""."""
    reading = values.get(method, {})
    ours = reading.get(field)
    diverged_at = reading.get("diverged_at")
    name = f"{method}.{field}".removeprefix(".")
    whose = method or "the energy"
    if field == "diverged_at":
        if ours is None or not compare(ours, limit):
            return ""
        return f"{name} is {ours:g}"
    if diverged_at is not None:
        return f"{whose} failed at {diverged_at:g}"
    if reading.get("verdict") == UNDECIDED and reading.get("slope", 0) is None:
        return f"cannot tell: {whose} cannot be judged: {reading['reason']}"
    if ours is None or not (isinstance(ours, str) or math.isfinite(ours)):
        return reading.get("unknown", {}).get(field) or f"{name} is not known"
    if field in BOUNDS and compare not in (operator.eq, operator.ne):
        bound = reading.get(BOUNDS[field])
        sign = 1.0 if compare in (operator.gt, operator.ge) else -1.0
        if bound is None or bound > abs(ours):
            return not_within(float(limit), name, slope=ours, bound=bound, sign=sign)
    is_unknown = ours == UNDECIDED and limit != UNDECIDED
    if not (is_unknown or compare(ours, limit)):
        return ""
    if not isinstance(ours, str):
        return f"{name} is {reading.get('shown', {}).get(field) or format(ours, 'g')}"
    return ": ".join(filter(None, (f"{name} is {ours}", reading.get("reason"))))


def _quoted(text: str) -> str:
    """Return a text in quotes, shortened and without control characters."""
    return repr(printable(text, 60))


class Check(NamedTuple):
    """The gate of one run, record or method."""

    name: str
    failure: str  # the values that trip it, "" if it passes


def conclude(expression: str | None, checks: Sequence[Check], what: str = "runs") -> Exit:
    """Warn of the checks that failed, and return the exit code."""
    failed = [check for check in checks if check.failure]
    if not failed:
        return Exit.FINE
    where = ""
    if len(checks) > 1:
        where = f" in {len(failed)} of {len(checks)} {what}, first at {failed[0].name}"
    warn(f"the check failed{where}: {expression} ({failed[0].failure})")
    return Exit.CHECK_FAILED
