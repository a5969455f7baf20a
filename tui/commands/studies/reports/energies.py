"""The numbers and the lines of judge: trends in the units that people quote."""

import math
from collections.abc import Sequence
from typing import Any

from engine.run.judgement import Progress
from recordings.errors import printable
from tui.cli.columns import REASONS, Table
from tui.cli.errors import UserError
from tui.words.numbers import counted

MAX_ERROR = 1e300  # JSON has no infinity
NANOSECONDS = {"fs": 1e-6, "ps": 1e-3, "ns": 1.0, "us": 1e3, "µs": 1e3, "ms": 1e6, "s": 1e9}
BOLTZMANN = {  # in the unit a kelvin; the 2019 SI
    "ev": 8.617333262e-5,
    "mev": 8.617333262e-2,
    "kj/mol": 8.31446261815324e-3,
    "kj/mole": 8.31446261815324e-3,
    "kcal/mol": 1.987204258640832e-3,
    "kcal/mole": 1.987204258640832e-3,
    "hartree": 3.166811563e-6,
    "ha": 3.166811563e-6,
    "a.u.": 3.166811563e-6,
    "au": 3.166811563e-6,
    "j": 1.380649e-23,
    "k": 1.0,
}


def judged(
    table: Table, scale: float | str, atoms: int | None, temperature: float | None
) -> dict[str, Any]:
    """Return the fields of the result for a table of times, energies and kinetic energies."""
    import numpy as np

    from engine.run.judge import Judge

    times = np.asarray(table.columns[0])
    energies = np.asarray(table.columns[1])
    # a deviation has no zero of energy
    found = Judge.read(times, energies, failed=table.failed_at is not None, absolute=scale != "std")
    rest = energies[found.first :]
    size = _size(table, rest, scale)
    with np.errstate(over="ignore"):
        errors = np.clip((rest - rest[0]) / size, -MAX_ERROR, MAX_ERROR)
    fields = {
        "table": table.number,
        "tables": table.count,
        "verdict": found.verdict,
        "progress": found.progress and found.progress._asdict(),
        "transient": found.transient,
        **_trend_fields(table, found.slope, found.uncertainty, size),
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
    return fields | _per_atom(fields, atoms, temperature)


def _size(table: Table, energies: Any, scale: float | str) -> float:
    """Return the energy that errors are relative to."""
    if isinstance(scale, float):
        return scale
    if scale == "first":
        size = abs(float(energies[0]))
    elif scale == "std":
        largest = abs(energies).max() or 1.0
        size = float((energies / largest).std() * largest)  # squares must not overflow
    else:
        size = abs(sum(table.columns[2]) / len(table.columns[2]))
    if not 0 < size < math.inf:
        what = {"first": "first energy", "std": "deviation"}.get(scale, "mean kinetic energy")
        raise UserError(
            f"the {what} is 0, and errors are relative to it; give a typical one with --scale."
        )
    return size


def _trend_fields(
    table: Table, slope: float | None, uncertainty: float | None, size: float
) -> dict[str, Any]:
    """Return the trend, absolute and relative to a size, with units."""
    time_unit = printable(table.units[0], 20)
    if time_unit.casefold() in NANOSECONDS:
        time_unit = time_unit.casefold()
    known = slope is not None and uncertainty is not None
    known = known and (abs(slope) + uncertainty) / size < MAX_ERROR  # type: ignore[arg-type, operator]
    return {
        "time_unit": time_unit,
        "energy_unit": printable(table.units[1], 20),
        "trend": slope / size if known else None,  # type: ignore[operator]
        "uncertainty": uncertainty / size if known else None,  # type: ignore[operator]
        "trend_unit": f"1/{time_unit}" if time_unit else "",
        "absolute_trend": slope if known else None,
        "absolute_uncertainty": uncertainty if known else None,
    }


def _per_atom(
    fields: dict[str, Any], atoms: int | None, temperature: float | None
) -> dict[str, Any]:
    """Return the trend per ns and atom, in the energy's unit and in kT."""
    if atoms is None:
        if temperature is not None:
            raise UserError("--temperature belongs to --atoms: give the number of atoms, too.")
        return {}
    time_unit = fields["time_unit"]
    energy_unit = fields["energy_unit"]
    if time_unit not in NANOSECONDS:
        raise UserError(
            "--atoms needs the unit of the times in the head of the column, such as Time (ps); "
            f"units: {', '.join(NANOSECONDS)}."
        )
    slope = fields["absolute_trend"]
    each = None if slope is None else slope / NANOSECONDS[time_unit] / atoms
    found = {"atoms": atoms, "energy_per_ns_per_atom": each}
    if temperature is None:
        return found
    if energy_unit.casefold() not in BOLTZMANN:
        raise UserError(
            "--temperature needs the unit of the energies in the head of the column, such as E "
            f"(eV); units: {', '.join(BOLTZMANN)}."
        )
    kt = BOLTZMANN[energy_unit.casefold()] * temperature
    return found | {
        "temperature": temperature,
        "kt_per_ns_per_atom": None if each is None else each / kt,
    }


def orders(steps: Sequence[float], results: Sequence[dict[str, Any]]) -> dict[str, float | None]:
    """Return the powers of the step size with which fluctuation and drift go.

    A drift that is not significant at each step size has no order.
    """
    drifts = [
        abs(fields["absolute_trend"] or 0.0) if fields["verdict"] in ("grows", "loses") else 0.0
        for fields in results
    ]
    fluctuations = [fields["fluctuation"] or 0.0 for fields in results]
    return {"fluctuation_order": _power(steps, fluctuations), "drift_order": _power(steps, drifts)}


def _power(steps: Sequence[float], values: Sequence[float]) -> float | None:
    """Return the slope of log value over log step by least squares."""
    if min(values) <= 0:
        return None
    logarithms = [math.log(step) for step in steps]
    mean = sum(logarithms) / len(steps)
    weights = [each - mean for each in logarithms]
    total = sum(weight * math.log(value) for weight, value in zip(weights, values, strict=True))
    return total / sum(weight * weight for weight in weights)


def title_of(fields: dict[str, Any]) -> str:
    """Return what was judged."""
    unit = f" {fields['time_unit']}" if fields["time_unit"] else ""
    name = "stdin" if fields["file"] == "-" else printable(fields["file"])
    span = f"from {fields['first_time']:g} to {fields['last_time']:g}{unit}"
    text = f"{name}: {counted(fields['samples'], 'sample')} {span}"
    if fields["tables"] > 1:
        text += f", table {fields['table']} of {fields['tables']}"
    rows = [
        f"{counted(number, 'row')} {REASONS[why]}"
        for why, number in fields["skipped"].items()
        if number
    ]
    return f"{text}; skipped: {', '.join(rows)}" if rows else text


def lines_of(fields: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the result for people: names and texts."""
    energy_unit = f" {fields['energy_unit']}" if fields["energy_unit"] else ""
    error = f"{fields['energy_error']:+.2e} at the end, {fields['max_energy_error']:.2e} at most"
    return [
        ("verdict", _verdict(fields)),
        *_trend(fields, energy_unit),
        ("energy error", f"{error}, relative to {fields['scale']:.6g}{energy_unit}"),
        *_hint(fields),
    ]


def _hint(fields: dict[str, Any]) -> list[tuple[str, str]]:
    """Return a better scale where the energies lie around zero."""
    at_first = fields["scale"] == abs(fields["first_energy"])
    if not at_first or fields["max_energy_error"] < 1 or fields["verdict"] != "bounded":
        return []
    return [("hint", "the energies lie around zero; --scale std compares errors with their spread")]


def _verdict(fields: dict[str, Any]) -> str:
    unit = f" {fields['time_unit']}" if fields["time_unit"] else ""
    text = str(fields["verdict"])
    if progress := fields["progress"]:
        text += f": {Progress(**progress)}"
    if fields["diverged_at"] is not None:
        text += f": the energies are nan or inf from {fields['diverged_at']:g}{unit} on"
    if fields["transient"]:
        text += f", after a transient of {fields['transient']:.3g}{unit}"
    return text


def _trend(fields: dict[str, Any], energy_unit: str) -> list[tuple[str, str]]:
    """Return the lines of the trend: relative and absolute, and per atom."""
    slope = fields["trend"]
    if slope is None:
        return []
    uncertainty = fields["uncertainty"]
    time = fields["time_unit"] or "unit of time"
    absolute = (
        f"{fields['absolute_trend']:+.2e} ± {fields['absolute_uncertainty']:.0e}{energy_unit}"
    )
    lines = [
        (
            "trend",
            f"relative {slope:+.2e} ± {uncertainty:.0e} per {time}, absolute {absolute} per {time}",
        )
    ]
    if (each := fields.get("energy_per_ns_per_atom")) is not None:
        kt = fields.get("kt_per_ns_per_atom")
        text = f"{each:+.2e}{energy_unit} per ns"
        lines.append(("per atom", text if kt is None else f"{text}, {kt:+.2e} kT per ns"))
    if fields["independent_samples"] == 0 and fields["verdict"] == "bounded":
        lines.append(("±", "the energies move by no more than their last digit, or rounding"))
    return lines
