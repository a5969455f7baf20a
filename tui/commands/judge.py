"""Judge the energies of another program: does its integrator gain or lose energy?

The table may be a CSV, a GROMACS .xvg, a log of LAMMPS or Amber, JSON lines, an .npz or the like.
Units in its heads, such as Time (ps), are those of the answer.
"""

import argparse
import math
from collections.abc import Sequence
from statistics import linear_regression
from typing import TYPE_CHECKING, Any

from engine.run.judge import Judge
from engine.run.judgement import DEFINITIONS, FALSE_ALARMS, Progress
from recordings.errors import printable
from tui.cli.checks import Check, add_check_options, conclude, parse
from tui.cli.errors import Exit, UserError
from tui.cli.options import add_file, count, positive
from tui.cli.report import Report, add_report_options, form_of
from tui.words.numbers import counted

if TYPE_CHECKING:
    from tui.cli.columns import Table

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


MAX_ERROR = 1e300  # JSON has no infinity
NANOSECONDS = {"fs": 1e-6, "ps": 1e-3, "ns": 1.0, "us": 1e3, "µs": 1e3, "ms": 1e6, "s": 1e9}
BOLTZMANN = {  # in the unit a kelvin; the 2019 SI
    "ev": 8.617333262e-5,
    "mev": 8.617333262e-2,
    **dict.fromkeys(("kj/mol", "kj/mole"), 8.31446261815324e-3),
    **dict.fromkeys(("kcal/mol", "kcal/mole"), 1.987204258640832e-3),
    **dict.fromkeys(("hartree", "ha", "a.u.", "au"), 3.166811563e-6),
    "j": 1.380649e-23,
    "k": 1.0,
}


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
    gate = None
    if options.fail_if is not None:
        gate = parse(options.fail_if, fields=FIELDS)
    _check(options)
    results = [judge(name, options) for name in options.files]
    fields = results[0]
    title = title_of(fields)
    lines = lines_of(fields)
    shared: dict[str, float | None] = {}
    if options.steps:
        shared = orders(options.steps, results)
        fields = {"steps": options.steps, "files": results, **shared}
        title = ""
        lines = [line for each in results for line in (("file", title_of(each)), *lines_of(each))]
        for name, order in shared.items():
            text = "none that stands out at each step"
            if order is not None:
                text = f"goes as h^{order:.2f}"
            lines.append((name.removesuffix("_order"), text))
    notes = [f"{name:<13} {text}" for name, text in lines]
    Report(name="judge", title=title, notes=notes, fields=fields).show(form_of(options))
    failures: dict[str, None] = {}
    if gate:
        for each in results:
            skipped = sum(each["skipped"].values())  # rows, for whatever reason
            failures[gate({"": each | shared | {"skipped": skipped}})] = None
    check = Check(
        f"{options.energy}: {options.fail_if or 'no check'}",
        "; ".join(map(" ".join, lines)),
        "; ".join(filter(None, failures)) or None,
    )
    code = conclude(options, f"pendu-tui judge {' '.join(options.files)}", [check])
    if any(each["verdict"] == "failed" for each in results):
        return Exit.CHECK_FAILED
    return code


def judge(name: str, options: argparse.Namespace) -> dict[str, Any]:
    """Return the fields of the result for one file; - is stdin.  Raises UserError."""
    import numpy as np

    table = _read(name, options)
    times, energies, *_ = map(np.asarray, table.columns)
    # a deviation has no zero of energy
    is_absolute = options.scale != "std"
    found = Judge.read(times, energies, failed=table.failed_at is not None, absolute=is_absolute)
    rest = energies[found.first :]
    size = _size(table, rest, options.scale)
    with np.errstate(over="ignore"):
        errors = np.clip((rest - rest[0]) / size, -MAX_ERROR, MAX_ERROR)
    fields = {
        "file": name,
        "table": table.number,
        "tables": table.count,
        "verdict": found.verdict,
        "progress": found.progress and found.progress._asdict(),
        "transient": found.transient,
        **_trend(table, found.slope, found.uncertainty, size),
        "independent_samples": found.independent,
        "fluctuation": found.fluctuation,
        "max_energy_error": float(np.abs(errors).max()),
        "energy_error": float(errors[-1]),
        "first_energy": float(rest[0]),
        "scale": size,
        "samples": len(times),
        "first_time": float(times[0]),
        "last_time": float(times[-1]),
        "diverged_at": table.failed_at,
        "skipped": table.skipped,
    }
    if options.atoms is not None:
        fields |= _per_atom(fields, options.atoms, options.temperature)
    return fields


