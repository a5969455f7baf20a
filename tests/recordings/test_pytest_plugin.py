"""The pytest plugin, in a project that has folders of its own with the names of ours."""

import subprocess
import sys
from pathlib import Path

GAME = """
import sys

import engine
import recordings
import tui


def test_the_projects_own_packages_are_imported():
    assert (engine.x, recordings.x, tui.x) == ("engine", "recordings", "tui")


def test_nothing_of_pendu_tui_is_loaded_before_a_test_uses_it():
    loaded = {"numpy", "textual", "pendu_tui.engine", "pendu_tui.recordings.verification"}
    assert not loaded & set(sys.modules)


def test_energies_are_judged(energy_drift):
    times = [0.1 * step for step in range(4000)]
    energies = [10 + step * 7919 % 101 / 1e5 for step in range(4000)]
    assert energy_drift.check(times, energies).verdict == "bounded"
"""


def test_installed_is_enough_and_nothing_of_the_project_is_hidden(tmp_path):
    for name in ("engine", "recordings", "tui"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text(f"x = {name!r}\n")
    (tmp_path / "test_game.py").write_text(GAME)
    (tmp_path / "pytest.ini").write_text("[pytest]\npythonpath = .\n")
    options = ["-q", "-W", "error", "-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:asyncio"]
    command = [Path(sys.executable).with_name("pytest"), *options]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "3 passed" in done.stdout, done.stdout + done.stderr
