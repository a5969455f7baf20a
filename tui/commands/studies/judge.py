"""Judge the energies of another program, from a file or stdin: does its integrator gain or lose energy?

The table may be a CSV, a GROMACS .xvg, a LAMMPS log or the like; rows that cannot be used are counted.  Errors are
relative to the first energy, and trends are per unit of the time column: per second if that is in seconds.
"""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from recordings.errors import printable
from tui.cli.columns import REASONS, Columns, read_columns
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import parse
from tui.cli.junit import Check, write_junit
from tui.cli.options import Suggestions, add_file, positive
from tui.cli.output import fields_of, warn, write_json
from tui.words.numbers import counted

if TYPE_CHECKING:
    from engine.run.energies import Finding

EXAMPLES = """\
examples:
  pendu-tui judge energy.csv --time t --energy total
  pendu-tui judge energy.xvg --time 1 --energy "Total Energy" --fail-if 'verdict != bounded'
  pendu-tui judge log.lammps --time Step --energy TotEng --junit judge.xml
  ./game --headless | pendu-tui judge - --time 1 --energy 4 --fail-if 'max_energy_error > 1e-2'

verdicts: bounded; grows; loses; caught (left its start, stays at another level); wanders; too early.
They follow from the energies alone. run, which knows the method and its step, may say it otherwise for a while: an
energy that grew and stopped is caught here at once, and there after 4096 steps.
Energies that end in nan or inf are called grows, and fail every check.
"""

FIELDS = ("max_energy_error", "trend_per_second")
"""What --fail-if compares, besides the verdict."""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_file(parser, "file", metavar="FILE", help="a table of times and energies; - for stdin")
    parser.add_argument("--time", metavar="COLUMN", required=True, help="the column of times, by name or number from 1")
    parser.add_argument("--energy", metavar="COLUMN", required=True, help="the column of total energies, likewise")
    parser.add_argument(
        "--scale", metavar="ENERGY", type=positive, help="errors are relative to this energy (default: the first one)"
    )
    parser.add_argument(
        "--fail-if",
        metavar="EXPR",
        choices=Suggestions((*FIELDS, "verdict")),
        help=f"exit 1 if the expression is true, e.g. {FIELDS[0]} > 1e-3 (also {FIELDS[1]}, verdict)",
    )
    add_file(parser, "--junit", metavar="FILE", type=Path, help="also write the check as JUnit XML, over an older FILE")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    gate = None if options.fail_if is None else parse(options.fail_if, fields=FIELDS)
    with _input(options.file) as lines:
        columns = read_columns(lines, options.time, options.energy)
    if not columns.times:
        raise UserError(f"no row has a usable time and energy{_skipped(columns)}.", Exit.INPUT_UNREADABLE)
    if columns.skipped["time_not_later"] > len(columns.times):
        raise UserError(
            "most rows are not later than the row before: there seem to be several runs or methods in this table;"
            " judge one of them, for example filtered with grep.",
            Exit.INPUT_UNREADABLE,
        )
    import numpy as np

    from engine.run.energies import judge

    times, energies = np.asarray(columns.times), np.asarray(columns.energies)
    if energies[0] == 0 and options.scale is None:
        raise UserError("the first energy is 0, and errors are relative to it; give a typical one with --scale.")
    finding = judge(times, energies, options.scale, columns.diverged_at is not None)
    fields = _fields(options, columns, finding)
    if options.json:
        write_json("judge", fields)
    else:
        print("\n".join(_lines(fields, columns, finding)))
    failed = gate is not None and gate({"": fields})
    if options.junit:
        check = f"{options.energy}: {options.fail_if or 'no check'}"
        failure = f"the check failed: {options.fail_if}" if failed else None
        said = "; ".join(_lines(fields, columns, finding))
        write_junit(options.junit, f"pendu-tui judge {options.file}", [Check(check, said, failure)])
    if failed:
        warn(f"the check failed: {options.fail_if}")
        return Exit.CHECK_FAILED
    return Exit.FINE


@contextmanager
def _input(name: str) -> Iterator[TextIO]:
    """The lines of a file or of stdin, as UTF-8.  Raises UserError if it cannot be read."""
    try:
        source = 0 if name == "-" else name
        with open(source, encoding="utf-8-sig", errors="replace", closefd=source != 0) as stream:
            yield stream
    except OSError as error:
        raise UserError(f"{printable(name)}: {error.strerror or error}.", Exit.INPUT_UNREADABLE) from None


def _fields(options: argparse.Namespace, columns: Columns, finding: "Finding") -> dict[str, Any]:
    forecast = finding.forecast
    return {
        "file": options.file,
        "verdict": finding.verdict,
        "trend_per_second": finding.slope,
        "uncertainty": finding.uncertainty,
        "max_energy_error": finding.max_error,
        "energy_error": finding.last_error,
        "first_energy": columns.energies[0],
        "scale": abs(columns.energies[0]) if options.scale is None else options.scale,
        "samples": len(columns.times),
        "first_time": columns.times[0],
        "last_time": columns.times[-1],
        "diverged_at": columns.diverged_at,
        "forecast": None if forecast is None else fields_of(forecast, "time", "low", "high"),
        "skipped": columns.skipped,
    }


def _lines(fields: dict[str, Any], columns: Columns, finding: "Finding") -> list[str]:
    """The result for people."""
    name = "stdin" if fields["file"] == "-" else printable(fields["file"])
    many = counted(fields["samples"], "sample")
    span = f"from time {fields['first_time']:g} to {fields['last_time']:g}"
    lines = [f"{name}: {many} {span}{_skipped(columns)}", f"verdict       {finding.verdict}"]
    if columns.diverged_at is not None:
        lines.append(f"failed        the energies are nan or inf from time {columns.diverged_at:g} on")
    if finding.slope is not None:
        lines.append(f"trend         {finding.slope:+.2e} ± {finding.uncertainty:.0e} per unit of time")
    lines.append(f"energy error  {finding.last_error:+.2e} at the end, {finding.max_error:.2e} at most")
    if ahead := finding.forecast:
        lines.append(f"forecast      {ahead.low:+.1e} to {ahead.high:+.1e} at time {ahead.time:g}, if the trend stays")
    return lines


def _skipped(columns: Columns) -> str:
    """How many lines were not used, and why."""
    reasons = [f"{count} {REASONS[why]}" for why, count in columns.skipped.items() if count]
    total = sum(columns.skipped.values())
    return f"; {counted(total, 'row')} skipped ({', '.join(reasons)})" if reasons else ""