def _read(name: str, options: argparse.Namespace) -> "Table":
    """Return the table of a file.  Raises UserError if it has nothing to judge."""
    from tui.cli.columns import read_table

    wanted = [options.time, options.energy]
    if str(options.scale).startswith("kinetic:"):
        wanted.append(options.scale.partition(":")[2])
    source = 0 if name == "-" else name
    try:
        with open(source, "rb", closefd=source != 0) as stream:
            table = read_table(stream, wanted, options.table, options.start)
    except OSError as error:
        why = f"{printable(name)}: {error.strerror or error}."
        raise UserError(why, Exit.INPUT_UNREADABLE) from None
    rows = len(table.columns[0])
    if table.skipped["time_not_later"] > rows:
        raise UserError(
            "most rows are not later than the row before: there seem to be several methods in this"
            " table; judge one of them, for example filtered with grep.",
            Exit.INPUT_UNREADABLE,
        )
    if rows == 0:
        why = f"no row has a usable time and energy; skipped: {', '.join(_skipped(table.skipped))}."
        if table.failed_at is not None:
            why += f" Judge from a later time than {table.failed_at:g} on with --from."
        raise UserError(why, Exit.INPUT_UNREADABLE)
    return table


def _skipped(skipped: dict[str, int]) -> list[str]:
    from tui.cli.columns import REASONS

    return [f"{counted(number, 'row')} {REASONS[why]}" for why, number in skipped.items() if number]


def _size(table: "Table", energies: Any, scale: float | str) -> float:
    if isinstance(scale, float):
        return scale
    if scale == "first":
        what = "first energy"
        size = abs(float(energies[0]))
    elif scale == "std":
        what = "deviation"
        largest = abs(energies).max() or 1.0
        size = float((energies / largest).std() * largest)  # squares must not overflow
    else:
        what = "mean kinetic energy"
        size = abs(sum(table.columns[2]) / len(table.columns[2]))
    if not 0 < size < math.inf:
        raise UserError(
            f"the {what} is 0, and errors are relative to it; give a typical one with --scale."
        )
    return size


def _trend(
    table: "Table", slope: float | None, uncertainty: float | None, size: float
) -> dict[str, Any]:
    """Return the trend, absolute and relative to a size, with units."""
    time_unit, energy_unit = (printable(unit, 20) for unit in table.units[:2])
    if time_unit.casefold() in NANOSECONDS:
        time_unit = time_unit.casefold()
    fields: dict[str, Any] = {
        "time_unit": time_unit,
        "energy_unit": energy_unit,
        "trend": None,
        "uncertainty": None,
        "trend_unit": time_unit and f"1/{time_unit}",
        "absolute_trend": None,
        "absolute_uncertainty": None,
    }
    if slope is not None and uncertainty is not None:
        relative = {"trend": slope / size, "uncertainty": uncertainty / size}
        if abs(relative["trend"]) + relative["uncertainty"] < MAX_ERROR:
            fields |= relative
            fields |= {"absolute_trend": slope, "absolute_uncertainty": uncertainty}
    return fields


