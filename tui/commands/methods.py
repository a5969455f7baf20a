"""List the methods: what is claimed of them, and order and limit as measured here and now."""

import argparse
import math
from typing import Any

from engine.methods import Method
from engine.scenes import DEFAULT_SCENE
from tui.cli.errors import Exit
from tui.cli.output import print_table, write_json

EXAMPLES = """\
examples:
  pendu-tui methods
  pendu-tui methods --json | jq '.methods[] | select(.symplectic) | .key'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    """List the methods."""
    from engine.run.compiled import COMPILED_FROM, available

    methods = _measured()
    if options.json:
        write_json("methods", {"methods": methods, "compiled": available()})
        return Exit.FINE
    print_table(
        "lrrrllrrl",
        ("method", "order", "measured", "forces", "symplectic", "reversible", "z limit", "measured", "also called"),
        (
            (
                method["key"],
                str(method["order"]),
                f"{method['measured_order']:.3f}",
                str(method["force_evaluations"]),
                "yes" if method["symplectic"] else "no",
                "yes" if method["reversible"] else "no",
                _limit(method["linear_limit"]),
                _limit(method["measured_linear_limit"]),
                ", ".join(method["other_names"]),
            )
            for method in methods
        ),
    )
    print(
        "\nOrders are of theta over one swing of the scene drift; forces are evaluated per step; z = h·w0,"
        "\nand its limit is the linear oscillator's: pendu-tui stability tells the pendulum's."
        "\n"
        + (f"Numba: used in runs of {COMPILED_FROM:,} steps and more." if available() else "Numba is not installed.")
    )
    return Exit.FINE


def _limit(z: float) -> str:
    return f"{z:.3f}" if z else "none"


def _measured() -> list[dict[str, Any]]:
    """The methods with the order that their errors show on the default scene, and their limit by bisection."""
    from engine.accuracy.study import orders
    from engine.stability.linear import linear_limit

    return [
        _claims(method) | {"measured_order": order, "measured_linear_limit": linear_limit(method.step)}
        for method, order in orders(DEFAULT_SCENE, math.inf)
    ]


def _claims(method: Method) -> dict[str, Any]:
    return {
        "key": method.key,
        "label": method.label,
        "letter": method.letter,
        "formula": method.formula,
        "order": method.order,
        "force_evaluations": method.force_evaluations,
        "symplectic": method.symplectic,
        "reversible": method.reversible,
        "linear_limit": method.linear_limit,
        "other_names": method.other_names,
        "reference": method.reference,
        "used": method.used,
    }
