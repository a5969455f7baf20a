"""Recordings of other models than the pendulum and of special methods."""

import csv

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.events import Entry
from pendu_tui.recordings.format import EXTRA
from pendu_tui.recordings.headless import simulate
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from pendu_tui.tui.playback.replay import Replay
from tests.recordings.examples import record, samples_of, start, with_changes
from tests.tui.command_line import pendu

SPECIAL = sorted(name for name, scene in SCENES.items() if scene.why_not_mapped)
SPRING_FIELDS = [field.name for field in EXTRA["spring"]]
SPRING = SCENES["stiff-slow"]


@pytest.mark.parametrize("name", SPECIAL)
def test_a_run_is_recorded_verified_exported_and_replayed(tmp_path, name):
    path, scene = tmp_path / "a.mcap", SCENES[name]
    with Recorder(path, wall=None) as recorder:
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
