"""List the methods with their claimed and measured properties.

A method of your own has measured properties only.
"""

import argparse
import math
from collections.abc import Iterator
from itertools import groupby
from typing import Any

from pendu_tui.engine.methods import METHODS, Method, simplified
from pendu_tui.engine.scenes import DEFAULT_SCENE, MAX_METHODS
from pendu_tui.tui.cli.cast import KEYS, add_cast_options, cast_of, family_of
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.options import Suggestions
from pendu_tui.tui.cli.report import Column, Report, add_report_options, fields_of, finite, publish
from pendu_tui.tui.words.cards import method_card

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
found: the measured order of the theta error, over one swing of the scene drift.
evals: force evaluations per step, on average if they vary.
z limit: for the linear oscillator, z = h·w0; pendu-tui stability has those of the pendulum."""

Row = dict[str, Any]


def add_options(parser: argparse.ArgumentParser) -> None:
    keys = Suggestions(KEYS)
    parser.add_argument("keys", metavar="KEY", nargs="*", choices=keys, help="as --methods")
    add_cast_options(parser, "all")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from pendu_tui.engine.accuracy.study import orders
    from pendu_tui.engine.run.compiled import available

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
    labels = [
        f"{method.label} ({method.key})"
        for method in cast
        if simplified(method.label) != simplified(method.key)
    ]
    notes = [NOTE, f"in the lab: {', '.join(labels)}"]
    if options.keys:
        notes = [NOTE, *(f"\n{method_card(method)}" for method in cast)]
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
    """Return the claims, which a user's own method does not make, and the measured properties."""
    from pendu_tui.engine.methods import measure
    from pendu_tui.engine.methods.own import OwnMethod

    claims = fields_of(method, *CLAIMS)
    if isinstance(method, OwnMethod):
        claims |= dict.fromkeys(set(CLAIMS) - {"key", "label", "letter", "other_names"})
    if not method.general:  # tests measure these, each in its own scene
        return claims | dict.fromkeys(MEASURED)
    return claims | {
        "measured_order": order,
        "measured_linear_limit": measure.linear_limit(method.phases),
        "measured_symplectic": measure.is_symplectic(method.phases),
        "measured_reversible": measure.is_reversible(method.phases),
        "measured_force_evaluations": measure.evaluations(method.phases)[0],
    }


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
