"""The README and its pages: their commands, code and tables are right."""

import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import numpy
import pytest

from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.tui.cli.commands import COMMANDS
from pendu_tui.tui.commands.options import parser_of
from pendu_tui.tui.screens.dialogs import bindings_of, key_lines
from pendu_tui.tui.screens.lab import LabScreen

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / ".github" / "docs").glob("*.md"))]
README = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def block_with(language: str, word: str) -> str:
    (block,) = (block for block in blocks(language) if word in block)
    return block


def test_what_is_linked_is_there():
    for page in PAGES:
        for target in re.findall(r"\]\((?!http)(.*?)(?:#.*?)?\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).is_file(), f"{page}: {target}"


@pytest.mark.parametrize("tool", ["pip", "uv"])
@pytest.mark.parametrize("what", ["run it", "test it"])
def test_the_table_has_a_command_for_each_system_that_the_workflow_runs(what, tool):
    command = runpy.run_path(str(ROOT / ".ci" / "readme.py"))["command"]
    here = command(what, tool)
    there = command(f"{what} on Windows", tool)
    in_powershell = here.replace(" && ", "; ").replace(".venv/bin/", ".venv\\Scripts\\")
    assert there == in_powershell.replace("python3", "py")


def test_every_option_that_is_mentioned_exists():
    actions = [action for name in COMMANDS for action in parser_of(name)._actions]
    known = {option for action in actions for option in action.option_strings}
    mentioned = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", README))
    assert mentioned - known == {"--print-completion", "--allow-existing"}  # the latter is of uv


def test_tables_tell_what_the_program_tells():
    commands = "".join(f"| `{name}` | {each.about} |\n" for name, each in COMMANDS.items())
    assert f"| command | does |\n|---|---|\n{commands}" in README
    for each in VERDICTS.values():
        assert f"| `{each.word}` | {each.meaning} |" in README
    section = README.partition("## Keys\n")[2].partition("\n## ")[0]
    keys = re.findall(r"^\| `(.+?)` \| (.+) \|$", section, re.MULTILINE)
    assert len(keys) == 9
    assert {f"{key:<9}{does}" for key, does in keys} <= set(key_lines(bindings_of(LabScreen)))


def ran(folder: Path, *command: str | Path, **environment: str) -> subprocess.CompletedProcess:
    """Run a command in a folder, with the tested program first on the path."""
    programs = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    env = {**os.environ, "PATH": programs, **environment}
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)


@pytest.fixture
def shell(tmp_path):
    """Run a line as a reader would, in a folder of the test."""

    def run(line: str) -> str:
        done = ran(tmp_path, "bash", "-c", line, PENDU_RECORDINGS=str(tmp_path / "library"))
        lines = done.stderr.splitlines()
        told = [text for text in lines if not text.startswith("pendu-tui: wrote")]
        needs_a_terminal = done.returncode == 4 and "the lab is interactive" in done.stderr
        assert needs_a_terminal or (done.returncode, told) == (0, []), line
        return done.stdout

    return run


MY_MD = """
import math

def step(force, phase, h):
    q, p = phase
    a = force(q)
    while True:
        p = p + h / 2 * a
        q = q + h * p
        a = force(q)
        p = p + h / 2 * a
        yield q, p

def run(h, time=500):
    times, energies = [], []
    phases = step(lambda q: -math.sin(q), (1.0, 0.0), h)
    for count in range(1, round(time / h) + 1):
        q, p = next(phases)
        times.append(h * count)
        energies.append(2 + p * p / 2 - math.cos(q))
    return times, energies
"""


PLACEHOLDERS = {"judge FILE", "COMMAND --help", "verify", "serve"}  # the last one does not end


