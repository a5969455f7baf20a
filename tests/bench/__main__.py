"""Measure what the project promises: one JSON object with each figure beside its limit.

python -m tests.bench                     # all, hours
python -m tests.bench kill peers          # these
python -m tests.bench kill --share 0.1    # a tenth of the attempts

A bench is a module with `measure(share)`, which returns figures, and LIMITS, the largest values
allowed for some of them.  The exit code is 1 if a figure is above its limit.
"""

import argparse
import json
import sys
import time
from importlib import import_module
from typing import Any

BENCHES = ("foreign", "judging", "kill", "peers", "yardstick")


def report(name: str, share: float) -> tuple[dict[str, Any], bool]:
    """Return the figures of a bench beside their limits, and whether all keep them."""
    bench = import_module(f"tests.bench.{name}")
    began = time.monotonic()
    figures = bench.measure(share)
    figures["seconds"] = round(time.monotonic() - began, 1)
    limits = {key: {"found": figures[key], "limit": limit} for key, limit in bench.LIMITS.items()}
    return figures | limits, all(each["found"] <= each["limit"] for each in limits.values())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], prog="tests.bench")
    parser.add_argument("benches", nargs="*", help=f"of {', '.join(BENCHES)}")
    parser.add_argument("--share", type=float, default=1.0, help="of the attempts (default: 1)")
    options = parser.parse_args()
    reports = {}
    exit_code = 0
    for name in options.benches or BENCHES:
        print(name, file=sys.stderr)
        reports[name], passes = report(name, options.share)
        exit_code |= not passes
    print(json.dumps(reports, indent=1))
    return exit_code


if __name__ == "__main__":
    sys.exit(main())
