from types import SimpleNamespace

import pytest

from tests.tui.command_line import pendu
from tui.commands.about.doctor import colour, folder, size


def test_doctor_reports_and_never_fails():
    outcome = pendu("doctor")
    assert (outcome.code, outcome.err) == (0, "")
    lines = outcome.out.splitlines()
    for what in ("lab", "size", "encoding", "colours", "recordings", "python", "numba"):
        assert any(line.startswith(what) for line in lines), what


def test_doctor_as_json_has_the_same_findings():
    answer = pendu("doctor", "--json").json
    assert answer["schema"] == "pendu.doctor/1"
    assert {"what", "found", "advice"} == set(answer["findings"][0])


@pytest.mark.parametrize(
    ("columns", "rows", "word"), [(59, 16, "too small"), (80, 24, "120x40"), (120, 40, "")]
)
def test_the_advice_on_size_follows_the_layouts(columns, rows, word):
    advice = size(columns, rows).advice
    assert word in advice
    assert bool(advice) == bool(word)


@pytest.mark.parametrize(
    ("environment", "found", "advice"),
    [
        ({"TERM": "xterm-256color", "COLORTERM": "truecolor"}, "16 million", ""),
        ({"TERM": "xterm-256color"}, "256", "COLORTERM"),
        ({"TERM": "xterm"}, "16", "COLORTERM"),
        ({"TERM": "dumb"}, "none", "set TERM"),
        ({}, "none", "set TERM"),
        ({"TERM": "xterm", "NO_COLOR": "1"}, "NO_COLOR", "as requested"),
    ],
)
def test_colours_are_read_from_the_environment(environment, found, advice):
    finding = colour(environment)
    assert found in finding.found
    assert advice in finding.advice
    assert bool(finding.advice) == bool(advice)


def test_a_missing_folder_is_fine_unless_it_is_below_a_file(tmp_path):
    assert not folder(tmp_path / "a" / "b").advice
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").touch()
    assert "PENDU_RECORDINGS" in folder(tmp_path / "file" / "a").advice


def test_low_disk_space_is_reported(tmp_path, monkeypatch):
    assert "GB free" in folder(tmp_path).found
    monkeypatch.setattr(
        "tui.commands.about.doctor.shutil.disk_usage", lambda _: SimpleNamespace(free=5_000_000)
    )
    finding = folder(tmp_path)
    assert "5.0 MB free" in finding.found
    assert "prune" in finding.advice


def test_doctor_reports_the_rest_if_the_folder_cannot_be_read(monkeypatch, tmp_path):
    (tmp_path / "file").touch()
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "file"))
    outcome = pendu("doctor")
    assert (outcome.code, outcome.err) == (0, "")
    assert "cannot be written" in outcome.out
    assert "numba" in outcome.out


def test_without_a_terminal_the_lab_does_not_start_and_doctor_says_so():
    (finding,) = [f for f in pendu("doctor", "--json").json["findings"] if f["what"] == "lab"]
    assert finding["found"] == "cannot start here"
    assert "Use pendu-tui run" in finding["advice"]
