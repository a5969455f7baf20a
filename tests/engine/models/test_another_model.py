"""A model is added by a file of its own and a place in the list."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
TWIN = """
from pendu_tui.engine.models.mean_field import MeanField

class Twin(MeanField):
    key = "twin"
    bond, turning = MeanField.parameters
    parameters = bond._replace(name="bond"), turning._replace(name="turning")
"""
COMMANDS = """
import shlex, sys
sys.path.insert(0, ".")  # not PYTHONPATH, which the embeddable Python for Windows ignores
from pendu_tui.tui.cli.dispatch import main

for line in (
    "run --scene scene.toml --bond 1.5 --time 2 --record a.mcap",
    "verify a.mcap",
    "export a.mcap -o a.csv",
    "snapshot --scene scene.toml --size 200x60 --time 2 -o a.svg",
):
    assert not main(shlex.split(line)), line
"""


def test_another_model_runs_with_its_variables_is_recorded_verified_and_drawn(tmp_path):
    """In a copy of the program, whose list of models has one more: the mean field's twin."""
    copy = tmp_path / "pendu_tui"
    for package in ("engine", "recordings", "tui"):
        shutil.copytree(ROOT / package, copy / package)
    models = copy / "engine" / "models"
    (models / "twin.py").write_text(TWIN, "utf-8")
    listed = (models / "__init__.py").read_text("utf-8")
    line = "from pendu_tui.engine.models.twin import Twin\n"
    changed = line + re.sub(r"\(\s*Pendulum,", r"\g<0> Twin,", listed)
    assert changed.count("Twin") == 2
    (models / "__init__.py").write_text(changed, "utf-8")
    scene = 'model = "twin"\nmethods = ["rk4"]\n'
    (tmp_path / "scene.toml").write_text(scene, "utf-8")
    (tmp_path / "all.py").write_text(COMMANDS, "utf-8")
    done = subprocess.run(
        [sys.executable, "all.py"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert not done.returncode, done.stderr
    assert "identical" in done.stdout
    assert "probability_error" in (tmp_path / "a.csv").read_text("utf-8")
