"""List the methods with their claimed and measured properties.

Of your own method, only measured ones are known.
"""

import argparse
import math
from collections.abc import Iterator
from itertools import groupby
from typing import Any

from engine.methods import METHODS, Method, simplified
from engine.scenes import DEFAULT_SCENE, MAX_METHODS
from tui.cli.cast import KEYS, add_cast_options, cast_of, family_of
from tui.cli.errors import Exit
from tui.cli.options import Suggestions
from tui.cli.report import Column, Report, add_report_options, fields_of, finite, publish

EXAMPLES = """\
examples:
  pendu-tui methods
  pendu-tui methods rk4 verlet
  pendu-tui methods --json | jq '.methods[] | select(.symplectic) | .key'
"""

CLAIMS = (
    *("key", "label", "letter", "formula", "order", "force_evaluations", "symplectic"),
    *("reversible", "linear_limit", "other_names", "reference", "used"),
)
MEASURED = (
    *("measured_order", "measured_linear_limit", "measured_symplectic", "measured_reversible"),
    "measured_force_evaluations",
)
NOTE = """
found: the order of the theta error over one swing of scene drift.
evals: force evaluations per step, in the average where they vary.
z limit: of the linear oscillator, z = h·w0; for the pendulum see pendu-tui stability."""

Row = dict[str, Any]


def add_options(parser: argparse.ArgumentParser) -> None:
    keys = Suggestions(KEYS)
    names = "the methods, as --methods"
    parser.add_argument("keys", metavar="KEY", nargs="*", choices=keys, help=names)
    add_cast_options(parser, "all")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from engine.accuracy.study import orders
    from engine.run.compiled import available

    if options.keys:
        options.methods = ",".join((*options.keys, *filter(None, [options.methods])))
    cast = cast_of(options, METHODS, most=None)
    general = tuple(method for method in cast if method.general)
    measured = dict(orders(DEFAULT_SCENE.with_cast(general), math.inf))
    rows = [_row(method, measured.get(method)) for method in cast]
    columns = (
        Column("method", "key"),
        Column("order", "order", "d"),
        Column("found", "measured_order", ".3f"),
        Column("evals", lambda row: _known(row, "force_evaluations"), ".3g"),
        Column("symplectic", lambda row: _yes(_known(row, "symplectic"))),
        Column("reversible", lambda row: _yes(_known(row, "reversible"))),
        Column("z limit", lambda row: _known(row, "linear_limit"), _limit),
    )
    other = (each for each in cast if simplified(each.label) != simplified(each.key))
    notes = [NOTE, f"in the lab: {', '.join(f'{each.label} ({each.key})' for each in other)}"]
    if options.keys:
        notes = [NOTE, *map(_about, rows)]
    report = Report(
        name="methods",
        columns=columns,
        rows=list(_by_family(rows)),
        notes=notes,
        fields={"methods": [finite(row) for row in rows], "compiled": available()},
    )
    publish(report, options)
    return Exit.FINE


def _row(method: Method, order: float | None) -> Row:
    """Return what is claimed, nothing of a user's own method, and what is measured."""
    from engine.methods import measure
    from engine.methods.own import OwnMethod

    claims = fields_of(method, *CLAIMS)
    if isinstance(method, OwnMethod):
        claims |= dict.fromkeys(set(CLAIMS) - {"key", "label", "letter", "other_names"})
    measured = dict.fromkeys(MEASURED)
    if method.general:  # others are for a scene of their own, and measured there by the tests
        values = (
            order,
            measure.linear_limit(method.phases),
            measure.is_symplectic(method.phases),
            measure.is_reversible(method.phases),
            measure.evaluations(method.phases)[0],
        )
        measured = dict(zip(MEASURED, values, strict=True))
    return claims | measured


def _by_family(rows: list[Row]) -> Iterator[Any]:
    if len(rows) <= MAX_METHODS:
        yield from rows
        return
    for family, members in groupby(rows, lambda row: family_of(row["key"])):
        yield family
        yield from members


def _known(row: Row, name: str) -> Any:
    measured = row[f"measured_{name}"]
    return row[name] if measured is None else measured


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def _limit(z: float) -> str:
    return {math.inf: "any", 0.0: "none"}.get(z) or f"{z:.3f}"


def _about(row: Row) -> str:
    names = ", ".join((row["label"], *row["other_names"]))
    more = filter(None, (row["formula"], row["reference"]))
    return "\n".join(["", f"{names} ({row['letter']})", *more])
