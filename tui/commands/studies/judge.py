"""Judge the energies of another program: does its integrator gain or lose energy?

The table may be a CSV, a GROMACS .xvg, a log of LAMMPS or Amber, JSON lines, an .npz or the like.
Units in its heads, such as Time (ps), are those of the answer.
"""

import argparse
import math
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedReader
from typing import Any

from engine.run.judgement import DEFINITIONS, FALSE_ALARMS
from recordings.errors import printable
from tui.cli.columns import LATEST, REASONS, Table, read_table
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import parse
from tui.cli.junit import Check, add_check_options, conclude
from tui.cli.options import add_file, count, positive
from tui.cli.report import Report, add_report_options, form_of
from tui.commands.studies.reports.energies import judged, lines_of, orders, title_of

EXAMPLES = """\
examples:
  pendu-tui judge energy.csv --time t --energy total
  pendu-tui judge energy.xvg --time 1 --energy "Total Energy" --fail-if 'verdict != bounded'
  pendu-tui judge log.lammps --time Step --energy KinEng+PotEng --scale std --junit judge.xml
  pendu-tui judge md.csv --time 'Time (ps)' --energy total --atoms 648 --temperature 300
  pendu-tui judge a.csv b.csv --steps 1,2 --time t --energy E --fail-if 'fluctuation_order < 1.8'
  ./game --headless | pendu-tui judge - --time 1 --energy 4 --fail-if 'max_energy_error > 1e-2'

verdicts, and how many of 100 are wrong on series made with a known truth:
""" + "\n".join(
    f"  {verdict}: {text}" + (f" ({FALSE_ALARMS[verdict]})" if verdict in FALSE_ALARMS else "")
    for verdict, text in DEFINITIONS.items()
    if verdict != "chaotic"
)

FIELDS = (
    "max_energy_error",
    "trend",
    "absolute_trend",
    "fluctuation",
    "energy_per_ns_per_atom",
    "kt_per_ns_per_atom",
    "samples",
    "skipped",
    "independent_samples",
    "fluctuation_order",
    "drift_order",
)
"""The fields that --fail-if compares, besides the verdict."""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_file(
        parser,
        "files",
        metavar="FILE",
        nargs="+",
        help="a table of times and energies; - for stdin",
    )
    add = parser.add_argument
    times = "the column of times, by name or number from 1"
    add("--time", metavar="COLUMN", required=True, help=times)
    energies = "the column of total energies, or several joined by +"
    add("--energy", metavar="COLUMN", required=True, help=energies)
    add("--table", metavar="N", type=count, help="judge table N (default: the last one)")
    start = "judge from time T on"
    add("--from", metavar="T", dest="start", type=float, default=-LATEST, help=start)
    scale = "errors are relative to first, std, kinetic:COLUMN, or a number"
    add("--scale", default="first", help=scale)
    add("--atoms", metavar="N", type=count, help="give the trend per ns and atom")
    add("--temperature", metavar="K", type=positive, help="give it in kT, too")
    steps = "the step sizes of the files: how do the errors follow them?"
    add("--steps", metavar="H,H", help=steps)
    names = (*FIELDS, "verdict")
    meaning = f"exit 1 if the expression is true; fields: {', '.join(names)}"
    add_check_options(parser, names, meaning)
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    gate = None if options.fail_if is None else parse(options.fail_if, fields=FIELDS)
    steps = _steps(options)
    scale = _scale(options.scale)
    results = [_judge(name, options, scale) for name in options.files]
    shared = orders(steps, results) if steps else {}
    lines: list[tuple[str, str]] = []
    for fields in results:
        lines += [("file", title_of(fields))] if steps else []
        lines += lines_of(fields)
    for name, order in shared.items():
        text = "none that stands out at each step" if order is None else f"goes as h^{order:.2f}"
        lines.append((name.removesuffix("_order"), text))
    Report(
        name="judge",
        title="" if steps else title_of(results[0]),
        notes=[f"{name:<13} {text}" for name, text in lines],
        fields={"steps": steps, "files": results, **shared} if steps else results[0],
    ).show(form_of(options))
    found = []
    if gate is not None:
        for fields in results:
            skipped = sum(fields["skipped"].values())  # rows, for whatever reason
            found.append(gate({"": fields | shared | {"skipped": skipped}}))
    check = Check(
        f"{options.energy}: {options.fail_if or 'no check'}",
        "; ".join(map(" ".join, lines)),
        "; ".join(dict.fromkeys(filter(None, found))) or None,
    )
    code = conclude(options, f"pendu-tui judge {' '.join(options.files)}", [check])
    failed = any(fields["verdict"] == "failed" for fields in results)
    return Exit.CHECK_FAILED if failed else code


def _steps(options: argparse.Namespace) -> list[float]:
    """Return the step sizes of the files, if they are given."""
    if options.steps is None:
        if len(options.files) > 1:
            raise UserError(
                "several files are judged together with --steps, for example --steps 1,2."
            )
        return []
    try:
        steps = [float(text) for text in options.steps.split(",")]
    except ValueError:
        steps = []
    if (
        len(steps) != len(options.files)
        or len(set(steps)) < 2
        or not all(0 < h < math.inf for h in steps)
    ):
        raise UserError(
            "--steps takes a step size for each of two or more files, for example --steps 1,2."
        )
    return steps


def _scale(text: str) -> float | str:
    """Return a number, first, std, or the name of a column after kinetic: ."""
    if text in ("first", "std") or text.startswith("kinetic:"):
        return text
    try:
        return positive(text)
    except (argparse.ArgumentTypeError, ValueError):
        name = repr(printable(text, 40))
        raise UserError(
            f"--scale {name} is none of first, std, kinetic:COLUMN and a positive number."
        ) from None


def _judge(name: str, options: argparse.Namespace, scale: float | str) -> dict[str, Any]:
    """Return the result for one file."""
    wanted = [options.time, options.energy]
    if isinstance(scale, str) and scale.startswith("kinetic:"):
        wanted.append(scale.partition(":")[2])
    with _input(name) as stream:
        table = read_table(stream, wanted, options.table, options.start)
    _check(table)
    return {"file": name, **judged(table, scale, options.atoms, options.temperature)}


def _check(table: Table) -> None:
    """Raise UserError if there is nothing to judge, or several methods in one."""
    rows = len(table.columns[0])
    if table.skipped["time_not_later"] > rows:
        raise UserError(
            "most rows are not later than the row before: there seem to be several methods in this"
            " table; judge one of them, for example filtered with grep.",
            Exit.INPUT_UNREADABLE,
        )
    if rows == 0:
        rows_skipped = ", ".join(
            f"{number} {REASONS[why]}" for why, number in table.skipped.items() if number
        )
        raise UserError(
            f"no row has a usable time and energy; skipped: {rows_skipped}.", Exit.INPUT_UNREADABLE
        )


@contextmanager
def _input(name: str) -> Iterator[BufferedReader]:
    """The bytes of a file or of stdin.  Raises UserError if it cannot be read."""
    source = 0 if name == "-" else name
    try:
        with open(source, "rb", closefd=source != 0) as stream:
            yield stream
    except OSError as error:
        raise UserError(
            f"{printable(name)}: {error.strerror or error}.", Exit.INPUT_UNREADABLE
        ) from None
    except MemoryError:
        raise UserError(
            f"{printable(name)} does not fit into memory.", Exit.INPUT_UNREADABLE
        ) from None
