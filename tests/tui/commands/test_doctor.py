"""`pendu-tui doctor`: what it finds, and what it advises."""

import os
import re
from importlib.metadata import PackageNotFoundError
from types import SimpleNamespace

import pytest

from pendu_tui.tui.commands import doctor
from tests.tui.command_line import link, pendu


def test_without_a_terminal_it_says_why_the_lab_cannot_start():
    outcome = pendu("doctor")
    assert (outcome.code, outcome.err) == (0, "")
    assert re.search(r"^encoding +utf-8 +fine", outcome.out, re.MULTILINE)
    lab = r"^lab +cannot start here +not a terminal.* Use pendu-tui run"
    assert re.search(lab, outcome.out, re.MULTILINE)


USUAL = {
    "COLUMNS": "60",
    "LINES": "16",
    "TERM": "xterm-256color",
    "COLORTERM": "",
    "NO_COLOR": "",
    "PENDU_RECORDINGS": "new/folder",
    "MISSING": "nothing",
}
PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")


@pytest.mark.parametrize(
    ("environment", "what", "found", "advice"),
    [
        ({}, "lab", "starts here", ""),
        ({}, "size", "60x16", ""),
        ({"COLUMNS": "59"}, "size", "59x16", "the lab needs 60x16; 120x40 shows all panes"),
        ({"LINES": "15"}, "size", "60x15", "the lab needs 60x16; 120x40 shows all panes"),
        ({}, "console", "older", "use Windows Terminal"),
        ({"WT_SESSION": "1"}, "console", "Windows Terminal", ""),
        ({}, "encoding", "latin-1", "PYTHONUTF8=1"),
        ({}, "colours", "256, TERM=xterm-256color", "COLORTERM=truecolor"),
        ({"COLORTERM": "truecolor"}, "colours", "16777216, TERM=xterm-256color", ""),
        ({"TERM": "xterm", "NO_COLOR": "1"}, "colours", "16, TERM=xterm", ""),
        ({}, "recordings", "new/folder, 2.0 GB free", ""),
        ({"PENDU_RECORDINGS": "file"}, "recordings", "file", "set PENDU_RECORDINGS to a writ"),
        ({"PENDU_RECORDINGS": "file/below"}, "recordings", "file/below", "set PENDU_RECORDINGS"),
        ({"PENDU_RECORDINGS": "lost link"}, "recordings", "lost link", "set PENDU_RECORDINGS"),
        ({}, "python", "3.14.1, Windows arm64", ""),
        ({}, "versions", ", ".join(f"{each} {each}'s" for each in PACKAGES), ""),
        ({}, "numba", "numba's", ""),
        ({"MISSING": "numba"}, "numba", "not installed", "install pendu-tui[fast]"),
    ],
)
def test_what_is_found_comes_with_advice_unless_it_is_fine(
    environment, what, found, advice, here, monkeypatch
):
    def version(package: str) -> str:
        if package == os.environ["MISSING"]:
            raise PackageNotFoundError
        return f"{package}'s"

    (here / "file").touch()
    if found == "lost link":
        link(here / found, "nowhere")
    before = [*here.iterdir()]
    monkeypatch.delenv("WT_SESSION", raising=False)
    for name, value in (USUAL | environment).items():
        monkeypatch.setenv(name, value)
    stdout = SimpleNamespace(isatty=lambda: True, encoding="latin-1")
    monkeypatch.setattr(doctor, "sys", SimpleNamespace(stdout=stdout))
    monkeypatch.setattr(doctor, "check_terminal", lambda: None)
    monkeypatch.setattr(doctor, "version", version)
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: SimpleNamespace(free=2e9))
    for name, value in (("system", "Windows"), ("python_version", "3.14.1"), ("machine", "arm64")):
        monkeypatch.setattr(f"platform.{name}", lambda value=value: value)
    findings = {each.pop("what"): each for each in pendu("doctor", "--json").json["findings"]}
    assert findings[what]["found"].replace("\\", "/") == found
    assert advice in findings[what]["advice"]
    assert bool(advice) == bool(findings[what]["advice"])
    assert [*here.iterdir()] == before  # no folder is made