def _per_atom(fields: dict[str, Any], atoms: int, temperature: float | None) -> dict[str, Any]:
    time_unit = fields["time_unit"]
    energy_unit = fields["energy_unit"].casefold()
    if time_unit not in NANOSECONDS:
        raise UserError(
            "--atoms needs the unit of the times in the head of the column, such as Time (ps); "
            f"units: {', '.join(NANOSECONDS)}."
        )
    each = fields["absolute_trend"] and fields["absolute_trend"] / NANOSECONDS[time_unit] / atoms
    found = {"atoms": atoms, "energy_per_ns_per_atom": each}
    if temperature is None:
        return found
    if energy_unit not in BOLTZMANN:
        raise UserError(
            "--temperature needs the unit of the energies in the head of the column, such as E "
            f"(eV); units: {', '.join(BOLTZMANN)}."
        )
    in_kt = each and each / (BOLTZMANN[energy_unit] * temperature)
    return found | {"temperature": temperature, "kt_per_ns_per_atom": in_kt}


def orders(steps: Sequence[float], results: Sequence[dict[str, Any]]) -> dict[str, float | None]:
    """Return the powers of the step size with which fluctuation and drift go.

    A drift that is not significant at each step size has no order.
    """
    found = {"fluctuation_order": _power(steps, [fields["fluctuation"] for fields in results])}
    found["drift_order"] = None
    if all(fields["verdict"] in ("grows", "loses") for fields in results):
        found["drift_order"] = _power(steps, [fields["absolute_trend"] for fields in results])
    return found


def _power(steps: Sequence[float], values: Sequence[float | None]) -> float | None:
    """Return the slope of log |value| over log step by least squares; None if one is unknown."""
    sizes = [abs(value) for value in values if value]
    if len(sizes) < len(steps):
        return None
    return linear_regression([*map(math.log, steps)], [*map(math.log, sizes)]).slope


def title_of(fields: dict[str, Any]) -> str:
    span = f"from {fields['first_time']:g} to {fields['last_time']:g}{_unit(fields, 'time')}"
    name = {"-": "stdin"}.get(fields["file"]) or printable(fields["file"])
    text = f"{name}: {counted(fields['samples'], 'sample')} {span}"
    if fields["tables"] > 1:
        text += f", table {fields['table']} of {fields['tables']}"
    if skipped := _skipped(fields["skipped"]):
        text += f"; skipped: {', '.join(skipped)}"
    return text


def _unit(fields: dict[str, Any], name: str) -> str:
    unit = fields[f"{name}_unit"]
    return unit and f" {unit}"


def lines_of(fields: dict[str, Any]) -> list[tuple[str, str]]:
    time_unit = _unit(fields, "time")
    energy_unit = _unit(fields, "energy")
    verdict = fields["verdict"]
    if progress := fields["progress"]:
        verdict += f": {Progress(**progress)}"
    if fields["diverged_at"] is not None:
        verdict += f": the energy is nan or inf at {fields['diverged_at']:g}{time_unit}"
    if fields["transient"]:
        verdict += f", after a transient of {fields['transient']:.3g}{time_unit}"
    lines = [("verdict", verdict)]
    if fields["trend"] is not None:
        per = f"per {fields['time_unit'] or 'unit of time'}"
        relative = f"relative {fields['trend']:+.2e} ± {fields['uncertainty']:.0e} {per}"
        size = f"{fields['absolute_trend']:+.2e} ± {fields['absolute_uncertainty']:.0e}"
        lines.append(("trend", f"{relative}, absolute {size}{energy_unit} {per}"))
    if (each := fields.get("energy_per_ns_per_atom")) is not None:
        text = f"{each:+.2e}{energy_unit} per ns"
        if (in_kt := fields.get("kt_per_ns_per_atom")) is not None:
            text += f", {in_kt:+.2e} kT per ns"
        lines.append(("per atom", text))
    error = f"{fields['energy_error']:+.2e} at the end, {fields['max_energy_error']:.2e} at most"
    lines.append(("energy error", f"{error}, relative to {fields['scale']:.6g}{energy_unit}"))
    is_of_first = fields["scale"] == abs(fields["first_energy"])
    if is_of_first and fields["max_energy_error"] >= 1 and fields["verdict"] == "bounded":
        hint = "the energies lie around zero; --scale std compares errors with their spread"
        lines.append(("hint", hint))
    return lines
