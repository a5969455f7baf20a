"""Judge the energies of another program: does its integrator gain or lose energy?

A table is a CSV, a GROMACS .xvg, a log of LAMMPS or Amber, JSON lines, an .npz or the like.
Results have the units in its heads, such as Time (ps).  A verdict of failed is exit code 1.
"""

import argparse
import math
from collections.abc import Sequence
from statistics import linear_regression
from typing import TYPE_CHECKING, Any

from pendu_tui.engine.run.verdicts import CHAOTIC, FAILED, LEAVES, VERDICTS, Progress
from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.checks import Check, add_gate_option, conclude, parse
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import add_file, count, positive
from pendu_tui.tui.cli.report import Report, add_report_options, fields_of, publish
from pendu_tui.tui.words.numbers import counted

if TYPE_CHECKING:
    from pendu_tui.tui.cli.columns import Table

EXAMPLES = """\
examples:
  pendu-tui judge energy.csv --time t --energy total
  pendu-tui judge energy.xvg --time 1 --energy "Total Energy" --fail-if 'verdict != bounded'
  pendu-tui judge log.lammps --time Step --energy KinEng+PotEng --scale std
  pendu-tui judge md.csv --time 'Time (ps)' --energy total --atoms 648 --temperature 300
  pendu-tui judge a.csv b.csv --steps 1,2 --time t --energy E --fail-if 'fluctuation_order < 1.8'
  ./game --headless | pendu-tui judge - --time 1 --energy 4 --fail-if 'max_energy_error > 1e-2'

verdicts:
""" + "\n".join(
    f"  {each.word}: {each.meaning}" for each in VERDICTS.values() if each.word != CHAOTIC
)

