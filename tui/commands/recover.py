"""Save what is intact of a damaged or unfinished recording, and say what is lost."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.files import check_free, interruptible
from tui.cli.options import add_file, add_recording
from tui.cli.output import progress, write_json
from tui.words.numbers import seconds

if TYPE_CHECKING:
    from recordings.recover import Recovery

EXAMPLES = """\
examples:
  pendu-tui recover sitting.mcap.part -o sitting.mcap
  pendu-tui recover damaged.mcap -o saved.mcap --json
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, help="what is left of a recording: a file, latest, or a name such as drift")
    add_file(parser, "-o", "--output", metavar="OUT", type=Path, required=True, help="the recording to make of it")
    parser.add_argument("--force", action="store_true", help="overwrite OUT")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from recordings.library import resolve
    from recordings.recover import recover

    path = resolve(options.file)
    check_free(options.output, options.force)
    with interruptible(), progress(printable(path.name)) as show:
        recovery = recover(path, options.output, show, options.force)
    if options.json:
        write_json("recover", asdict(recovery) | {"file": str(recovery.file), "out": str(recovery.out)})
    else:
        print(_sentence(recovery))
    return Exit.FINE


def _sentence(recovery: "Recovery") -> str:
    lines = [f"{printable(str(recovery.out))}: {recovery.samples_kept} samples saved."]
    if recovery.reason:
        lines.append(f"What was wrong: {recovery.reason}.")
    elif not recovery.runs_lost and not recovery.runs_broken:
        return "\n".join([*lines, "Nothing was lost."])
    chunks = f"{recovery.chunks_lost} chunk{'' if recovery.chunks_lost == 1 else 's'}"
    if recovery.chunks_lost and not recovery.samples_lost:
        lines.append(f"Lost: {chunks}; how many samples were there, or came after, the file does not tell.")
    else:
        lost = f"{recovery.samples_lost} samples, {chunks}, {seconds(recovery.seconds_lost)}"
        lines.append(f"Lost, as far as the file tells: {lost}.")
    if recovery.runs_lost:
        lines.append(f"Runs without their start, and so not saved: {recovery.runs_lost}.")
    if recovery.runs_broken:
        lines.append(f"Lost a change of h, so they play but do not verify: runs {str(recovery.runs_broken)[1:-1]}.")
    return "\n".join(lines)
