"""Print what makes the tab key complete commands, options, scenes, choices and files, in bash, zsh or fish."""

import argparse
from importlib import import_module

from tui.cli.errors import Exit
from tui.cli.options import Parser

EXAMPLES = """\
examples:
  pendu-tui completion bash

To have it in every new shell:
  bash  add to ~/.bashrc                     eval "$(pendu-tui completion bash)"
  zsh   add to ~/.zshrc, below compinit      eval "$(pendu-tui completion zsh)"
  fish  add to ~/.config/fish/config.fish    pendu-tui completion fish | source
"""

SHELLS = ("bash", "zsh", "fish")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    parser.add_argument("shell", metavar="|".join(SHELLS), choices=SHELLS, help="the shell that is to read it")


def run(options: argparse.Namespace) -> int:
    """Print the script."""
    import shtab

    print(shtab.complete(whole_parser(), options.shell))
    return Exit.FINE


def whole_parser() -> Parser:
    """All commands in one parser, whose arguments know what they can be completed to."""
    from tui.cli.dispatch import COMMANDS

    parser = Parser(prog="pendu-tui")
    parser.add_argument("--version", action="store_true", help="print the version")
    import_module("tui.commands.live").add_options(parser)  # which pendu-tui alone is
    commands = parser.add_subparsers()
    for name, does in COMMANDS.items():
        command = commands.add_parser(name, help=does, description=does)
        import_module(f"tui.commands.{name}").add_options(command)
        _teach(command)
    _teach(parser)
    return parser


def _teach(parser: Parser) -> None:
    """Say what completes what argparse takes as any text."""
    import shtab

    from engine.methods import METHODS
    from engine.scenes import SCENES
    from recordings.library import golden_names
    from tui.cli.fail_if import FIELDS

    for action in parser._actions:
        metavar = str(action.metavar or "")
        if action.dest == "scene":
            action.choices = list(SCENES)
        elif action.dest == "fail_if":
            action.choices = [f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict")]
        elif metavar.startswith(("FILE", "OUT")) and action.option_strings:
            action.complete = shtab.FILE  # type: ignore[attr-defined]
        elif metavar.startswith("FILE"):
            names = ["latest", *golden_names()]
            if action.nargs == argparse.ONE_OR_MORE:
                action.nargs = argparse.REMAINDER  # or shtab has zsh complete only one of them
                names.append("golden")
            action.complete = _files_or(names)  # type: ignore[attr-defined]
        action.metavar = metavar.replace(":", " ") or None  # a colon would end it, for zsh


def _files_or(names: list[str]) -> dict[str, str | dict[str, str]]:
    """What completes to a file or to one of these names, in each shell's own words."""
    words = " ".join(names)
    function = f"_pendu_tui_file_{len(names)}"
    return {
        "bash": function,
        "zsh": function,
        "fish": f"{words} (__fish_complete_path (commandline -ct))",
        "preamble": {
            "bash": f'{function}() {{ compgen -W \'{words}\' -- "$1"; compgen -f -- "$1"; }}',
            "zsh": f"{function}() {{ _alternative 'names:recording:({words})' 'files:file:_files'; }}",
        },
    }
