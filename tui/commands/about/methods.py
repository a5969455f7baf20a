"""List the methods with their claimed properties, and with order and limit as measured now."""

import argparse
import math
from collections.abc import Iterator
from typing import Any

from engine.scenes import DEFAULT_SCENE
from tui.cli.errors import Exit
from tui.cli.output import fields_of, print_table, write_json

EXAMPLES = """\
examples:
  pendu-tui methods
  pendu-tui methods --json | jq '.methods[] | select(.symplectic) | .key'
"""

CLAIMS = (
    *("key", "label", "letter", "formula", "order", "force_evaluations", "symplectic", "reversible", "linear_limit"),
    *("other_names", "reference", "used"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from engine.run.compiled import COMPILED_FROM, available

    methods = _measured()
    if options.json:
        write_json("methods", {"methods": methods, "compiled": available()})
        return Exit.FINE
    print_table(
        "lrrrllrrl",
        ("method", "order", "measured", "forces", "symplectic", "reversible", "z limit", "measured", "also called"),
        map(_row, methods),
    )
    print(
        "\nOrder: measured on theta over one swing of scene drift.  Forces: evaluations per step."
        "\nz limit: linear oscillator, z = h·w0; for the pendulum see pendu-tui stability."
        "\n"
        + (f"Numba: used in runs of at least {COMPILED_FROM:,} steps." if available() else "Numba is not installed.")
    )
    return Exit.FINE


def _row(method: dict[str, Any]) -> Iterator[str]:
    yield from (method["key"], str(method["order"]), f"{method['measured_order']:.3f}")
    yield str(method["force_evaluations"])
    yield from ("yes" if method[claim] else "no" for claim in ("symplectic", "reversible"))
    yield from (f"{z:.3f}" if z else "none" for z in (method["linear_limit"], method["measured_linear_limit"]))
    yield ", ".join(method["other_names"])


def _measured() -> list[dict[str, Any]]:
    """The methods with the order that their errors show on the default scene, and their limit by bisection."""
    from engine.accuracy.study import orders
    from engine.stability.linear import linear_limit

    return [
        fields_of(method, *CLAIMS) | {"measured_order": order, "measured_linear_limit": linear_limit(method)}
        for method, order in orders(DEFAULT_SCENE, math.inf)
    ]
