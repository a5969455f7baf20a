"""Judge the energies of another program: does its integrator gain or lose energy?

The table may be a CSV, a GROMACS .xvg, a log of LAMMPS or Amber, JSON lines, an .npz or the like.
Units in its heads, such as Time (ps), are those of the answer.
"""

import argparse
import math

from engine.run.judgement import DEFINITIONS, FALSE_ALARMS
from tui.cli.checks import Check, add_check_options, conclude, parse
from tui.cli.errors import Exit, UserError
from tui.cli.options import add_file, count, positive
from tui.cli.report import Report, add_report_options, form_of

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
    *("max_energy_error", "trend", "absolute_trend", "fluctuation"),
    *("energy_per_ns_per_atom", "kt_per_ns_per_atom", "samples", "skipped"),
    *("independent_samples", "fluctuation_order", "drift_order"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    table = "a table of times and energies; - for stdin"
    add_file(parser, "files", metavar="FILE", nargs="+", help=table)
    add = parser.add_argument
    times = "the column of times, by name or number from 1"
    add("--time", metavar="COLUMN", required=True, help=times)
    energies = "the column of total energies, or several joined by +"
    add("--energy", metavar="COLUMN", required=True, help=energies)
    add("--table", metavar="N", type=count, help="judge table N (default: the last one)")
    start = "judge from time T on"
    add("--from", metavar="T", dest="start", type=float, default=-math.inf, help=start)
    relative = "errors are relative to first, std, kinetic:COLUMN, or a number"
    add("--scale", type=scale, default="first", help=relative)
    add("--atoms", metavar="N", type=count, help="give the trend per ns and atom")
    add("--temperature", metavar="K", type=positive, help="give it in kT, too")
    follow = "the step sizes of the files: how do the errors follow them?"
    add("--steps", metavar="H,H", type=steps, default=[], help=follow)
    names = (*FIELDS, "verdict")
    meaning = f"exit 1 if the expression is true; fields: {', '.join(names)}"
    add_check_options(parser, names, meaning)
    add_report_options(parser)


def scale(text: str) -> float | str:
    """Return a number, first, std, or the name of a column after kinetic: ."""
    if text in ("first", "std") or text.startswith("kinetic:"):
        return text
    try:
        return positive(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(
            f"{text[:40]!r} is none of first, std, kinetic:COLUMN and a positive number"
        ) from None


def steps(text: str) -> list[float]:
    return [positive(part) for part in text.split(",")]


def _check(options: argparse.Namespace) -> None:
    steps = options.steps
    are_fit = len(set(steps)) > 1 and len(steps) == len(options.files)
    if (steps or len(options.files) > 1) and not are_fit:
        raise UserError(
            "several files take --steps, a step size for each, for example --steps 1,2."
        )
    if options.temperature is not None and options.atoms is None:
        raise UserError("--temperature belongs to --atoms: give the number of atoms, too.")


def run(options: argparse.Namespace) -> int:
    from tui.commands.studies.energies import judge, lines_of, orders, title_of

    gate = None if options.fail_if is None else parse(options.fail_if, fields=FIELDS)
    _check(options)
    results = [judge(name, options) for name in options.files]
    shared = orders(options.steps, results) if options.steps else {}
    lines: list[tuple[str, str]] = []
    for fields in results:
        lines += [("file", title_of(fields))] if shared else []
        lines += lines_of(fields)
    for name, order in shared.items():
        text = "none that stands out at each step" if order is None else f"goes as h^{order:.2f}"
        lines.append((name.removesuffix("_order"), text))
    together = {"steps": options.steps, "files": results, **shared}
    Report(
        name="judge",
        title="" if shared else title_of(results[0]),
        notes=[f"{name:<13} {text}" for name, text in lines],
        fields=together if shared else results[0],
    ).show(form_of(options))
    failures: dict[str, None] = {}
    if gate:
        for fields in results:
            skipped = sum(fields["skipped"].values())  # rows, for whatever reason
            failures[gate({"": fields | shared | {"skipped": skipped}})] = None
    check = Check(
        f"{options.energy}: {options.fail_if or 'no check'}",
        "; ".join(map(" ".join, lines)),
        "; ".join(filter(None, failures)) or None,
    )
    code = conclude(options, f"pendu-tui judge {' '.join(options.files)}", [check])
    failed = any(fields["verdict"] == "failed" for fields in results)
    return Exit.CHECK_FAILED if failed else code
