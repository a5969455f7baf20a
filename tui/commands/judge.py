"""Judge the energies of another program: does its integrator gain or lose energy?

FILE is a log or table of any program: CSV, LAMMPS, GROMACS, OpenMM, ASE, NAMD, Amber, CP2K, JSON,
.npz, …, compressed or not.  Alone, it lists its tables and columns, and judges the energy if it is
certain which it is.  Results have the units of its heads.  A verdict of failed is exit code 1.
"""

import argparse
import shutil
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pendu_tui.engine import library
from pendu_tui.engine.inputs import InputError, did_you_mean
from pendu_tui.engine.quantities import ENERGY_ERROR, LARGEST
from pendu_tui.engine.run.record import Fluctuation, Order, fluctuation, order_of
from pendu_tui.engine.run.verdicts import FAILED, LEAVES
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli import units
from pendu_tui.tui.cli.checks import JUDGED, Check, conclude, parse
from pendu_tui.tui.cli.errors import Exit, UserError, explained, unreadable
from pendu_tui.tui.cli.layouts import role
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted, find
from pendu_tui.tui.commands.report import Report, fields_of, finite, publish
from pendu_tui.tui.words.numbers import counted

if TYPE_CHECKING:
    from rich.text import Text

MAX_LISTED = 30
FAR = 5  # times as far from the median as 98 of 100 energies
MIN_CHART = 10  # rows
MAX_CHART = 20
CHOOSE = "choose with --time, --energy"


class Answer(NamedTuple):
    """What there is to say about a file."""

    fields: dict[str, Any]  # as in --json
    series: Series
    judged: library.Judged


