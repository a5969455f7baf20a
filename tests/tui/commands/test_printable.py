"""Nothing that a name or a file says steers the terminal, wherever it is printed."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.recordings.examples import record, two_runs
from tests.tui.command_line import IS_WINDOWS, own_method, pendu
from tests.tui.pty_lab import PtyLab

EVIL = "\x1b]0;evil\x07\u202e"
"""Escape sequences that set the title, and a character that turns text around."""
NAME = "\u202e" if IS_WINDOWS else EVIL  # there names hold no control characters


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with an evil name, and files with evil names and contents in it."""
    folder = tmp_path / f"folder{NAME}"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("PENDU_RECORDINGS", str(folder))
    entries = two_runs()
    scene = replace(entries[0].value.scene, name=EVIL, watch=EVIL)
    entries[0] = entries[0]._replace(value=entries[0].value._replace(scene=scene))
    whole = record(folder / f"whole{NAME}.mcap", entries)
    (folder / f"cut{NAME}.mcap").write_bytes(whole.read_bytes()[:-700])
    (folder / f"killed{NAME}.mcap.part").write_bytes(whole.read_bytes()[:-700])
    (folder / f"none{NAME}.mcap").write_bytes(b"nothing of ours")
    Path(own_method(folder)).with_name(f"mine{NAME}.py").write_text("def mine(): pass\n")
    (folder / f"bad{NAME}.toml").write_text(f"name = {EVIL!r}\n{EVIL} = 1\n", encoding="utf-8")
    (folder / f"wrong{NAME}.toml").write_text("theta = 'x\\u001b[2J'\n", encoding="utf-8")
    rows = "".join(f"{n},{10 + (-1) ** n}\n" for n in range(200))
    (folder / f"log{NAME}.csv").write_text(f"t{EVIL},E{EVIL}\n{rows}", encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    "command",
    [
        ("verify", f"whole{NAME}.mcap", f"cut{NAME}.mcap"),
        ("recordings",),
        ("recordings", "show", f"cut{NAME}.mcap"),
        ("recordings", "recover", f"cut{NAME}.mcap", "-o", f"new{NAME}.mcap"),
        ("export", f"cut{NAME}.mcap", "-o", f"new{NAME}.csv"),
        ("replay", f"none{NAME}.mcap", "--plain"),
        ("run", "--time", "1", "--record", f"run{NAME}.mcap"),
        ("run", "--time", "1", "--scene", f"bad{NAME}.toml"),
        ("run", "--time", "1", "--scene", f"wrong{NAME}.toml"),
        ("run", "--time", "1", "--method", f"mine{NAME}.py:absent{EVIL}"),
        ("judge", f"log{NAME}.csv", "--time", f"t{EVIL}", "--energy", f"E{EVIL}"),
        ("judge", f"log{NAME}.csv", "--time", f"x{EVIL}", "--energy", "1"),
        ("snapshot", "-o", f"absent{EVIL}/lab.svg"),
        ("live", "--record", f"whole{NAME}.mcap", "--plain"),
        ("doctor",),
        (EVIL,),
        ("run", f"--{EVIL}"),
    ],
    ids=lambda value: "",
)
def test_no_command_prints_what_steers_a_terminal(command):
    outcome = pendu(*command)
    said = outcome.out + outcome.err
    assert said.strip()
    assert said.replace("\n", "").isprintable()


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [("replay", f"cut{NAME}.mcap"), ("live", "--record", f"live{NAME}.mcap")],
    ids=lambda value: "",
)
def test_no_screen_shows_what_steers_a_terminal(command, folder):
    with PtyLab(*command, folder=folder) as lab:
        lab.run(2.0)
        lab.type("q")
        assert lab.end() == 0
    assert b"\x1b]0;evil" not in lab.output
    assert "\u202e".encode() not in lab.output
