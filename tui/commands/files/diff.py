"""Compare two recordings: scene, methods, changes, the first number that differs, and the errors side by side."""

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.options import add_recording
from tui.cli.output import difference_fields, fields_of, progress, warn, write_json
from tui.cli.report import print_table
from tui.words.numbers import counted, scientific, seconds

if TYPE_CHECKING:
    from recordings.diff import Comparison, EventDifference, ValueDifference
    from recordings.recording import Recording

SHOWN = 10  # differences of a kind; --json has all
NEAR = 1_000_000  # ulps; further apart they say nothing

EXAMPLES = """\
examples:
  pendu-tui diff drift latest
  pendu-tui diff before.mcap after.mcap --json

Runs are paired by number, samples by step; where the steps differ in size, by simulated time.
Exit 0: the same was done with the same numbers; 1: something differs; 3: one cannot be read.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser, "a", metavar="A")
    add_recording(parser, "b", metavar="B", help="the other one")
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    from recordings import library
    from recordings.diff import compare
    from recordings.recording import Recording

    paths = library.resolve(options.a), library.resolve(options.b)
    with (
        progress(" and ".join(printable(path.name) for path in paths)) as show,
        Recording.open(paths[0], progress=show) as a,
        Recording.open(paths[1], progress=show) as b,
    ):
        result = compare(a, b, show)
    if options.json:
        write_json("diff", _fields(a, b, result))
    else:
        for recording in (a, b):
            if recording.reason:
                warn(f"{printable(str(recording.path))}: {recording.reason}; the rest is compared.")
        _print(a, b, result)
    return Exit.FINE if result.identical else Exit.CHECK_FAILED


def _fields(a: "Recording", b: "Recording", result: "Comparison") -> dict[str, Any]:
    return {
        **{name: _file_fields(recording) for name, recording in (("a", a), ("b", b))},
        "identical": result.identical,
        "scene_differences": [asdict(difference) for difference in result.scenes],
        **{f"runs_only_in_{side}": runs for side, runs in zip("ab", result.runs_only, strict=True)},
        **{f"methods_only_in_{side}": keys for side, keys in zip("ab", result.methods_only, strict=True)},
        "event_differences": map(_event_fields, result.events),
        "first_difference": result.first and difference_fields(result.first, ("run", "step", "step_b", "t"), "ab"),
        "samples": {"compared": result.paired, "different": result.differing}
        | {f"only_in_{side}": count for side, count in zip("ab", result.unpaired, strict=True)},
        "methods": [
            {"method": key}
            | {f"max_energy_error_{side}": value for side, value in zip("ab", errors.max_energy_error, strict=True)}
            | fields_of(errors, "theta_difference", "energy_error_difference", "run", "t")
            for key, errors in result.errors.items()
        ],
    }


def _file_fields(recording: "Recording") -> dict[str, Any]:
    facts = fields_of(recording, "complete", "reason", "samples")
    return {"file": str(recording.path), **facts, "runs": len(recording.runs), "seconds": recording.length}


def _event_fields(difference: "EventDifference") -> dict[str, Any]:
    names = ("run", "step", "t", "kind", "h", "equal_cost", "speed", "text")
    return {"only_in": difference.only_in, **fields_of(difference.event, *names)}


def _print(a: "Recording", b: "Recording", result: "Comparison") -> None:
    for name, recording in (("A", a), ("B", b)):
        runs = counted(len(recording.runs), "run")
        print(f"{name}  {printable(str(recording.path))}: {seconds(recording.length)}, {runs}")
    if result.identical:
        print(f"identical: {counted(result.paired, 'sample')}")
        return
    starts = [(d.run, d.field, _plain(d.a), _plain(d.b)) for d in result.scenes if d.field != "watch"]
    _table("start of", "lll", ("A", "B"), [(f"run {run}, {field}", x, y) for run, field, x, y in starts])
    for name, other in (("A", 0), ("B", 1)):
        for what, values in (("runs", result.runs_only[other]), ("methods", result.methods_only[other])):
            if values:
                print(f"\n{what} only in {name}: {_some(list(map(str, values)))}")
    _table("done only in", "lll", ("at", "what"), [_event_row(difference) for difference in result.events])
    print(f"\n{result.paired} samples compared, {result.differing} different;", end=" ")
    print(f"{result.unpaired[0]} only in A, {result.unpaired[1]} only in B")
    if result.first is not None:
        print(_where(result.first))
    headers = ("largest error", "A", "B", "theta apart", "at t [s]")
    rows = []
    for key, errors in result.errors.items():
        worst = (scientific(value, 8, 2, "-") for value in errors.max_energy_error)
        apart = "0" if errors.run is None else scientific(errors.theta_difference, 8, 2, "-")
        rows.append((key, *worst, apart, "-" if errors.t is None else f"{errors.t:g}"))
    print()
    print_table("lrrrr", headers, rows)


def _table(first: str, align: str, headers: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Print the first rows and how many more there are, or nothing if there are none."""
    if rows:
        print()
        print_table(align, (first, *headers), rows[:SHOWN])
    if len(rows) > SHOWN:
        print(f"... and {len(rows) - SHOWN} more; --json lists all.")


def _some(words: list[str]) -> str:
    more = [f"and {len(words) - SHOWN} more"] if len(words) > SHOWN else []
    return ", ".join([*words[:SHOWN], *more])


def _event_row(difference: "EventDifference") -> tuple[str, ...]:
    event = difference.event
    what = {
        "set_h": f"h {event.h} s" + (", equal cost" if event.equal_cost else ""),
        "speed": f"speed {event.speed}",
        "mark": f"mark {event.text or ''}".rstrip(),
    }.get(event.kind, event.kind)
    return difference.only_in.upper(), f"run {event.run}, step {event.step}, t = {event.t:g} s", printable(what, 30)


def _plain(value: float | str) -> str:
    return printable(value, 24) if isinstance(value, str) else repr(value)


def _where(difference: "ValueDifference") -> str:
    at_other = "" if difference.step == difference.step_b else f" (B: step {difference.step_b})"
    place = f"run {difference.run}, step {difference.step}{at_other}, t = {difference.t:g} s"
    lines = [f"first in {difference.field} at {place}, {difference.method or 'all methods'}:"]
    for name, value in (("A", difference.a), ("B", difference.b)):
        lines.append(f"  {name} nothing" if value is None else f"  {name} {value!r} ({value.hex()})")
    if difference.ulps is not None and difference.ulps < NEAR:
        lines.append(f"  {difference.ulps} ulps apart")
    return "\n".join(lines)
