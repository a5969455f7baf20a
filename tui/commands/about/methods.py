"""List the methods with their claimed and measured properties.

Of your own method, only measured ones are known.
"""

import argparse
import math
from collections.abc import Iterator
from typing import Any

from engine.methods import FAMILIES, METHODS, Cast, Method
from engine.scenes import DEFAULT_SCENE, MOST_METHODS
from tui.cli.cast import KEYS, add_cast_options, cast_of
from tui.cli.errors import Exit
from tui.cli.options import Suggestions
from tui.cli.output import fields_of
from tui.cli.report import Column, Report, add_report_options, finite, publish

EXAMPLES = """\
examples:
  pendu-tui methods
  pendu-tui methods rk4 verlet
  pendu-tui methods --method mine.py:my_step
  pendu-tui methods --json | jq '.methods[] | select(.symplectic) | .key'
"""

CLAIMS = (
    *(
        "key",
        "label",
        "letter",
        "formula",
        "order",
        "force_evaluations",
        "symplectic",
        "reversible",
        "linear_limit",
    ),
    *("other_names", "reference", "used"),
)
MEASURED = (
    *("measured_order", "measured_linear_limit", "measured_symplectic", "measured_reversible"),
    "measured_force_evaluations",
)
NOTE = """
found: the order of the theta error over one swing of scene drift.
evals: force evaluations per step, in the average where they vary.
z limit: of the linear oscillator, z = h·w0; for the pendulum see pendu-tui stability."""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "keys",
        metavar="KEY",
        nargs="*",
        choices=Suggestions(KEYS),
        help="the methods, as --methods",
    )
    add_cast_options(parser, "all")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from engine.run.compiled import available

    if options.keys:
        options.methods = ",".join((*options.keys, *filter(None, [options.methods])))
    methods = _measured(cast_of(options, METHODS, most=None))
    columns = (
        Column("method", "key"),
        Column("order", "order", "d"),
        Column("found", "measured_order", ".3f"),
        Column("evals", lambda method: _known(method, "force_evaluations"), ".3g"),
        Column("symplectic", lambda method: "yes" if _known(method, "symplectic") else "no"),
        Column("reversible", lambda method: "yes" if _known(method, "reversible") else "no"),
        Column("z limit", _limit, right=True),
    )
    notes = [NOTE, *(_about(method) for method in methods if options.keys)]
    fields = {"methods": [finite(method) for method in methods], "compiled": available()}
    report = Report(
        name="methods", columns=columns, rows=[*_by_family(methods)], notes=notes, fields=fields
    )
    publish(report, options)
    return Exit.FINE


def _by_family(methods: list[dict[str, Any]]) -> Iterator[Any]:
    """Yield the methods, those of a family below its name; your own come last."""
    if len(methods) <= MOST_METHODS:
        yield from methods
        return
    left = {method["key"]: method for method in methods}
    for family, members in FAMILIES.items():
        found = [left.pop(each.key) for each in members if each.key in left]
        yield from [family, *found]
    yield from ["your own", *left.values()] if left else ()


def _known(method: dict[str, Any], name: str) -> Any:
    """Return a property as measured, or as claimed where it is not measured."""
    measured = method[f"measured_{name}"]
    return method[name] if measured is None else measured


def _limit(method: dict[str, Any]) -> str | None:
    z = _known(method, "linear_limit")
    if z is None:
        return None
    if z == math.inf:
        return "any"
    return f"{z:.3f}" if z else "none"


def _about(method: dict[str, Any]) -> str:
    names = ", ".join((method["label"], *method["other_names"]))
    return "\n".join(
        [
            "",
            f"{names} ({method['letter']})",
            *filter(None, (method["formula"], method["reference"])),
        ]
    )


def _measured(cast: Cast) -> list[dict[str, Any]]:
    """Return the methods with the order of their errors on the default scene, and more."""
    from engine.accuracy.study import orders

    general = tuple(method for method in cast if method.general)
    measured_orders = dict(orders(DEFAULT_SCENE.with_cast(general), math.inf))
    return [_claims(method) | _properties(method, measured_orders.get(method)) for method in cast]


def _claims(method: Method) -> dict[str, Any]:
    """Return what is claimed; of a user's own method nothing is."""
    from engine.methods.own import OwnMethod

    claims = fields_of(method, *CLAIMS)
    if isinstance(method, OwnMethod):
        claims |= dict.fromkeys(set(CLAIMS) - {"key", "label", "letter", "other_names"})
    return claims


def _properties(method: Method, order: float | None) -> dict[str, Any]:
    from engine.methods import measure

    if not method.general:  # it is for a scene of its own, and measured there by the tests
        return dict.fromkeys(MEASURED)
    values = (
        order,
        measure.linear_limit(method.phases),
        measure.is_symplectic(method.phases),
        measure.is_reversible(method.phases),
        measure.evaluations(method.phases)[0],
    )
    return dict(zip(MEASURED, values, strict=True))
