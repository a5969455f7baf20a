"""A replay, driven by a clock that the test moves."""

import itertools
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from engine.run.lockstep import Sample
from recordings.events import Entry
from recordings.recording import Recording
from tests.tui.harness import FPS, Clocked, eventful, recorded
from tui.playback.cursor import DENSE, MAX_PIECES, pieces
from tui.playback.marks import Marks
from tui.playback.replay import Replay
from tui.words.events import event_lines

NANOSECOND = 1e-9  # what clocks in a file are rounded to
LENGTH = 12.0  # s, of the eventful sitting


@pytest.fixture(autouse=True)
def closed():
    """What a test has opened."""
    yield
    while Table.opened:
        Table.opened.pop().close()


class Table(Clocked):
    """A replay with its clock."""

    opened: ClassVar[list[Recording]] = []

    def __init__(self, path: Path):
        self.recording = Recording.open(path)
        self.opened.append(self.recording)
        self.replay = Replay(self.recording, Marks(path), clock=lambda: 0.0)
        super().__init__(self.replay)

    @property
    def due(self) -> Sample:
        """The last sample recorded before the playhead, found the slow way."""
        position = self.replay.playhead.position + NANOSECOND
        return [value for clock, value in self.samples if clock <= position][-1]

    @cached_property
    def samples(self) -> list[Entry]:
        return [entry for entry in self.recording.entries() if isinstance(entry.value, Sample)]