def run(options: argparse.Namespace) -> int:
    gate = parse(options.fail_if, fields=JUDGED)
    _check(options)
    answers = [judge(name, options) for name in options.files]
    files = [answer.fields for answer in answers]
    lines = [line for answer in answers for line in lines_of(answer)]
    fields = files[0]
    gated: dict[str, Any] = {}
    if options.steps:
        order, drift = _orders(options.steps, answers)
        lines += [_goes_as("fluctuation", order), _goes_as("drift", drift)]
        gated = {"drift_order": drift and drift.power, **_gated(order)}
        fields = {
            "steps": options.steps,
            "files": files,
            "fluctuation_order": order and order.power,
            "fluctuation_order_uncertainty": order and order.uncertainty,
            "drift_order": gated["drift_order"],
        }
    charts = []
    if sys.stdout.isatty() and not options.json:
        columns = shutil.get_terminal_size().columns
        rows = sum(1 + len(line) // columns for line in lines)
        charts = [line for answer in answers for line in _chart(answer, rows)]
    publish(Report(name="judge", version=2, notes=[*charts, *lines], fields=fields), options)
    checks = [Check(each["file"], gate({"": each | gated})) for each in files]
    code = conclude(options.fail_if, checks, "files")
    return Exit.CHECK_FAILED if FAILED in [each["verdict"] for each in files] else code


def _check(options: argparse.Namespace) -> None:
    steps = options.steps
    are_fit = len(set(steps)) > 1 and len(steps) == len(options.files)
    if (steps or len(options.files) > 1) and not are_fit:
        raise UserError(
            "several files need --steps, one per file and not all the same, such as --steps 1,2."
        )
    if "time" in options.units and options.step and options.step[1]:
        raise UserError("--step already gives the unit of time; leave time= out of --units.")
    if options.temperature is not None and options.atoms is None:
        raise UserError("--temperature needs --atoms: give the number of atoms, too.")


@np.errstate(over="ignore", invalid="ignore")  # energies may be as large as a number can be
def judge(name: str, options: argparse.Namespace) -> Answer:
    """Return the answer for one file; - is stdin.  Raises UserError."""
    try:
        seen = read(name, options)
        tables = [_seen(number, each) for number, each in enumerate(seen, 1)]
        fields: dict[str, Any] = {"file": name, "seen": tables}
        series = table_to_judge(seen, options.table)
        if doubt := series.choice.doubt:
            publish(Report(name="judge", version=2, notes=_listed(fields), fields=fields), options)
            raise UserError(f"it is not clear which column is {doubt}; {CHOOSE}.")
        series.finish(options.start, options.end)
        judged = _judged(series, options.scale[0])
        table = tables[seen.index(series)]
        fields |= {"tables": len(seen)} | {
            name: table[name] for name in ("table", "time", "energy")
        }
        fields |= _fields(series, judged)
        if options.atoms is not None:
            fields |= _per_atom(fields, options.atoms, options.temperature)
    except InputError as error:
        raise UserError(f"{_shown(name)}: {error}", explained(error).code) from None
    fields["is_guess"] = options.time is None or options.energy is None
    return Answer(finite(fields), series, judged)


def _shown(name: str) -> str:
    return "stdin" if name == "-" else printable(name)


def read(name: str, options: argparse.Namespace) -> list[Series]:
    """Return all tables of a file.  Raises UserError if there is none."""
    _, kinetic = options.scale
    wanted = Wanted(options.time, options.energy, kinetic, options.units, options.step)
    source = 0 if name == "-" else name
    try:
        with open(source, "rb", closefd=source != 0) as stream:
            found = [each for sheet in read_sheets(stream, wanted, name) for each in sheet.series()]
    except OSError as error:
        why = f"{error.strerror}; give a log or a table, or - for stdin."
        raise unreadable(why) from None
    if not found:
        raise unreadable("it has no rows of numbers.")
    return found


def table_to_judge(seen: Sequence[Series], table: int | None) -> Series:
    """Return the last table whose columns are certain, or else the last.  Raises UserError."""
    if table and table > len(seen):
        raise UserError(f"there is no table {table}; the input has {len(seen)}.")
    some = [seen[table - 1]] if table else seen
    named = [series for series in some if series.sheet.choice]
    if not named:
        raise _missing(some[-1])
    certain = [series for series in named if not series.choice.doubt]
    return (certain or named)[-1]


def _missing(series: Series) -> UserError:
    """Return the error that a table has no column of a name that the user gave."""
    names = series.sheet.names
    wanted = series.sheet.wanted
    asked = (wanted.time, wanted.energy, wanted.kinetic)
    lost = next(text for text in filter(None, asked) if not find(names, text))
    part = next(part.strip() for part in lost.split("+") if not find(names, part))
    present = [printable(name, 40) or str(n) for n, name in enumerate(names[:20], 1)]
    advice = did_you_mean(part, present) or f"; choose from {', '.join(present)}."
    return UserError(f"there is no column {printable(part, 40)!r}{advice}")


def _seen(number: int, series: Series) -> dict[str, Any]:
    """Return a table as it is listed."""
    names = zip(series.sheet.names, series.sheet.units, strict=True)
    times = series.times[np.isfinite(series.times)]
    return {
        "table": number,
        "rows": len(series.times),
        "span": [*times[:1], *times[-1:]],
        "columns": [{"name": printable(name), "unit": printable(unit)} for name, unit in names],
        "time": printable(series.named(series.choice.time)),
        "energy": printable(series.named(series.choice.energy)),
    }


def _judged(series: Series, scale: float | str | None) -> library.Judged:
    """Return what the library says of a table.  Raises InputError, as where the scale is 0."""
    if series.choice.kinetic:
        scale = abs(float(series.kinetic.mean()))
    elif scale is None:
        scale = 1.0 if series.holds_errors else "first"
    times = series.times
    energies = series.energies
    if series.diverged_at is not None:
        times = np.append(times, series.diverged_at)
        energies = np.append(energies, np.nan)
    return library.judge(times, energies, scale)


def _fields(series: Series, judged: library.Judged) -> dict[str, Any]:
    """Return the fields of the result for one table."""
    time_unit, energy_unit = (printable(unit, 20) for unit in series.units)
    fields = {
        **fields_of(judged, "verdict", "reason", "rests", "share", "scale", "diverged_at"),
        **fields_of(judged, "slope", "uncertainty", "bound"),
        "trend": judged.slope,
        "trend_unit": time_unit and f"1/{time_unit}",
        "time_unit": time_unit,
        "energy_unit": energy_unit,
        "independent_samples": judged.independent,
        LARGEST.name: judged.max_error,
        ENERGY_ERROR.name: judged.error,
        "first_energy": series.energies[0],
        "lowest_energy": series.energies.min(),
        "highest_energy": series.energies.max(),
        "samples": len(series.times),
        "first_time": series.times[0],
        "last_time": series.times[-1],
        "skipped": series.skipped,
        "log_error": printable(series.sheet.error, 100),
    }
    absolute = {
        "absolute_trend": judged.slope,
        "absolute_uncertainty": judged.uncertainty,
        "absolute_bound": judged.bound,
        "fluctuation": judged.fluctuation,
    }
    return fields | {name: value and value * judged.scale for name, value in absolute.items()}


def _per_atom(fields: dict[str, Any], atoms: int, temperature: float | None) -> dict[str, Any]:
    """Return the trend and its bound per nanosecond and atom.

    Raises UserError if a unit is not known.
    """
    result: dict[str, Any] = {"atoms": atoms}
    scales = {"energy": 1.0}
    if temperature is not None:
        result["temperature"] = temperature
        scales["kt"] = units.size("energy", fields["energy_unit"]) * temperature
    time = units.size("time", fields["time_unit"])
    for name, scale in scales.items():
        for end, value in (("", fields["absolute_trend"]), ("_bound", fields["absolute_bound"])):
            result[f"{name}{end}_per_ns_per_atom"] = value and value / time / atoms / scale
    return result


def _orders(steps: Sequence[float], answers: Sequence[Answer]) -> list[Order | None]:
    """Return the powers of the step size with which fluctuations go, and drifts.

    None: a record is too short or failed, or its drift is not significant.
    """
    left = [each.fields for each in answers if each.judged.verdict in LEAVES]
    drifts = [
        Fluctuation(abs(each["absolute_trend"] or 0.0), each["absolute_uncertainty"])
        for each in left
    ]
    orders: list[Order | None] = [None, None]
    with suppress(ValueError):
        whole = [each.series for each in answers if each.judged.verdict != FAILED]
        orders[0] = order_of(steps, [fluctuation(each.times, each.energies) for each in whole])
    with suppress(ValueError):
        orders[1] = order_of(steps, drifts)
    return orders


def _goes_as(name: str, order: Order | None) -> str:
    """Return a line on the power of h with which something goes."""
    text = f"scales as {order}" if order else "no clear power of h"
    if order and order.power < -2 * order.uncertainty:
        text += "; are the steps in the order of the files?"
    return _line(name, text)


def _gated(order: Order | None) -> dict[str, Any]:
    """Return the order of the fluctuation as --fail-if compares it, as high as it may be."""
    if order is None:
        return {}
    return {
        "fluctuation_order": order.highest,
        "unknown": {"fluctuation_order": order.doubt},
        "shown": {"fluctuation_order": str(order).strip("h^()")},
    }


def lines_of(answer: Answer) -> list[str]:
    """Return the lines on one file."""
    fields = answer.fields
    energy_unit = fields["energy_unit"]
    step = fields["time"].casefold() if role(fields["time"])[0] == "step" else ""
    lines = answer.judged.lines(fields["time_unit"], energy_unit, step)
    lines = [_title(fields), *_listed(fields), *lines]
    if fields["log_error"]:
        lines.append(_line("log ends", f"with {fields['log_error']}"))
    if fields.get("energy_per_ns_per_atom") is not None:
        text = f"{fields['energy_per_ns_per_atom']:+.2e}{_spaced(energy_unit)} per ns"
        if "temperature" in fields:
            text += f", {fields['kt_per_ns_per_atom']:+.2e} kT per ns"
        lines.append(_line("per atom", text))
    is_of_first = fields["scale"] == abs(fields["first_energy"])
    is_around_zero = fields["lowest_energy"] < 0 < fields["highest_energy"]
    hint = ""
    if is_of_first and is_around_zero:
        hint = "the energies straddle zero; --scale std compares errors with their spread"
    distances = np.abs(answer.series.energies - np.median(answer.series.energies))
    far = (distances > FAR * np.quantile(distances, 0.98)).sum()
    if far and fields["verdict"] in LEAVES and not fields["rests"]:
        hint = f"{counted(far, 'value')} far from all others may distort the trend"
    return [*lines, _line("hint", hint)] if hint else lines


def _chart(answer: Answer, rows_below: int) -> "list[Text]":
    """Return the lines of a chart of the energy, which leave room for what is printed below."""
    from pendu_tui.tui.drawing.picture import PALETTES
    from pendu_tui.tui.drawing.picture import lines_of as drawn
    from pendu_tui.tui.drawing.plotted import record_chart

    fields, series, judged = answer
    width, height = shutil.get_terminal_size()
    scale = f"{judged.scale:.6g}{_spaced(fields['energy_unit'])}"
    chart = record_chart(
        series.times,
        (series.energies - series.energies[0]) / judged.scale,
        (width, min(max(height - rows_below - 1, MIN_CHART), MAX_CHART)),
        slope=judged.slope,
        deviation=judged.fluctuation,
        title=f"energy error relative to {scale}; dotted: trend, ± 2 sd",
        unit=fields["time_unit"],
    )
    return drawn(chart, PALETTES["dark"])


def _listed(fields: Mapping[str, Any]) -> list[str]:
    """Return the lines on what is in the file, none where the user named the columns."""
    if not fields.get("is_guess", True):
        return []
    lines = []
    seen = fields["seen"]
    for each in seen[-MAX_LISTED:]:
        if len(seen) > 1 or "verdict" not in fields:
            span = " to ".join(f"{time:.10g}" for time in each["span"])
            lines.append(_line(f"table {each['table']}", f"{counted(each['rows'], 'row')}, {span}"))
        columns = [_column(place, column) for place, column in enumerate(each["columns"], 1)]
        lines.append(_line("columns", ", ".join(columns[:MAX_LISTED])))
    if "verdict" in fields:
        lines.append(_line("judged", f"{fields['energy']} over {fields['time']}; {CHOOSE}"))
    return lines


def _column(place: int, column: Mapping[str, str]) -> str:
    name = column["name"] or f"column {place}"
    return name if column["unit"] in name else f"{name} [{column['unit']}]"


def _title(fields: dict[str, Any]) -> str:
    span = f"{fields['first_time']:.10g} to {fields['last_time']:.10g}"
    span += _spaced(fields["time_unit"])
    text = f"{_shown(fields['file'])}: {counted(fields['samples'], 'sample')} from {span}"
    if fields["tables"] > 1:
        text += f", table {fields['table']} of {fields['tables']}"
    if fields["skipped"]:
        rows = counted(fields["skipped"], "row")
        text += f"; skipped: {rows} without numbers or out of time order"
    return text


def _line(name: str, text: str) -> str:
    return f"{name:<13} {text}"


def _spaced(unit: str) -> str:
    return unit and f" {unit}"
