"""Write a recording as CSV, one row per sample and method."""

import argparse
from collections.abc import Callable, Iterator, Sequence

from pendu_tui.engine.quantities import DIVERGED_AT
from pendu_tui.recordings.format import EXTRA, MOMENT, READING, Field, values_of
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.cli.errors import Exit, progress, warn
from pendu_tui.tui.cli.files import text_file
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.commands.report import write_csv


def run(options: argparse.Namespace) -> int:
    path = resolve(options.file)
    with Recording.open(path) as recording, progress(path.name) as show:
        models = [run.scene.model for run in recording.runs]
        fields = dict.fromkeys((*READING, *(each for model in models for each in EXTRA[model])))
        columns = ("clock_s", *map(_column, MOMENT), "method", *map(_column, fields))
        with text_file(options.output, options.force) as out:
            write_csv(out, columns, _rows(recording, [each.name for each in fields], show))
        if recording.reason:
            warn(f"{path}: {recording.reason}; the rest is exported.")
    return Exit.FINE


def _column(field: Field) -> str:
    """Return a name with its unit."""
    if not field.unit:
        return field.name
    unit = field.unit.replace("/", "_per_").replace("s^-", "per_s").removesuffix("1")
    return f"{field.name}_{unit}"


def _rows(
    recording: Recording, names: Sequence[str], show: Callable[[float, float], None]
) -> Iterator[tuple[object, ...]]:
    """Yield the values of each method in each sample; energies are per unit m·L²."""
    for clock, sample in recording.samples_between():
        show(clock, recording.length)
        cast = recording.run_of(sample.run).scene.cast
        for method, reading in zip(cast, sample.readings, strict=True):
            place = (clock, sample.run, sample.step, sample.t, method.key)
            known = {name: value for name, value in values_of(reading).items() if value is not None}
            if reading.diverged_at is not None:  # a recording repeats the last finite numbers
                known = {DIVERGED_AT.name: reading.diverged_at}
            # NaN, because readers take an empty column for text
            yield *place, *(known.get(name, "NaN") for name in names)
