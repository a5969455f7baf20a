"""Whoever unpacks somebody's recordings and looks at them there runs none of the code beside them."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from recordings.library import GOLDEN
from tests.tui.pty_lab import ROOT, PtyLab
from tui.cli.dispatch import COMMANDS

pytestmark = pytest.mark.slow

SMALL_MAP = ("--map", "--theta-values", "1", "--z-values", "0.1:2:4", "--steps", "20")
SECTION = ("--section", "--starts", "9", "--steps", "50", "-o", "map.svg")
ARGUMENTS: dict[str, list[tuple[str, ...]]] = {
    "snapshot": [("--time", "0.1", "-o", "out.svg")],
    "accuracy": [("--time", "1")],
    "stability": [
        (*SMALL_MAP, "--workers", "2"),
        ("--theta-values", "1", "--z-values", "1:2:3", "--steps", "20"),
        SECTION,
    ],
    "run": [("--time", "1", "--record", "run.mcap"), ("--time", "1", "--json")],
    "verify": [("drift.mcap",)],
    "judge": [("energies.csv", "--time", "1", "--energy", "2")],
    "diff": [("drift.mcap", "drift.mcap")],
    "export": [("drift.mcap", "-o", "out.csv")],
    "recordings": [
        (),
        ("show", "drift.mcap"),
        ("show", "drift"),
        ("recover", "drift.mcap", "-o", "out.mcap"),
    ],
    "scenes": [()],
    "methods": [()],
    "doctor": [()],
}
"""Of every command without a screen."""

ON_SCREEN: dict[str, tuple[str, ...]] = {"live": (), "tour": (), "replay": ("drift.mcap",)}
NAMES = (
    *(
        "pickle",
        "numpy",
        "multiprocessing",
        "json",
        "random",
        "signal",
        "textual",
        "rich",
        "mcap",
        "zstandard",
    ),
    *(
        "plotext",
        "platformdirs",
        "shtab",
        "numba",
        "sitecustomize",
        "usercustomize",
        "tui",
        "engine",
        "recordings",
    ),
)


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """A folder with a recording, and a module for everything that somebody may import."""
    folder = tmp_path / "hostile"
    folder.mkdir()
    shutil.copy(GOLDEN / "drift.mcap", folder)
    (folder / "energies.csv").write_text("".join(f"{n},1\n" for n in range(100)))
    for name in NAMES:
        code = f"open({str(tmp_path / 'ran')!r}, 'a').write({name!r})\n"
        (folder / f"{name}.py").write_text(code)
        (folder / name).mkdir()
        (folder / name / "__init__.py").write_text(code)
    return folder


@pytest.fixture
def program(tmp_path: Path) -> list[str]:
    """As what pip installs: a script, somewhere else."""
    script = tmp_path / "pendu-tui"
    script.write_text(
        "import sys\nfrom tui.cli.dispatch import main\nif __name__ == '__main__': sys.exit(main())\n"
    )
    return [sys.executable, str(script)]


def environment(tmp_path: Path) -> dict[str, str]:
    return {"PYTHONPATH": str(ROOT), "PENDU_RECORDINGS": str(tmp_path / "library")}


def test_every_command_is_tried():
    assert {*ARGUMENTS, *ON_SCREEN} == {*COMMANDS} - {
        "serve"
    }  # which starts its labs with -P, as it says


@pytest.mark.parametrize(
    "arguments",
    [(command, *each) for command, some in ARGUMENTS.items() for each in some],
    ids=" ".join,
)
def test_a_command_runs_no_module_of_the_current_folder(tmp_path, hostile, program, arguments):
    done = subprocess.run(
        [*program, *arguments],
        cwd=hostile,
        env={**os.environ, **environment(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode in ((0, 1, 4) if arguments[0] == "doctor" else (0,)), done.stderr
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()


@pytest.mark.parametrize("command", ON_SCREEN)
def test_no_lab_runs_a_module_of_the_current_folder(tmp_path, hostile, program, command):
    arguments = (command, *ON_SCREEN[command])
    with PtyLab(*arguments, program=program, folder=hostile, **environment(tmp_path)) as session:
        session.wait_for("Quit")
        if command == "live":
            look_at_all_views(session)
        session.type("s?")
        session.run(0.5)
        session.type("\x1b")
        session.run(0.3)
        session.type("q")
        assert session.end() == 0
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()


def look_at_all_views(session: PtyLab) -> None:
    session.type("\x1bOR")  # F3
    session.wait_for("area")
    session.type("x")
    session.wait_for("Own map of Velocity Verlet")
    session.wait_for("computing 10%")  # by another process
    session.type("\x1bOS")  # F4
    session.wait_for("points left")
    session.type("\x1b[15~")  # F5
    session.wait_for("300 steps")  # of what another process has computed


def test_what_lies_there_would_be_run_if_python_looked_for_it(tmp_path, hostile):
    unsafe = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
    subprocess.run([sys.executable, "-c", "import plotext"], cwd=hostile, env=unsafe, check=True)
    assert "plotext" in (tmp_path / "ran").read_text()
