import re
from importlib.metadata import PackageNotFoundError
from types import SimpleNamespace

import pytest

from pendu_tui.tui.commands import doctor
from tests.tui.command_line import link, pendu


def findings() -> dict[str, dict[str, str]]:
    return {each["what"]: each for each in pendu("doctor", "--json").json["findings"]}


def test_it_reports_all_it_has_checked_and_why_the_lab_cannot_start_without_a_terminal():
    outcome = pendu("doctor")
    assert (outcome.code, outcome.err) == (0, "")
    assert re.search(r"^encoding +utf-8 +fine", outcome.out, re.MULTILINE)
    lab = r"^lab +cannot start here +not a terminal.* Use pendu-tui run"
    assert re.search(lab, outcome.out, re.MULTILINE)


@pytest.mark.parametrize("folder", ["file", "file/below", "lost link"])
def test_it_explains_a_folder_of_recordings_that_cannot_be_used(folder, here, monkeypatch):
    (here / "file").touch()
    if folder == "lost link":
        link(here / folder, "nowhere")
    monkeypatch.setenv("PENDU_RECORDINGS", folder)
    found = findings()["recordings"]
    assert found["found"].replace("\\", "/") == folder
    assert "PENDU_RECORDINGS" in found["advice"]


@pytest.mark.parametrize("missing", ["", "numba"])
def test_it_tells_the_versions_and_to_install_numba(missing, monkeypatch):
    def version(package: str) -> str:
        if package == missing:
            raise PackageNotFoundError
        return f"{package}'s"

    monkeypatch.setattr(doctor, "version", version)
    found = findings()
    packages = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")
    assert found["versions"]["found"] == ", ".join(f"{each} {each}'s" for each in packages)
    assert found["numba"]["found"] == ("not installed" if missing else "numba's")
    assert ("[fast]" in found["numba"]["advice"]) == bool(missing)


def test_a_folder_that_is_not_there_yet_is_fine_and_is_not_made(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "a" / "b"))
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: SimpleNamespace(free=2e9))
    found = findings()["recordings"]
    assert found["found"] == f"{tmp_path / 'a' / 'b'}, 2.0 GB free"
    assert not found["advice"]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("number", "fine", "environment"),
    [
        (16777216, True, {"TERM": "xterm-256color", "COLORTERM": "truecolor"}),
        (256, False, {"TERM": "xterm-256color", "COLORTERM": ""}),
        (16, True, {"TERM": "xterm", "COLORTERM": "", "NO_COLOR": "1"}),
    ],
)
def test_colours_are_read_from_the_environment(number, fine, environment, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    found = findings()["colours"]
    assert bool(found["advice"]) == (not fine)
    assert found["found"] == f"{number}, TERM={environment['TERM']}"


@pytest.mark.parametrize(("session", "console"), [("1", "Windows Terminal"), ("", "older")])
def test_on_windows_it_says_which_terminal_to_use(session, console, monkeypatch):
    monkeypatch.setattr("platform.system", lambda: "Windows")
    monkeypatch.setattr("platform.python_version", lambda: "3.14.1")
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    monkeypatch.delenv("WT_SESSION", raising=False)
    if session:
        monkeypatch.setenv("WT_SESSION", session)
    found = findings()
    assert found["python"]["found"] == "3.14.1, Windows arm64"
    assert found["console"]["found"] == console
    assert ("use Windows Terminal" in found["console"]["advice"]) == (not session)


@pytest.mark.parametrize(("size", "fine"), [("60x16", True), ("59x16", False), ("60x15", False)])
def test_a_terminal_may_be_as_small_as_the_lab(size, fine, monkeypatch):
    stdout = SimpleNamespace(isatty=lambda: True, encoding="latin-1")
    monkeypatch.setattr(doctor, "sys", SimpleNamespace(stdout=stdout))
    monkeypatch.setattr(doctor, "check_terminal", lambda: None)
    for name, value in zip(("COLUMNS", "LINES"), size.split("x"), strict=True):
        monkeypatch.setenv(name, value)
    found = findings()
    assert found["lab"] == {"what": "lab", "found": "starts here", "advice": ""}
    assert found["size"]["found"] == size
    advice = "" if fine else "the lab needs 60x16; 120x40 shows all panes"
    assert found["size"]["advice"] == advice
    assert "PYTHONUTF8=1" in found["encoding"]["advice"]
