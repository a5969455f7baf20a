"""Re-simulate recordings from their recorded inputs, and compare every number bit for bit."""

import argparse
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recordings.errors import RecordingError, printable
from recordings.library import PART
from tui.cli.cast import add_cast_options, cast_of, own_methods
from tui.cli.errors import Exit
from tui.cli.options import add_recording, count
from tui.cli.output import difference_fields, fields_of, progress, warn, write_json
from tui.words.numbers import counted

if TYPE_CHECKING:
    from recordings.verify import Difference, Verification

EXAMPLES = """\
examples:
  pendu-tui verify latest
  pendu-tui verify tests/recordings/ crossover.mcap
  pendu-tui verify golden
  pendu-tui verify crossover.mcap --methods rk4

A folder means all recordings below it; golden means the bundled ones.
A recording holds a SHA-256 of all that is in it, which shows what was changed, added or left out later. It proves
nothing against somebody who recomputes it.
Exit 0: all are identical; 1: at least one differs or is incomplete (a .part may be); 3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "files", nargs="+", help="a file, a folder, latest, or a name such as drift")
    add_cast_options(parser, "all of a recording's")
    parser.add_argument(
        "--max-steps",
        metavar="N",
        type=count,
        default=10_000_000,
        help="simulate at most so many steps of each recording (%(default)s)",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    results: list[tuple[Path, Verification | RecordingError]] = []
    own = own_methods(options)
    if own:
        from recordings.events import remember

        remember(own)
    only = None if options.methods is None else [method.key for method in cast_of(options, ())]
    for path, result in (verified for name in options.files for verified in _verified(name, options.max_steps, only)):
        results.append((path, result))
        if options.json:
            continue
        if isinstance(result, RecordingError):
            warn(str(result))
        else:
            print(_sentence(result))
    passed = [_passes(result) for _, result in results]
    if options.json:
        write_json("verify", {"files": [_fields(path, result) for path, result in results]})
    elif len(results) > 1:
        print(f"{len(results)} recordings, {sum(passed)} identical")
    if any(isinstance(result, RecordingError) for _, result in results):
        return Exit.INPUT_UNREADABLE
    return Exit.FINE if all(passed) else Exit.CHECK_FAILED


def _passes(result: "Verification | RecordingError") -> bool:
    """Whether nothing differs and, except in a .part, nothing is missing."""
    if isinstance(result, RecordingError):
        return False
    return result.identical and result.sealed is not False and (result.complete or result.file.suffix == PART)


def _verified(
    name: str, max_steps: int, only: list[str] | None
) -> "Iterator[tuple[Path, Verification | RecordingError]]":
    """Verify the recordings that a name on the command line stands for, the unreadable ones notwithstanding."""
    from recordings import library
    from recordings.verify import verify

    path = library.GOLDEN if name == "golden" and not Path(name).exists() else Path(name)
    try:
        files = sorted(path.rglob("*.mcap")) if path.is_dir() else [library.resolve(name)]
        if not files:
            raise RecordingError(f"{printable(name)}: no recordings in this folder.")
    except RecordingError as error:
        yield path, error
        return
    for file in files:
        result: Verification | RecordingError
        try:
            with progress(printable(file.name)) as show:
                result = verify(file, show, max_steps, only)
        except RecordingError as error:
            result = error
        yield file, result


def _sentence(result: "Verification") -> str:
    name = printable(str(result.file))
    size = f"{counted(result.samples, 'sample')} in {counted(result.runs, 'run')}"
    end = "" if result.complete else f"; {result.reason}"
    others = " and ".join(f"{name}()" for name in result.other_functions)
    notes = f"; within tolerance only: this machine has another {others}" if others else ""
    notes += "; it has no digest" if result.sealed is None else ""
    first = result.first_difference
    where = "" if first is None else f"\n{_where(first)}"
    if result.sealed is False:
        numbers = "identical" if first is None else "different"
        return f"altered     {name}: {size}; {result.reason}; its numbers are {numbers}{notes}{where}"
    if result.identical and not _passes(result):
        return f"unfinished  {name}: {size}{end}; identical as far as it goes{notes}"
    if result.identical:
        return f"identical   {name}: {size}{end}{notes}"
    if first is None:
        return f"damaged     {name}: {size} before it; {result.reason}"
    return f"different   {name}: {size}{end}{notes}{where}"


def _where(difference: "Difference") -> str:
    place = f"run {difference.run}, step {difference.step}, t = {difference.t:g} s"
    lines = [f"  first in {difference.field} at {place}, {difference.method or 'all methods'}:"]
    for what, value in (("recorded", difference.recorded), ("computed", difference.computed)):
        lines.append(f"    {what} nothing" if value is None else f"    {what} {value!r} ({value.hex()})")
    if difference.ulps is not None:
        lines.append(f"    {difference.ulps} ulps apart")
    return "\n".join(lines)


def _fields(path: Path, result: "Verification | RecordingError") -> dict[str, Any]:
    if isinstance(result, RecordingError):
        nothing: dict[str, Any] = {"complete": False, "runs": 0, "samples": 0, "same_sin": None, "identical": False}
        nothing |= dict.fromkeys(("other_functions", "sha256", "digest_matches", "max_difference", "first_difference"))
        return {"file": str(path), **nothing, "reason": str(result)}
    first = result.first_difference
    return {
        "file": str(path),
        **fields_of(result, "complete", "runs", "samples", "same_sin", "identical", "other_functions", "sha256"),
        "digest_matches": result.sealed,
        "max_difference": result.max_difference if math.isfinite(result.max_difference) else None,
        "first_difference": first and difference_fields(first, ("run", "step", "t"), ("recorded", "computed")),
        "reason": result.reason,
    }
