"""A replay, driven by a clock that the test moves."""

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pendu_tui.engine.methods import method_of
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.recordings.events import Event, simulate
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from tests.own_methods import VERLET, load
from tests.recordings.examples import samples_of
from tests.tui.harness import FPS, Clocked, Lab, eventful, recorded
from tests.tui.playback.test_live import states

LENGTH = 12.0  # s, of the eventful sitting


class Table(Clocked):
    def __init__(self, path: Path):
        self.recording = Recording.open(path)
        self.replay = Replay(self.recording, clock=lambda: 0.0)
        self.samples = samples_of(self.recording)
        super().__init__(self.replay)

    @property
    def due(self) -> Sample:
        """The last sample recorded before the playhead, found the slow way."""
        position = round(self.replay.playhead.position, 9)  # s, as clocks in a file
        return [value for clock, value in self.samples if clock <= position][-1]

    @property
    def verdicts(self) -> list[str]:
        return [judgement.verdict for judgement in self.replay.judgements]


@pytest.fixture(scope="module")
def sitting(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return eventful(tmp_path_factory.mktemp("replay") / "eventful.mcap")


@pytest.fixture
def table(sitting: Path) -> Table:
    return Table(sitting)


@pytest.fixture
def replay(table: Table) -> Replay:
    return table.replay


def test_it_shows_the_last_sample_recorded_before_and_begins_again_after_the_end(table, replay):
    assert replay.sample == table.samples[0].value
    assert replay.length == pytest.approx(LENGTH)
    assert (replay.kind, replay.recording_status) == ("REPLAY", ("eventful.mcap", 12.0, None))
    while not replay.playhead.paused:
        assert table.run(0.2) == table.due
        assert table.now < 13
    assert replay.sample == table.samples[-1].value
    replay.pause(False)
    replay.set_speed(4.0)
    table.run(0.5)
    replay.pause(False)
    assert replay.playhead.position == pytest.approx(2.0)
    for seconds in (-5.0, 3.3, 99.0):
        replay.seek(seconds)
        assert replay.playhead.position == min(max(seconds, 0.0), replay.length)
        assert replay.sample == table.due


def test_few_samples_in_between_are_shown_too_and_the_past_is_read_frame_by_frame(sitting):
    table = Table(sitting)
    table.replay.seek(1.9)
    assert len(table.replay.history.trails()) == 39
    assert table.replay.knows_past
    looks = itertools.count(0, 0.004)
    replay = Replay(Recording.open(sitting), clock=looks.__next__)
    assert (replay.sample.step, replay.stepping) == (0, replay.changes[0].stepping)
    replay.seek(replay.length)
    began = next(looks)
    assert not replay.fill()
    assert not replay.knows_past
    assert next(looks) - began == pytest.approx(0.016)  # 6 ms or more
    while not replay.fill():
        pass
    replay.seek(replay.length - 0.5)
    assert replay.knows_past


def test_played_backwards_it_shows_the_same_samples_and_stops_at_the_start(table, replay):
    replay.seek(LENGTH)
    replay.set_speed(-1.0)
    runs = []
    while not replay.playhead.paused:
        sample = table.run(1 / FPS)
        assert sample == table.due
        runs.append(sample.run)
        assert table.now < 13
    assert sample == table.samples[0].value
    assert list(dict.fromkeys(runs)) == [3, 2, 1]
    replay.pause(False)
    assert replay.playhead.position == replay.length
    steps = table.samples[-1].value.step
    assert replay.counts == {"run": (3, 3), "step": (steps, steps)}


@pytest.mark.parametrize(
    ("speed", "start", "behind"), [(1.0, LENGTH - 0.5, 0.5), (-1.0, 0.5, LENGTH - 0.5)]
)
def test_a_loop_goes_round_both_ways(table, replay, speed, start, behind):
    replay.looping = True
    replay.set_speed(speed)
    replay.seek(start)
    table.run(1)
    assert replay.playhead.position == pytest.approx(behind, abs=0.1)
    assert not replay.playhead.paused


def test_steps_go_from_sample_to_sample_both_ways_and_not_over_the_ends(table, replay):
    values = [entry.value for entry in table.samples]
    forward = [replay.step(1) for _ in range(len(values) + 2)]
    assert forward == [*values[1:], *values[-1:] * 3]
    assert replay.playhead.paused
    backward = [replay.step(-1) for _ in range(len(values) + 2)]
    assert backward == [*values[-2::-1], *values[:1] * 3]


def assert_same(one, other):
    """Compare two histories."""
    one, other = one.window(), other.window()
    np.testing.assert_array_equal(one.t, other.t)
    for quantity in ("energy_error", "shadow_error"):
        np.testing.assert_array_equal(one.high[quantity], other.high[quantity])


@pytest.mark.parametrize(("seconds", "origin"), [(1.0, 12.0), (4.9, 12.0), (11.5, 0.0)])
def test_after_a_jump_chart_and_trails_show_what_they_show_after_playing(sitting, seconds, origin):
    played, jumped = Table(sitting), Table(sitting)
    while played.replay.playhead.position < seconds:
        played.run(1 / FPS)
    jumped.replay.seek(origin)
    jumped.replay.seek(played.replay.playhead.position)
    assert len(jumped.replay.history.trails()) > 9  # before the rest of the past
    jumped.replay.pause(True)
    jumped.run(0.1)
    assert jumped.verdicts == played.verdicts
    one, other = played.replay.history, jumped.replay.history
    np.testing.assert_array_equal(one.trails()[-15:], other.trails()[-15:])
    assert_same(one, other)


def test_it_shows_the_past_that_the_lab_showed(tmp_path):
    live = []

    def change(lab):
        lab.change(Stepping(0.1, not lab.stepping.equal_cost))

    table = Table(recorded(tmp_path / "lab.mcap", live.append, 2.0, change, 2.0, change, 1.0))
    table.replay.seek(table.replay.length)
    table.run(0.1)
    assert_same(table.replay.history, live[0].history)


def test_of_a_long_past_the_last_minute_is_read_whole_and_300_seconds_before(tmp_path):
    path = tmp_path / "long.mcap"
    with Recorder(path) as recorder:
        list(simulate(DEFAULT_SCENE, 1050.0, recorder.add, sample_every=10))
    replay = Table(path).replay
    replay.seek(1050.0)
    assert len(replay.history.trails()) == 3  # at once, a second
    assert replay.fill()
    changes = [SteppingChange(step, step * 0.05, Stepping(0.1)) for step in (0, 19_800, 20_990)]
    is_told = [replay.history.since(change) is not None for change in changes]
    assert is_told == [False, True, True]  # what lies between is not known
    times = np.arange(0, 1050.5, 0.5)
    is_read = (times >= 990) | ((times + 1e-6) % 3.3 < 1 + 2e-6)
    assert replay.history.window().t == pytest.approx(times[is_read])


def test_the_next_event_and_the_one_before_are_found(replay):
    assert replay.ticks[-1] < 10  # the stop is no event to go to
    places = [0.0]
    while places[-1] < replay.length - 1e-6:
        replay.seek_event(1)
        places.append(replay.playhead.position)
        if places[-1] == pytest.approx(2.0):
            assert replay.events[-1].kind == "set_h"
    assert [round(place) for place in places] == [0, 2, 4, 5, 9, 9, 12]  # a verdict
    assert replay.playhead.paused
    replay.pause(False)
    assert replay.go_to(1, 40)
    assert (replay.playhead.position, replay.playhead.paused) == (places[1], True)
    assert not replay.go_to(1, 41)
    assert not replay.go_to(2, 40)
    replay.seek(LENGTH)
    for place in reversed(places[:-1]):
        replay.seek_event(-1)
        assert replay.playhead.position == place


def test_a_change_of_h_counts_from_its_moment_between_steps_and_in_a_pause(tmp_path):
    acts = []
    for h in (0.1, 0.2, 0.3):
        acts += [lambda lab, h=h: lab.change(Stepping(h)), lambda lab: lab.step(1)]
    scene = DEFAULT_SCENE.altered(h=0.5)
    path = recorded(tmp_path / "lab.mcap", Live.mark, 0.8, *acts, scene=scene)
    replay = Table(path).replay
    replay.seek(0.8)
    steps = [(replay.stepping.h, replay.step(-1).step) for _ in range(4)]
    assert steps == [(0.3, 3), (0.3, 2), (0.2, 1), (0.5, 0)]


@pytest.mark.parametrize(("ahead", "seconds"), [(1.9, 1.0), (8.0, 6.0)])
def test_the_past_of_a_lab_that_goes_on_from_here_is_that_of_the_replay(replay, ahead, seconds):
    replay.seek(ahead)
    replay.fill()
    replay.seek(seconds)
    live = replay.live()
    errors = [each.history.window().high["energy_error"] for each in (replay, live)]
    np.testing.assert_array_equal(*errors)
    live.change(Stepping(0.04))
    live.step(3)
    passed = live.history.window().t[-4:] - replay.sample.t
    assert passed == pytest.approx([0.0, 0.04, 0.08, 0.12])  # and nothing that was recorded later
    replay.step(3)
    assert (np.diff(replay.history.rows["step"]) > 0).all()  # nor is anything of the lab here


@pytest.mark.parametrize("seconds", [4.7, 11.0])
def test_a_lab_that_goes_on_from_here_has_the_same_bits(replay, seconds):
    replay.seek(seconds)
    replay.set_speed(-2.0)
    live = replay.live()
    assert (live.kind, live.playhead.speed, live.recording_status) == ("LIVE", 2.0, None)
    assert (live.knows_past, live.playhead.position) == (True, live.history.window().x[-1])
    here = replay.sample
    assert (live.sample.step, live.sample.t) == (here.step, here.t)
    assert live.stepping.h == replay.stepping.h
    assert states(live.sample) == states(here)
    ahead = replay.step(1)
    if ahead.run == here.run:
        assert states(live.step(ahead.step - here.step)) == states(ahead)


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """A lab that ran for 24 s, then from the last verdict on for 8 s with another h.

    With its milestones of the 24 s, what it said at each sample, and its file.
    """
    path = tmp_path_factory.mktemp("lab") / "lab.mcap"
    lab = Lab(record=path)
    live = lab.live
    said = {}

    def run(seconds):
        for _ in range(round(seconds * FPS)):
            sample = lab.run(1 / FPS)
            said[sample.run, sample.step] = told(live)

    run(24.0)
    first = list(live.milestones)
    live.step(first[-1].step - live.sample.step)
    live.change(live.stepping._replace(h=0.02, equal_cost=True))
    live.pause(False)
    run(8.0)
    live.close()
    return live, first, said, path


def told(source):
    judged = [(each.verdict, each.progress) for each in source.judgements]
    return judged, list(source.milestones)


def test_it_says_at_each_sample_what_the_lab_said_and_shows_the_trend_of_each_verdict(lab):
    live, first, said, path = lab
    assert live.recording_status == ("lab.mcap", live.recorder.seconds, None)
    assert verify(path).identical
    replay = Table(path).replay
    seen = {}
    trends = {}
    while replay.sample != (sample := replay.step(1)):
        seen[sample.run, sample.step] = told(replay)
        for method, judgement in zip(replay.scene.cast, replay.judgements, strict=True):
            trends.setdefault((method, judgement.verdict), judgement.trend)
    both = seen.keys() & said.keys()
    assert len(both) > 500
    assert [seen[place] for place in both] == [said[place] for place in both]
    verdicts = {((each.method, each.verdict), each.trend) for each in first if each.verdict}
    assert trends.items() >= {each for each in verdicts if each[0][1] != "undecided"}
    assert set(trends.values()) > {None}
    assert replay.run.number == 2
    # also those of before the first sample of this run
    assert list(replay.milestones) == list(live.milestones)


def test_a_lab_that_goes_on_from_here_knows_what_was_known(lab):
    table = Table(lab[3])
    replay = table.replay
    replay.seek(17.5)
    table.run(1 / FPS)
    assert replay.fill()
    assert table.verdicts == ["grows", "bounded", "bounded", "loses"]
    live = replay.live()
    assert list(live.milestones) == list(replay.milestones)
    np.testing.assert_array_equal(live.history.window().t, replay.history.window().t)
    replay.seek(23.0)
    live.step(replay.sample.step - live.sample.step)
    assert [judgement.verdict for judgement in live.judgements] == table.verdicts
    table.replay.seek(17.5)
    replay.fill()
    live = replay.live()
    live.change(Stepping(-0.1))
    live.step(3)  # and nothing of what was recorded later
    window = live.history.window()
    assert window.t[-4:] - replay.sample.t == pytest.approx([0.0, -0.1, -0.2, -0.3])
    assert window.x[-4:] - window.x[-4] == pytest.approx([0.0, 0.1, 0.2, 0.3])


def test_it_shows_the_verdicts_that_were_recorded_and_not_those_of_this_version(lab, tmp_path):
    _, first, _, path = lab
    said = next(each for each in first if each.verdict == "bounded")
    with Recorder(tmp_path / "other.mcap") as recorder:
        for clock, value in Table(path).recording.entries():
            if value.run > 1:
                break
            if isinstance(value, Event) and value.milestone == said:
                other = said._replace(verdict="chaotic", lyapunov=0.5)
                recorder.add(value._replace(milestone=other), clock)
                passes = Milestone("over the top", said.method, said.step, said.t, 0.0)
                value = value._replace(milestone=passes)
            recorder.add(value, clock)
    table = Table(tmp_path / "other.mcap")
    table.replay.seek(table.replay.length)
    judgement = table.replay.judgements[table.replay.scene.cast.index(said.method)]
    assert (judgement.verdict, judgement.lyapunov) == ("chaotic", 0.5)


def test_no_lab_goes_on_without_the_users_own_method(tmp_path):
    cast = (load(VERLET), method_of("implicit_midpoint"))
    scene = replace(DEFAULT_SCENE, theta=3.0, h=0.7, cast=cast)
    table = Table(recorded(tmp_path / "lab.mcap", 2.0, scene=scene))
    table.replay.seek(2.0)
    assert table.verdicts == ["undecided", "failed"]
    with pytest.raises(RecordingError, match="--method"):
        table.replay.live()


def test_a_closed_replay_stands_still(table, replay):
    replay.seek(11.0)
    here = replay.sample
    history = replay.history
    replay.close()
    assert table.run(1.0) == here
    assert (replay.history, replay.playhead.position) == (history, 11.0)
    assert table.recording._stream.closed
