"""The options of all commands, by the names that COMMANDS gives them, and the parsers.

What differs for one command stands under `COMMAND NAME`.  The rows are read off the lists of
scenes, methods, numbers, verdicts and fields.
"""

import argparse
import math
import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, NoReturn

from pendu_tui.engine.inputs import angle, check_name, did_you_mean, number, seconds
from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Z_LIMITS
from pendu_tui.recordings.files import is_stream
from pendu_tui.tui.cli import units
from pendu_tui.tui.cli.checks import JUDGED, MEASURED_NUMBERS, MEASURED_WORDS
from pendu_tui.tui.cli.commands import COMMANDS
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.files import FIGURES
from pendu_tui.tui.cli.options import (
    LIST,
    above_zero,
    count,
    ladder,
    moment,
    positive,
    scale,
    step_sizes,
    values,
)
from pendu_tui.tui.drawing.picture import PALETTES
from pendu_tui.tui.terminal.options import CALM_FPS, CHARACTER_SETS, FPS, cells

Settings = dict[str, Any]  # of an option, as argparse takes them


def option(
    metavar: str | None, help: str, read: Callable[[str], Any] = str, **more: Any
) -> Settings:
    """Return an option with a value that `read` returns from its text."""
    return {"metavar": metavar, "help": help, "type": read, **more}


def file(metavar: str, help: str, read: Callable[[str], Any] = Path, **more: Any) -> Settings:
    """Return an option that the tab key completes to a file."""
    return option(metavar, help, read, is_file=True, **more)


def choice(
    help: str, words: Sequence[str], default: str, metavar: str | None = None, **more: Any
) -> Settings:
    """Return an option whose value is one of these words."""

    def read(text: str) -> str:
        check_name("choice", text, words)
        return text

    return option(metavar, help, read, choices=words, default=default, **more)


def flag(help: str) -> Settings:
    return {"action": "store_true", "help": help}


class AnyOf(argparse.Action):
    """Joins the expressions of a repeated option by `or`."""

    def __call__(self, parser: Any, options: Any, text: Any, flag: Any = None) -> None:
        before = getattr(options, self.dest)
        setattr(options, self.dest, text if before is None else f"({before}) or ({text})")


def gate(meaning: str) -> Settings:
    help = f"exit with 1 if the expression is true (repeatable){meaning}"
    return option("EXPR", help, action=AnyOf)


