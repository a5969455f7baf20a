"""The options of all commands, by the names that COMMANDS gives them.

A row is an option, or a function that adds a group of them.  They are read off the lists of scenes,
methods, numbers, verdicts and fields.
"""

import argparse
import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

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
    add_file,
    add_recording,
    angle,
    count,
    duration,
    ladder,
    moment,
    number,
    positive,
    record_time,
    scale,
    step_sizes,
    values,
)
from pendu_tui.tui.terminal.options import add_picture_options, add_terminal_options, cells

KEYS = [method.key for method in METHODS]

Add = Callable[[argparse.ArgumentParser], object]


def add_scene_options(parser: argparse.ArgumentParser, lists: bool = False) -> None:
    """Add the options of a scene, for `scene_of`; with `lists`, for `scenes_of`."""
    more = f"; a number may be a list, 0.1,0.2 or {LIST}" if lists else ""
    group = parser.add_argument_group("scene", f"options override the values of the scene{more}")
    names = Suggestions(SCENES)
    group.add_argument(
        "scene", metavar="SCENE", nargs="?", choices=names, help="the scene, as --scene"
    )
    group.add_argument(
        "--scene",
        dest="scene_option",
        metavar="NAME|FILE.toml",
        choices=names,
        help=f"see pendu-tui scenes ({DEFAULT_SCENE.name}), or a file with the fields of scenes "
        "--json",
    )
    for each in NUMBERS.values():
        option = f"--{each.name.replace('_', '-')}"
        read = values(each.read) if lists else each.read
        group.add_argument(option, metavar=each.metavar, type=read, help=each.about)
    add_cast_options(group)


def add_cast_options(parser: argparse._ActionsContainer, default: str = "the scene's") -> None:
    """Add the options that choose methods, for `cast_of`.

    `default` describes the cast without --methods in the help.
    """
    parser.add_argument(
        "--methods",
        metavar="KEY,KEY",
        choices=Suggestions(KEYS),
        help=f"these methods, in this order (default: {default}); the start of a name is enough",
    )
    add_file(
        parser,
        "--method",
        metavar="FILE.py:FUNCTION[,letter=m]",
        action="append",
        default=[],
        help="add your own method: a generator function (force, phase, h), see "
        ".github/docs/methods.md; the file runs with your rights (repeatable)",
    )


def add_report_options(
    parser: argparse._ActionsContainer, *, csv: bool = False, files: Sequence[str] = ()
) -> None:
    """Add --json, --csv for rows of numbers, and -o for files with these suffixes."""
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--json", action="store_true", help="one JSON object, SI units")
    if csv:
        forms.add_argument("--csv", action="store_true", help="a line of CSV for each row")
    if files:
        names = "|".join(files)
        what = f"write FILE, in the form of its suffix: {', '.join(files)}"
        add_file(forms, "-o", "--output", metavar=f"FILE{names}", type=file_type(files), help=what)
        parser.add_argument("--force", action="store_true", help="overwrite FILE")


