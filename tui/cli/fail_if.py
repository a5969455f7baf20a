"""A gate for CI: `velocity_verlet.max_energy_error > 1e-2 or rk4.verdict == grows` -> true or false.

A gate is comparisons joined by `and` and `or`; `and` binds tighter, and there are no parentheses.
It fails safe.  A comparison holds, whatever its sign, where its method has diverged or its value is
not known (None, missing, not finite): what cannot be checked has not passed.  Only `diverged_at` is
compared as it is, None meaning that the method never diverged.  `verdict` is compared by == or != with bounded,
drifts, grows or too_early (or 'too early'); too_early is a word like the others, so `!= bounded` is the careful
gate.
"""

import math
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, get_args

from engine.methods import METHODS
from engine.run.verdict import Verdict
from recordings.fields import NUMBERS
from tui.cli.options import did_you_mean

FIELDS = (*NUMBERS, "theta_error", "drift_per_second", "force_evaluations", "diverged_at")
"""The fields of `run --json` that are numbers."""

Values = Mapping[str, Mapping[str, float | str | None]]  # method key -> field -> value

_OPERATORS: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
_COMPARISON = re.compile(
    r"\s*(?P<method>\w+)\.(?P<field>\w+)\s*(?P<sign><=|>=|==|!=|<|>)"
    r"\s*(?P<quote>['\"]?)(?P<value>[-+]?[\w.][\w.+ -]*?)(?P=quote)\s*"
)
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE | re.ASCII)
_EXAMPLE = "velocity_verlet.max_energy_error > 1e-2"


class GateError(ValueError):
    """An expression that is no gate; its text is a sentence for the user."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """method.field sign value."""

    method: str
    field: str
    sign: str
    value: float | str  # a number; for `verdict` its words

    def holds(self, values: Values) -> bool:
        """Whether it is true of these values, or cannot be checked."""
        reading = values.get(self.method, {})
        value, diverged_at = reading.get(self.field), reading.get("diverged_at")
        if self.field == "diverged_at":
            return value is not None and _OPERATORS[self.sign](value, self.value)
        if value is None or diverged_at is not None or not (isinstance(value, str) or math.isfinite(value)):
            return True
        return _OPERATORS[self.sign](value, self.value)


@dataclass(frozen=True, slots=True)
class Gate:
    """Alternatives (`or`) of comparisons that must hold together (`and`)."""

    alternatives: tuple[tuple[Comparison, ...], ...]

    def holds(self, values: Values) -> bool:
        """Whether the gate trips on these values."""
        return any(all(comparison.holds(values) for comparison in together) for together in self.alternatives)


def parse(text: str) -> Gate:
    """The gate that `text` says.

    Raises GateError, one sentence, for anything else.
    """
    return Gate(
        tuple(
            tuple(_comparison(piece) for piece in re.split(r"\band\b", alternative))
            for alternative in re.split(r"\bor\b", text)
        )
    )


def _comparison(text: str) -> Comparison:
    found = _COMPARISON.fullmatch(text)
    if not found:
        raise GateError(f"{_quoted(text)} is no comparison: write METHOD.FIELD > NUMBER, for example {_EXAMPLE!r}.")
    method = _known("method", found["method"], [method.key for method in METHODS])
    field = _known("field", found["field"], (*FIELDS, "verdict"))
    sign, value = found["sign"], found["value"]
    if field == "verdict":
        if sign not in ("==", "!="):
            raise GateError(f"A verdict is not {sign} another: compare it with == or !=.")
        return Comparison(method, field, sign, _known("verdict", value.replace("_", " "), get_args(Verdict)))
    if found["quote"] or not _NUMBER.fullmatch(value) or not math.isfinite(number := float(value)):
        raise GateError(f"{_quoted(value)} is no finite number: compare with one like 0.05 or 1e-2.")
    return Comparison(method, field, sign, number)


def _known(what: str, name: str, names: Sequence[str]) -> str:
    if name in names:
        return name
    advice = did_you_mean(name, names) or f": choose from {', '.join(names)}."
    raise GateError(f"There is no {what} {_quoted(name)}{advice}")


def _quoted(text: str) -> str:
    """`text` in quotes, short and without control characters."""
    text = " ".join(text.split())
    return repr(text if len(text) <= 60 else text[:57] + "...")
