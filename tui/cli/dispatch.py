"""pendu-tui: find the command, run it, return the exit code.  Imports nothing that the command does not need."""

import io
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from tui.cli.errors import Exit, UserError, explained
from tui.cli.files import repeat_swallowed_interrupts

if TYPE_CHECKING:
    from tui.cli.options import Parser

GROUPS = {
    "lab": {
        "live": "the lab: four pendulums, their errors, a recording",
        "tour": "a tour of the lab: eight short steps, each with a question",
        "replay": "play a recording on the same screen",
        "snapshot": "save the lab as an SVG image",
        "serve": "the lab in a browser",
        "keys": "list all keys and mouse actions",
    },
    "studies": {
        "accuracy": "speed against accuracy: which method, which h, at what cost",
        "stability": "where each method becomes unstable: theory and measurement",
        "section": "phase portrait of a method's own map: islands, chaos, spirals",
        "run": "run a scene without the screen and judge each method; for CI",
        "judge": "judge the energies of another program, from a file or stdin; for CI",
    },
    "files": {
        "verify": "re-simulate recordings and compare every bit",
        "info": "show what is in a recording, whole or damaged",
        "diff": "compare two recordings: scene, changes, every number",
        "recover": "salvage a damaged recording",
        "export": "convert a recording to CSV, or to a film (asciicast)",
        "recordings": "list the recordings, or prune them",
    },
    "about": {
        "scenes": "list the scenes, with what to watch",
        "methods": "list the methods with claimed and measured properties",
        "doctor": "check the environment and suggest fixes",
        "completion": "print a shell completion script",
    },
}
"""Folder of tui.commands -> name of a command in it -> what it does."""

COMMANDS = {name: does for group in GROUPS.values() for name, does in group.items()}

USAGE = """\
usage: pendu-tui [COMMAND] [OPTIONS]

Four integrators simulate the same pendulum in your terminal: see which gains, conserves or slowly loses energy.

commands (pendu-tui COMMAND --help shows details):
{commands}

Without a command: live.  pendu-tui --version prints the version.

exit codes: 0 fine, 1 a check failed, 2 usage error, 3 unreadable input, 4 unsuitable terminal, 5 disk error, \
130 interrupted.

examples:
  pendu-tui
  pendu-tui --theta 170deg --h 0.02
  pendu-tui replay latest
  pendu-tui run --scene crossover --time 100
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.  Nothing but a bug leaves a traceback."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without θ shows a ?, not a traceback
    if arguments is None:
        repeat_swallowed_interrupts()
    try:
        code = _dispatch(list(sys.argv[1:] if arguments is None else arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        _drop_output()
        return Exit.PIPE_CLOSED
    except (KeyboardInterrupt, Exception) as error:
        refusal = explained(error)
        from recordings.errors import printable
        from tui.cli.output import warn

        warn(printable(str(refusal), limit=1000))
        try:
            sys.stdout.flush()
        except OSError:
            _drop_output()
        return refusal.code


def _drop_output() -> None:
    """Discard what stdout did not take: at its end the interpreter would try again, and complain."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _dispatch(arguments: list[str]) -> int:
    match arguments:
        case ["-h" | "--help", *_] | ["help"]:
            print(USAGE.format(commands="\n".join(f"  {name:<12}{does}" for name, does in COMMANDS.items())), end="")
            return Exit.FINE
        case ["help", name, *_]:
            return _run(name, ["--help"])
        case ["--version", *_]:
            from importlib.metadata import version

            print(f"pendu-tui {version('pendu-tui')}")
            return Exit.FINE
        case [name, *rest] if not name.startswith("-"):
            return _run(name, rest)
    return _run("live", arguments)


def _run(name: str, arguments: list[str]) -> int:
    parser, command = command_of(name)
    try:
        options = parser.parse_args(arguments)
    except SystemExit:  # --help, printed
        return Exit.FINE
    except UserError as error:
        late = parser.stray(arguments, COMMANDS) if name == "live" else None
        if late:  # a command after its options, which made it live
            raise UserError(f"put the command first: pendu-tui {late}.") from None
        raise parser.unknown_option(arguments) or error from None
    code: int = command.run(options)
    return code


def command_of(name: str) -> tuple["Parser", ModuleType]:
    """A command's parser and module.  Raises UserError if there is none."""
    from argparse import RawDescriptionHelpFormatter

    from engine.scenes import SCENES
    from tui.cli.options import Parser, did_you_mean

    if name not in COMMANDS:
        hint = did_you_mean(name, COMMANDS) or "; pendu-tui --help lists them."
        if name in SCENES:
            hint = f"; for the scene use: pendu-tui --scene {name}"
        elif name.endswith(".mcap"):
            hint = f"; to play the recording use: pendu-tui replay {name}"
        raise UserError(f"there is no command {name!r}{hint}")
    command = module_of(name)
    parser = Parser(
        prog=f"pendu-tui {name}",
        description=command.__doc__,
        epilog=command.EXAMPLES,
        formatter_class=RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    command.add_options(parser)
    return parser, command


def module_of(name: str) -> ModuleType:
    """A command's module."""
    group = next(group for group, names in GROUPS.items() if name in names)
    return import_module(f"tui.commands.{group}.{name}")