def file_type(suffixes: Sequence[str]) -> Callable[[str], Path]:
    """Return a reader of paths with one of these suffixes; devices and pipes may have any."""

    def read(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in suffixes and not is_stream(path):
            named = " or ".join(f"{path.stem}{suffix}" for suffix in suffixes)
            raise ValueError(f"{text!r} has another suffix; use {named}")
        return path

    return read


def add_worker_options(parser: argparse.ArgumentParser) -> None:
    """Add --workers and --dask, for `tui.cli.workers.workers_of`."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        metavar="N",
        type=count,
        default=1,
        help="compute in N processes on this machine (%(default)s)",
    )
    where.add_argument(
        "--dask", metavar="ADDRESS", help="on a Dask scheduler, such as tcp://10.0.0.1:8786"
    )


def option(*names: str, **settings: Any) -> Add:
    """Return an option as argparse takes it."""
    return lambda parser: parser.add_argument(*names, **settings)


def file(*names: str, **settings: Any) -> Add:
    """Return an option that the tab key completes to a file."""
    return lambda parser: add_file(parser, *names, **settings)


def flag(name: str, help: str) -> Add:
    return option(name, action="store_true", help=help)


def gate(names: Iterable[str], meaning: str) -> Add:
    """Return --fail-if, whose comparisons have these names."""
    meaning = f"exit with 1 if the expression is true{meaning}"
    return option("--fail-if", metavar="EXPR", choices=Suggestions(names), help=meaning)


def recording(parser: argparse.ArgumentParser) -> None:
    """Add --record and --no-record of the lab."""
    group = parser.add_mutually_exclusive_group()
    record = "record to FILE instead of the data folder"
    add_file(group, "--record", metavar="FILE", type=Path, help=record)
    group.add_argument("--no-record", action="store_true", help="do not record")


def unrecorded(parser: argparse.ArgumentParser) -> None:
    """Add --no-record of a lab that is recorded in the data folder."""
    parser.set_defaults(record=None)
    parser.add_argument("--no-record", action="store_true", help="do not record")


def recover(parser: argparse.ArgumentParser) -> None:
    """Add the options of `recordings recover`."""
    group = parser.add_argument_group("recover")
    add_file(group, "-o", "--output", metavar="OUT", type=Path, help="the file to write")
    group.add_argument("--force", action="store_true", help="overwrite OUT")


SPEED = "--speed"
VERBS = ("list", "show", "recover")

OPTIONS: dict[str, Add] = {
    # groups that several commands share
    "scene": add_scene_options,
    "scene lists": partial(add_scene_options, lists=True),
    "cast of all": partial(add_cast_options, default="all"),
    "cast of a recording": partial(add_cast_options, default="all of the recording's"),
    "report": add_report_options,
    "report figures": partial(add_report_options, csv=True, files=(".csv", ".json", *FIGURES)),
    "workers": add_worker_options,
    "terminal": add_terminal_options,
    "picture": partial(add_picture_options, theme="dark", character_set="braille"),
    "recording": recording,
    "recover": recover,
    # files and names
    "recording file": add_recording,
    "recording files": partial(
        add_recording,
        name="files",
        metavar="FILE",
        nargs="+",
        help="a file, a folder, latest, golden, or a name such as drift",
    ),
    "recordings file": partial(
        add_recording, nargs="?", help="for show and recover: a file, latest, or a name"
    ),
    "judge files": file(
        "files", metavar="FILE", nargs="+", help="the log or table of a program; - for stdin"
    ),
    "verb": option(
        "verb",
        metavar="|".join(VERBS),
        nargs="?",
        choices=VERBS,
        default="list",
        help="what to do (%(default)s)",
    ),
    "scene name": option(
        "key", metavar="SCENE", nargs="?", choices=Suggestions(SCENES), help="the scene to show"
    ),
    "method names": option(
        "keys", metavar="KEY", nargs="*", choices=Suggestions(KEYS), help="as --methods"
    ),
    "--force": flag("--force", "overwrite the file"),
    "snapshot -o": file(
        *("-o", "--output"),
        metavar="FILE.svg",
        type=file_type([".svg"]),
        help="the image to write (default: SCENE.svg)",
    ),
    "export -o": file(
        *("-o", "--output"),
        metavar="OUT.csv",
        type=file_type([".csv"]),
        help="write to OUT.csv instead of stdout",
    ),
    "run --record": file(
        "--record", metavar="FILE", type=Path, help="record to FILE (the same bytes each time)"
    ),
    "serve --record": file(
        "--record", metavar="FOLDER", type=Path, help="record each lab in FOLDER"
    ),
    # the screen
    "live --speed": option(
        SPEED, metavar="X", type=positive, help="multiple of real time (default: the scene's)"
    ),
    "replay --speed": option(
        SPEED, metavar="X", type=positive, default=1.0, help="playback speed (%(default)g)"
    ),
    "--equal-cost": flag(
        "--equal-cost",
        "give all methods equally many force evaluations: cheaper ones take smaller steps",
    ),
    "tour --no-record": unrecorded,
    "replay --no-record": flag("--no-record", "do not record what continues live"),
    "--start-at": option(
        "--start-at",
        metavar="S",
        type=number,
        default=0.0,
        help="start S seconds into the recording (%(default)g)",
    ),
    "--loop": flag("--loop", "start again at the end"),
    "--paused": flag("--paused", "start paused"),
    "--size": option(
        "--size", metavar="CxR", type=cells, default=(120, 40), help="columns x rows (120x40)"
    ),
    "--port": option(
        "--port",
        metavar="N",
        type=int,
        default=8000,
        help="port to listen on (%(default)s; 0: any free one)",
    ),
    "--host": option(
        "--host", metavar="ADDRESS", default="127.0.0.1", help="address to listen on (%(default)s)"
    ),
    "--at-most": option(
        "--at-most", metavar="N", type=count, default=20, help="limit of open labs (%(default)s)"
    ),
    # times and steps
    "run --time": option(
        *("--time",),
        metavar="S",
        type=duration,
        required=True,
        help="simulated time: 60 (s) or 1min",
    ),
    "accuracy --time": option(
        "--time", metavar="S", type=duration, help="simulated time (ten small swings)"
    ),
    "snapshot --time": option(
        "--time", metavar="S", type=moment, default=12.0, help="simulated seconds (%(default)g)"
    ),
    "--sample-every": option(
        *("--sample-every",),
        metavar="N",
        type=count,
        help="record every N steps (default: every 1/30 s)",
    ),
    "stability --steps": option(
        "--steps",
        metavar="N",
        type=count,
        default=10_000,
        help="steps for each swing (%(default)s)",
    ),
    "--max-steps": option(
        "--max-steps", metavar="N", type=count, help="simulate at most N steps of each recording"
    ),
    "--no-compiled": flag("--no-compiled", "do not use Numba (same results)"),
    # studies
    "--all": flag("--all", "chart all methods for any force"),
    "--h-values": option(
        "--h-values",
        metavar="A:B:N",
        type=ladder,
        help="N step sizes from A to B in s, log-spaced (12, with z = h·w0 from 0.6 to 0.0015)",
    ),
    "--error": option(
        "--error",
        choices=("theta", "energy", "final"),
        default="theta",
        help="largest angle error [rad], largest energy error or last angle error (%(default)s)",
    ),
    "--cost": option(
        "--cost",
        choices=("evaluations", "seconds"),
        default="evaluations",
        help="what counts as cost (%(default)s); seconds are without Numba if a method is your own",
    ),
    "--target": option(
        "--target",
        metavar="ERROR",
        type=positive,
        help="find the cheapest h of each method, or of each in --methods, for this error",
    ),
    "--theta-values": option(
        "--theta-values",
        metavar="LIST",
        type=values(angle),
        help=f"amplitudes: 0.5,1,120deg or {LIST} (0.1,0.5,1,2,3 and the scene's; for a map 100)",
    ),
    "--z-values": option(
        "--z-values",
        metavar="LIST",
        type=values(number),
        help=f"z = h·w0: 0.5,1 or {LIST} (up to 3.2 in steps of 1 %%; for a map 200 up to 3)",
    ),
    # gates
    "run --fail-if": gate(
        (f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict")),
        ", e.g. rk4.max_energy_error > 1e-3 or any.verdict == grows; fields: those of --json",
    ),
    "judge --fail-if": gate((*JUDGED, "verdict"), f"; fields: {', '.join((*JUDGED, 'verdict'))}"),
    "methods --fail-if": gate(
        (*MEASURED_NUMBERS, *MEASURED_WORDS),
        " of a method, as measured; fields: " + ", ".join((*MEASURED_NUMBERS, *MEASURED_WORDS)),
    ),
    # records of other programs
    "judge --time": option(
        "--time",
        metavar="COLUMN",
        help="the column of times or steps, by name or number from 1 (default: a guess)",
    ),
    "--energy": option(
        "--energy",
        metavar="COLUMN",
        help="the column of total energies, or several joined by + (default: a guess)",
    ),
    "--table": option(
        "--table", metavar="N", type=count, help="judge table N (default: the last one)"
    ),
    "--step": option(
        "--step",
        metavar="TIME",
        type=units.quantity,
        help="the time of a step, or of a row if there is no column of times, such as 0.5fs",
    ),
    "--units": option(
        "--units",
        metavar="UNITS",
        type=units.assignments,
        default={},
        help="the units, where the file does not name them: time=ps,energy=kJ/mol",
    ),
    "--from": option(
        *("--from",),
        metavar="T",
        dest="start",
        type=record_time,
        default=-math.inf,
        help="begin at time T",
    ),
    "--to": option(
        "--to", metavar="T", dest="end", type=record_time, default=math.inf, help="end at time T"
    ),
    "--scale": option(
        "--scale",
        type=scale,
        help="divide errors by the first energy (first), the standard deviation (std), the mean of "
        "a column (kinetic:COLUMN) or a number; default: first, and 1 for relative errors",
    ),
    "--atoms": option(
        "--atoms", metavar="N", type=count, help="print the trend per ns and atom, too"
    ),
    "--temperature": option(
        "--temperature", metavar="K", type=positive, help="with --atoms: and in kT"
    ),
    "judge --steps": option(
        "--steps",
        metavar="H,H",
        type=step_sizes,
        default=[],
        help="the step size of each file, to see how the errors scale with it",
    ),
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
        OPTIONS[each](parser)
    examples = command.examples
    for word, text in TEXTS.items():
        examples = examples.replace(word, text)
    parser.epilog = f"examples:\n{examples}"
