"""Judge the energies of another program: does its integrator gain or lose energy?

FILE is a log or table of any program: CSV, LAMMPS, GROMACS, OpenMM, ASE, NAMD, Amber, CP2K, JSON,
.npz, …, also compressed.  Alone, it lists its tables and columns, and judges the energy if it is
certain which it is.  Results have the units of its heads.  A verdict of failed is exit code 1.
"""

import argparse
import math
import shutil
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from statistics import linear_regression
from typing import TYPE_CHECKING, Any

import numpy as np

from pendu_tui.engine import library
from pendu_tui.engine.inputs import did_you_mean
from pendu_tui.engine.run.record import Order, fluctuation, order_of
from pendu_tui.engine.run.verdicts import FAILED, LEAVES
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli import units
from pendu_tui.tui.cli.checks import JUDGED, Check, conclude, parse
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.layouts import role
from pendu_tui.tui.cli.reader import read_sheets
from pendu_tui.tui.cli.tables import Series, Wanted, find, unreadable
from pendu_tui.tui.commands.report import Report, fields_of, finite, form_of, publish
from pendu_tui.tui.words.numbers import counted

if TYPE_CHECKING:
    from rich.text import Text

MAX_LISTED = 30
MIN_CHART = 10  # rows
MAX_CHART = 20
CHOOSE = "choose with --time, --energy"


def _check(options: argparse.Namespace) -> None:
    steps = options.steps
    are_fit = len(set(steps)) > 1 and len(steps) == len(options.files)
    if (steps or len(options.files) > 1) and not are_fit:
        raise UserError(
            "several files take --steps, one for each and not all the same, such as --steps 1,2."
        )
    if "time" in options.units and (options.step or ("", ""))[1]:
        raise UserError("--step has the unit of time already; leave out time= of --units.")
    if options.temperature is not None and options.atoms is None:
        raise UserError("--temperature belongs to --atoms: give the number of atoms, too.")
    if not options.start <= options.end:
        raise UserError(f"there is no time from {options.start:g} to {options.end:g}.")


