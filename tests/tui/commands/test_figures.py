"""Figures by Matplotlib: as wide as a column, and the same bytes each time."""

import re

import pytest

from tests.tui.command_line import pendu

RUN = ("run", "--time", "5", "--methods", "rk4,verlet,heun", "-o")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "label"),
    [
        (RUN, "time / s"),
        (("accuracy", "--time", "1", "--h-values", "0.1:0.05:2", "-o"), "force evaluations"),
        (
            ("stability", "--steps", 20, "--z-values", "0.5,1", "--theta-values", "1,2", "-o"),
            "amplitude / °",
        ),
    ],
    ids=["run", "accuracy", "stability"],
)
def test_the_same_input_gives_the_same_figure_of_the_width_of_a_column(command, label, tmp_path):
    pytest.importorskip("matplotlib")
    files = [tmp_path / "one.svg", tmp_path / "two.svg"]
    for file in files:
        assert pendu(*command, file).code == 0
    svg, again = (file.read_text(encoding="utf-8") for file in files)
    assert svg == again
    width = float(re.search(r'width="([0-9.]+)pt"', svg)[1])
    assert width / 72 * 2.54 == pytest.approx(8.5, abs=0.01)
    assert "<text" not in svg  # letters are outlines
    assert {"RK4", "Velocity Verlet", label} <= set(re.findall("<!-- (.*?) -->", svg))


@pytest.mark.slow
def test_other_figures_are_pdf_with_truetype_and_png(tmp_path):
    pytest.importorskip("matplotlib")
    for suffix, holds in (("pdf", b"/FontFile2"), ("png", b"PNG")):
        assert pendu(*RUN, tmp_path / f"run.{suffix}").code == 0
        assert holds in (tmp_path / f"run.{suffix}").read_bytes()


def test_without_matplotlib_there_is_one_sentence_with_the_advice(tmp_path, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.report.find_spec", lambda name: None)
    assert pendu(*RUN, tmp_path / "run.pdf").refused(2, ".pdf files", "[plot]")
