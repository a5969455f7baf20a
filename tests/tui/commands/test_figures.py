"""Figures by Matplotlib: as wide as a column, and the same bytes each time."""

import re
import sys
from contextlib import nullcontext
from unittest.mock import MagicMock

import pytest

from tests.tui.command_line import pendu

RUN = ("run", "--time", "5", "--methods", "rk4,verlet,heun", "-o")


STUDIES = """\
run --theta 3 --time 20 --methods rk4,explicit_e,heun,forest,yoshida,backward
run damped --time 30 --methods rk4
accuracy --time 2 --h-values 0.2:0.1:2 --methods rk4 --error energy
stability --steps 50 --z-values 0.1:1.5:4 --theta-values 0.5,2
"""


def test_what_matplotlib_is_asked_to_draw(snapshot, tmp_path, monkeypatch):
    matplotlib = MagicMock()
    matplotlib.figure.Figure().savefig.side_effect = lambda file, **_: file.touch()
    monkeypatch.setitem(sys.modules, "matplotlib", matplotlib)
    monkeypatch.setattr("pendu_tui.tui.commands.report.find_spec", bool)
    listed = pendu("run", "--theta", "1,2", "--time", "1", "-o", tmp_path / "a.svg")
    assert listed.refused(2, "a figure are for one run")
    texts = []
    for line, suffix in zip(STUDIES.splitlines(), ("SVG", "svg", "pdf", "png"), strict=True):
        matplotlib.reset_mock()
        assert pendu(*line.split(), "--force", "-o", tmp_path / f"a.{suffix}").code == 0
        texts += ["", f"$ {line}", *map(str, matplotlib.mock_calls)]
    drawn = []
    with monkeypatch.context() as long:
        long.setattr("pendu_tui.tui.commands.run.publish", lambda *each: drawn.append(each[0]))
        pendu("run", "--time", 3000, "--h", 0.1, "--methods", "verlet", "-o", tmp_path / "c.svg")
    ((_, t, _),) = drawn[0].figure.lines
    assert (len(t), t[1] - t[0]) == (395, pytest.approx(38 * 0.2))  # of 15 000 samples
    matplotlib.reset_mock()
    pendu("accuracy", "--all", "--time", 2, "--h-values", "0.2:0.1:2", "-o", tmp_path / "d.svg")
    plots = matplotlib.figure.Figure().add_subplot().plot.call_args_list
    assert len({plot.kwargs.get("label") for plot in plots}) > 9  # more than line styles
    monkeypatch.setattr("pendu_tui.tui.commands.run.stop_requests", lambda: nullcontext(lambda: 1))
    assert pendu(*RUN, tmp_path / "b.svg").code == 130  # after the first sample
    text = re.sub(r"\w+Path\(.*?\)", "FILE", "\n".join(texts))
    text = re.sub(r"\d+\.\d{6,}(e[-+]\d+)?", lambda found: f"{float(found[0]):.4g}", text)
    snapshot("figures.txt", text + "\n")


@pytest.mark.slow
def test_the_same_input_gives_the_same_figure_of_the_width_of_a_column(tmp_path):
    files = [tmp_path / "one.svg", tmp_path / "two.svg"]
    for file in files:
        assert pendu(*RUN, file).code == 0
    svg, again = (file.read_text(encoding="utf-8") for file in files)
    assert svg == again
    width = float(re.search(r'width="([0-9.]+)pt"', svg)[1])
    assert width / 72 * 2.54 == pytest.approx(8.5, abs=0.01)
    assert "<text" not in svg  # letters are outlines


def test_without_matplotlib_there_is_one_sentence_with_the_advice(tmp_path, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.report.find_spec", lambda name: None)
    assert pendu(*RUN, tmp_path / "run.pdf").refused(2, ".pdf files", "[plot]")
