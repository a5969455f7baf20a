"""The options of all commands, by the names that COMMANDS gives them.

The last word of a name is the option's own.  The rows are read off the lists of scenes, methods,
numbers, verdicts and fields; GROUPS are options that belong together in the help.
"""

import argparse
import math
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

from pendu_tui.engine.inputs import angle, number
from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.run.verdicts import CHAOTIC, VERDICTS
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.engine.studies import LOST
from pendu_tui.recordings.files import is_stream
from pendu_tui.tui.cli import units
from pendu_tui.tui.cli.checks import FIELDS, JUDGED, MEASURED_NUMBERS, MEASURED_WORDS
from pendu_tui.tui.cli.commands import COMMANDS
from pendu_tui.tui.cli.files import FIGURES
from pendu_tui.tui.cli.options import (
    LIST,
    Suggestions,
    count,
    duration,
    ladder,
    moment,
    positive,
    record_time,
    scale,
    step_sizes,
    values,
)
from pendu_tui.tui.terminal.options import add_picture_options, add_terminal_options, cells

Settings = dict[str, Any]  # of an option, as argparse takes them


def option(
    metavar: str | None, help: str, read: Callable[[str], Any] = str, **more: Any
) -> Settings:
    """Return an option with a value that `read` returns from its text."""
    return {"metavar": metavar, "help": help, "type": read, **more}


def file(metavar: str, help: str, read: Callable[[str], Any] = Path, **more: Any) -> Settings:
    """Return an option that the tab key completes to a file."""
    return option(metavar, help, read, is_file=True, **more)


def flag(help: str) -> Settings:
    return {"action": "store_true", "help": help}


def recording(help: str, metavar: str = "FILE|latest|NAME", **more: Any) -> Settings:
    """Return an argument for `resolve`."""
    return file(metavar, help, str, **more)


def gate(names: Iterable[str], meaning: str) -> Settings:
    """Return --fail-if, whose comparisons have these names."""
    meaning = f"exit with 1 if the expression is true{meaning}"
    return option("EXPR", meaning, choices=Suggestions(names))


