import re
import shlex

import pytest

from tests.tui.command_line import pendu
from tui.cli.dispatch import COMMANDS, command_of, split
from tui.cli.errors import Exit


def test_help_shows_every_exit_code():
    _, _, rest = pendu("--help").out.partition("exit codes:")
    codes, _, _ = rest.partition("\n\n")
    assert [int(code) for code in re.findall(r"\d+", codes)] == [
        code for code in Exit if code != Exit.PIPE_CLOSED
    ]


def test_help_with_a_command_is_its_help():
    assert pendu("help", "run").out == pendu("run", "--help").out


def test_version_is_that_of_the_package():
    from importlib.metadata import version

    assert pendu("--version").out == f"pendu-tui {version('pendu-tui')}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_a_command_ends_with_examples_that_its_parser_takes(name):
    out = pendu(name, "--help").out
    examples = [
        line.strip()
        for line in out[out.index("\nexamples:\n") :].splitlines()
        if "pendu-tui" in line
    ]
    examples = [example for example in examples if example.startswith("pendu-tui")]
    assert examples
    for example in examples:
        command, words = split(shlex.split(example.split("|")[0])[1:])
        command_of(command)[0].parse_args(words)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_explained(name):
    parser, _ = command_of(name)
    for action in parser._actions:
        assert action.help, action.dest
