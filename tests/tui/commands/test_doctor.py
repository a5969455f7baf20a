import pytest

from pendu_tui.tui.commands.doctor import colour, folder, size
from tests.tui.command_line import pendu


def test_doctor_reports_and_never_fails(monkeypatch, tmp_path):
    (tmp_path / "file").touch()
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "file"))
    outcome = pendu("doctor")
    assert (outcome.code, outcome.err) == (0, "")
    assert "cannot be written" in outcome.out
    assert all(f"\n{what}" in outcome.out for what in ("lab", "size", "encoding", "numba"))
    lab = pendu("doctor", "--json").json["findings"][0]  # without a terminal
    assert lab["found"] == "cannot start here"
    assert "Use pendu-tui run" in lab["advice"]


def test_the_advice_on_size_follows_the_layouts():
    assert "too small" in size(59, 16)[1]
    assert "120x40" in size(80, 24)[1]
    assert not size(120, 40)[1]


@pytest.mark.parametrize(
    ("environment", "found", "advice"),
    [
        ({"TERM": "xterm-256color", "COLORTERM": "truecolor"}, "16 million", ""),
        ({"TERM": "xterm-256color"}, "256", "COLORTERM"),
        ({}, "none", "set TERM"),
        ({"TERM": "xterm", "NO_COLOR": "1"}, "NO_COLOR", "as requested"),
    ],
)
def test_colours_are_read_from_the_environment(environment, found, advice):
    text, told_advice = colour(environment)
    assert found in text
    assert advice in told_advice
    assert bool(told_advice) == bool(advice)


def test_a_missing_folder_is_fine_unless_it_is_below_a_file(tmp_path):
    found, advice = folder(tmp_path / "a" / "b")
    assert found.endswith("B free")
    assert not advice
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").touch()
    assert "PENDU_RECORDINGS" in folder(tmp_path / "file" / "a")[1]
