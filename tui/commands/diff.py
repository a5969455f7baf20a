"""Compare two recordings: their inputs, the first number that differs, and the errors."""

import argparse
from typing import Any

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.options import add_recording, resolve
from tui.cli.report import Column, Report, Table, add_report_options, publish, warn

EXAMPLES = """\
examples:
  pendu-tui diff drift latest
  pendu-tui diff before.mcap after.mcap --json

Exit codes: 0 identical, 1 something differs, 3 one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "a", metavar="A")
    add_recording(parser, "b", metavar="B")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from recordings.diff import compare
    from recordings.recording import Recording

    with Recording.open(resolve(options.a)) as a, Recording.open(resolve(options.b)) as b:
        result = compare(a, b)
    for recording in (a, b):
        if recording.reason:
            warn(f"{printable(str(recording.path))}: {recording.reason}; the rest is compared.")
    title = "identical"
    code = Exit.FINE
    if not result["identical"]:
        title = "{samples} samples at equal times; {only_in_a} only in A, {only_in_b} only in B"
        code = Exit.CHECK_FAILED
    notes: list[Any] = []
    if result["first"]:
        place = (
            "first in {field} of {method} at run {run}, t = {t:g} s, step {step_a} of A and "
            "{step_b} of B: {a!r} and {b!r}"
        )
        notes.append(place.format(**result["first"]))
    if result["done"]:
        columns = Column("done differently", 0), Column("A", 1), Column("B", 2)
        notes.append(Table(columns, result["done"]))
    report = Report(
        name="diff",
        title=title.format(**result),
        columns=(
            Column("largest energy error", "method"),
            Column("A", "a", ".2e"),
            Column("B", "b", ".2e"),
        ),
        rows=[{"method": method, **errors} for method, errors in result["errors"].items()],
        notes=notes,
        fields=result,
    )
    publish(report, options)
    return code