@pytest.fixture(scope="module")
def sitting(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return eventful(tmp_path_factory.mktemp("replay") / "eventful.mcap")


@pytest.fixture
def table(sitting: Path) -> Table:
    return Table(sitting)


def test_it_begins_at_the_first_sample(table):
    assert table.replay.sample == table.samples[0].value
    assert table.replay.length == pytest.approx(LENGTH)


def test_at_every_moment_it_shows_the_last_sample_that_was_recorded_before(table):
    for _ in range(60):
        sample = table.run(0.2)
        assert sample == table.due


def test_it_stops_at_the_end_and_from_there_goes_on_from_the_start(table):
    table.run(LENGTH + 1)
    assert table.replay.playhead.paused
    assert table.replay.sample == table.samples[-1].value
    table.replay.pause(False)
    table.run(0.5)
    assert table.replay.playhead.position == pytest.approx(0.5)


def test_played_backwards_it_shows_the_same_samples_and_stops_at_the_start(table):
    table.replay.seek(LENGTH)
    table.replay.set_speed(-1.0)
    runs = []
    while not table.replay.playhead.paused:
        sample = table.run(1 / FPS)
        assert sample == table.due
        runs.append(sample.run)
    assert sample == table.samples[0].value
    assert list(dict.fromkeys(runs)) == [3, 2, 1]


def test_steps_go_from_sample_to_sample_both_ways_and_not_over_the_ends(table):
    replay = table.replay
    forward = [replay.step(1) for _ in range(len(table.samples) + 2)]
    assert forward[: len(table.samples) - 1] == [entry.value for entry in table.samples[1:]]
    assert forward[-1] == table.samples[-1].value
    backward = [replay.step(-1) for _ in range(len(table.samples) + 2)]
    assert backward[: len(table.samples) - 1] == [entry.value for entry in table.samples[-2::-1]]


@pytest.mark.parametrize("seconds", [-5.0, 0.0, 3.3, 9.0, LENGTH, 99.0])
def test_a_seek_lands_where_playing_would_have_come_by(table, sitting, seconds):
    table.replay.seek(seconds)
    inside = min(max(seconds, 0.0), table.replay.length)
    assert table.replay.playhead.position == inside
    assert table.replay.sample == table.due


@pytest.mark.parametrize("seconds", [1.0, 4.4, 8.0, 11.5])
@pytest.mark.parametrize("origin", [0.0, 12.0])
def test_after_a_jump_chart_and_trails_show_what_they_show_after_playing(sitting, seconds, origin):
    played, jumped = Table(sitting), Table(sitting)
    while played.replay.playhead.position < seconds:
        played.run(1 / FPS)
    jumped.replay.seek(origin)
    jumped.replay.seek(played.replay.playhead.position)
    jumped.replay.pause(True)
    jumped.run(0.1)
    assert jumped.replay.sample == played.replay.sample
    for one, other in zip(
        played.replay.history.trails(15)[:, 3].T,
        jumped.replay.history.trails(15)[:, 3].T,
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)
    one, other = played.replay.history.window(), jumped.replay.history.window()
    np.testing.assert_array_equal(one.t, other.t)
    np.testing.assert_array_equal(one.low["energy_error"], other.low["energy_error"])
    assert jumped.replay.judgements == played.replay.judgements


def test_right_after_a_jump_the_trails_are_there_before_the_rest_of_the_past(table):
    table.replay.seek(4.0)
    assert len(table.replay.history.trails(15)[:, 0].T[0]) == 15


def test_stepping_back_takes_the_past_back(table):
    table.replay.seek(4.0)
    table.run(0.1)
    table.replay.step(-30)
    table.run(0.1)
    window = table.replay.history.window()
    assert window.t[-1] == table.replay.sample.t


def test_the_step_size_is_the_one_in_force_at_the_moment(table):
    seen = {}
    for clock in (1.0, 3.0, 4.5, 6.0, 11.0):
        table.replay.seek(clock)
        seen[clock] = table.replay.stepping.h
    assert seen == {1.0: 0.05, 3.0: 0.1, 4.5: -0.1, 6.0: 0.02, 11.0: 0.05}


def test_the_next_event_and_the_one_before_are_found(table):
    places = [0.0]
    while places[-1] < table.replay.length - 1e-6:
        table.replay.seek_event(1)
        places.append(table.replay.playhead.position)
    assert [round(place) for place in places] == [0, 2, 4, 5, 9, 12]
    for place in reversed(places[:-1]):
        table.replay.seek_event(-1)
        assert table.replay.playhead.position == place


def test_the_next_event_may_be_a_milestone(tmp_path):
    table = Table(recorded(tmp_path / "drift.mcap", 20.0))
    listed = []
    for _ in range(3):
        table.replay.seek_event(1)
        table.replay.pause(True)
        table.run(1 / FPS)
        listed.append(
            [line.text for line in event_lines(table.replay)][sum(map(len, listed)) + 1 :]
        )
    assert listed == [
        ["Explicit Euler over the top, 5.1 E0"],
        ["Explicit Euler gains energy", "RK4 loses energy"],
        ["Symplectic Euler stays bounded", "Verlet stays bounded"],
    ]
    table.replay.seek_event(1)
    assert table.replay.playhead.position == table.replay.length


def test_speed_counts_for_the_recording_clock(table):
    table.replay.set_speed(4.0)
    table.run(2)
    assert table.replay.playhead.position == pytest.approx(8.0)


@pytest.mark.parametrize("seconds", [1.0, 3.5, 4.7, 8.0, 11.0])
def test_a_lab_that_goes_on_from_here_has_the_same_bits(table, seconds):
    table.replay.seek(seconds)
    live = table.replay.live()
    here = table.replay.sample
    assert (live.sample.step, live.sample.t, live.stepping.h) == (
        here.step,
        here.t,
        table.replay.stepping.h,
    )
    assert [(r.theta, r.omega) for r in live.sample.readings] == [
        (r.theta, r.omega) for r in here.readings
    ]
    table.replay.step(1)
    ahead = table.replay.sample
    if ahead.run == here.run:
        live.step(ahead.step - here.step)
        assert [(r.theta, r.omega) for r in live.sample.readings] == [
            (r.theta, r.omega) for r in ahead.readings
        ]


def test_a_lab_that_goes_on_from_here_knows_what_was_known(tmp_path):
    table = Table(recorded(tmp_path / "drift.mcap", 22.0))
    table.replay.seek(18.0)
    table.run(1 / FPS)
    assert table.replay.fill()
    milestones = list(table.replay.milestones)
    times = table.replay.history.window().t
    live = table.replay.live()
    assert [judgement.verdict for judgement in live.judgements] == [
        "grows",
        "bounded",
        "bounded",
        "loses",
    ]
    assert list(live.milestones) == milestones
    np.testing.assert_array_equal(live.history.window().t, times)
    while table.replay.sample.step < table.samples[-1].value.step:
        table.replay.step(1)
        live.step(table.replay.sample.step - live.sample.step)
    verdicts = [judgement.verdict for judgement in table.replay.judgements]
    assert [judgement.verdict for judgement in live.judgements] == verdicts


def test_a_moment_has_one_mark(tmp_path):
    path = recorded(
        tmp_path / "marked.mcap", 2.0, lambda live: live.mark(), lambda live: live.mark(), 1.0
    )
    table = Table(path)
    marks = [event for _, event in table.recording.events if event.kind == "mark"]
    assert len(marks) == 1
    table.replay.seek(2.0)
    table.replay.mark()
    assert list(table.replay.marks) == []
    table.replay.seek(2.5)
    table.replay.mark()
    table.replay.mark()
    assert len(list(table.replay.marks)) == 1


def test_marks_are_kept_beside_the_recording_which_is_not_touched(tmp_path):
    path = recorded(tmp_path / "marked.mcap", 3.0)
    before = path.read_bytes()
    table = Table(path)
    table.replay.seek(1.5)
    table.replay.mark("look")
    assert path.read_bytes() == before
    again = Table(path)
    assert [(mark.clock, mark.text) for mark in again.replay.marks] == [(1.5, "look")]
    assert 1.5 in again.replay.ticks


@pytest.mark.parametrize(
    "content",
    ["", "[]", "{}", '{"schema": "pendu.marks/1", "marks": [{"clock": "x"}]}', "[" * 9999],
)
def test_a_file_of_marks_that_is_not_ours_is_no_marks(tmp_path, content):
    path = tmp_path / "a.mcap"
    (tmp_path / "a.mcap.marks.json").write_text(content)
    assert list(Marks(path)) == []


def test_a_long_past_is_read_in_pieces_of_which_the_last_minute_is_whole():
    short, long = pieces(0.0, 30.0), pieces(100.0, 30_000.0)
    assert short == [(0.0, 30.0)]
    assert long[-1] == (30_000.0 - DENSE, 30_000.0)
    assert long[0] == (100.0, 101.0)
    assert len(long) == MAX_PIECES + 1
    whole = pieces(0.0, DENSE + 200)
    assert all(end == begin for (_, end), (begin, _) in itertools.pairwise(whole))


def test_a_closed_replay_stands_still(sitting):
    table = Table(sitting)
    here = table.replay.sample
    table.replay.close()
    assert table.run(1.0) == here
    table.replay.seek(5.0)
    assert table.replay.step(3) == here
    assert table.replay.fill()


@pytest.mark.parametrize(
    ("speed", "start", "behind"), [(1.0, LENGTH - 0.5, 0.5), (-1.0, 0.5, LENGTH - 0.5)]
)
def test_a_loop_goes_round_both_ways(table, speed, start, behind):
    table.replay.looping = True
    table.replay.set_speed(speed)
    table.replay.seek(start)
    table.run(1)
    assert table.replay.playhead.position == pytest.approx(behind, abs=0.1)
    assert not table.replay.playhead.paused
