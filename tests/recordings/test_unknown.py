"""Recordings of a later version: what this one does not know plays as it was recorded, and is not verified."""

from dataclasses import fields, replace

import pytest

from engine.methods import RK4, VELOCITY_VERLET
from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.events import Entry, Event, method_named, scene_named
from recordings.headless import simulate
from recordings.recording import Recording
from recordings.recover import recover
from recordings.verify import verify
from tests.recordings.examples import record
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PtyLab
from tui.playback.marks import Marks
from tui.playback.replay import Replay

KNOWN = Scene("later", theta=2.0, h=0.05, cast=(VELOCITY_VERLET, RK4))
METHOD = replace(KNOWN, cast=(VELOCITY_VERLET, method_named("gauss_legendre_4")))
MODEL = scene_named(**{field.name: getattr(KNOWN, field.name) for field in fields(KNOWN)} | {"model": "kepler"})


@pytest.fixture(params=[METHOD, MODEL], ids=["method", "model"])
def scene(request):
    return request.param


@pytest.fixture
def path(tmp_path, scene):
    """Six seconds as a version that knows it would have recorded them, and then a second of what this one knows."""
    samples = list(simulate(KNOWN, 6.0))
    entries = [Entry(0.0, Event("start", 1, 0, 0.0, scene=scene)), *(Entry(each.t, each) for each in samples)]
    entries += [Entry(6.0, Event("start", 2, 0, 0.0, scene=KNOWN))]
    entries += [Entry(6.0 + each.t, each._replace(run=2)) for each in simulate(KNOWN, 1.0)]
    return record(tmp_path / "later.mcap", entries)


def test_it_cannot_be_verified_and_says_why(path, scene):
    unknown = "the method gauss_legendre_4" if scene is METHOD else "the model kepler"
    pendu("verify", path).refused(3, "cannot be verified", f"this version does not know {unknown}")
    report = pendu("verify", path, "--json")
    assert report.code == 3
    assert report.json["files"][0]["identical"] is False
    assert unknown in report.json["files"][0]["reason"]


def test_the_methods_that_are_known_can_be_verified_alone(path, scene):
    outcome = pendu("verify", path, "--methods", "velocity_verlet")
    assert outcome.code == (0 if scene is METHOD else 3)


def test_it_opens_with_all_recorded_samples(path, scene):
    with Recording.open(path, check=True) as recording:
        assert recording.complete
        assert recording.sealed
        assert [run.scene for run in recording.runs] == [scene, KNOWN]
        samples = [value for _, value in recording.entries() if isinstance(value, Sample) and value.run == 1]
    computed = list(simulate(KNOWN, 6.0))
    assert [each.readings[1].theta for each in samples] == [each.readings[1].theta for each in computed]


def test_it_is_listed_exported_and_recovered(path, scene, tmp_path):
    report = pendu("info", path, "--json").json
    assert report["runs"][0]["scene"]["methods"] == [method.key for method in scene.cast]
    assert report["runs"][0]["scene"]["model"] == scene.model
    rows = pendu("export", path, "--format", "csv").out.splitlines()
    assert {row.split(",")[4] for row in rows[1:]} == {*report["methods"]}
    assert len(rows) == 1 + 2 * report["samples"]
    assert recover(path, tmp_path / "out.mcap").samples_lost == 0
    with Recording.open(path) as was, Recording.open(tmp_path / "out.mcap") as now:
        assert list(was.entries()) == list(now.entries())


def test_a_replay_shows_its_numbers_and_judges_nothing_that_it_cannot_compute(path, scene):
    with Recording.open(path) as recording:
        replay = Replay(recording, Marks(path))
        replay.tick(0.0)
        for frame in range(150):
            replay.tick(frame / 30)
        assert replay.scene == scene
        assert replay.sample.readings == recording.sample(recording.at(replay.playhead.position)).value.readings
        assert [judgement.verdict for judgement in replay.judgements] == ["too early"] * 2
        replay.seek(6.5)
        assert replay.scene == KNOWN


@pytest.mark.parametrize("scene", [MODEL], ids=["model"])
def test_the_screen_shows_it(path):
    with PtyLab("replay", str(path)) as lab:
        for key in ("", "n", "\x1b[F", "\x1bOR", "\x1bOQ", "p"):
            lab.type(key)
            lab.run(0.4)
        lab.type("q")
        assert lab.end() == 0


def test_the_rest_of_a_damaged_one_verifies_as_little(path, tmp_path):
    data = bytearray(path.read_bytes())
    data[data.index(b"\x04\x00\x00\x00zstd") + 60] ^= 1
    path.write_bytes(data)
    with Recording.open(path) as recording:
        assert recording.damaged
    assert recover(path, tmp_path / "out.mcap").runs_lost == 1
    assert verify(tmp_path / "out.mcap").identical
