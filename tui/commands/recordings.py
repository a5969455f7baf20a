"""List the recordings, show the contents of one, or recover a damaged one."""

import argparse
from pathlib import Path
from typing import Any

from pendu_tui.recordings import files
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.commands.report import Column, Report, fields_of
from pendu_tui.tui.words.numbers import counted, file_size, seconds


def run(options: argparse.Namespace) -> int:
    given = (options.file is not None, options.output is not None)
    report_of, takes = REPORTS[options.verb]
    if given != takes:
        raise UserError("use recordings, recordings show FILE, or recordings recover FILE -o OUT.")
    report = report_of(options)
    report.show("json" if options.json else "table")  # -o names a recording
    return Exit.FINE


def _list(options: argparse.Namespace) -> Report:
    folder = str(files.folder())
    rows = [_facts(item) for item in files.listing()]
    columns = (
        Column("newest first", lambda row: Path(row["file"]).name),
        Column("length", "seconds", seconds),
        Column("size", "bytes", file_size),
        Column("scenes", _scenes),
    )
    return Report(
        name="recordings",
        title=f"{counted(len(rows), 'recording')} in {folder}",
        columns=columns if rows else (),
        rows=rows,
        fields={"folder": folder, "recordings": rows},
        notes=[f"recording now: {each.path.stem}" for each in files.listing(being_made=True)],
    )


def _scenes(row: dict[str, Any]) -> str:
    scenes = row["scenes"]
    if len(scenes) > 2:
        scenes = [scenes[0], f"{len(scenes) - 1} more"]
    return "; ".join(filter(None, (", ".join(scenes), row["reason"])))


def _facts(item: files.Item) -> dict[str, Any]:
    facts = {"file": str(item.path), "bytes": item.bytes, "modified": item.modified}
    try:
        with Recording.open(item.path) as recording:
            scenes = list(dict.fromkeys(run.scene.name for run in recording.runs))
            facts |= {"seconds": recording.length, "scenes": scenes, "reason": recording.reason}
    except RecordingError as error:
        facts |= {"seconds": None, "scenes": [], "reason": str(error)}
    return facts


def _show(options: argparse.Namespace) -> Report:
    with Recording.open(resolve(options.file), check=True) as recording:
        return _contents(recording)


def _contents(recording: Recording) -> Report:
    runs: list[dict[str, Any]] = [
        {"run": run.number, "scene": run.scene.fields(), "steps": run.steps, "time": run.t}
        | {"seconds": run.end - run.begin, "inputs": run.inputs}
        | {"numerics": run.arithmetic.numerics}
        for run in recording.runs
    ]
    cast = list(dict.fromkeys(method.key for run in recording.runs for method in run.scene.cast))
    health = recording.reason or "complete"
    if recording.damaged:
        health = f"damaged: {health}"
    samples = counted(recording.samples, "sample")  # reads them all
    notes = []
    if len(runs) > MAX_RUNS:
        notes = [f"and {len(runs) - MAX_RUNS} more runs; --json has them all"]
    return Report(
        name="recordings-show",
        title=f"{recording.path}: {health}\n"
        f"{seconds(recording.length)}, {samples}, {file_size(recording.bytes)}\n"
        f"methods: {', '.join(cast)}\n",
        columns=RUN_COLUMNS,
        rows=[run["scene"] | run for run in runs[:MAX_RUNS]],
        fields={
            "file": str(recording.path),
            "runs": runs,
            "seconds": recording.length,
            "methods": cast,
            **fields_of(recording, "complete", "damaged", "reason", "samples", "bytes"),
        },
        notes=notes,
    )


MAX_RUNS = 500  # in the table, of which Rich draws a thousand rows a second
RUN_COLUMNS = (
    Column("run", "run", "d"),
    Column("scene", "name"),
    Column("theta [rad]", "theta", "g"),
    Column("omega [rad/s]", "omega", "g"),
    Column("h [s]", "h", "g"),
    Column("steps", "steps", "d"),
    Column("simulated [s]", "time", "g"),
    Column("recorded [s]", "seconds", ".2f"),
    Column("inputs", "inputs", "d"),
)


def _recover(options: argparse.Namespace) -> Report:
    path = resolve(options.file)
    if options.output.resolve() == path.resolve():
        raise UserError(f"{options.output} is the damaged file itself; choose another name.")
    result = recover(path, options.output, options.force)
    saved = counted(result["samples_kept"], "sample")
    lost = f"{result['entries_lost']} samples and events, and {counted(result['runs_lost'], 'run')}"
    why = result["reason"] or "it was complete"
    notes = [f"{result['out']}: {saved} saved; {lost} lost: {why}."]
    return Report(name="recordings-recover", fields=result, notes=notes)


REPORTS = {
    "list": (_list, (False, False)),
    "show": (_show, (True, False)),
    "recover": (_recover, (True, True)),
}
"""The report of each verb, and whether it takes FILE and -o."""
