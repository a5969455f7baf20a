"""Export: one row for each sample and method, for pandas, DuckDB and spreadsheets."""

import csv
from typing import TextIO

from engine.run.lockstep import Sample
from recordings.fields import MOMENT, READING, values_of
from recordings.recording import Recording
from recordings.scan import ShowProgress

COLUMNS = ("clock_s", *(field.column for field in MOMENT), "method", *(field.column for field in READING))
"""Names with their units; energies are per unit m·L²."""


def write_csv(recording: Recording, out: TextIO, progress: ShowProgress | None = None) -> int:
    """Write all samples and return how many there were.  Every number reads back with the same bits."""
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(COLUMNS)
    count = 0
    for clock, value in recording.entries():
        if not isinstance(value, Sample):
            continue
        for method, reading in zip(recording.methods, value.readings, strict=True):
            rows.writerow((clock, value.run, value.step, value.t, method, *values_of(reading)))
        count += 1
        if progress and count % 1000 == 0:
            progress(count, recording.samples)
    return count
