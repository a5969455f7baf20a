"""Show what a recording contains and whether it is complete."""

import argparse
from itertools import islice
from typing import TYPE_CHECKING, Any

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.options import add_recording
from tui.cli.output import fields_of, progress, write_json
from tui.cli.report import print_table
from tui.words.numbers import counted, file_size, seconds

if TYPE_CHECKING:
    from recordings.recording import Recording

RUNS_SHOWN = 1000

EXAMPLES = """\
examples:
  pendu-tui info latest
  pendu-tui info drift --json
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from recordings import library
    from recordings.recording import Recording

    path = library.resolve(options.file)
    with progress(printable(path.name)) as show, Recording.open(path, check=True, progress=show) as recording:
        if options.json:
            write_json("info", _fields(recording, path.stat().st_size))
        else:
            _print(recording, path.stat().st_size)
    return Exit.FINE


def _fields(recording: "Recording", size: int) -> dict[str, Any]:
    return {
        "file": str(recording.path),
        "format": recording.version,
        **fields_of(recording, "complete", "damaged", "reason"),
        "runs": (
            {"scene": run.scene.fields(), "steps": run.steps, "time": run.t, "seconds": run.end - run.begin}
            | {"events": run.events}
            for run in recording.runs
        ),
        **fields_of(recording, "methods", "samples"),
        "sha256": recording.seal.sha256 if recording.seal else None,
        "digest_matches": recording.sealed,
        "seconds": recording.length,
        "bytes": size,
        "metadata": recording.metadata,
    }


def _digest(recording: "Recording") -> str:
    """The SHA-256 of all that is in it, as far as it goes."""
    if recording.sealed is None:
        return "none" if recording.version > 1 else "none: format 1 had none"
    end = "" if recording.seal and recording.seal.end else ", up to its last intact chunk"
    return f"sha256 {recording.seal.sha256}{end}" if recording.sealed and recording.seal else "does not match"


def _print(recording: "Recording", size: int) -> None:
    health = "complete" if recording.complete else f"{recording.reason}"
    facts = {
        "file": str(recording.path),
        "health": ("damaged: " if recording.damaged else "") + health,
        "length": seconds(recording.length),
        "size": f"{file_size(size)}, {counted(recording.samples, 'sample')}",
        "methods": ", ".join(recording.methods),
        "digest": _digest(recording),
        **{name: value for name, value in recording.metadata.items() if not name.endswith(".hex")},
    }
    print_table("ll", ("", ""), facts.items())
    print()
    headers = ("run", "scene", "theta [rad]", "omega [rad/s]", "h [s]", "steps", "simulated s", "recorded s", "inputs")
    rows = []
    for run in islice(recording.runs, RUNS_SHOWN):
        start = (f"{value:g}" for value in (run.scene.theta, run.scene.omega, run.scene.h))
        lengths = (str(run.steps), f"{run.t:g}", f"{run.end - run.begin:.2f}")
        rows.append((str(run.number), run.scene.name, *start, *lengths, str(run.events)))
    print_table("rlrrrrrrr", headers, rows)
    if len(recording.runs) > RUNS_SHOWN:
        print(f"... and {len(recording.runs) - RUNS_SHOWN} more runs; --json lists all.")
