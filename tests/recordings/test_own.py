"""A user's own method in a recording: its source is kept with a hash, and never executed."""

import hashlib
import json
from pathlib import Path

import pytest
from mcap.reader import make_reader

from pendu_tui.recordings import events
from tests.recordings.killed import HEUN
from tests.tui.command_line import pendu


@pytest.fixture
def path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(events, "_own", {})
    Path("mine.py").write_text(HEUN)
    own = "--method", "mine.py:my_heun"
    made = pendu("run", "--methods", "rk4", *own, "--time", "20", "--record", "own.mcap")
    assert made.code == 0
    return tmp_path / "own.mcap"


def test_it_verifies_with_its_file_and_the_others_without_it(path):
    assert pendu("verify", path, "--methods", "rk4").code == 0
    pendu("verify", path).refused(3, "my_heun", "--method FILE.py:my_heun")
    same = pendu("verify", path, "--method", "mine.py:my_heun", "--json")
    assert same.code == 0
    assert same.json["files"][0]["changed_sources"] == []


@pytest.mark.parametrize(("factor", "code"), [("2.0", 0), ("2.001", 1)])
def test_a_changed_file_is_compared_by_its_numbers(path, factor, code):
    changed = HEUN.replace("h / 2 * (a + b)", f"h / {factor} * (a + b)")
    assert changed != HEUN
    Path("mine.py").write_text(changed)
    verified = pendu("verify", path, "--method", "mine.py:my_heun")
    assert verified.code == code
    assert "the source of my_heun is not the recorded one" in verified.out
    (row,) = pendu("verify", path, "--method", "mine.py:my_heun", "--json").json["files"]
    assert row["changed_sources"] == ["my_heun"]
    assert row["identical"] == (not code)
    if code:
        assert row["first_difference"]["method"] == "my_heun"


def test_the_recording_and_its_recovery_keep_the_text_and_its_hash(path):
    events._own.clear()
    assert pendu("recordings", "recover", path, "-o", "copy.mcap").code == 0
    for each in (path, Path("copy.mcap")):
        with each.open("rb") as stream:
            _, _, message = next(make_reader(stream).iter_messages(["/pendu/events"]))
        own = json.loads(message.data)
        assert own["sources"] == [HEUN]
        assert own["methods"] == ["rk4", f"my_heun@{hashlib.sha256(HEUN.encode()).hexdigest()}"]


def test_show_and_export_work_without_the_text(path):
    Path("mine.py").unlink()
    assert "my_heun" in pendu("recordings", "show", path).out
    assert pendu("export", path, "-o", "own.csv").code == 0
    assert "my_heun" in Path("own.csv").read_text()
