import os
import subprocess
from pathlib import Path

import pytest

from tests.tui.command_line import pendu
from tests.tui.pty_lab import PENDU
from tui.cli.dispatch import RENAMED


@pytest.mark.parametrize(
    "arguments", [("scnes",), ("scenes", "--jsn"), ("scenes", "extra"), ("--nonsense",)]
)
def test_a_mistake_on_the_command_line_is_one_sentence_and_exit_2(arguments):
    assert pendu(*arguments).refused(2)


def test_a_mistyped_command_is_answered_with_the_nearest_one():
    assert pendu("scenez").refused(2, "did you mean scenes?")


@pytest.mark.parametrize("name", RENAMED)
def test_an_old_command_is_answered_with_the_new_one(name):
    assert pendu(name, "x", "--json").refused(2, f"use: pendu-tui {RENAMED[name]}")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "--tiem", "10"), "run has no option --tiem: did you mean --time?"),
        (("run", "--tiem=10"), "--time?"),
        (("snapshot", "-x", "lab.svg"), "snapshot has no option -x; pendu-tui snapshot --help"),
        (("--nonsense",), "live has no option --nonsense"),
    ],
)
def test_an_unknown_option_is_named_before_one_that_is_missing(arguments, words):
    assert pendu(*arguments).refused(2, words)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("judge", "x.csv"), "required: --time, --energy"),
        (("run", "--time", "1", "--theta", "-abc"), "has no option -a"),
        (("run", "--time", "--h", "0.1"), "--time: expected one argument"),
        (("run", "--time", "1", "drift", "more"), "unrecognized arguments: more"),
    ],
)
def test_a_mistake_with_known_options_is_reported_by_argparse(arguments, words):
    assert pendu(*arguments).refused(2, words)


@pytest.mark.parametrize("argument", ["--theta=--", "--record=--", "--scene=--"])
def test_two_hyphens_are_no_value(argument):
    assert pendu(argument).refused(2, argument.removesuffix("=--"))
    assert pendu("snapshot", "-o--").refused(2, "-o")


def test_a_bug_is_not_hidden_behind_a_sentence(monkeypatch):
    monkeypatch.setattr("tui.commands.about.scenes.run", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        pendu("scenes")


@pytest.mark.parametrize("becomes", [KeyboardInterrupt, ImportError])
def test_an_interrupt_is_one_sentence_and_exit_130_even_if_a_library_makes_another_error_of_it(
    monkeypatch, becomes
):
    def interrupted(_: object) -> int:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:
            raise becomes("half imported") from None

    monkeypatch.setattr("tui.commands.about.scenes.run", interrupted)
    outcome = pendu("scenes")
    assert (outcome.code, outcome.err) == (130, "pendu-tui: interrupted.\n")


def test_a_closed_pipe_prints_nothing_and_exits_with_141():
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [*PENDU, "scenes"], stdout=writing, stderr=subprocess.PIPE, text=True, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.skipif(
    not Path("/dev/full").exists(), reason="a device that is always full is Linux's"
)
@pytest.mark.parametrize("command", ["methods", "scenes"])  # less than a buffer, and more
def test_a_full_disk_under_stdout_is_one_sentence_and_exit_5(command):
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*PENDU, command], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 5
    assert (
        done.stderr
        == "pendu-tui: output: No space left on device; free some space or write elsewhere.\n"
    )


def test_an_ascii_terminal_gets_question_marks_not_a_traceback():
    ascii_only = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [*PENDU, "methods"], env=ascii_only, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0
    assert "h?w0" in done.stdout


def test_an_escape_sequence_on_the_command_line_is_not_printed_raw():
    assert "\x1b" not in pendu("\x1b[31mscenes").err
