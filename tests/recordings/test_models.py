"""Recordings of other models than the pendulum, of special methods, and of methods of one's own."""

import csv
import hashlib
import json
from pathlib import Path

import pytest
from mcap.reader import make_reader

from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings import events
from pendu_tui.recordings.events import Entry, simulate
from pendu_tui.recordings.format import EXTRA
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from pendu_tui.tui.playback.replay import Replay
from tests.recordings.examples import record, samples_of, start, with_changes
from tests.recordings.killed import HEUN
from tests.tui.command_line import pendu

SPECIAL = sorted(name for name, scene in SCENES.items() if scene.why_not_mapped)
SPRING_FIELDS = [field.name for field in EXTRA["spring"]]
SPRING = SCENES["stiff-slow"]


@pytest.mark.parametrize("name", SPECIAL)
def test_a_run_is_recorded_verified_exported_and_replayed(tmp_path, name):
    path, scene = tmp_path / "a.mcap", SCENES[name]
    with Recorder(path) as recorder:
        samples = list(with_changes(scene, 60 * scene.h, recorder, [(40, scene.h / 2)]))
    with Recording.open(path, check=True) as recording:
        assert recording.runs[0].scene == scene
        assert [value for _, value in samples_of(recording)] == samples
        replay = Replay(recording, clock=lambda: 0.0)
        replay.seek(recording.length)
        assert (replay.scene, replay.sample.readings) == (scene, samples[-1].readings)
    assert pendu("export", path, "-o", tmp_path / "a.csv").code == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").open()))
    readings = [reading for sample in samples for reading in sample.readings]
    assert [float(row["theta_rad"]) for row in rows] == [reading.theta for reading in readings]
    if scene.model == "spring":
        names = ("x", "y", "vx_per_s", "vy_per_s", "spring_energy")
        exported = [[float(row[name]) for name in names] for row in rows]
        assert exported == [list(reading.extra.values()) for reading in readings]
    info = pendu("recordings", "show", path, "--json").json
    assert info["runs"][0]["scene"] == scene.fields()
    recover(path, tmp_path / "copy.mcap")
    assert verify(tmp_path / "copy.mcap").identical


@pytest.mark.parametrize("field", SPRING_FIELDS)
def test_a_change_in_the_plane_is_found_by_verify(tmp_path, field):
    def change(sample):
        if sample.step != 50:
            return sample
        first, *others = sample.readings
        extra = {**first.extra, field: first.extra[field] * (1 + 1e-15)}
        return sample._replace(readings=(first._replace(extra=extra), *others))

    samples = [change(sample) for sample in simulate(SPRING, 3.0)]
    entries = [Entry(0.0, start(scene=SPRING)), *(Entry(sample.t, sample) for sample in samples)]
    found = verify(record(tmp_path / "b.mcap", entries)).first_difference
    assert (found.step, found.method, found.field) == (50, "velocity_verlet", field)


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
