"""The tab key in real shells, those of them that are installed."""

import os
import pty
import select
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from engine.methods import METHODS
from engine.scenes import SCENES
from recordings.library import golden_names
from tests.tui.command_line import pendu
from tui.cli.dispatch import COMMANDS
from tui.commands.about.completion import EXAMPLES, SHELLS, whole_parser
from tui.drawing.palette import PALETTES

THEMES = {"auto", *PALETTES}
ANY_RECORDING = {"latest", *golden_names(), "swing.mcap"}
PATIENCE = 60.0  # s, for a shell on a busy machine; half a second is usual

CASES = [  # what is typed before the tab, and what it offers: just that, or that among others
    ("pendu-tui re", {"replay", "recover", "recordings"}),
    ("pendu-tui --scene cro", {"crossover"}),
    ("pendu-tui run --scene ", set(SCENES)),
    ("pendu-tui run --theta 1 --scene sp", {"spin"}),
    ("pendu-tui live --present --theme ", THEMES),
    ("pendu-tui tour --no-r", {"--no-record"}),
    ("pendu-tui replay ", ANY_RECORDING),
    ("pendu-tui verify drift ", ANY_RECORDING | {"golden"}),
    ("pendu-tui run --record ", {"swing.mcap"}),
    ("pendu-tui diff drift ", ANY_RECORDING),
    ("pendu-tui export drift --format ", {"csv", "cast", "foxglove"}),
    ("pendu-tui run --fail-if rk4.m", {"rk4.max_energy_error"}),
    ("pendu-tui recordings ", {"list", "prune"}),
    ("pendu-tui serve --at-m", {"--at-most"}),
    ("pendu-tui completion ", set(SHELLS)),
    ("pendu-tui run --methods forest", {"forest_ruth"}),
    ("pendu-tui replay drift --methods velocity_v", {"velocity_verlet"}),
    ("pendu-tui methods --method ", {"swing.mcap"}),
    ("pendu-tui accuracy --h-values 0.1:0.01:3 --err", {"--error"}),
]


def needs(shell):
    return pytest.mark.skipif(shutil.which(shell) is None, reason=f"{shell} is not installed")


@pytest.fixture
def script(tmp_path, monkeypatch):
    """A folder with a recording and a shell's script in it: the file's name."""
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "swing.mcap").touch()
    monkeypatch.chdir(tmp_path / "here")

    def write(shell):
        outcome = pendu("completion", shell)
        assert (outcome.code, outcome.err) == (0, "")
        file = tmp_path / f"pendu-tui.{shell}"
        file.write_text(outcome.out, encoding="utf-8")
        return file

    return write


@pytest.mark.parametrize("shell", [pytest.param(shell, marks=needs(shell)) for shell in SHELLS])
def test_the_script_is_one_that_its_shell_can_read(shell, script):
    done = subprocess.run([shell, "-n", script(shell)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@needs("bash")
@pytest.mark.parametrize(("typed", "offered"), CASES)
def test_bash_completes(typed, offered, script):
    ask = (
        'source "$1"; COMP_WORDS=("${@:2}"); COMP_CWORD=$(($# - 2)); _shtab_pendu_tui; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    done = subprocess.run(
        ["bash", "-c", ask, "bash", script("bash"), *typed.split(" ")], capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
    assert set(done.stdout.split()) == offered


@needs("fish")
@pytest.mark.parametrize(("typed", "offered"), CASES)
def test_fish_completes(typed, offered, script, tmp_path):
    done = subprocess.run(
        ["fish", "--no-config", "-c", "source $argv[1]; complete -C $argv[2]", script("fish"), typed],
        env={**os.environ, "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr == ""
    assert {line.partition("\t")[0] for line in done.stdout.splitlines()} == offered


@needs("zsh")
@pytest.mark.parametrize(("typed", "offered"), CASES)
def test_zsh_completes(typed, offered, script):
    """Only its line editor can say, so it is asked by a terminal, and lists what a tab finds even if it is but one."""
    script("zsh")
    pid, terminal = pty.fork()
    if pid == 0:
        os.environ["TERM"] = "dumb"
        os.execvp("zsh", ["zsh", "-f", "-i"])
    try:
        set_up = (
            "PS1=; PROMPT_EOL_MARK=; LISTMAX=1000; setopt no_beep; unset zle_bracketed_paste; autoload -U compinit; "
            'compinit -u -D; eval "$(<../pendu-tui.zsh)"; bindkey "^X" list-choices; echo rea""dy\n'
        )
        os.write(terminal, set_up.encode())
        read_until(terminal, {"ready\r\n"})
        os.write(terminal, typed.encode() + b"\t" * (len(offered) == 1) + b"\x18" * (len(offered) > 1))
        read_until(terminal, offered)
    finally:
        os.kill(pid, signal.SIGKILL)
        os.close(terminal)
        os.waitpid(pid, 0)


def read_until(terminal, words):
    read = ""
    deadline = time.monotonic() + PATIENCE
    while not all(word in read for word in words):
        assert select.select([terminal], [], [], max(0.0, deadline - time.monotonic()))[0], read
        read += os.read(terminal, 1 << 16).decode(errors="replace")


@needs("bash")
def test_bash_completes_the_last_of_several_methods(script):
    ask = 'source "$1"; _pendu_tui_methods rk4,symp'
    done = subprocess.run(["bash", "-c", ask, "bash", script("bash")], capture_output=True, text=True, check=True)
    assert done.stdout == "rk4,symplectic_euler\n"


COMPLETED = {"NAME", "KEY,KEY", "FILE.py FUNCTION[,letter=m]", "FILE", "OUT", "EXPR", "FILE.svg", "FILE.npz"}


def test_every_option_with_a_choice_or_a_file_can_be_completed():
    for command in whole_parser()._subparsers._group_actions[0].choices.values():
        for action in command._actions:
            if action.metavar in COMPLETED:
                assert action.choices or action.complete, (command.prog, action.dest)


def test_the_readme_and_the_help_agree_on_every_shell():
    lines = EXAMPLES.partition("To have it in every new shell:\n")[2].splitlines()
    assert tuple(line.split()[0] for line in lines) == SHELLS
    readme = (Path(__file__).parents[3] / "README.md").read_text(encoding="utf-8")
    assert "\n".join(line.strip() for line in lines) in readme


def test_every_command_is_completed():
    assert set(whole_parser()._subparsers._group_actions[0].choices) == set(COMMANDS)


@pytest.mark.parametrize("shell", SHELLS)
def test_every_method_can_be_completed(shell):
    script = pendu("completion", shell).out
    for method in METHODS:
        assert f"{method.key}.max_energy_error" in script


@pytest.mark.parametrize("arguments", [(), ("tcsh",), ("bash", "zsh")])
def test_a_wrong_shell_or_none_is_one_sentence_and_exit_2(arguments):
    assert pendu("completion", *arguments).refused(2)
    assert pendu("completion").refused(2, "bash|zsh|fish")