@pytest.mark.slow
def test_the_commands_of_text_and_blocks_run(shell, tmp_path, monkeypatch, capsys):
    (tmp_path / "my_md.py").write_text(MY_MD, encoding="utf-8")
    (tmp_path / "mine.py").write_text(block_with("python", "def ruth_3"), encoding="utf-8")
    (tmp_path / "course.toml").write_text(blocks("toml")[0], encoding="utf-8")
    exec(MY_MD, names := {})
    for name, h in (("fine.csv", 0.05), ("coarse.csv", 0.1), ("md.log", 0.1)):
        rows = zip(*names["run"](h), strict=True)
        text = "\n".join(f"{time!r},{energy!r}" for time, energy in rows)
        (tmp_path / name).write_text(f"time,energy\n{text}\n", encoding="utf-8")
    inline = dict.fromkeys(re.findall(r"`pendu-tui ([^`]*)`", README)).keys() - PLACEHOLDERS
    ordered = sorted(inline, key=lambda command: "verify" in command)  # after what they verify
    for line in [*"".join(blocks("sh")).splitlines(), *(f"pendu-tui {each}" for each in ordered)]:
        shell(line)
    assert (tmp_path / "saved.mcap").exists()
    monkeypatch.chdir(tmp_path)
    exec(block_with("python", "crossover.csv"), {"numpy": numpy})
    assert float(capsys.readouterr().out) == pytest.approx(0.16, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("command", re.findall(r"^\$ (.*)$", README, re.MULTILINE))
def test_what_is_shown_of_a_command_is_what_it_prints(shell, command):
    def lines(text: str) -> list[str]:
        return [re.sub(r"in [\d.]+ s$", "", line.rstrip()) for line in text.splitlines()]

    shown = README.partition(f"$ {command}\n")[2].partition("```")[0].partition("\n$ ")[0]
    assert lines(shell(command)) == lines(shown)


@pytest.fixture
def project(tmp_path):
    """Make a project with a test file, and return what its pytest prints."""

    def tested(test: str, my_md: str = MY_MD) -> str:
        (tmp_path / "test_mine.py").write_text(test, encoding="utf-8")
        (tmp_path / "my_md.py").write_text(my_md, encoding="utf-8")
        alone = "-q -W error -p no:cacheprovider -p no:asyncio -p no:xdist --rootdir ."
        done = ran(tmp_path, sys.executable, "-m", "pytest", *alone.split(), "--junit-xml", "j.xml")
        return done.stdout + done.stderr

    return tested


@pytest.mark.slow
def test_the_three_gates_pass_on_right_code_and_fail_on_a_forgotten_half_kick(project, tmp_path):
    test = block_with("python", "import my_md")
    assert "3 passed" in project(test)
    report = (tmp_path / "j.xml").read_text(encoding="utf-8")
    assert '<property name="verdict" value="bounded"' in report
    told = project(test, MY_MD.replace("        p = p + h / 2 * a\n        yield", "        yield"))
    assert "3 failed" in told
    for reason in ("the wrong equation", "the energy fluctuates as h^(", "the error is"):
        assert reason in told


@pytest.mark.slow
def test_recordings_below_a_folder_are_tests(project, tmp_path):
    (line,) = re.findall(r"`(test_recordings = [^`]*)`", README)
    imports = "from pendu_tui.recordings.pytest import verify_recordings"
    test = f"from pathlib import Path\n{imports}\n{line}"
    told = project(test)
    assert "test_recordings[no recording]" in told
    assert "there is no recording below this folder" in told
    shutil.copy(ROOT / "recordings" / "golden" / "drift.mcap", tmp_path)
    assert "1 passed" in project(test)


@pytest.mark.slow
def test_the_library_does_what_the_readme_shows(capsys):
    exec(block_with("python", "from pendu_tui.engine import"), names := {})
    assert capsys.readouterr().out.startswith("verdict       bounded\ntrend ")
    assert names["run"]["rk4"].verdict == "loses"
    general = sum(method.general for method in names["METHODS"].values())
    assert f"\n{general} methods take any force" in README


@pytest.mark.slow
def test_a_method_of_ones_own_is_measured_and_put_on_stage_as_described(shell, tmp_path):
    (tmp_path / "mine.py").write_text(block_with("python", "def ruth_3"), encoding="utf-8")
    commands = re.findall(r"`(pendu-tui [^`]*--method mine[^`]*)`", README)
    told, on_stage, _ = (shell(command) for command in commands)
    (words,) = (line.split() for line in told.splitlines() if line.startswith("ruth_3"))
    assert words[1:] == ["-", words[2], "3", "yes", "no", "2.507"]
    assert float(words[2]) == pytest.approx(3, abs=0.01)
    assert re.search(r"Ruth 3 +bounded", on_stage)


@pytest.mark.slow
def test_a_method_is_added_to_the_project_as_described(tmp_path):
    for package in ("engine", "recordings", "tui"):
        shutil.copytree(ROOT / package, tmp_path / "pendu_tui" / package)
    family = tmp_path / "pendu_tui" / "engine" / "methods" / "splitting.py"
    source, of_family, members = family.read_text(encoding="utf-8").partition("FAMILY = (")
    method = block_with("python", "def ruth_3") + "\n\n" + block_with("python", "Method(")
    family.write_text(f"{source}{method}\n{of_family}RUTH_3, {members}", encoding="utf-8")

    def run(*arguments: str) -> str:
        done = ran(tmp_path, sys.executable, "-P", *arguments, PYTHONPATH=str(tmp_path))
        assert done.returncode == 0, done.stderr
        return done.stdout

    pendu = ("-c", "import sys; from pendu_tui.tui.cli import main; sys.exit(main())")
    assert "Ruth 3  bounded" in run(*pendu, "run", "--time", "60", "--methods", "ruth,rk4")
    (tmp_path / "tests").mkdir()
    shutil.copy(ROOT / "tests" / "models.py", tmp_path / "tests")
    claims = shutil.copy(ROOT / "tests" / "engine" / "methods" / "test_claims.py", tmp_path)
    alone = ("-c", os.devnull, "--rootdir", ".", "-p", "no:cacheprovider")
    told = run("-m", "pytest", *alone, claims, "-k", "ruth_3 and not every_bit")
    assert re.search(r"= [4-9] passed, \d+ deselected", told)
