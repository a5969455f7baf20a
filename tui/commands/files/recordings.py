"""List the recordings in the library, newest first, or prune them."""

import argparse
import re
import sys
import time
from typing import TYPE_CHECKING, Any

from recordings.errors import RecordingError, printable
from tui.cli.errors import Exit, UserError
from tui.cli.options import count
from tui.cli.output import write_json
from tui.cli.report import print_table
from tui.words.numbers import file_size, seconds

if TYPE_CHECKING:
    from recordings.library import Item

EXAMPLES = """\
examples:
  pendu-tui recordings
  pendu-tui recordings prune --keep 20
  pendu-tui recordings prune --size 500MB --yes
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    actions = ("list", "prune")
    parser.add_argument(
        "action", metavar="|".join(actions), nargs="?", choices=actions, default="list", help="what to do (%(default)s)"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object")
    group = parser.add_argument_group("prune")
    group.add_argument("--keep", metavar="N", type=count, help="keep the N newest")
    group.add_argument("--size", metavar="SIZE", type=size, help="keep the newest up to SIZE in total, e.g. 500MB")
    group.add_argument("--yes", action="store_true", help="delete without asking")


def size(text: str) -> int:
    """A size in bytes from `500MB`, `1.5 GB` or `2000000`."""
    match = re.fullmatch(r"(\d{1,9}(?:\.\d{1,9})?) ?([kMGT]?)B?", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is not a size; use for example 500MB or 2GB")
    return int(float(match[1]) * 1000 ** ("kMGT".index(match[2]) + 1 if match[2] else 0))


def run(options: argparse.Namespace) -> int:
    if options.action == "prune":
        return _prune(options)
    if options.keep is not None or options.size is not None:
        raise UserError("--keep and --size belong to pendu-tui recordings prune.")
    from recordings import library

    all_facts, leftovers = [_facts(item) for item in library.listing()], library.leftovers()
    if options.json:
        write_json("recordings", {"folder": str(library.folder()), "recordings": all_facts})
        return Exit.FINE
    if not all_facts:
        print(f"No recordings in {printable(str(library.folder()))} yet; start pendu-tui to make one.")
    else:
        rows = []
        for facts in all_facts:
            finished = time.strftime("%Y-%m-%d %H:%M", time.localtime(facts["modified"]))
            length = "-" if facts["seconds"] is None else seconds(facts["seconds"])
            scenes = facts["reason"] or ", ".join(facts["scenes"])
            rows.append((facts["file"], finished, scenes, length, file_size(facts["bytes"])))
        print_table("lllrr", ("recording, newest first", "finished", "scenes", "length", "size"), rows)
    for path in library.being_made():
        print(f"recording now: {printable(str(path.with_suffix('')))}, {file_size(path.stat().st_size)} so far")
    for path in leftovers:
        print(f"unfinished: {printable(str(path))}; will be recovered the next time the lab starts")
    return Exit.FINE


def _facts(item: "Item") -> dict[str, Any]:
    """What --json shows of a recording."""
    from recordings.recording import Recording

    known: dict[str, Any] = {"seconds": None, "scenes": [], "reason": None}
    try:
        with Recording.open(item.path) as recording:
            scenes = list(dict.fromkeys(run.scene.name for run in recording.runs))
            known = {"seconds": recording.length, "scenes": scenes, "reason": recording.reason}
    except RecordingError as error:
        known["reason"] = str(error)
    return {"file": str(item.path), "bytes": item.bytes, "modified": item.modified, **known}


def _prune(options: argparse.Namespace) -> int:
    from recordings import library

    if options.keep is None and options.size is None:
        raise UserError("specify what to keep: --keep 20 for the newest 20, or --size 500MB for what fits.")
    doomed = library.to_prune(library.listing(), options.keep, options.size)
    if doomed and not options.yes and not _confirmed(doomed):
        doomed = []
    deleted = library.prune(doomed)
    if options.json:
        write_json("recordings", {"deleted": [str(item.path) for item in deleted]})
        return Exit.FINE
    print(f"deleted {len(deleted)} recordings, {file_size(sum(item.bytes for item in deleted))}")
    if len(deleted) < len(doomed):
        print(f"{len(doomed) - len(deleted)} more could not be deleted (in use?)")
    return Exit.FINE


def _confirmed(doomed: "list[Item]") -> bool:
    if not sys.stdin.isatty():
        raise UserError("not a terminal, cannot ask: add --yes to delete.")
    for item in doomed:
        print(printable(str(item.path)), file=sys.stderr)
    print(f"Delete these {len(doomed)} recordings? [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")
