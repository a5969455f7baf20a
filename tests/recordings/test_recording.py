"""Reading: any moment of a recording, complete or not."""

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import Writer

from pendu_tui.recordings.events import Entry, Event, arithmetic_here
from pendu_tui.recordings.files import GOLDEN, RecordingError
from pendu_tui.recordings.format import without_extremes
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording, Run, SamplePlace
from tests.recordings.examples import SCENE, record, samples_of, start, two_runs


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return record(tmp_path_factory.mktemp("reading") / "a.mcap", two_runs())


@pytest.mark.parametrize("check", [False, True])
def test_everything_recorded_is_read_in_order_with_a_stop_at_the_end(path, check):
    entries = two_runs()
    last = entries[-1].value
    expected = [*entries, Entry(4.0, Event("stop", last.run, last.step, last.t))]
    with Recording.open(path, check) as recording:
        assert recording.bytes == path.stat().st_size
        assert [run.inputs for run in recording.runs] == [5, 2]
        for (clock, value), (when, was) in zip(recording.entries(), expected, strict=True):
            assert clock == when
            if isinstance(was, Event):
                assert value._replace(arithmetic=None) == was
            else:
                assert without_extremes(value) == without_extremes(was)


def test_stepping_reaches_every_sample_in_both_directions(path):
    with Recording.open(path) as recording:
        samples = samples_of(recording)
        places = [recording.at(-1.0)]
        while place := recording.beside(places[-1], 1):
            places.append(place)
        assert [recording.sample(place) for place in places] == samples
        assert [clock for clock, _ in samples].count(2.5) == 2
        back = [places[-1]]
        while place := recording.beside(back[-1], -1):
            back.append(place)
        assert back[::-1] == places


CLOCKS = st.floats(-1, 6).map(lambda clock: round(clock, 9))  # the nearest that a file can hold
CLOCKS |= st.sampled_from([clock for clock, _ in two_runs()])


@given(CLOCKS, CLOCKS)
def test_a_time_gives_the_last_sample_before_it_and_a_window_the_entries_in_it(path, start, end):
    with Recording.open(path) as recording:
        samples = samples_of(recording)
        before = [entry for entry in samples if entry.clock <= start]
        assert recording.sample(recording.at(start)) == (before or samples[:1])[-1]
        within = [entry for entry in recording.entries() if start <= entry.clock <= end]
        assert list(recording.entries(start, end)) == within


@pytest.mark.parametrize("frame", [1, 14, 1001, 123_457])
def test_a_time_is_rounded_to_the_nearest_nanosecond(tmp_path, frame):
    clock = frame / 30  # what a lab's frames may have
    path = record(tmp_path / "a.mcap", [*two_runs()[:2], Entry(clock, two_runs()[2].value)])
    with Recording.open(path) as recording:
        assert recording.sample(recording.at(clock)).value.step == 3
        assert len(list(recording.entries(clock, clock))) == 2  # the sample and the stop


def test_a_run_without_samples_has_no_length_and_a_recording_without_them_is_refused(
    tmp_path, monkeypatch
):
    path, opened, opening = record(tmp_path / "a.mcap", two_runs()[:1]), [], Path.open
    with monkeypatch.context() as watched:
        watched.setattr(Path, "open", lambda *each: opened.append(opening(*each)) or opened[-1])
        with pytest.raises(RecordingError, match="it has no samples"):
            Recording.open(path)
    assert [stream.closed for stream in opened] == [True]
    starts = [Entry(1.0, start(2)), Entry(1.0, start(3))]
    with Recording.open(record(tmp_path / "b.mcap", [*two_runs()[:4], *starts])) as recording:
        runs = [(run.steps, round(run.t, 9), run.begin, run.end) for run in recording.runs]
    assert runs == [(6, 0.6, 0.0, 1.0), (0, 0.0, 1.0, 1.0), (0, 0.0, 1.0, 1.0)]
    assert recording._stream.closed


def test_a_file_of_another_program_is_called_so(tmp_path):
    path = tmp_path / "robot.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream, enable_data_crcs=True)
        writer.start()
        writer.finish()
    with pytest.raises(RecordingError, match="not a recording of pendu-tui"):
        Recording.open(path)
    path.write_bytes(b"")
    for name, why in ((path, "its end is missing"), (os.devnull, "a device or a pipe")):
        with pytest.raises(RecordingError, match=why):
            Recording.open(Path(name))


def test_a_file_that_is_emptied_while_it_is_read_is_one_sentence(tmp_path):
    copy = tmp_path / "copy.mcap"
    copy.write_bytes((GOLDEN / "drift.mcap").read_bytes())
    with Recording.open(copy) as recording:
        places = [SamplePlace(chunk, 1 - chunk) for chunk in (0, 1)]
        assert [recording.sample(place).value.step for place in places] == [0, 2]
        recording._decode.cache_clear()
        copy.write_bytes(b"")
        for place in places:
            with pytest.raises(RecordingError, match="it was changed while"):
                recording.sample(place)


def test_a_sample_that_lacks_a_method_is_damage(tmp_path):
    path, sample = tmp_path / "a.mcap", two_runs()[1].value
    with Recorder(path) as recorder:
        for value in (start(), sample):
            recorder.add(value, 0.0)
        recorder._begin(SCENE.with_cast(SCENE.cast[:3]))
        recorder.add(sample._replace(step=1, readings=sample.readings[:3]), 0.5)
    with Recording.open(path) as recording:
        assert (recording.damaged, recording.reason) == (True, "a sample is incomplete")
    path.write_bytes(path.read_bytes()[:-1])
    with Recording.open(path) as recording:  # the first reason
        assert (recording.damaged, recording.reason) == (True, "its end is missing or damaged")


def test_a_step_of_no_length_is_refused(tmp_path):
    entries = [*two_runs()[:2], Entry(0.5, Event("set_h", 1, 0, 0.0, h=0.0))]
    with pytest.raises(RecordingError, match="run 1 cannot have been recorded: h = 0 s"):
        Recording.open(record(tmp_path / "a.mcap", entries))


def test_the_way_of_a_run_grows_also_while_time_runs_back():
    run = Run(1, SCENE, arithmetic_here(), 0.0, 9.0)
    for step, t, h in ((20, 2.0, -0.05), (60, 0.0, 0.1)):
        run.add(9.0, Event("set_h", 1, step, t, h=h, equal_cost=True))
    assert [change.x for change in run.changes] == [0.0, 2.0, 4.0]  # s on the way
    assert [change.stepping.equal_cost for change in run.changes] == [False, True, True]


def test_a_recording_of_another_format_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("pendu_tui.recordings.recorder.FORMAT_VERSION", "2")
    path = record(tmp_path / "a.mcap", two_runs())
    with pytest.raises(RecordingError, match="another format; this version reads 3"):
        Recording.open(path)