def run(options: argparse.Namespace) -> int:
    gate = None
    if options.fail_if is not None:
        gate = parse(options.fail_if, fields=JUDGED)
    _check(options)
    results = [judge(name, options) for name in options.files]
    lines = [line for result in results for line in lines_of(result)]
    fields = results[0]
    gated: dict[str, Any] = {}
    if options.steps:
        order = _fluctuation_order(options.steps, results)
        drift = _drift_order(options.steps, results)
        power, uncertainty = order or (None, None)
        lines.append(_line("fluctuation", _goes_as(power, str(order), uncertainty or 0.0)))
        lines.append(_line("drift", _goes_as(drift, f"h^{drift:.2f}" if drift else "")))
        gated = {"drift_order": drift, **_gated(order)}
        fields = {
            "steps": options.steps,
            "files": results,
            "fluctuation_order": power,
            "fluctuation_order_uncertainty": uncertainty,
            "drift_order": drift,
        }
    charts = []
    if form_of(options) == "table" and sys.stdout.isatty():
        columns = shutil.get_terminal_size().columns
        rows = sum(1 + len(line) // columns for line in lines)
        charts = [line for result in results for line in _chart(result, rows)]
    for result in results:
        del result["series"], result["judged"]
    publish(Report(name="judge", version=2, notes=[*charts, *lines], fields=fields), options)
    failures = [gate({"": result | gated}) for result in results if gate]
    failure = "; ".join(filter(None, dict.fromkeys(failures)))
    code = conclude(options.fail_if, [Check("", failure)])
    if any(result["verdict"] == FAILED for result in results):
        return Exit.CHECK_FAILED
    return code


@np.errstate(over="ignore", invalid="ignore")  # energies may be as large as a number can be
def judge(name: str, options: argparse.Namespace) -> dict[str, Any]:
    """Return the fields of the result for one file; - is stdin.  Raises UserError."""
    shown = "stdin" if name == "-" else printable(name)
    try:
        seen = read(name, options)
        series = table_to_judge(seen, options)
        fields: dict[str, Any] = {"file": name, "seen": [_seen(each) for each in seen]}
        if series is None:
            publish(Report(name="judge", version=2, notes=_listed(fields), fields=fields), options)
            doubt = seen[-1].choice.doubt or "the total energy"
            raise UserError(f"it is not certain which column is {doubt}; {CHOOSE}.")
        fields |= {"tables": len(seen), **_judged(series, options)}
    except UserError as error:
        raise UserError(f"{shown}: {error}", error.code) from None
    except OSError as error:
        why = f"{shown}: {error.strerror or error}; give a log or a table, or - for stdin."
        raise UserError(why, Exit.INPUT_UNREADABLE) from None
    fields["is_guess"] = options.time is None or options.energy is None
    return fields


def read(name: str, options: argparse.Namespace) -> list[Series]:
    """Return all tables of a file.  Raises UserError if there is none."""
    kinetic = None
    if str(options.scale).startswith("kinetic:"):
        kinetic = options.scale.partition(":")[2]
    wanted = Wanted(options.time, options.energy, kinetic, options.units, options.step)
    source = 0 if name == "-" else name
    with open(source, "rb", closefd=source != 0) as stream:
        sheets = read_sheets(stream, wanted, name)
    found = [series for sheet in sheets for series in sheet.series()]
    if not found:
        raise unreadable("no row of numbers is in it.")
    for place, series in enumerate(found, 1):
        series.number = place
    return found


def table_to_judge(seen: Sequence[Series], options: argparse.Namespace) -> Series | None:
    """Return the table to judge, None if that is not certain.  Raises UserError."""
    if options.table and options.table > len(seen):
        raise UserError(f"there is no table {options.table}; the input has {len(seen)}.")
    some = seen
    if options.table:
        some = [seen[options.table - 1]]
    named = [series for series in some if series.sheet.choice]
    if not named:
        raise _missing(some[-1])
    certain = [series for series in named if series.choice.energy and not series.choice.doubt]
    return certain[-1] if certain else None


def _missing(series: Series) -> UserError:
    """Return the error that a table has no column of a name that the user gave."""
    names = series.sheet.names
    wanted = series.sheet.wanted
    asked = [text for text in (wanted.time, wanted.energy, wanted.kinetic) if text]
    parts = [part.strip() for text in asked for part in text.split("+") if not find(names, text)]
    lost = next(part for part in parts if not find(names, part))
    present = [printable(name, 40) or str(n) for n, name in enumerate(names[:20], 1)]
    advice = did_you_mean(lost, present) or f"; choose from {', '.join(present)}."
    return UserError(f"there is no column {printable(lost, 40)!r}{advice}")


def _seen(series: Series) -> dict[str, Any]:
    """Return a table as it is listed."""
    names = zip(series.sheet.names, series.sheet.units, strict=True)
    times = series.times[np.isfinite(series.times)]
    return {
        "table": series.number,
        "rows": series.rows,
        "span": [float(time) for time in (*times[:1], *times[-1:])],
        "columns": [{"name": printable(name), "unit": printable(unit)} for name, unit in names],
        "time": printable(series.named(series.choice.time)),
        "energy": printable(series.named(series.choice.energy)),
    }


def _judged(series: Series, options: argparse.Namespace) -> dict[str, Any]:
    """Return the fields of the result for one table.  Raises UserError."""
    series.finish(options.start, options.end)
    judged = _judgement(series, options.scale)
    time_unit, energy_unit = (printable(unit, 20) for unit in series.units)
    fields = {
        "table": series.number,
        "time": printable(series.named(series.choice.time)),
        "energy": printable(series.named(series.choice.energy)),
        **fields_of(judged, "verdict", "reason", "rests", "share", "scale"),
        **fields_of(judged, "slope", "uncertainty", "bound"),
        "trend": judged.slope,
        "trend_unit": time_unit and f"1/{time_unit}",
        "time_unit": time_unit,
        "energy_unit": energy_unit,
        "independent_samples": judged.independent,
        "max_energy_error": judged.max_error,
        "energy_error": judged.error,
        "first_energy": float(series.energies[0]),
        "lowest_energy": float(series.energies.min()),
        "highest_energy": float(series.energies.max()),
        "samples": series.rows,
        "first_time": float(series.times[0]),
        "last_time": float(series.times[-1]),
        "diverged_at": series.diverged_at,
        "skipped": series.skipped,
    }
    for name, value in (
        ("absolute_trend", judged.slope),
        ("absolute_uncertainty", judged.uncertainty),
        ("absolute_bound", judged.bound),
        ("fluctuation", judged.fluctuation),
    ):
        fields[name] = value and value * judged.scale
    if options.atoms is not None:
        fields |= _per_atom(fields, options.atoms, options.temperature)
    return finite(fields) | {"series": series, "judged": judged}


def _judgement(series: Series, scale: float | str | None) -> library.Judged:
    """Return what the library says of a table.  Raises UserError if the scale is 0."""
    if scale is None:
        scale = "first"
        if series.holds_errors:
            scale = 1.0
    elif str(scale).startswith("kinetic:"):
        scale = abs(float(series.kinetic.mean()))
    times = series.times
    energies = series.energies
    if series.diverged_at is not None:
        times = np.append(times, series.diverged_at)
        energies = np.append(energies, np.nan)
    try:
        return library.judge(times, energies, scale)
    except ValueError as error:
        why = f"{str(error).removesuffix('.')}; give a typical energy with --scale."
        raise UserError(why) from None


def _per_atom(fields: dict[str, Any], atoms: int, temperature: float | None) -> dict[str, Any]:
    """Return the trend per nanosecond and atom.  Raises UserError if a unit is not known."""
    trend = fields["absolute_trend"]
    energy = trend and trend / units.size("time", fields["time_unit"]) / atoms
    result = {"atoms": atoms, "energy_per_ns_per_atom": energy}
    if temperature is None:
        return result
    in_kt = energy and energy / (units.size("energy", fields["energy_unit"]) * temperature)
    return result | {"temperature": temperature, "kt_per_ns_per_atom": in_kt}


def _goes_as(power: float | None, shown: str, uncertainty: float = 0.0) -> str:
    """Return a sentence's end on the power of h with which something goes."""
    if power is None:
        return "no clear power of h"
    question = "; are the steps in the order of the files?"
    return f"goes as {shown}{question * (power < -2 * uncertainty)}"


def _gated(order: Order | None) -> dict[str, Any]:
    """Return the order of the fluctuation as --fail-if compares it, as high as it may be."""
    if order is None:
        return {}
    unknown = {"fluctuation_order": f"cannot tell: it goes as {order}; {order.advice}"}
    shown = {"fluctuation_order": str(order).removeprefix("h^")}
    return {"fluctuation_order": order.highest, "unknown": unknown, "shown": shown}


def _fluctuation_order(steps: Sequence[float], results: Sequence[dict[str, Any]]) -> Order | None:
    """Return the power of the step size with which fluctuations go, if that can be told."""
    series = [fields["series"] for fields in results if fields["verdict"] != FAILED]
    if len(series) < len(steps):
        return None
    with suppress(ValueError):  # too few samples, or an energy that never changes
        return order_of(steps, [fluctuation(each.times, each.energies) for each in series])
    return None


def _drift_order(steps: Sequence[float], results: Sequence[dict[str, Any]]) -> float | None:
    """Return the power of the step size with which drifts go, if all of them are significant."""
    drifts = [fields["absolute_trend"] for fields in results if fields["verdict"] in LEAVES]
    logs = [math.log(abs(drift)) for drift in drifts if drift]
    if len(logs) < len(steps):
        return None
    return linear_regression([math.log(step) for step in steps], logs).slope


def lines_of(fields: dict[str, Any]) -> list[str]:
    """Return the lines on one file."""
    step = ""
    if role(fields["time"])[0] == "step":
        step = fields["time"].casefold()
    energy_unit = fields["energy_unit"]
    lines = fields["judged"].lines(fields["time_unit"], energy_unit, step)
    lines = [_title(fields), *_listed(fields), *lines]
    if fields.get("energy_per_ns_per_atom") is not None:
        text = f"{fields['energy_per_ns_per_atom']:+.2e}{_spaced(energy_unit)} per ns"
        if "temperature" in fields:
            text += f", {fields['kt_per_ns_per_atom']:+.2e} kT per ns"
        lines.append(_line("per atom", text))
    is_of_first = fields["scale"] == abs(fields["first_energy"])
    is_around_zero = fields["lowest_energy"] < 0 < fields["highest_energy"]
    if is_of_first and is_around_zero and (fields["max_energy_error"] or 0) >= 1:
        hint = "the energies lie around zero; --scale std compares errors with their spread"
        lines.append(_line("hint", hint))
    return lines


def _chart(fields: Mapping[str, Any], rows_below: int) -> "list[Text]":
    """Return the lines of a chart of the energy, which leave room for what is printed below."""
    from pendu_tui.tui.drawing.picture import PALETTES
    from pendu_tui.tui.drawing.picture import lines_of as drawn
    from pendu_tui.tui.drawing.plotted import record_chart

    series = fields["series"]
    judged = fields["judged"]
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
            span = " to ".join(f"{time:g}" for time in each["span"])
            lines.append(_line(f"table {each['table']}", f"{counted(each['rows'], 'row')}, {span}"))
        columns = [_column(place, column) for place, column in enumerate(each["columns"], 1)]
        lines.append(_line("columns", ", ".join(columns[:MAX_LISTED])))
    if "verdict" in fields:
        lines.append(_line("judged", f"{fields['energy']} over {fields['time']}; {CHOOSE}"))
    return lines


def _column(place: int, column: Mapping[str, str]) -> str:
    name = column["name"] or f"column {place}"
    return f"{name} [{column['unit']}]" if column["unit"] and column["unit"] not in name else name


def _title(fields: dict[str, Any]) -> str:
    name = "stdin" if fields["file"] == "-" else printable(fields["file"])
    span = f"{fields['first_time']:g} to {fields['last_time']:g}{_spaced(fields['time_unit'])}"
    text = f"{name}: {counted(fields['samples'], 'sample')} from {span}"
    if fields["tables"] > 1:
        text += f", table {fields['table']} of {fields['tables']}"
    if fields["skipped"]:
        rows = counted(fields["skipped"], "row")
        text += f"; skipped: {rows} without numbers or a later time"
    return text


def _line(name: str, text: str) -> str:
    return f"{name:<13} {text}"


def _spaced(unit: str) -> str:
    return unit and f" {unit}"
