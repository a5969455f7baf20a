"""List the recordings, show the contents of one, or recover a damaged one."""

import argparse
import time
from typing import Any

from pendu_tui.recordings import files
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.commands.report import Column, Report, Table, fields_of
from pendu_tui.tui.words.numbers import counted, file_size, seconds

OPTIONS = {"file": ("show", "recover"), "output": ("recover",), "force": ("recover",)}
"""Option -> the verbs that take it."""


def run(options: argparse.Namespace) -> int:
    for name, verbs in OPTIONS.items():
        if getattr(options, name) and options.verb not in verbs:
            option = "a file" if name == "file" else f"--{name}"
            raise UserError(f"{option} belongs to pendu-tui recordings {' or '.join(verbs)}.")
    if options.verb in OPTIONS["file"] and options.file is None:
        raise UserError(f"name a recording: pendu-tui recordings {options.verb} FILE.")
    report = {"list": _list, "show": _show, "recover": _recover}[options.verb](options)
    report.show("json" if options.json else "table")  # -o names a recording
    return Exit.FINE


def _list(options: argparse.Namespace) -> Report:
    rows = [_facts(item) for item in files.listing()]
    notes = [
        f"recording now: {item.path.with_suffix('')}" for item in files.listing(being_made=True)
    ]
    if not (rows or notes):
        notes = [f"No recordings in {files.folder()} yet; start pendu-tui to make one."]
    columns = (
        Column("recording, newest first", "file"),
        Column("last written", "modified", _date),
        Column("scenes", _scenes),
        Column("length", "seconds", seconds),
        Column("size", "bytes", file_size),
    )
    return Report(
        name="recordings",
        columns=columns if rows else (),
        rows=rows,
        fields={"folder": str(files.folder()), "recordings": rows},
        notes=notes,
    )


def _scenes(row: dict[str, Any]) -> str:
    parts = (", ".join(row["scenes"]), row["reason"])
    return "; ".join(filter(None, parts))


def _date(when: float) -> str:
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(when))


def _facts(item: files.Item) -> dict[str, Any]:
    facts = {"file": str(item.path), "bytes": item.bytes, "modified": item.modified}
    try:
        with Recording.open(item.path) as recording:
            scenes = list(dict.fromkeys(run.scene.name for run in recording.runs))
            return facts | {
                "seconds": recording.length,
                "scenes": scenes,
                "reason": recording.reason,
            }
    except RecordingError as error:
        return facts | {"seconds": None, "scenes": [], "reason": str(error)}


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
    more = []
    if len(runs) > MAX_RUNS:
        more = [f"and {len(runs) - MAX_RUNS} runs more; --json has them all"]
    size = f"{file_size(recording.bytes)}, {counted(recording.samples, 'sample')}"  # reads them all
    health = recording.reason or "complete"
    facts = {
        "file": str(recording.path),
        "health": f"damaged: {health}" if recording.damaged else health,
        "length": seconds(recording.length),
        "size": size,
        "methods": ", ".join(cast),
    }
    fields = {"file": facts["file"], "runs": runs, "seconds": recording.length, "methods": cast}
    return Report(
        name="recordings-show",
        columns=(Column("", "name"), Column("", "value")),
        rows=[{"name": name, "value": value} for name, value in facts.items()],
        fields=fields | fields_of(recording, "complete", "damaged", "reason", "samples", "bytes"),
        notes=[Table(RUN_COLUMNS, [run["scene"] | run for run in runs[:MAX_RUNS]]), *more],
    )


MAX_RUNS = 500  # in the table, of which Rich draws a thousand rows a second
RUN_COLUMNS = (
    Column("run", "run", "d"),
    Column("scene", "name"),
    Column("theta [rad]", "theta", "g"),
    Column("omega [rad/s]", "omega", "g"),
    Column("h [s]", "h", "g"),
    Column("steps", "steps", "d"),
    Column("simulated s", "time", "g"),
    Column("recorded s", "seconds", ".2f"),
    Column("inputs", "inputs", "d"),
)


def _recover(options: argparse.Namespace) -> Report:
    if options.output is None:
        raise UserError("name the file to write: -o OUT.")
    path = resolve(options.file)
    if options.output.exists() and path.samefile(options.output):
        raise UserError(f"{path} is read by this command; choose another name to write.")
    result = recover(path, options.output, options.force)
    notes = [f"{result['out']}: {counted(result['samples_kept'], 'sample')} saved."]
    if result["reason"]:
        notes.append(f"Problem: {result['reason']}.")
    if result["entries_lost"]:
        notes.append(f"Lost: {result['entries_lost']} samples and events.")
    if result["runs_lost"]:
        notes.append(f"Runs not saved because their start is missing: {result['runs_lost']}.")
    return Report(name="recordings-recover", fields=result, notes=notes)
