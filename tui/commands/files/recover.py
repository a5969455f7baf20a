"""Salvage a damaged or unfinished recording, and show what was lost."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.files import check_free
from tui.cli.options import add_file, add_recording
from tui.cli.output import progress, write_json
from tui.words.numbers import counted, seconds

if TYPE_CHECKING:
    from recordings.recover import Recovery

EXAMPLES = """\
examples:
  pendu-tui recover swing.mcap.part -o swing.mcap
  pendu-tui recover damaged.mcap -o saved.mcap --json
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, help="the damaged recording: a file, latest, or a name such as drift")
    add_file(parser, "-o", "--output", metavar="OUT", type=Path, required=True, help="the file to write")
    parser.add_argument("--force", action="store_true", help="overwrite OUT")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from recordings.library import resolve
    from recordings.recover import recover

    path = resolve(options.file)
    check_free(options.output, options.force)
    with progress(printable(path.name)) as show:
        recovery = recover(path, options.output, show, options.force)
    if options.json:
        write_json("recover", asdict(recovery) | {"file": str(recovery.file), "out": str(recovery.out)})
    else:
        print(_sentence(recovery))
    return Exit.FINE


def _sentence(recovery: "Recovery") -> str:
    lines = [f"{printable(str(recovery.out))}: {counted(recovery.samples_kept, 'sample')} saved."]
    if recovery.reason:
        lines.append(f"Problem: {recovery.reason}.")
    chunks = f"{recovery.chunks_lost} chunk{'' if recovery.chunks_lost == 1 else 's'}"
    if recovery.chunks_lost and not recovery.samples_lost:
        lines.append(f"Lost: {chunks}; the number of lost samples is unknown.")
    elif recovery.samples_lost or recovery.seconds_lost:
        lines.append(f"Lost (known): {recovery.samples_lost} samples, {chunks}, {seconds(recovery.seconds_lost)}.")
    else:
        lines.append("Nothing was lost.")
    if recovery.runs_lost:
        lines.append(f"Runs not saved because their start is missing: {recovery.runs_lost}.")
    if recovery.runs_broken:
        runs = ", ".join(map(str, recovery.runs_broken))
        lines.append(f"A change of h is missing, so these runs replay but cannot be verified: {runs}.")
    return "\n".join(lines)
