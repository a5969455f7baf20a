"""Compare two recordings: what was done, the first different number, and the errors."""

import argparse
from operator import itemgetter
from typing import Any

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.options import add_recording, resolve
from tui.cli.report import Column, Report, Table, add_report_options, form_of, warn

EXAMPLES = """\
examples:
  pendu-tui diff drift latest
  pendu-tui diff before.mcap after.mcap --json

Exit 0: identical; 1: something differs; 3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "a", metavar="A")
    add_recording(parser, "b", metavar="B")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from recordings.diff import compare
    from recordings.recording import Recording

    with Recording.open(resolve(options.a)) as a, Recording.open(resolve(options.b)) as b:
        found = compare(a, b)
    for recording in (a, b):
        if recording.reason:
            warn(f"{printable(str(recording.path))}: {recording.reason}; the rest is compared.")
    title = "identical"
    code = Exit.FINE
    if not found["identical"]:
        title = "{samples} samples at equal times; {only_in_a} only in A, {only_in_b} only in B"
        code = Exit.CHECK_FAILED
    notes: list[Any] = []
    if found["first"]:
        place = (
            "first in {field} of {method} at run {run}, t = {t:g} s, step {step_a} of A and "
            "{step_b} of B: {a!r} and {b!r}"
        )
        notes.append(place.format(**found["first"]))
    if found["done"]:
        heads = enumerate(("done differently", "A", "B"))
        notes.append(Table([Column(head, itemgetter(at)) for at, head in heads], found["done"]))
    Report(
        name="diff",
        title=title.format(**found),
        columns=(
            Column("largest energy error", "method"),
            Column("A", "a", ".2e"),
            Column("B", "b", ".2e"),
        ),
        rows=[{"method": method, **errors} for method, errors in found["errors"].items()],
        notes=notes,
        fields=found,
    ).show(form_of(options))
    return code
