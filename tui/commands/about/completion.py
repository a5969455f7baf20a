"""Print a completion script for bash, zsh or fish: commands, options, scenes, choices and files."""

import argparse

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
    parser.add_argument("shell", metavar="|".join(SHELLS), choices=SHELLS, help="your shell")


def run(options: argparse.Namespace) -> int:
    import shtab

    print(shtab.complete(whole_parser(), options.shell))
    return Exit.FINE


def whole_parser() -> Parser:
    """All commands in one parser, as shtab wants them."""
    from tui.cli.dispatch import COMMANDS, module_of

    parser = Parser(prog="pendu-tui")
    parser.add_argument("--version", action="store_true", help="print the version")
    module_of("live").add_options(parser)  # which pendu-tui alone is
    commands = parser.add_subparsers()
    for name, does in COMMANDS.items():
        module_of(name).add_options(commands.add_parser(name, help=does, description=does))
    for each in (parser, *commands.choices.values()):
        for action in each._actions:
            if action.nargs == argparse.ONE_OR_MORE:
                action.nargs = argparse.REMAINDER  # or shtab has zsh complete only one of them
            if isinstance(action.metavar, str):
                action.metavar = action.metavar.replace(":", " ")  # a colon would end it, for zsh
    return parser
