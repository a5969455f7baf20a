"""Export: one row for each sample and method, for pandas, DuckDB and spreadsheets."""

import csv
from typing import TextIO

from engine.run.lockstep import Sample
from recordings.recording import Recording
from recordings.scan import Progress

COLUMNS = (
    "clock_s",
    "run",
    "step",
    "t_s",
    "method",
    "theta_rad",
    "omega_rad_per_s",
    "energy_per_s2",
    "energy_error",  # relative
    "max_energy_error",
    "energy_error_low",
    "energy_error_high",
    "diverged_at_s",
)
"""Names with their units; energies are per unit m·L²."""


def write_csv(recording: Recording, out: TextIO, progress: Progress | None = None) -> int:
    """Write all samples and return how many there were.  Every number is written so that it reads back the same."""
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(COLUMNS)
    count = 0
    for clock, value in recording.entries():
        if not isinstance(value, Sample):
            continue
        for method, reading in zip(recording.methods, value.readings, strict=True):
            rows.writerow(
                (
                    clock,
                    value.run,
                    value.step,
                    value.t,
                    method,
                    reading.theta,
                    reading.omega,
                    reading.energy,
                    reading.energy_error,
                    reading.max_energy_error,
                    reading.energy_error_low,
                    reading.energy_error_high,
                    reading.diverged_at,
                )
            )
        count += 1
        if progress and count % 1000 == 0:
            progress(count, recording.samples)
    return count
