"""What the first word of a command line may be: a command, a file of ours, a scene."""

from pathlib import Path

import pytest

from engine.methods import METHODS
from recordings.library import GOLDEN
from tests.tui.command_line import pendu
from tui.cli.dispatch import COMMANDS, completion_parser

ONE_SECOND = ("--time", "1", "--json")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("swing.toml").write_text("theta = 0.5\n", encoding="utf-8")
    Path("swing.mcap").write_bytes((GOLDEN / "drift.mcap").read_bytes())


@pytest.mark.parametrize("word", ["crossover", "swing.toml", "swing.mcap"])
def test_a_scene_or_a_file_opens_the_lab_which_needs_a_terminal(word):
    assert pendu(word).refused(4)


@pytest.mark.parametrize("word", ["nothing.toml", "nothing.mcap"])
def test_a_file_that_is_not_there_cannot_be_read(word):
    assert pendu(word).refused(3, word)


@pytest.mark.parametrize(
    ("word", "meant"), [("crosover", "crossover"), ("rum", "run"), ("snapshto", "snapshot")]
)
def test_another_word_is_answered_with_the_nearest_command_or_scene(word, meant):
    assert pendu(word).refused(2, f"did you mean {meant}?")


@pytest.mark.parametrize(
    "arguments",
    [("spin", *ONE_SECOND), (*ONE_SECOND, "spin"), (*ONE_SECOND, "--scene", "spin")],
    ids=" ".join,
)
def test_a_scene_may_stand_before_or_after_the_options(arguments):
    assert pendu("run", *arguments).json["scene"]["name"] == "spin"


def test_two_scenes_are_refused():
    assert pendu("run", "spin", "--scene", "drift", *ONE_SECOND).refused(2, "spin", "drift")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_for_the_tab_key_has_all_commands_and_methods(shell):
    outcome = pendu("--print-completion", shell)
    assert (outcome.code, outcome.err) == (0, "")
    for word in (*COMMANDS, *(method.key for method in METHODS)):
        assert word in outcome.out


def test_an_unknown_shell_is_refused():
    assert pendu("--print-completion", "ksh").refused(2, "bash")


def test_every_option_with_a_file_is_completed():
    for command in completion_parser()._subparsers._group_actions[0].choices.values():
        for action in command._actions:
            if action.metavar in ("FILE", "FILE.svg", "FILE.npz", "KEY,KEY", "SCENE"):
                assert action.choices or action.complete, (command.prog, action.dest)