FIELDS = (
    *("max_energy_error", "trend", "absolute_trend", "fluctuation"),
    *("energy_per_ns_per_atom", "kt_per_ns_per_atom", "samples", "skipped"),
    *("independent_samples", "fluctuation_order", "drift_order"),
)
MAX_ERROR = 1e300  # JSON has no infinity
NANOSECONDS = {"fs": 1e-6, "ps": 1e-3, "ns": 1.0, "us": 1e3, "µs": 1e3, "ms": 1e6, "s": 1e9}
BOLTZMANN = {  # per kelvin, in the 2019 SI
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
    start = "ignore rows before time T"
    add("--from", metavar="T", dest="start", type=float, default=-math.inf, help=start)
    divisor = (
        "divide errors by the first energy (first), the standard deviation (std), the mean of a "
        "column (kinetic:COLUMN) or a number; default: first"
    )
    add("--scale", type=scale, default="first", help=divisor)
    add("--atoms", metavar="N", type=count, help="print the trend per ns and atom, too")
    add("--temperature", metavar="K", type=positive, help="with --atoms: and in kT")
    sizes = "the step size of each file, to see how the errors scale with it"
    add("--steps", metavar="H,H", type=steps, default=[], help=sizes)
    names = (*FIELDS, "verdict")
    meaning = f"exit with 1 if the expression is true; fields: {', '.join(names)}"
    add_gate_option(parser, names, meaning)
    add_report_options(parser)


def scale(text: str) -> float | str:
    """Return a number, or the text: first, std or kinetic:COLUMN."""
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
    lines = [line for result in results for line in lines_of(result)]
    fields = results[0]
    orders: dict[str, float | None] = {}
    if options.steps:
        orders = orders_of(options.steps, results)
        fields = {"steps": options.steps, "files": results, **orders}
        for name, order in orders.items():
            text = "no clear power of h" if order is None else f"goes as h^{order:.2f}"
            lines.append(_line(name.removesuffix("_order"), text))
    publish(Report(name="judge", notes=lines, fields=fields), options)
    failures: list[str] = []
    if gate:
        for result in results:
            skipped = sum(result["skipped"].values())  # rows, for whatever reason
            failures.append(gate({"": result | orders | {"skipped": skipped}}))
    failure = "; ".join(filter(None, dict.fromkeys(failures)))
    code = conclude(options.fail_if, [Check("", failure)])
    if any(result["verdict"] == FAILED for result in results):
        return Exit.CHECK_FAILED
    return code


def judge(name: str, options: argparse.Namespace) -> dict[str, Any]:
    """Return the fields of the result for one file; - is stdin.  Raises UserError."""
    import numpy as np

    from pendu_tui.engine.run.energies import judge_record

    table = _read(name, options)
    times, energies, *_ = map(np.asarray, table.columns)
    # relative to the standard deviation, no result may depend on the zero of energy
    is_absolute = options.scale != "std"
    judgement = judge_record(
        times, energies, failed=table.failed_at is not None, absolute=is_absolute
    )
    rest = energies[judgement.first :]
    size = _size(table, rest, options.scale)
    with np.errstate(over="ignore"):
        errors = np.clip((rest - rest[0]) / size, -MAX_ERROR, MAX_ERROR)
    fields = {
        "file": name,
        "table": table.number,
        "tables": table.count,
        **fields_of(judgement, "verdict", "transient", "fluctuation"),
        "progress": judgement.progress and judgement.progress._asdict(),
        **_trend(table, judgement.slope, judgement.uncertainty, size),
        "independent_samples": judgement.independent,
        "max_energy_error": float(np.abs(errors).max()),
        "energy_error": float(errors[-1]),
        "first_energy": float(rest[0]),
        "lowest_energy": float(rest.min()),
        "highest_energy": float(rest.max()),
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
    from pendu_tui.tui.cli.columns import read_table

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
            "most rows are not later than the row before, so this table seems to hold several "
            "methods; judge one of them, for example filtered with grep.",
            Exit.INPUT_UNREADABLE,
        )
    if rows == 0:
        why = f"no row has a usable time and energy; skipped: {', '.join(_skipped(table.skipped))}."
        if table.failed_at is not None:
            why += f" Use --from with a later time than {table.failed_at:g}."
        raise UserError(why, Exit.INPUT_UNREADABLE)
    return table


def _skipped(skipped: dict[str, int]) -> list[str]:
    from pendu_tui.tui.cli.columns import REASONS

    return [f"{counted(number, 'row')} {REASONS[why]}" for why, number in skipped.items() if number]


def _size(table: "Table", energies: Any, scale: float | str) -> float:
    """Return the energy by which errors are divided.  Raises UserError if it is 0."""
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
    trend = fields["absolute_trend"]
    time_unit = fields["time_unit"]
    energy_unit = fields["energy_unit"].casefold()
    if time_unit not in NANOSECONDS:
        raise UserError(
            "--atoms needs the unit of time in the column's head, such as Time (ps); units: "
            f"{', '.join(NANOSECONDS)}."
        )
    energy = trend and trend / NANOSECONDS[time_unit] / atoms
    result = {"atoms": atoms, "energy_per_ns_per_atom": energy}
    if temperature is None:
        return result
    if energy_unit not in BOLTZMANN:
        raise UserError(
            "--temperature needs the unit of energy in the column's head, such as E (eV); units: "
            f"{', '.join(BOLTZMANN)}."
        )
    in_kt = energy and energy / (BOLTZMANN[energy_unit] * temperature)
    return result | {"temperature": temperature, "kt_per_ns_per_atom": in_kt}


def orders_of(steps: Sequence[float], results: Sequence[dict[str, Any]]) -> dict[str, float | None]:
    """Return the powers of the step size with which fluctuation and drift scale.

    The drift has no order unless it is significant at each step size.
    """
    fluctuations = [fields["fluctuation"] for fields in results]
    drifts = [fields["absolute_trend"] for fields in results if fields["verdict"] in LEAVES]
    return {"fluctuation_order": _power(steps, fluctuations), "drift_order": _power(steps, drifts)}


def _power(steps: Sequence[float], values: Sequence[float | None]) -> float | None:
    """Return the slope of log |value| over log step, or None if a value is missing or 0."""
    logs = [math.log(abs(value)) for value in values if value]
    if len(logs) < len(steps):
        return None
    return linear_regression([math.log(step) for step in steps], logs).slope


def lines_of(fields: dict[str, Any]) -> list[str]:
    """Return the lines on one file."""
    time_unit = _spaced(fields["time_unit"])
    energy_unit = _spaced(fields["energy_unit"])
    verdict = fields["verdict"]
    if fields["progress"]:
        verdict += f": {Progress(**fields['progress'])}"
    if fields["diverged_at"] is not None:
        verdict += f": the energy is nan or inf at {fields['diverged_at']:g}{time_unit}"
    if fields["transient"]:
        verdict += f", after a transient of {fields['transient']:.3g}{time_unit}"
    lines = [_title(fields), _line("verdict", verdict)]
    if fields["trend"] is not None:
        per = f"per {fields['time_unit'] or 'unit of time'}"
        relative = f"relative {fields['trend']:+.2e} ± {fields['uncertainty']:.0e} {per}"
        absolute = f"{fields['absolute_trend']:+.2e} ± {fields['absolute_uncertainty']:.0e}"
        lines.append(_line("trend", f"{relative}, absolute {absolute}{energy_unit} {per}"))
    if fields.get("energy_per_ns_per_atom") is not None:
        text = f"{fields['energy_per_ns_per_atom']:+.2e}{energy_unit} per ns"
        if "temperature" in fields:
            text += f", {fields['kt_per_ns_per_atom']:+.2e} kT per ns"
        lines.append(_line("per atom", text))
    error = f"{fields['energy_error']:+.2e} at the end, {fields['max_energy_error']:.2e} at most"
    lines.append(_line("energy error", f"{error}, relative to {fields['scale']:.6g}{energy_unit}"))
    is_of_first = fields["scale"] == abs(fields["first_energy"])
    is_around_zero = fields["lowest_energy"] < 0 < fields["highest_energy"]
    if is_of_first and is_around_zero and fields["max_energy_error"] >= 1:
        hint = "the energies lie around zero; --scale std compares errors with their spread"
        lines.append(_line("hint", hint))
    return lines


def _title(fields: dict[str, Any]) -> str:
    name = "stdin" if fields["file"] == "-" else printable(fields["file"])
    span = f"{fields['first_time']:g} to {fields['last_time']:g}{_spaced(fields['time_unit'])}"
    text = f"{name}: {counted(fields['samples'], 'sample')} from {span}"
    if fields["tables"] > 1:
        text += f", table {fields['table']} of {fields['tables']}"
    skipped = _skipped(fields["skipped"])
    if skipped:
        text += f"; skipped: {', '.join(skipped)}"
    return text


def _line(name: str, text: str) -> str:
    return f"{name:<13} {text}"


def _spaced(unit: str) -> str:
    return unit and f" {unit}"
