"""Figures by Matplotlib: what is in them, as wide as a column, and the same bytes each time."""

import re
import subprocess
import sys

import pytest

from tests.tui.command_line import pendu

COMMANDS = {
    "run": ("run", "--time", "20"),
    "accuracy": ("accuracy", "--time", "2", "--h-values", "0.1:0.02:3"),
    "map": ("stability", "--steps", 20, "--z-values", "0.5,1", "--theta-values", "1,2"),
    "section": ("stability", "--section", "--steps", 20, "--starts", 5),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_the_same_input_gives_the_same_figure_of_the_width_of_a_column(name, tmp_path):
    pytest.importorskip("matplotlib")
    for file in ("one.svg", "two.svg", "one.pdf", "one.png"):
        assert pendu(*COMMANDS[name], "-o", tmp_path / file).code == 0
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()
    svg = (tmp_path / "one.svg").read_text(encoding="utf-8")
    width = float(re.search(r'width="([0-9.]+)pt"', svg)[1])
    assert width / 72 * 2.54 == pytest.approx(8.5, abs=0.01)
    assert "<text" not in svg  # letters are outlines
    assert b"/FontFile2" in (tmp_path / "one.pdf").read_bytes()  # TrueType
    assert pendu(*COMMANDS[name], "-o", tmp_path / "one.svg").code == 5


def test_a_figure_has_a_line_for_each_method(tmp_path):
    pytest.importorskip("matplotlib")
    pendu(*COMMANDS["run"], "--methods", "rk4,verlet,heun", "-o", tmp_path / "run.svg")
    svg = (tmp_path / "run.svg").read_text(encoding="utf-8")
    assert {"RK4", "Velocity Verlet", "Heun", "time / s"} <= set(re.findall("<!-- (.*?) -->", svg))


def test_without_matplotlib_there_is_one_sentence_with_the_advice(tmp_path, monkeypatch):
    monkeypatch.setattr("tui.commands.studies.figures.find_spec", lambda name: None)
    path = tmp_path / "run.pdf"
    assert pendu(*COMMANDS["run"], "-o", path).refused(2, ".pdf files need Matplotlib", "[plot]")
    assert not path.exists()


def test_matplotlib_is_loaded_for_figures_only():
    program = (
        "import sys; from tui.cli.dispatch import main; main(['run', '--time', '1']);"
        "sys.exit('matplotlib' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", program], check=True, capture_output=True)
