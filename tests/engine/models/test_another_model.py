"""A model is added by a file of its own and a place in the list."""

import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
MODEL = """
import math
from dataclasses import dataclass
from functools import partial

from pendu_tui.engine.models.model import Number
from pendu_tui.engine.models.model import ExactMotion, ExtraColumn, Model, Observation, State
from pendu_tui.engine.quantities import Chart, Quantity


@dataclass(frozen=True)
class Decaying(Model):
    w0_squared: float
    decay: float

    key = "decaying"
    equation = "theta'' = -w0² theta, u' = -decay u"
    parameters = (Number("decay", "s⁻¹", "of u", 0.0, 10.0, default=0.5),)
    turns = False
    offers = ("rates",)
    variables = (Quantity("u", about="decays"), Quantity("square", chart=Chart("u²")))
    extra_columns = (ExtraColumn("u²", "square", "the square of u", lambda extra: extra["square"]),)
    caption = "a projection, without u"
    without_force = "Maps and studies are for one angle; this model has u as well."
    without_ring = "No ring in three dimensions."

    def start(self, theta, omega):
        return theta, omega, 1.0

    def observe(self, phase):
        theta, omega, u = phase
        return Observation(theta, omega, {"u": u, "square": u * u})

    def rates(self, sin=math.sin):
        return lambda phase: (phase[1], -self.w0_squared * phase[0], -self.decay * phase[2])

    def energy(self, sin=math.sin):
        return lambda phase: phase[1] * phase[1] / 2 + self.w0_squared * phase[0] * phase[0] / 2

    def exact(self, theta, omega):
        return ExactMotion(partial(self._at, theta, omega), "libration", math.tau / self.w0)

    def _at(self, theta, omega, t):
        c, s = math.cos(self.w0 * t), math.sin(self.w0 * t)
        return State(theta * c + omega / self.w0 * s, omega * c - theta * self.w0 * s)
"""
COMMANDS = """
import shlex, sys
sys.path.insert(0, ".")  # not PYTHONPATH, which the embeddable Python for Windows ignores
from pendu_tui.tui.cli.dispatch import main

for line in (
    "run --scene scene.toml --decay 1 --time 2 --json",
    "run --scene scene.toml --time 2 --record a.mcap",
    "verify a.mcap",
    "export a.mcap -o a.csv",
    "snapshot --scene scene.toml --size 200x60 --time 2 -o a.svg",
):
    assert not main(shlex.split(line)), line
"""


def test_another_model_runs_with_its_variables_is_recorded_verified_and_drawn(tmp_path):
    """In a copy of the program, whose list of models has one more."""
    copy = tmp_path / "pendu_tui"
    for package in ("engine", "recordings", "tui"):
        shutil.copytree(ROOT / package, copy / package)
    models = copy / "engine" / "models"
    (models / "decaying.py").write_text(MODEL, "utf-8")
    listed = (models / "__init__.py").read_text("utf-8")
    line = "from pendu_tui.engine.models.decaying import Decaying\n"
    changed = line + re.sub(r"\(\s*Pendulum,", r"\g<0> Decaying,", listed)
    assert changed.count("Decaying") == 2
    (models / "__init__.py").write_text(changed, "utf-8")
    scene = 'model = "decaying"\ndecay = 2.0\nmethods = ["explicit_euler", "rk4"]\n'
    (tmp_path / "scene.toml").write_text(scene, "utf-8")
    (tmp_path / "all.py").write_text(COMMANDS, "utf-8")
    done = subprocess.run(
        [sys.executable, "all.py"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert not done.returncode, done.stderr
    assert "identical" in done.stdout
    answer, _ = json.JSONDecoder().raw_decode(done.stdout)
    rows = answer["methods"]
    assert [row["method"] for row in rows] == ["explicit_euler", "rk4"]
    assert rows[1]["square"] == pytest.approx(math.exp(-4), rel=1e-3)
