"""Simulate recordings again from what was done in them, and compare every number to the last bit."""

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recordings.errors import RecordingError, printable
from recordings.library import PART
from tui.cli.errors import Exit
from tui.cli.output import progress, write_json

if TYPE_CHECKING:
    from recordings.verify import Difference, Verification

EXAMPLES = """\
examples:
  pendu-tui verify latest
  pendu-tui verify tests/recordings/ crossover.mcap
  pendu-tui verify golden

A folder stands for the recordings in it and below it, golden for those that come with the program.
Exit 0: all are the same; 1: one is not, or lacks its end and is no .part; 3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    parser.add_argument("files", metavar="FILE", nargs="+", help="a file, a folder, latest, or a name such as drift")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    """Verify all of them, the unreadable ones notwithstanding."""
    from recordings.verify import verify

    pairs: list[tuple[Path, Verification | RecordingError]] = []
    for file, missing in (found for name in options.files for found in _files(name)):
        result: Verification | RecordingError
        try:
            if missing:
                raise missing
            with progress(printable(file.name)) as show:
                result = verify(file, show)
        except RecordingError as error:
            result = error
        pairs.append((file, result))
        if not options.json:
            if isinstance(result, RecordingError):
                print(f"pendu-tui: {result}", file=sys.stderr)
            else:
                print(_sentence(result))
    results = [result for _, result in pairs]
    if options.json:
        write_json("verify", {"files": [_fields(file, result) for file, result in pairs]})
    elif len(results) > 1:
        print(f"{len(results)} recordings, {sum(map(_passes, results))} identical")
    if any(isinstance(result, RecordingError) for result in results):
        return Exit.INPUT_UNREADABLE
    return Exit.FINE if all(map(_passes, results)) else Exit.CHECK_FAILED


def _passes(result: "Verification | RecordingError") -> bool:
    """Whether nothing differs, and nothing is missing but from what is known to be unfinished by its name."""
    if isinstance(result, RecordingError):
        return False
    return result.identical and (result.complete or result.file.suffix == PART)


def _files(name: str) -> list[tuple[Path, RecordingError | None]]:
    """The recordings that a name on the command line stands for, or why it stands for none."""
    from recordings import library

    path = library.GOLDEN if name == "golden" and not Path(name).exists() else Path(name)
    try:
        files = sorted(path.rglob("*.mcap")) if path.is_dir() else [library.resolve(name)]
        if not files:
            raise RecordingError(f"{printable(name)}: there is no recording in this folder.")
    except RecordingError as error:
        return [(path, error)]
    return [(file, None) for file in files]


def _sentence(result: "Verification") -> str:
    name = printable(str(result.file))
    size = f"{result.samples} samples in {result.runs} run{'s' * (result.runs != 1)}"
    end = "" if result.complete else f"; {result.reason}"
    sin = "" if result.same_sin else "; within tolerance only, this machine's sin is not the recording's"
    if result.identical and not _passes(result):
        return f"unfinished  {name}: {size}{end}; as far as it goes, it is identical{sin}"
    if result.identical:
        return f"identical   {name}: {size}{end}{sin}"
    if result.first_difference is None:
        return f"damaged     {name}: {size} before it; {result.reason}"
    return f"different   {name}: {size}{end}{sin}\n{_where(result.first_difference)}"


def _where(difference: "Difference") -> str:
    place = (
        f"run {difference.run}, step {difference.step}, t = {difference.t:g} s, {difference.method or 'all methods'}"
    )
    values = [
        f"    {what} {value!r} ({value.hex()})" if value is not None else f"    {what} nothing"
        for what, value in (("recorded", difference.recorded), ("computed", difference.computed))
    ]
    ulps = "" if difference.ulps is None else f"\n    {difference.ulps} ulps apart"
    return f"  first in {difference.field} at {place}:\n" + "\n".join(values) + ulps


def _fields(file: Path, result: "Verification | RecordingError") -> dict[str, Any]:
    if isinstance(result, RecordingError):
        return {
            "file": str(file),
            "complete": False,
            "runs": 0,
            "samples": 0,
            "same_sin": None,
            "identical": False,
            "max_difference": None,
            "first_difference": None,
            "reason": str(result),
        }
    return {
        "file": str(file),
        "complete": result.complete,
        "runs": result.runs,
        "samples": result.samples,
        "same_sin": result.same_sin,
        "identical": result.identical,
        "max_difference": result.max_difference if math.isfinite(result.max_difference) else None,
        "first_difference": _difference(result.first_difference) if result.first_difference else None,
        "reason": result.reason,
    }


def _difference(difference: "Difference") -> dict[str, Any]:
    recorded, computed = difference.recorded, difference.computed
    return {
        "run": difference.run,
        "step": difference.step,
        "t": difference.t,
        "method": difference.method or None,
        "field": difference.field,
        "recorded": recorded,
        "computed": computed,
        "recorded_hex": None if recorded is None else recorded.hex(),
        "computed_hex": None if computed is None else computed.hex(),
        "ulps": difference.ulps,
    }
