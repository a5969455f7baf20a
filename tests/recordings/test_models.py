"""Recordings of every scene, and of methods of one's own."""

import hashlib
import json
from pathlib import Path

import pytest
from mcap.reader import make_reader

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings import events
from pendu_tui.recordings.events import Entry
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from pendu_tui.tui.playback.replay import Replay
from tests.recordings.examples import SCENE, record, run_of, samples_of, start
from tests.recordings.killed import HEUN
from tests.tui.command_line import pendu


@pytest.mark.parametrize(("name", "scene"), SCENES.items())
def test_a_scene_is_recorded_verified_recovered_and_replayed(tmp_path, name, scene):
    path, copy = tmp_path / "a.mcap", tmp_path / "copy.mcap"
    forty = 7, 7, 7, 7, 7, 5
    entries = run_of(scene, 0, *forty, Stepping(-scene.h / 2, cast=scene.cast), *forty)
    samples = [value for _, value in entries if isinstance(value, Sample)]
    record(path, entries)
    assert verify(path).identical
    recover(path, copy)
    with Recording.open(copy, check=True) as recording, Recording.open(path) as original:
        assert list(recording.entries()) == list(original.entries())
        assert recording.runs[0].scene == scene
        assert [value for _, value in samples_of(recording)] == samples
        replay = Replay(recording, clock=lambda: 0.0)
        replay.seek(recording.length)
        assert (replay.scene, replay.sample) == (scene, samples[-1])


@pytest.fixture
def path(tmp_path, monkeypatch):
    """A run with a method of one's own, which is then unknown again, and one without."""
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(HEUN)
    own = "--method", "mine.py:my_heun", "--time", "20", "--record", "own.mcap"
    assert pendu("run", "--methods", "rk4", *own).code == 0
    with Recording.open(Path("own.mcap")) as recording:
        entries = [*recording.entries()]
    entries += [Entry(20.0, value) for value in (start(2), Lockstep(SCENE, run=2).sample())]
    record(Path("both.mcap"), entries)
    monkeypatch.setattr(events, "_own", {})
    return Path("both.mcap")


def test_without_the_file_all_is_kept_but_only_the_other_methods_verify(path):
    assert pendu("verify", path, "--methods", "rk4").code == 0
    pendu("verify", path).refused(3, "my_heun", "--method FILE.py:my_heun")
    with pytest.raises(RecordingError, match="needs the user's own method my_heun"):
        verify(path, only={"my_heun"})
    assert "my_heun" in pendu("recordings", "show", path).out
    assert "my_heun" in pendu("export", path).out
    assert pendu("recordings", "recover", path, "-o", "copy.mcap").code == 0
    for each in (path, Path("copy.mcap")):
        with each.open("rb") as stream:
            _, _, message = next(make_reader(stream).iter_messages(["/pendu/events"]))
        own = json.loads(message.data)
        assert own["sources"] == [HEUN]
        assert own["methods"] == ["rk4", f"my_heun@{hashlib.sha256(HEUN.encode()).hexdigest()}"]


@pytest.mark.parametrize(
    ("factor", "changed"), [("2", []), ("2.0", ["my_heun"]), ("2.001", ["my_heun"])]
)
def test_a_changed_file_is_said_and_compared_by_its_numbers(path, factor, changed):
    Path("mine.py").write_text(HEUN.replace("h / 2 * (a + b)", f"h / {factor} * (a + b)"))
    verified = pendu("verify", path, "--method", "mine.py:my_heun", "--json")
    (row,) = verified.json["files"]
    assert (row["methods"][:2], row["changed_sources"]) == (["rk4", "my_heun"], changed)
    assert row["identical"] == (factor != "2.001")
    assert verified.code == (not row["identical"])
    if verified.code:
        assert row["first_difference"]["method"] == "my_heun"
