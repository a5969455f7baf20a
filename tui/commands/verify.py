"""Simulate recordings again from their inputs, and compare every number bit for bit."""

import argparse
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from pendu_tui.engine.run import NUMERICS
from pendu_tui.recordings.events import remember
from pendu_tui.recordings.files import GOLDEN, PART, RecordingError, named
from pendu_tui.recordings.verification import Verification, verify
from pendu_tui.tui.cli.cast import cast_of, own_methods
from pendu_tui.tui.cli.errors import Exit, progress, say, warn
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.commands.report import Report
from pendu_tui.tui.words.numbers import counted


def run(options: argparse.Namespace) -> int:
    own = own_methods(options)
    remember(own)
    only = None
    if options.methods is not None:
        only = [method.key for method in cast_of(options, ())]
    rows = []
    for path in (path for name in options.files for path in _files(name)):
        row = _row(path, only, options.max_steps)
        rows.append(row)
        if row["error"] and not options.json:
            warn(row["error"])
        elif not options.json:
            say(_sentence(row))
    used = {key for row in rows for key in row["methods"]}
    for method in own:
        if method.key not in used:
            warn(f"no recording has the method {method.key}; --method was not needed for it.")
    passed = sum(row["passes"] for row in rows)
    if options.json:
        Report(name="verify", fields={"files": rows}).show("json")
    elif len(rows) > 1:
        say(f"{len(rows)} recordings, {passed} identical")
    if any(row["error"] for row in rows):
        return Exit.INPUT_UNREADABLE
    if passed < len(rows):
        return Exit.CHECK_FAILED
    return Exit.FINE


def _files(name: str) -> list[Path]:
    """Return the recordings that an argument stands for, or its path."""
    path = Path(name)
    if name == "golden" and not path.exists():
        path = GOLDEN
    with suppress(OSError):  # a name may be too long
        return sorted(path.rglob("*.mcap")) or [path]
    return [path]


def _row(path: Path, only: list[str] | None, max_steps: int | None) -> dict[str, Any]:
    result = Verification(path)
    error = None
    try:
        with named(path):
            if path.is_dir():
                raise RecordingError("no recordings in this folder")
        result.file = resolve(str(path))
        with progress(result.file.name) as show:
            result = verify(result.file, show, max_steps, only)
    except RecordingError as caught:
        error = str(caught)
    passes = result.identical and (result.complete or result.file.suffix == PART)
    return asdict(result) | {"file": str(result.file), "passes": passes, "error": error}


def _sentence(row: dict[str, Any]) -> str:
    text = f"{counted(row['samples'], 'sample')} in {counted(row['runs'], 'run')}"
    if not row["complete"]:
        text += f"; {row['reason']}"
    if row["other_functions"]:
        others = " and ".join(f"{name}()" for name in row["other_functions"])
        text += f"; within tolerance only: this machine computes {others} differently"
    if row["numerics"] != NUMERICS:
        text += f"; made with version {row['numerics']} of the numerics, not {NUMERICS}"
    if row["changed_sources"]:
        text += (
            f"; the source of {' and '.join(row['changed_sources'])} differs from the recorded one"
        )
    verdict = "damaged"
    if first := row["first_difference"]:
        verdict = "different"
        place = f"run {first['run']}, step {first['step']}, t = {first['t']:g} s"
        text += f"\n  first in {first['field']} at {place}, {first['method'] or 'all methods'}:"
        for name in ("recorded", "computed"):
            value = first[name]
            number = "nothing" if value is None else f"{value!r} ({value.hex()})"
            text += f"\n    {name} {number}"
    elif row["passes"]:
        verdict = "identical"
    elif row["identical"]:
        verdict = "unfinished"
        text += "; identical as far as it goes"
    return f"{verdict:<11} {row['file']}: {text}"
