"""Re-simulate recordings from their recorded inputs, and compare every number bit for bit."""

import argparse
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from recordings.errors import RecordingError, printable
from recordings.library import PART
from tui.cli.cast import add_cast_options, cast_of, own_methods
from tui.cli.errors import Exit
from tui.cli.options import add_recording, count, resolve
from tui.cli.output import progress, warn
from tui.cli.report import Report, add_report_options, form_of
from tui.words.numbers import counted

EXAMPLES = """\
examples:
  pendu-tui verify latest
  pendu-tui verify tests/recordings/ crossover.mcap
  pendu-tui verify golden
  pendu-tui verify crossover.mcap --methods rk4

A folder means all recordings below it; golden means the bundled ones.
Exit 0: all are identical; 1: at least one differs or is incomplete (a .part may be);
3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    about = "a file, a folder, latest, or a name such as drift"
    add_recording(parser, "files", nargs="+", help=about)
    add_cast_options(parser, "all of a recording's")
    parser.add_argument(
        "--max-steps",
        metavar="N",
        type=count,
        help="simulate at most N steps of each recording",
    )
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    own = own_methods(options)
    if own:
        from recordings.events import remember

        remember(own)
    rows = []
    for path, refusal in (found for name in options.files for found in _files(name)):
        row = _row(path, refusal, options)
        rows.append(row)
        if not options.json:
            show = warn if row["error"] else print
            show(_sentence(row))
    passed = sum(row["passes"] for row in rows)
    if options.json:
        Report(name="verify", fields={"files": rows}).show(form_of(options))
    elif len(rows) > 1:
        print(f"{len(rows)} recordings, {passed} identical")
    if any(row["error"] for row in rows):
        return Exit.INPUT_UNREADABLE
    return Exit.FINE if passed == len(rows) else Exit.CHECK_FAILED


def _files(name: str) -> Iterator[tuple[Path, RecordingError | None]]:
    """Yield the recordings that a name on the command line stands for, or why there is none."""
    from recordings import library

    path = Path(name)
    if name == "golden" and not path.exists():
        path = library.GOLDEN
    try:
        files = sorted(path.rglob("*.mcap")) if path.is_dir() else [resolve(name)]
    except RecordingError as error:
        yield path, error
        return
    if not files:
        yield path, RecordingError(f"{printable(name)}: no recordings in this folder.")
    for file in files:
        yield file, None


def _row(path: Path, refusal: RecordingError | None, options: argparse.Namespace) -> dict[str, Any]:
    """Verify a recording, and return the result, or the reason why it cannot be read."""
    from recordings.verification import Verification, verify

    only = None
    if options.methods is not None:
        only = [method.key for method in cast_of(options, ())]
    result = Verification(path)
    if refusal is None:
        try:
            with progress(printable(path.name)) as show:
                result = verify(path, show, options.max_steps, only)
        except RecordingError as error:
            refusal = error
    first = result.first_difference
    passes = result.identical and (result.complete or result.file.suffix == PART)
    return {
        **asdict(result),
        "file": str(result.file),
        "first_difference": first and asdict(first),
        "passes": passes,
        "error": refusal and str(refusal),
    }


def _sentence(row: dict[str, Any]) -> str:
    if row["error"]:
        return str(row["error"])
    from engine.run import NUMERICS

    size = f"{counted(row['samples'], 'sample')} in {counted(row['runs'], 'run')}"
    if not row["complete"]:
        size += f"; {row['reason']}"
    if row["other_functions"]:
        others = " and ".join(f"{name}()" for name in row["other_functions"])
        size += f"; within tolerance only: this machine has another {others}"
    if row["numerics"] != NUMERICS:
        size += f"; made with version {row['numerics']} of the numerics, this is version {NUMERICS}"
    verdict = "damaged"
    if row["first_difference"]:
        verdict = "different"
        size += f"\n{_where(row['first_difference'])}"
    elif row["passes"]:
        verdict = "identical"
    elif row["identical"]:
        verdict = "unfinished"
        size += "; identical as far as it goes"
    return f"{verdict:<11} {printable(row['file'])}: {size}"


def _where(first: dict[str, Any]) -> str:
    place = f"run {first['run']}, step {first['step']}, t = {first['t']:g} s"
    lines = [f"  first in {first['field']} at {place}, {first['method'] or 'all methods'}:"]
    for name in ("recorded", "computed"):
        value = first[name]
        number = "nothing" if value is None else f"{value!r} ({value.hex()})"
        lines.append(f"    {name} {number}")
    return "\n".join(lines)
