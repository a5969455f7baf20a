"""Compare two recordings: what was done, the first number that differs, and the errors side by side."""

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.options import add_recording
from tui.cli.output import progress, warn
from tui.cli.report import Column, Report, Table, add_report_options, form_of

if TYPE_CHECKING:
    from recordings.diff import Comparison, Difference

EXAMPLES = """\
examples:
  pendu-tui diff drift latest
  pendu-tui diff before.mcap after.mcap --json

Runs are paired by number, samples by simulated time.
Exit 0: identical; 1: something differs; 3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "a", metavar="A")
    add_recording(parser, "b", metavar="B", help="the other one")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    from recordings.diff import compare
    from recordings.library import resolve
    from recordings.recording import Recording

    paths = resolve(options.a), resolve(options.b)
    with (
        progress(" and ".join(printable(path.name) for path in paths)) as show,
        Recording.open(paths[0], progress=show) as a,
        Recording.open(paths[1], progress=show) as b,
    ):
        result = compare(a, b, show)
    for recording in (a, b):
        if recording.reason:
            warn(f"{printable(str(recording.path))}: {recording.reason}; the rest is compared.")
    _report(result).show(form_of(options))
    return Exit.FINE if result.identical else Exit.CHECK_FAILED


def _report(result: "Comparison") -> Report:
    title = f"{result.samples} samples at equal times, {result.different} different"
    title += f"; {result.only_in_a} only in A, {result.only_in_b} only in B"
    rows = [{"method": key, **errors} for key, errors in result.errors.items()]
    notes: list[Any] = [_first(result.first)] if result.first else []
    if result.done:
        columns = (Column("done differently", "at"), Column("A", "a"), Column("B", "b"))
        notes.append(
            Table(columns, [dict(zip(("at", "a", "b"), each, strict=True)) for each in result.done])
        )
    return Report(
        name="diff",
        title="identical" if result.identical else title,
        columns=(
            Column("largest error", "method"),
            Column("A", "a", ".2e"),
            Column("B", "b", ".2e"),
            Column("theta apart", "theta_difference", ".2e"),
            Column("at t [s]", "t", "g"),
        ),
        rows=rows,
        fields={
            **asdict(result),
            "identical": result.identical,
            "first": result.first and result.first._asdict(),
        },
        notes=notes,
    )


def _first(first: "Difference") -> str:
    place = f"run {first.run}, t = {first.t:g} s, step {first.step_a} of A and {first.step_b} of B"
    return f"first in {first.field} of {first.method} at {place}: {first.a!r} and {first.b!r}"