def with_suffix(*suffixes: str) -> Callable[[str], Path]:
    """Return a reader of paths with one of these suffixes; devices and pipes may have any."""

    def read(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in suffixes and not is_stream(path):
            named = " or ".join(f"{path.stem}{suffix}" for suffix in suffixes)
            raise ValueError(f"{text!r} has the wrong suffix; use {named}")
        return path

    return read


MAX_TIME = 1e9  # s, 30 years, which is also the limit of a recording's clock
KEYS = [method.key for method in METHODS]
VERBS = ("list", "show", "recover")
RECORDING = "FILE|latest|NAME"
SUFFIXES = (".csv", ".json", *FIGURES)

OPTIONS: dict[str, Settings] = {
    # files and names
    "file": file(RECORDING, "a file, latest, or a name such as drift", str),
    "recordings file": file(
        RECORDING, "for show and recover: a file, latest, or a name", str, nargs="?"
    ),
    "files": file(
        "FILE", "a file, a folder, latest, golden, or a name such as drift", str, nargs="+"
    ),
    "judge files": file("FILE", "the log or table of a program; - for stdin", str, nargs="+"),
    "verb": choice("what to do (%(default)s)", VERBS, "list", "|".join(VERBS), nargs="?"),
    "name": option("SCENE", "the scene to show", nargs="?", choices=[*SCENES]),
    "names": option("KEY", "the methods to show", nargs="*", choices=KEYS),
    "scene": option("SCENE", "the scene, as --scene", nargs="?", choices=[*SCENES]),
    "--scene": option(
        "NAME|FILE.toml",
        f"see pendu-tui scenes ({DEFAULT_SCENE.name}), or a file with the fields of scenes --json",
        choices=[*SCENES],
        dest="scene_option",
    ),
    "--methods": option(
        "KEY,KEY",
        "only these methods, in this order; names may be shortened",
        choices=KEYS,
    ),
    "--method": file(
        "FILE.py:FUNCTION",
        "add a method of your own: a generator function (force, phase, h), see "
        ".github/docs/methods.md; the file runs with your permissions (repeatable)",
        str,
        action="append",
        default=[],
    ),
    # results
    "--json": flag("one JSON object, SI units"),
    "--csv": flag("print CSV"),
    "-o": file(
        "FILE" + "|".join(SUFFIXES),
        f"write FILE in the format of its suffix: {', '.join(SUFFIXES)}",
        with_suffix(*SUFFIXES),
    ),
    "--force": flag("overwrite a file of that name"),
    "snapshot -o": file("FILE.svg", "the image to write (default: SCENE.svg)", with_suffix(".svg")),
    "export -o": file("FILE.csv", "write to a file instead of stdout", with_suffix(".csv")),
    "recordings -o": file("OUT", "the file to write"),
    "--record": file("FILE", "record to FILE instead of the data folder"),
    "run --record": file("FILE", "record to FILE (the same bytes each time)"),
    "serve --record": file("FOLDER", "record each lab in FOLDER"),
    "--no-record": flag("do not record"),
    # the screen
    "--theme": choice("colours (%(default)s)", ("auto", *PALETTES), "auto"),
    "--pixels": choice("what to draw with (%(default)s)", ("auto", *CHARACTER_SETS), "auto"),
    "--plain": flag("no TUI: print sentences about what happens; Ctrl+C stops"),
    "--no-mouse": flag("disable the mouse; every mouse action also has a key"),
    "--fps": option(
        "N",
        f"frames per second ({FPS}; {CALM_FPS} with TEXTUAL_ANIMATIONS=none)",
        above_zero(count, 61),
    ),
    "--speed": option("X", "multiple of real time (default: the scene's; replay: 1)", positive),
    "--equal-cost": flag(
        "give all methods the same number of force evaluations: costlier ones take longer steps"
    ),
    "--start-at": option(
        "S", "start S seconds into the recording (%(default)g)", number, default=0.0
    ),
    "--loop": flag("restart at the end"),
    "--paused": flag("start paused"),
    "--size": option("CxR", "columns x rows (120x40)", cells, default=(120, 40)),
    "--port": option(
        "N",
        "port to listen on (%(default)s; 0: any free one)",
        partial(count, least=0),
        default=8000,
    ),
    "--host": option("ADDRESS", "address to listen on (%(default)s)", default="127.0.0.1"),
    "--at-most": option("N", "maximum number of open labs (%(default)s)", count, default=20),
    # times and steps
    "run --time": option(
        "S", "simulated time (required): 60 (s) or 1min", above_zero(seconds, MAX_TIME)
    ),
    "accuracy --time": option(
        "S", "simulated time (ten small-amplitude periods)", above_zero(seconds)
    ),
    "snapshot --time": option("S", "simulated time (%(default)g)", moment, default=12.0),
    "--sample-every": option("N", "record every N steps (default: every 1/30 s)", count),
    "stability --steps": option(
        "N", "steps in each run (%(default)s)", above_zero(count, 2**31), default=10_000
    ),
    "--max-steps": option("N", "refuse recordings of more than N steps", count),
    "--workers": option(
        "N", "compute in N processes on this machine (%(default)s)", count, default=1
    ),
    "--dask": option("ADDRESS", "on a Dask scheduler, such as tcp://10.0.0.1:8786"),
    # studies
    "--all": flag("chart all methods that take any force"),
    "--h-values": option(
        "A:B:N",
        "N step sizes from A to B in s, log-spaced (12, with z = h·w0 from 0.6 to 0.0015)",
        ladder,
    ),
    "--error": choice(
        "largest angle error [rad], largest energy error or final angle error (%(default)s)",
        ("theta", "energy", "final"),
        "theta",
    ),
    "--cost": choice(
        "what counts as cost (%(default)s); a method of your own is timed without Numba",
        ("evaluations", "seconds"),
        "evaluations",
    ),
    "--target": option(
        "ERROR",
        "find the cheapest h for this error, for each method of --all or of --methods",
        positive,
    ),
    "--theta-values": option(
        "LIST",
        f"amplitudes: 0.5,1,120deg or {LIST} (0.1,0.5,1,2,3 and the scene's; for a map, 100)",
        values(above_zero(angle, math.pi)),
    ),
    "--z-values": option(
        "LIST",
        f"z = h·w0: 0.5,1 or {LIST} (up to 3.2 by factors of 1.01; for a map, 200 up to 3)",
        values(above_zero(number, Z_LIMITS[1])),
    ),
    # gates
    "run --fail-if": gate(
        ", e.g. rk4.max_energy_error > 1e-3 or any.verdict == grows; fields: those of --json"
    ),
    "judge --fail-if": gate(f"; fields: {', '.join((*JUDGED, 'verdict'))}"),
    "methods --fail-if": gate(
        f"; fields, as measured: {', '.join((*MEASURED_NUMBERS, *MEASURED_WORDS))}"
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
        "the duration of a step, or of a row if there is no column of times, such as 0.5fs",
        units.quantity,
    ),
    "judge --json": flag("one JSON object, in the units of the file"),
    "--units": option(
        "UNITS",
        "the units, where the file does not name them: time=ps,energy=kJ/mol",
        units.assignments,
        default={},
    ),
    "--from": option(
        "T", "begin at time T, such as 50ps", units.moment, dest="start", default=(-math.inf, "")
    ),
    "--to": option("T", "end at time T", units.moment, dest="end", default=(math.inf, "")),
    "--scale": option(
        None,
        "divide errors by the first energy (first), the standard deviation (std), the mean of "
        "a column (kinetic:COLUMN) or a number; default: first, and 1 for relative errors",
        scale,
        default=(None, None),
    ),
    "--atoms": option("N", "also print the trend per ns per atom", count),
    "--temperature": option("K", "with --atoms: also give the trend in kT", positive),
    "judge --steps": option(
        "H,H",
        "the step size of each file, to see how the errors scale with it",
        step_sizes,
        default=[],
    ),
}


NUMBER_OPTIONS = {f"--{name.replace('_', '-')}": each for name, each in NUMBERS.items()}
for name, each in NUMBER_OPTIONS.items():
    OPTIONS[name] = option(each.metavar, each.about, each.read)
    OPTIONS[f"run {name}"] = option(each.metavar, each.about, values(each.read))

SCENE = ("scene", "--scene", *NUMBER_OPTIONS, "--methods", "--method")
OVERRIDE = "options override the values of the scene"
PICTURE = ("--theme", "--pixels")
DETECTED = "auto: detected from the terminal (see pendu-tui doctor)"

GROUPS: dict[str, tuple[str, str | None, tuple[str, ...]]] = {
    "SCENE": ("scene", OVERRIDE, SCENE),
    "run SCENE": ("scene", f"{OVERRIDE}; a number may be a list, 0.1,0.2 or {LIST}", SCENE),
    "PICTURE": ("display", DETECTED, PICTURE),
    "TERMINAL": ("display", DETECTED, (*PICTURE, "--plain", "--no-mouse", "--fps")),
    "RECOVER": ("recover", None, ("-o", "--force")),
    # At most one option of each of these groups can be given.
    "FORM": ("", "", ("--json", "--csv", "-o")),
    "RECORDING": ("", "", ("--record", "--no-record")),
    "WORKERS": ("", "", ("--workers", "--dask")),
}
"""Options that belong together: their title in the help, a sentence, and their names."""

UNASKED: Settings = {
    **dict.fromkeys(("output", "record", "csv", "cost", "methods", "no_mouse", "fps")),
    "force": False,
    "method": [],
}
"""The values of options that a command does not have."""

MEANINGS = "\n".join(f"  {word}: {each.meaning}" for word, each in VERDICTS.items())


def add_options(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the options of a command, and its examples below them."""
    command = COMMANDS[name]
    parser.set_defaults(**UNASKED)
    _add(parser, name, command.options.split())
    parser.set_defaults(**command.defaults)
    parser.epilog = f"examples:\n{command.examples}".replace("{verdicts}", MEANINGS)


def _add(parser: argparse._ActionsContainer, command: str, names: Iterable[str]) -> None:
    for name in names:
        key = f"{command} {name}"
        if name in GROUPS:
            title, about, members = GROUPS.get(key) or GROUPS[name]
            if title:
                _add(parser.add_argument_group(title, about), command, members)
            else:
                _add(parser.add_mutually_exclusive_group(), command, members)
            continue
        settings = {**(OPTIONS.get(key) or OPTIONS[name])}
        is_file = settings.pop("is_file", False)
        flags = ("-o", "--output") if name == "-o" else (name,)
        action = parser.add_argument(*flags, **settings)
        if is_file:
            action.complete = "file"  # type: ignore[attr-defined]


def commands_with(option: str) -> str:
    """Return the end of a sentence that names the commands with an option, "" if none has it."""
    having = []
    for name, command in COMMANDS.items():
        names = command.options.split()
        groups = [GROUPS[each][2] for each in names if each in GROUPS]
        if option in chain(names, *groups):
            having.append(name)
    if not having:
        return ""
    return f"; it is an option of {', '.join(having)}."


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, and which takes -1e-3 and -pi/2 for numbers."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self._negative_number_matcher = re.compile(r"-(\.?\d|pi|π)")

    def _get_value(self, action: argparse.Action, text: str) -> Any:
        """Return the value of an option; a ValueError's text is the reason to refuse it."""
        try:
            return action.type(text) if callable(action.type) else text
        except ValueError as error:
            raise argparse.ArgumentError(action, str(error)) from None

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Leave values to their readers; choices are for the tab key, except shtab's own."""
        if action.type is None:
            super()._check_value(action, value)

    def error(self, message: str) -> NoReturn:
        sentence = message.removeprefix("argument ")
        match sentence.partition(": "):
            case "unrecognized arguments", _, words if words.startswith("-"):
                option = re.split(r"[\s=]", words)[0]
                near = did_you_mean(option, self._option_string_actions)
                sentence = f"there is no option {option}{commands_with(option) or near}"
        if not sentence.endswith(("?", ".")):
            sentence += f"; {self.prog} --help shows the options."
        raise UserError(sentence)

    def _print_message(self, message: str, file: Any = None) -> None:
        """Write the help; argparse would hide that the disk is full."""
        file.write(message)

    def parse_args(  # type: ignore[override]
        self, arguments: Sequence[str], namespace: Any = None
    ) -> Any:
        """Parse the arguments; words, such as SCENE, may also come between options."""
        if any(each.endswith("=--") for each in arguments):  # of which Python 3.11 makes a list
            self.error("-- is not a value")
        if {"-h", "--help"} & {*arguments}:  # the next would change the help's text
            return super().parse_args(arguments, namespace)
        return self.parse_intermixed_args(arguments, namespace)


def parser_of(name: str) -> Parser:
    """Return a command's parser."""
    command = COMMANDS[name]
    parser = Parser(
        prog=f"pendu-tui {name}",
        description=f"{command.about[0].upper()}{command.about[1:]}.\n\n{command.more}".strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add_options(parser, name)
    return parser


def completion_parser() -> Parser:
    """Return a parser of all commands with --print-completion."""
    import shtab

    parser = Parser(prog="pendu-tui")
    shtab.add_argument_to(parser, "--print-completion")
    parser.add_argument("--version", action="store_true", help="print the version")
    commands = parser.add_subparsers(parser_class=argparse.ArgumentParser)
    for name, each in COMMANDS.items():
        subparser = commands.add_parser(name, help=each.about)
        add_options(subparser, name)
    return parser
