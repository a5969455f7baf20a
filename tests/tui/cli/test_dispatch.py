"""From the first word of a command line to its exit code."""

import errno
import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from unittest.mock import Mock

import pytest

from pendu_tui.engine.methods import METHODS
from pendu_tui.recordings.files import GOLDEN
from pendu_tui.tui.cli import dispatch
from pendu_tui.tui.cli.commands import COMMANDS, DROPPED
from pendu_tui.tui.cli.dispatch import split
from pendu_tui.tui.commands.options import completion_parser, parser_of
from tests.tui.command_line import PENDU, pendu


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("swing.toml").write_text("theta = 0.5\n", encoding="utf-8")
    for name in ("swing.csv", "swing.py"):
        Path(name).touch()
    for name in ("swing.mcap", "killed.mcap.part"):
        Path(name).write_bytes((GOLDEN / "drift.mcap").read_bytes())


@pytest.mark.parametrize(
    "line", ["", "crossover", "swing.toml", "swing.mcap", "killed.mcap.part", "tour"]
)
def test_nothing_a_scene_or_a_file_opens_the_lab_which_needs_a_terminal(line):
    assert pendu(*line.split()).refused(4, "not a terminal")


@pytest.mark.parametrize("words", ["spin --time 1", "--time 1 spin", "--time 1 --scene spin"])
def test_a_scene_may_stand_before_or_after_the_options(words):
    assert pendu("run", *words.split(), "--json").json["scene"]["name"] == "spin"
    assert pendu("recordings", "show", "--json", "swing.mcap").json["seconds"] == 15


# a word of what is used instead of each name in DROPPED
TODAY = (
    "alone keys F3 F3 F5 pytest pytest loops loops lists "
    "--workers --workers --workers table smaller CSV rm verify replay"
)


@pytest.mark.parametrize(
    ("line", "code", "words"),
    [
        ("nothing.toml", 3, "nothing.toml"),
        ("nothing.mcap", 3, "nothing.mcap"),
        ("swing.csv", 2, "pendu-tui judge swing.csv"),
        ("swing.py", 2, "pendu-tui --method swing.py"),
        ("crosover", 2, "did you mean crossover?"),
        ("jugde", 2, "did you mean judge?"),
        ("run --scene rift", 2, "there is no scene 'rift': did you mean drift?"),
        ("zzz", 2, "there is no command or scene 'zzz'; pendu-tui --help lists them."),
        (".", 2, "'.'; pendu-tui --help"),  # a folder
        ("run spin --scene drift --time 1", 2, "spin and drift"),
        ("run stiff-slow --methods x", 2, "explicit_euler, velocity_verlet"),  # for its model
        ("--print-completion ksh", 2, "--print-completion: "),
        ("stability --scene damped", 2, "no friction"),
        ("run --tim 10", 2, "there is no option --tim: did you mean --time?\n"),
        ("run --plain", 2, "no option --plain; it is an option of live, tour, replay.\n"),
        ("run --strength 1", 2, "no option --strength; pendu-tui run --help"),  # not --length
        ("run --DT", 2, "there is no option --DT; pendu-tui run --help"),  # not --dask
        ("run --METHOD_", 2, "there is no option --METHOD_: did you mean --method?\n"),
        ("run --resume=x", 2, DROPPED["run --resume"]),
        ("snapshot -x lab.svg", 2, "there is no option -x; pendu-tui snapshot --help"),
        ("accuracy --cost second", 2, "--cost: there is no choice 'second': did you mean seconds?"),
        ("run --time --h 0.1", 2, "--time: expected one argument"),
        ("run --time 1 drift more", 2, "unrecognized arguments: more"),
        ("--h 0.1 run", 2, "there is no scene 'run'"),
        ("--theta=--", 2, "-- is not a"),
        *((f"{name} x --json", 2, new) for name, new in zip(DROPPED, TODAY.split(), strict=True)),
    ],
)
def test_a_mistake_is_one_sentence_that_helps(line, code, words):
    assert pendu(*line.split()).refused(code, words)


