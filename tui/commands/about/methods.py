"""List the methods with their claimed properties, and as measured now; your own method is measured only."""

import argparse
import math
from collections.abc import Iterator
from typing import Any

from engine.methods import METHODS, Cast, Method
from engine.scenes import DEFAULT_SCENE
from tui.cli.cast import add_cast_options, cast_of
from tui.cli.errors import Exit
from tui.cli.output import fields_of, print_lines, write_json
from tui.cli.report import print_table

EXAMPLES = """\
examples:
  pendu-tui methods
  pendu-tui methods --methods rk4,verlet
  pendu-tui methods --method mine.py:my_step
  pendu-tui methods --json | jq '.methods[] | select(.symplectic) | .key'
"""

CLAIMS = (
    *("key", "label", "letter", "formula", "order", "force_evaluations", "symplectic", "reversible", "linear_limit"),
    *("other_names", "reference", "used"),
)

MEASURED = (
    *("measured_order", "measured_linear_limit", "measured_symplectic", "measured_reversible"),
    "measured_force_evaluations",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    add_cast_options(parser, "all")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from engine.run.compiled import COMPILED_FROM, available

    cast = cast_of(options, METHODS, most=None)
    methods = _measured(cast)
    if options.json:
        write_json("methods", {"methods": methods, "compiled": available()})
        return Exit.FINE
    print_table(
        "lrrrllrrl",
        ("method", "order", "found", "forces", "symplectic", "reversible", "z limit", "found z", "also called"),
        map(_row, methods),
    )
    usual = "; where they vary, the average of a minute of scene halving" * any(method.varies for method in cast)
    print_lines(
        "",
        f"Found: the order measured on theta over one swing of scene drift.  Forces: evaluations per step{usual}.",
        "z limit: of the linear oscillator, z = h·w0; found z: as measured; for the pendulum see pendu-tui stability.",
        f"Numba: used in runs of at least {COMPILED_FROM:,} steps." if available() else "Numba is not installed.",
    )
    return Exit.FINE


def _row(method: dict[str, Any]) -> Iterator[str]:
    own, order, forces = method["order"] is None, method["measured_order"], method["measured_force_evaluations"]
    measured = forces is not None
    yield from (method["key"], "-" if own else str(method["order"]))
    yield "-" if not measured else "none" if order is None else f"{order:.3f}"
    yield f"{forces if measured else method['force_evaluations']:g}"
    claims = (f"measured_{claim}" if measured else claim for claim in ("symplectic", "reversible"))
    yield from ("yes" if method[claim] else "no" for claim in claims)
    limits = method["linear_limit"], method["measured_linear_limit"]
    yield from ("-" if z is None else f"{z:.3f}" if z else "none" for z in limits)
    yield ", ".join(method["other_names"] or ["your own"] * own)


def _measured(cast: Cast) -> list[dict[str, Any]]:
    """The methods with the order that their errors show on the default scene, and what else is measured."""
    from engine.accuracy.study import orders

    general = tuple(method for method in cast if method.general)
    measured_orders = dict(orders(DEFAULT_SCENE.with_cast(general), math.inf))
    return [_claims(method) | _properties(method, measured_orders.get(method)) for method in cast]


def _claims(method: Method) -> dict[str, Any]:
    """What is claimed; of a user's own method nothing is."""
    from engine.methods.own import OwnMethod

    claims = fields_of(method, *CLAIMS)
    if isinstance(method, OwnMethod):
        claims |= dict.fromkeys(set(CLAIMS) - {"key", "label", "letter", "other_names"})
    return claims


def _properties(method: Method, order: float | None) -> dict[str, Any]:
    from engine.methods import measure

    if not method.general:  # it is for a scene of its own, and measured there by the tests
        return dict.fromkeys(MEASURED)
    return {
        "measured_order": order,
        "measured_linear_limit": measure.linear_limit(method.phases),
        "measured_symplectic": measure.is_symplectic(method.phases),
        "measured_reversible": measure.is_reversible(method.phases),
        "measured_force_evaluations": measure.evaluations(method.phases)[0],
    }
