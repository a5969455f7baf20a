"""Whoever looks at somebody's recordings where they lie runs none of the code beside them."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pendu_tui.recordings.files import GOLDEN
from tests.tui.command_line import ROOT
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow

COMMANDS = (
    "doctor",
    "run --time 1 --record run.mcap",
    "judge energies.csv --time 1 --energy 2",
    "stability --theta-values 1 --z-values 0.1:2:4 --steps 20 --workers 2",
)
NAMES = (
    "pickle numpy multiprocessing json random signal textual rich mcap zstandard plotext "
    "platformdirs shtab numba sitecustomize usercustomize tui engine recordings"
)


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """A folder with a recording, and a module for everything that somebody may import."""
    folder = tmp_path / "hostile"
    folder.mkdir()
    shutil.copy(GOLDEN / "drift.mcap", folder)
    (folder / "energies.csv").write_text("".join(f"{n},1\n" for n in range(100)))
    for name in NAMES.split():
        code = f"open({str(tmp_path / 'ran')!r}, 'a').write({name!r})\n"
        (folder / f"{name}.py").write_text(code)
        (folder / name).mkdir()
        (folder / name / "__init__.py").write_text(code)
    return folder


@pytest.fixture
def program(tmp_path: Path, monkeypatch) -> list[str]:
    """As what pip installs: a script, somewhere else."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    script = tmp_path / "pendu-tui"
    script.write_text(
        "import sys\nfrom pendu_tui.tui.cli import main\nif __name__ == '__main__': sys.exit(main())\n"
    )
    return [sys.executable, str(script)]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_runs_no_module_of_the_current_folder(tmp_path, hostile, program, command):
    line = [*program, *command.split()]
    done = subprocess.run(line, cwd=hostile, capture_output=True, text=True, check=False)
    assert done.returncode == 0 or command == "doctor", done.stderr
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()


def test_no_view_of_the_lab_runs_a_module_of_the_current_folder(tmp_path, hostile, program):
    with PtyLab("live", program=program, folder=hostile) as session:
        for keys, shown in (
            ("", "LIVE"),
            ("\x1bOR", "g: ring"),
            ("\x1bOS", "points left"),
            ("\x1b[15~", "300 steps"),  # of what another process has computed
        ):
            session.type(keys)
            session.wait_for(shown)
        session.type("s?")
        session.run(0.5)
        session.type("\x1b")
        session.run(0.3)
        session.type("q")
        assert session.end() == 0
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()