def test_a_bug_is_not_hidden_behind_a_sentence(monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.lists.scenes", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        pendu("scenes")


def test_an_interrupt_is_one_sentence_even_if_a_library_makes_another_error_of_it(monkeypatch):
    def interrupted(_: object) -> int:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:
            raise ImportError("half imported") from None

    monkeypatch.setattr("pendu_tui.tui.commands.lists.scenes", interrupted)
    outcome = pendu("scenes")
    assert (outcome.code, outcome.err) == (130, "pendu-tui: interrupted.\n")


def process(command: str, **options: object) -> subprocess.CompletedProcess[str]:
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | options
    return subprocess.run([*PENDU, *command.split()], check=False, **streams)


@pytest.mark.parametrize(("file", "code"), [(None, 141), ("a?.csv", 5)])
def test_windows_tells_of_a_closed_pipe_by_an_error_without_a_file(monkeypatch, file, code):
    error = OSError(errno.EINVAL, "Invalid argument", file)
    monkeypatch.setattr("pendu_tui.tui.commands.lists.scenes", Mock(side_effect=error))
    monkeypatch.setattr(dispatch, "_drop_output", lambda: 141)
    assert pendu("scenes").code == code


def test_a_closed_pipe_prints_nothing_and_exits_with_141():
    reading, writing = os.pipe()
    os.close(reading)
    done = process("scenes", stdout=writing)
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.skipif(not shutil.which("bash"), reason="needs bash")
def test_a_closed_stdout_is_one_sentence_and_exit_5_and_a_closed_stderr_silence():
    for closed, code, told in ((">&-", 5, 1), (">&- 2>&-", 5, 0), ("2>&-", 2, 0)):
        line = f"{shlex.join(map(str, PENDU))} {'swing.csv' if code == 2 else 'scenes'} {closed}"
        done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout) == (code, "")
        assert done.stderr.count("\n") == done.stderr.count("pendu-tui: ") == told


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/full")
def test_a_full_disk_under_stdout_is_one_sentence_and_exit_5():
    with Path("/dev/full").open("w") as full:
        for line in ("scenes", "run --help"):
            done = process(line, stdout=full)
            assert (done.returncode, done.stderr.count("\n")) == (5, 1)
            assert "output: No space left on device; free some space" in done.stderr


def test_an_ascii_terminal_gets_question_marks_not_a_traceback():
    done = process("scenes", env={**os.environ, "PYTHONIOENCODING": "ascii"}, text=False)
    assert (done.returncode, b"?" in done.stdout, b"\r" in done.stdout) == (0, True, False)


def test_help_and_version():
    assert "what to do (list)" in pendu("recordings", "--help").out
    assert "\n  pendu-tui recordings show latest\n" in pendu("recordings", "--help").out
    assert f"\n  live        {COMMANDS['live'].about}\n" in (text := pendu("--help").out)
    assert text.endswith("\n  pendu-tui run crossover --time 100\n")
    assert pendu("--version").out == f"pendu-tui {version('pendu-tui')}\n"


def test_the_parser_takes_the_examples():
    for name in COMMANDS:
        parser = parser_of(name)
        examples = re.findall(r"^ +(pendu-tui .*)", parser.epilog, re.MULTILINE)
        assert examples
        for example in examples:
            word, words = split(shlex.split(example.split("|")[0])[1:])
            parser_of(word).parse_args(words)
    dark = [name for name in COMMANDS if parser_of(name).get_default("theme") == "dark"]
    assert dark == ["snapshot", "serve"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_for_the_tab_key_has_all_commands_methods_and_files(shell):
    outcome = pendu("--print-completion", shell)
    assert (outcome.code, outcome.err) == (0, "")
    for word in (*COMMANDS, *(method.key for method in METHODS)):
        assert word in outcome.out
    for command in completion_parser()._subparsers._group_actions[0].choices.values():
        for action in command._actions:
            if action.metavar in ("FILE", "FILE.svg", "KEY,KEY", "SCENE"):
                assert action.choices or action.complete, (command.prog, action.dest)
