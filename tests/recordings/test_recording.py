"""Reading: any moment of a recording, complete or not."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.run.lockstep import Sample
from recordings.events import Entry, Event
from recordings.headless import simulate
from recordings.recorder import Recorder
from recordings.recording import Recording
from tests.recordings import hostile
from tests.recordings.examples import SCENE, record, start, two_runs


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return record(tmp_path_factory.mktemp("reading") / "a.mcap", two_runs())


@pytest.fixture(params=[False, True], ids=["by its summary", "checked"])
def recording(request, path):
    with Recording.open(path, check=request.param) as recording:
        yield recording


def expected():
    """What was recorded, as it reads back: a run's first sample knows no extremes, and there is a stop at the end."""
    entries = two_runs()
    last = entries[-1].value
    return [*entries, Entry(4.0, Event("stop", last.run, last.step, last.t))]


def nanoseconds(clock):
    """The nearest clock that a file can hold."""
    return round(clock, 9)


def places(recording):
    place = recording.at(0.0)
    while recording.previous(place):
        place = recording.previous(place)
    while place:
        yield place
        place = recording.next(place)


def test_everything_recorded_is_read_in_order(recording):
    entries = list(recording.entries())
    assert [clock for clock, _ in entries] == [clock for clock, _ in expected()]
    for (_, value), (_, was) in zip(entries, expected(), strict=True):
        if isinstance(was, Event):
            assert value._replace(arithmetic=None) == was
        else:
            assert [reading.theta for reading in value.readings] == [
                reading.theta for reading in was.readings
            ]
            assert (value.run, value.step, value.t) == (was.run, was.step, was.t)


def test_the_facts_of_a_recording_are_known_at_opening(recording):
    assert recording.complete
    assert not recording.damaged
    assert recording.reason is None
    assert recording.length == 4.0
    assert recording.samples == 10
    assert recording.bytes == recording.path.stat().st_size


def test_runs_have_their_scene_times_and_steps(recording):
    first, second = recording.runs
    assert (first.number, first.scene, first.begin, first.end, first.steps) == (
        1,
        SCENE,
        0.0,
        2.5,
        16,
    )
    assert first.inputs == 5  # set_h, speed, pause, mark, resume
    assert (second.number, second.begin, second.end, second.steps) == (2, 2.75, 4.0, 16)


def test_stepping_reaches_every_sample_in_both_directions(recording):
    forth = list(places(recording))
    samples = [recording.sample(place) for place in forth]
    assert [entry for entry in recording.entries() if isinstance(entry.value, Sample)] == samples
    assert [clock for clock, _ in samples].count(2.5) == 2
    back = [forth[-1]]
    while before := recording.previous(back[-1]):
        back.append(before)
    assert back[::-1] == forth


@given(
    clock=st.floats(-1, 6).map(nanoseconds) | st.sampled_from([clock for clock, _ in two_runs()])
)
def test_a_time_gives_the_last_sample_before_it_or_else_the_first(path, clock):
    with Recording.open(path) as recording:
        samples = [entry for entry in recording.entries() if isinstance(entry.value, Sample)]
        before = [entry for entry in samples if entry.clock <= clock]
        assert recording.sample(recording.at(clock)) == (before or samples[:1])[-1]


@given(st.floats(0, 6).map(nanoseconds), st.floats(0, 6).map(nanoseconds))
def test_a_time_window_gives_the_entries_in_it(path, start, end):
    with Recording.open(path) as recording:
        assert list(recording.entries(start, end)) == [
            entry for entry in recording.entries() if start <= entry.clock <= end
        ]


@given(st.integers(1, 1_000_000))
def test_a_time_is_rounded_to_the_nearest_nanosecond(tmp_path_factory, frame):
    clock = frame / 30  # what a lab's frames may have
    path = tmp_path_factory.mktemp("moment") / "a.mcap"
    record(path, [*two_runs()[:2], Entry(clock, two_runs()[2].value)])
    with Recording.open(path) as recording:
        assert recording.sample(recording.at(clock)).value.step == 3
        assert len(list(recording.entries(clock, clock))) == 2  # the sample and the stop


def test_a_recording_in_progress_opens_with_what_is_on_disk(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        for _ in simulate(SCENE, 2.0, recorder):
            pass
        with Recording.open(recorder.part) as recording:
            assert not recording.complete
            assert not recording.damaged
            assert recording.reason == "its end is missing or damaged"
            assert 1.0 <= recording.length <= 2.0
            assert recording.sample(recording.at(1.0)).value.t == pytest.approx(
                1.0
            )  # ten steps of 0.1


def test_a_recording_without_samples_opens_and_has_no_place(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs()[:1])
    with Recording.open(path) as recording:
        assert recording.at(0.0) is None
        assert recording.samples == 0
        assert recording.runs[0].steps == 0


def test_a_run_without_samples_has_no_length(tmp_path):
    path = record(
        tmp_path / "a.mcap", [*two_runs()[:4], Entry(1.0, start(2)), Entry(1.0, start(3))]
    )
    with Recording.open(path) as recording:
        assert [(run.steps, run.begin, run.end) for run in recording.runs] == [
            (6, 0.0, 1.0),
            (0, 1.0, 1.0),
            (0, 1.0, 1.0),
        ]


def test_a_chunk_whose_samples_are_impossible_costs_itself_only(tmp_path):
    def entries():
        yield from hostile.begun()
        yield from hostile.cut_run(2)

    hostile.write(tmp_path / "a.mcap", entries())
    with Recording.open(tmp_path / "a.mcap") as recording:
        assert [run.number for run in recording.runs] == [1, 2]
        assert [value for _, value in recording.entries()] == [None]
        assert recording.damaged
