"""What the lab noticed is recorded, and a replay says the same, whatever this version would say."""

import pytest

from engine.scenes import SCENES
from recordings.events import Event
from recordings.headless import simulate
from recordings.recorder import Recorder
from recordings.recording import Recording
from recordings.verification import verify
from tests.tui.harness import Lab, after
from tui.playback.marks import Marks
from tui.playback.replay import Replay


@pytest.fixture
def lab(tmp_path):
    """A lab that ran for 24 s, and then from 10 s on for 8 s with another step size; and its recording."""
    bench = Lab(record=tmp_path / "lab.mcap")
    bench.run(24.0)
    live = bench.live
    first = list(live.milestones)
    live.step(-(live.sample.step - 200))
    live.set_stepping(live.stepping._replace(h=0.02))
    live.pause(False)
    bench.run(8.0)
    live.close()
    return live, first, tmp_path / "lab.mcap"


def test_a_replay_shows_the_milestones_and_verdicts_of_the_lab(lab):
    live, first, path = lab
    assert {milestone.kind for milestone in first} == {"over the top", "verdict"}
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.runs[0].milestones == first
        replay = Replay(recording, Marks(path))
        replay.seek(recording.length)
        assert replay.run.number == 2
        assert list(replay.milestones) == list(
            live.milestones
        )  # also those of before the first sample of this run
        assert [each.verdict for each in replay.judgements] == [
            each.verdict for each in live.judgements
        ]
        replay.seek(23.9)
        assert [each for each in first if each.step <= replay.sample.step] == list(
            replay.milestones
        )
        assert "bounded" in [each.verdict for each in replay.judgements]
        replay.seek(1.0)
        assert list(replay.milestones) == []
        assert {each.verdict for each in replay.judgements} == {"too early"}


def test_a_replay_jumps_to_what_the_lab_noticed(lab):
    _, first, path = lab
    with Recording.open(path) as recording:
        clocks = [clock for clock, event in recording.runs[0].events if event.kind == "noticed"]
        replay = Replay(recording, Marks(path))
        assert set(clocks) < set(replay.ticks)
        for clock, milestone in zip(clocks, first, strict=True):
            assert 0 <= clock - milestone.t <= 1.0  # s: a verdict is given at the next look


def test_a_replay_says_what_was_said_and_not_what_would_be_said_today(lab, tmp_path):
    _, first, path = lab
    said = next(each for each in first if each.verdict == "bounded")
    with (
        Recording.open(path) as recording,
        Recorder(tmp_path / "other.mcap", wall=None) as recorder,
    ):
        for clock, value in recording.entries():
            if value.run > 1:
                break
            if isinstance(value, Event) and value.milestone == said:
                value = value._replace(milestone=said._replace(verdict="wanders"))
            recorder.event(value, clock) if isinstance(value, Event) else recorder.sample(
                value, clock
            )
    assert verify(tmp_path / "other.mcap").identical
    with Recording.open(tmp_path / "other.mcap") as recording:
        replay = Replay(recording, Marks(path))
        replay.seek(recording.length)
        assert replay.judgements[replay.scene.cast.index(said.method)].verdict == "wanders"


def test_errors_that_cross_are_recorded_and_a_stop_of_the_replay(tmp_path):
    path, scene = tmp_path / "crossover.mcap", SCENES["crossover"]
    with Recorder(path, wall=None) as recorder:
        for _ in simulate(scene, 40, recorder):
            pass
    with Recording.open(path) as recording:
        (crossing,) = [each for each in recording.runs[0].milestones if each.kind == "errors cross"]
        replay = Replay(recording, Marks(path))
        replay.seek(33.0)
        assert crossing not in replay.milestones
        replay.seek_event(1)
        assert replay.sample.step == crossing.step == 167
        assert crossing in replay.milestones
    assert crossing in after(scene, 40).milestones