def with_suffix(*suffixes: str) -> Callable[[str], Path]:
    """Return a reader of paths with one of these suffixes; devices and pipes may have any."""

    def read(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in suffixes and not is_stream(path):
            named = " or ".join(f"{path.stem}{suffix}" for suffix in suffixes)
            raise ValueError(f"{text!r} has another suffix; use {named}")
        return path

    return read


def output(*suffixes: str) -> Settings:
    what = f"write FILE, in the form of its suffix: {', '.join(suffixes)}"
    return file(f"FILE{'|'.join(suffixes)}", what, with_suffix(*suffixes))


KEYS = [method.key for method in METHODS]
VERBS = ("list", "show", "recover")

OPTIONS: dict[str, Settings] = {
    # files and names
    "recording file": recording("a file, latest, or a name such as drift"),
    "recording files": recording(
        "a file, a folder, latest, golden, or a name such as drift", "FILE", nargs="+"
    ),
    "recordings file": recording("for show and recover: a file, latest, or a name", nargs="?"),
    "judge files": file("FILE", "the log or table of a program; - for stdin", str, nargs="+"),
    "verb": option(
        "|".join(VERBS), "what to do (%(default)s)", nargs="?", choices=VERBS, default="list"
    ),
    "scene name": option("SCENE", "the scene to show", nargs="?", choices=Suggestions(SCENES)),
    "method names": option("KEY", "as --methods", nargs="*", choices=Suggestions(KEYS)),
    "scene": option("SCENE", "the scene, as --scene", nargs="?", choices=Suggestions(SCENES)),
    "--scene": option(
        "NAME|FILE.toml",
        f"see pendu-tui scenes ({DEFAULT_SCENE.name}), or a file with the fields of scenes --json",
        choices=Suggestions(SCENES),
        dest="scene_option",
    ),
    "--methods": option(
        "KEY,KEY",
        "these methods, in this order (default: the scene's); the start of a name is enough",
        choices=Suggestions(KEYS),
    ),
    "--method": file(
        "FILE.py:FUNCTION[,letter=m]",
        "add your own method: a generator function (force, phase, h), see "
        ".github/docs/methods.md; the file runs with your rights (repeatable)",
        str,
        action="append",
        default=[],
    ),
    # results
    "--json": flag("one JSON object, SI units"),
    "--csv": flag("a line of CSV for each row"),
    "figures -o": output(".csv", ".json", *FIGURES),
    "--force": flag("overwrite FILE"),
    "snapshot -o": file("FILE.svg", "the image to write (default: SCENE.svg)", with_suffix(".svg")),
    "export -o": file("OUT.csv", "write to OUT.csv instead of stdout", with_suffix(".csv")),
    "recover -o": file("OUT", "the file to write"),
    "lab --record": file("FILE", "record to FILE instead of the data folder"),
    "run --record": file("FILE", "record to FILE (the same bytes each time)"),
    "serve --record": file("FOLDER", "record each lab in FOLDER"),
    "--no-record": flag("do not record"),
    # the screen
    "live --speed": option("X", "multiple of real time (default: the scene's)", positive),
    "replay --speed": option("X", "playback speed (%(default)g)", positive, default=1.0),
    "--equal-cost": flag(
        "give all methods equally many force evaluations: cheaper ones take smaller steps"
    ),
    "replay --no-record": flag("do not record what continues live"),
    "--start-at": option(
        "S", "start S seconds into the recording (%(default)g)", number, default=0.0
    ),
    "--loop": flag("start again at the end"),
    "--paused": flag("start paused"),
    "--size": option("CxR", "columns x rows (120x40)", cells, default=(120, 40)),
    "--port": option("N", "port to listen on (%(default)s; 0: any free one)", int, default=8000),
    "--host": option("ADDRESS", "address to listen on (%(default)s)", default="127.0.0.1"),
    "--at-most": option("N", "limit of open labs (%(default)s)", count, default=20),
    # times and steps
    "run --time": option("S", "simulated time, which is required: 60 (s) or 1min", duration),
    "accuracy --time": option("S", "simulated time (ten small swings)", duration),
    "snapshot --time": option("S", "simulated seconds (%(default)g)", moment, default=12.0),
    "--sample-every": option("N", "record every N steps (default: every 1/30 s)", count),
    "stability --steps": option("N", "steps for each swing (%(default)s)", count, default=10_000),
    "--max-steps": option("N", "simulate at most N steps of each recording", count),
    "--no-compiled": flag("do not use Numba (same results)"),
    "--workers": option(
        "N", "compute in N processes on this machine (%(default)s)", count, default=1
    ),
    "--dask": option("ADDRESS", "on a Dask scheduler, such as tcp://10.0.0.1:8786"),
    # studies
    "--all": flag("chart all methods for any force"),
    "--h-values": option(
        "A:B:N",
        "N step sizes from A to B in s, log-spaced (12, with z = h·w0 from 0.6 to 0.0015)",
        ladder,
    ),
    "--error": option(
        None,
        "largest angle error [rad], largest energy error or last angle error (%(default)s)",
        choices=("theta", "energy", "final"),
        default="theta",
    ),
    "--cost": option(
        None,
        "what counts as cost (%(default)s); seconds are without Numba if a method is your own",
        choices=("evaluations", "seconds"),
        default="evaluations",
    ),
    "--target": option(
        "ERROR",
        "find the cheapest h of each method, or of each in --methods, for this error",
        positive,
    ),
    "--theta-values": option(
        "LIST",
        f"amplitudes: 0.5,1,120deg or {LIST} (0.1,0.5,1,2,3 and the scene's; for a map 100)",
        values(angle),
    ),
    "--z-values": option(
        "LIST",
        f"z = h·w0: 0.5,1 or {LIST} (up to 3.2 in steps of 1 %%; for a map 200 up to 3)",
        values(number),
    ),
    # gates
    "run --fail-if": gate(
        (f"{key}.{field}" for key in KEYS for field in (*FIELDS, "verdict")),
        ", e.g. rk4.max_energy_error > 1e-3 or any.verdict == grows; fields: those of --json",
    ),
    "judge --fail-if": gate((*JUDGED, "verdict"), f"; fields: {', '.join((*JUDGED, 'verdict'))}"),
    "methods --fail-if": gate(
        (*MEASURED_NUMBERS, *MEASURED_WORDS),
        " of a method, as measured; fields: " + ", ".join((*MEASURED_NUMBERS, *MEASURED_WORDS)),
    ),
    # records of other programs
    "judge --time": option(
        "COLUMN", "the column of times or steps, by name or number from 1 (default: a guess)"
    ),
    "--energy": option(
        "COLUMN", "the column of total energies, or several joined by + (default: a guess)"
    ),
    "--table": option("N", "judge table N (default: the last one)", count),
    "--step": option(
        "TIME",
        "the time of a step, or of a row if there is no column of times, such as 0.5fs",
        units.quantity,
    ),
    "--units": option(
        "UNITS",
        "the units, where the file does not name them: time=ps,energy=kJ/mol",
        units.assignments,
        default={},
    ),
    "--from": option("T", "begin at time T", record_time, dest="start", default=-math.inf),
    "--to": option("T", "end at time T", record_time, dest="end", default=math.inf),
    "--scale": option(
        None,
        "divide errors by the first energy (first), the standard deviation (std), the mean of "
        "a column (kinetic:COLUMN) or a number; default: first, and 1 for relative errors",
        scale,
    ),
    "--atoms": option("N", "print the trend per ns and atom, too", count),
    "--temperature": option("K", "with --atoms: and in kT", positive),
    "judge --steps": option(
        "H,H",
        "the step size of each file, to see how the errors scale with it",
        step_sizes,
        default=[],
    ),
}


def add(parser: argparse._ActionsContainer, *names: str, **changes: Any) -> None:
    """Add options of the table, with other settings for this command."""
    for name in names:
        settings = OPTIONS[name] | changes
        own = name.split()[-1]
        flags = ("-o", "--output") if own == "-o" else (own,)
        is_file = settings.pop("is_file", False)
        action = parser.add_argument(*flags, **settings)
        if is_file:
            action.complete = "file"  # type: ignore[attr-defined]


def add_scene(parser: argparse.ArgumentParser, lists: bool = False) -> None:
    """Add the options of a scene, for `scene_of`; with `lists`, for `scenes_of`."""
    more = f"; a number may be a list, 0.1,0.2 or {LIST}" if lists else ""
    group = parser.add_argument_group("scene", f"options override the values of the scene{more}")
    add(group, "scene", "--scene")
    for each in NUMBERS.values():
        read = values(each.read) if lists else each.read
        settings = option(each.metavar, each.about, read)
        group.add_argument(f"--{each.name.replace('_', '-')}", **settings)
    add(group, "--methods", "--method")


def add_cast(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the options of a cast, for `cast_of`; `default` is that without --methods."""
    help = OPTIONS["--methods"]["help"].replace("the scene's", default)
    add(parser, "--methods", help=help)
    add(parser, "--method")


def add_report(parser: argparse.ArgumentParser, *more: str) -> None:
    """Add the forms of a report; with `more`, also as CSV and in a file."""
    forms = parser.add_mutually_exclusive_group()
    add(forms, "--json", *more)
    if more:
        add(parser, "--force")


def add_one_of(parser: argparse.ArgumentParser, *names: str) -> None:
    add(parser.add_mutually_exclusive_group(), *names)


def add_unrecorded(parser: argparse.ArgumentParser) -> None:
    """Add --no-record of a lab that is recorded in the data folder."""
    parser.set_defaults(record=None)
    add(parser, "--no-record")


def add_recover(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("recover")
    add(group, "recover -o")
    add(group, "--force", help="overwrite OUT")


GROUPS: dict[str, Callable[[argparse.ArgumentParser], object]] = {
    "SCENE": add_scene,
    "SCENES": partial(add_scene, lists=True),
    "CAST of all": partial(add_cast, default="all"),
    "CAST of a recording": partial(add_cast, default="all of the recording's"),
    "REPORT": add_report,
    "REPORT and figures": lambda parser: add_report(parser, "--csv", "figures -o"),
    "WORKERS": lambda parser: add_one_of(parser, "--workers", "--dask"),
    "TERMINAL": add_terminal_options,
    "PICTURE": partial(add_picture_options, theme="dark", character_set="braille"),
    "RECORDING": lambda parser: add_one_of(parser, "lab --record", "--no-record"),
    "NO RECORDING": add_unrecorded,
    "RECOVER": add_recover,
}

_MEANINGS = {word: f"  {word}: {each.meaning}" for word, each in VERDICTS.items()}
TEXTS = {
    "{lost}": LOST,
    "{verdicts}": "\n".join(_MEANINGS.values()),
    "{verdicts of judge}": "\n".join(text for word, text in _MEANINGS.items() if word != CHAOTIC),
}
"""The texts that stand for words in braces in examples."""


def add_options(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the options of a command, and its examples below them."""
    command = COMMANDS[name]
    for each in command.options:
        if each in GROUPS:
            GROUPS[each](parser)
        else:
            add(parser, each)
    examples = command.examples
    for word, text in TEXTS.items():
        examples = examples.replace(word, text)
    parser.epilog = f"examples:\n{examples}"
