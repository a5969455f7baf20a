"""Figures by Matplotlib: as wide as a column, and the same bytes each time."""

import re

import pytest

from tests.tui.command_line import pendu

COMMANDS = {
    "run": ("run", "--time", "5"),
    "accuracy": ("accuracy", "--time", "1", "--h-values", "0.1:0.05:2"),
    "map": ("stability", "--steps", 20, "--z-values", "0.5,1", "--theta-values", "1,2"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_the_same_input_gives_the_same_figure_of_the_width_of_a_column(name, tmp_path):
    pytest.importorskip("matplotlib")
    files = [tmp_path / "one.svg", tmp_path / "two.svg"]
    for file in files:
        assert pendu(*COMMANDS[name], "-o", file).code == 0
    svg, again = (file.read_text(encoding="utf-8") for file in files)
    assert svg == again
    width = float(re.search(r'width="([0-9.]+)pt"', svg)[1])
    assert width / 72 * 2.54 == pytest.approx(8.5, abs=0.01)
    assert "<text" not in svg  # letters are outlines


@pytest.mark.slow
def test_a_figure_has_a_line_for_each_method(tmp_path):
    pytest.importorskip("matplotlib")
    run = (*COMMANDS["run"], "--methods", "rk4,verlet,heun")
    for suffix in ("svg", "pdf", "png"):
        assert pendu(*run, "-o", tmp_path / f"run.{suffix}").code == 0
    svg = (tmp_path / "run.svg").read_text(encoding="utf-8")
    assert {"RK4", "Velocity Verlet", "Heun", "time / s"} <= set(re.findall("<!-- (.*?) -->", svg))
    assert b"/FontFile2" in (tmp_path / "run.pdf").read_bytes()  # TrueType


def test_without_matplotlib_there_is_one_sentence_with_the_advice(tmp_path, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.report.find_spec", lambda name: None)
    figure = ("-o", tmp_path / "run.pdf")
    assert pendu(*COMMANDS["run"], *figure).refused(2, ".pdf files", "[plot]")
