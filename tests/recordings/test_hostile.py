"""Untrusted files: one sentence, little memory, nothing printed raw, nothing written elsewhere."""

import json
import os
import random
import struct
import subprocess
import sys
import time
import tracemalloc
import zlib
from contextlib import suppress

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType, Writer

from recordings import framing
from recordings.diff import compare
from recordings.errors import RecordingError
from recordings.events import Event
from recordings.format import EVENTS, encode_event, encode_readings, topic
from recordings.framing import read_chunk
from recordings.recorder import FLUSH_EVERY, Recorder
from recordings.recording import EVENT_LIMIT, Recording
from recordings.recover import recover
from recordings.scan import Scan
from recordings.summary import CHUNK_LIMIT, Chunks
from recordings.verify import verify
from tests.recordings.examples import METHOD_KEYS, record, start, two_runs
from tests.recordings.hostile import FILES

SECOND = 1_000_000_000


class Forger:
    """Writes what looks like a recording of ours."""

    def __init__(self, path, facts=None, schema_id=None, **options):
        self.path = path
        self.file = path.open("wb")
        self.writer = Writer(self.file, enable_data_crcs=True, **options)
        self.writer.start("pendu", "forger")
        schema = self.writer.register_schema("x", "jsonschema", b'{"type": "object"}')
        facts = {"format": "1", "sin": "0"} if facts is None else facts
        self.events = self.writer.register_channel(EVENTS, "json", schema, facts)
        self.methods = [self.writer.register_channel(topic(method), "json", schema) for method in METHOD_KEYS]

    def event(self, event, log_time=SECOND):
        data = event if isinstance(event, bytes) else encode_event(event)
        self.writer.add_message(self.events, log_time, data, log_time)

    def sample(self, sample, log_time=SECOND, change=lambda data: data):
        for channel, data in zip(self.methods, encode_readings(sample), strict=True):
            self.writer.add_message(channel, log_time, change(data), log_time)

    def done(self):
        self.writer.finish()
        self.file.close()
        return self.path


def refused(path, tmp_path):
    """The sentences with which everything refuses the file."""
    sentences = []
    for attempt in (
        lambda: list(Recording.open(path).entries()),
        lambda: Recording.open(path, check=True),
        lambda: verify(path),
        lambda: recover(path, tmp_path / "out" / "saved.mcap"),
    ):
        try:
            attempt()
        except RecordingError as error:
            sentence = str(error)
            assert sentence.startswith(str(path))
            assert sentence.endswith(".")
            assert sentence.isprintable()
            sentences.append(sentence)
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())
    return sentences


@pytest.fixture(autouse=True)
def out(tmp_path):
    (tmp_path / "out").mkdir()


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "the file is empty"),
        (b"hello", "this is not an MCAP file"),
        (b"\x1b[31m" * 1000, "this is not an MCAP file"),
        (bytes(100_000), "this is not an MCAP file"),
        (framing.MAGIC, "nothing in it can be read: the recording was not finished"),
        (framing.MAGIC + b"\x1b[31m" * 1000, "nothing in it can be read: there is no record where one should begin"),
        (framing.MAGIC + struct.pack("<BQ", 6, 1 << 62), "nothing in it can be read: unexpected record of"),
        (framing.MAGIC + struct.pack("<BQ", 1, 100), "nothing in it can be read: the recording was not finished"),
        (framing.MAGIC * 2, "nothing in it can be read"),
    ],
    ids=["empty", "text", "escapes", "zeros", "magic", "magic and escapes", "huge length", "cut header", "magic twice"],
)
def test_a_file_that_is_not_a_recording_is_refused_in_a_sentence(tmp_path, data, why):
    path = tmp_path / "x.mcap"
    path.write_bytes(data)
    sentences = refused(path, tmp_path)
    assert len(sentences) == 4
    assert all(why in sentence or "nothing in it can be" in sentence for sentence in sentences)
    assert why in sentences[0]


@pytest.mark.parametrize("name", ["missing.mcap", "folder", "\x1b[31mred.mcap"])
def test_a_file_that_cannot_be_opened_is_refused_in_a_sentence(tmp_path, name):
    (tmp_path / "folder").mkdir()
    for attempt in (Recording.open, verify):
        with pytest.raises(RecordingError, match=r"No such file|Is a directory") as caught:
            attempt(tmp_path / name)
        assert str(caught.value).isprintable()


def test_a_pipe_is_refused_in_a_sentence(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    writer = os.open(tmp_path / "pipe", os.O_RDWR)
    for attempt in (
        lambda path: Recording.open(path).close(),
        verify,
        lambda path: recover(path, tmp_path / "out.mcap"),
    ):
        with pytest.raises(RecordingError, match=r"this is a pipe, .*; save it as a file first"):
            attempt(tmp_path / "pipe")
    os.close(writer)


def test_an_unreadable_disk_is_reported_as_an_unreadable_file(tmp_path, monkeypatch):
    path = record(tmp_path / "a.mcap", two_runs())

    def broken(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr("recordings.scan.record_at", broken)
    for attempt in (lambda path: Recording.open(path, check=True), verify):
        with pytest.raises(RecordingError, match=r"a\.mcap: Input/output error\.$"):
            attempt(path)


def test_a_file_of_another_program_is_recognized(tmp_path):
    for options in (
        {},
        {"compression": CompressionType.LZ4},
        {"use_chunking": False},
        {"compression": CompressionType.NONE},
    ):
        path = tmp_path / "robot.mcap"
        with path.open("wb") as file:
            writer = Writer(file, **options)
            writer.start("ros2")
            channel = writer.register_channel("/camera", "cdr", writer.register_schema("Image", "ros2msg", b"x"))
            for i in range(100):
                writer.add_message(channel, i, bytes(1000), i)
            writer.finish()
        sentences = refused(path, tmp_path)
        assert len(sentences) == 4
        assert "an MCAP file, but not a recording of pendu-tui" in sentences[0]


@pytest.mark.parametrize(
    ("facts", "why"),
    [
        ({}, "or its format version is missing"),
        ({"format": "\x1b[2J"}, "or its format version is missing"),
        ({"format": "0x1"}, "or its format version is missing"),
        ({"format": "9" * 5000}, "or its format version is missing"),
        ({"format": "3"}, "has format 3"),
    ],
)
def test_an_unknown_format_is_refused(tmp_path, facts, why):
    forger = Forger(tmp_path / "x.mcap", facts)
    forger.event(start())
    assert any(why in sentence for sentence in refused(forger.done(), tmp_path))


def bomb(size, declared=None, frame=True):
    """A chunk record of `size` zeros that declares to be `declared` bytes."""
    compressor = zstandard.ZstdCompressor(write_content_size=frame)
    data = compressor.compress(bytes(size))
    head = struct.pack("<QQQI", SECOND, SECOND, declared if declared is not None else size, 1)
    content = head + b"\x04\x00\x00\x00zstd" + struct.pack("<Q", len(data)) + data
    return framing.MAGIC + struct.pack("<BQ", 6, len(content)) + content


@pytest.mark.parametrize(
    "data",
    [bomb(1 << 30), bomb(1 << 30, 100), bomb(1 << 30, 100, frame=False), bomb(1 << 30, 1 << 23, frame=False)],
    ids=["honest", "liar", "no size", "no size, largest allowed"],
)
def test_a_decompression_bomb_does_not_go_off(tmp_path, data):
    (tmp_path / "x.mcap").write_bytes(data)
    usage = f"""
import resource, sys
from pathlib import Path
sys.path.insert(0, {str(tmp_path)!r})
from recordings.recording import EVENT_LIMIT, Recording
from recordings.verify import verify
from recordings.recover import recover
from recordings.errors import RecordingError
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for attempt in (Recording.open, verify):
    try:
        attempt(Path(sys.argv[1]))
    except RecordingError as error:
        print(error)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    command = [sys.executable, "-c", usage, str(tmp_path / "x.mcap")]
    *sentences, grown = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(sentences) == 2
    assert int(grown) < 60_000  # kB


def test_a_chunk_that_declares_another_length_than_it_has_is_damaged():
    record = bomb(100)[len(framing.MAGIC) + framing.RECORD.size :]
    length = framing.CHUNK_HEADER - 8  # where its data's length stands
    with pytest.raises(RecordingError, match="a chunk's length is wrong"):
        read_chunk(record[:length] + struct.pack("<Q", 1 << 40) + record[framing.CHUNK_HEADER :])


@pytest.mark.parametrize(("lie", "looked_at"), [(0, 10), (1, 0)], ids=["plausible sizes", "sizes that disagree"])
def test_a_file_of_false_chunks_costs_no_more_than_a_limit(tmp_path, monkeypatch, lie, looked_at):
    length, path = 1_000_000, tmp_path / "x.mcap"
    chunk = struct.pack(
        "<BQQQQII4sQ", 6, length + framing.CHUNK_HEADER, SECOND, SECOND, 24, 1, 4, b"zstd", length + lie
    )
    path.write_bytes(framing.MAGIC + b"\0" + 1_000 * chunk + bytes(length))
    looks = []
    monkeypatch.setattr(framing, "SEARCH_LIMIT", 10 * length)
    monkeypatch.setattr(framing, "read_chunk", lambda content: looks.append(len(content)) or read_chunk(content))
    with pytest.raises(RecordingError, match="nothing in it can be verified"):
        verify(path)
    assert len(looks) == looked_at


def test_a_million_channels_are_refused_at_the_first_few(tmp_path):
    path = tmp_path / "x.mcap"
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=1 << 20, enable_data_crcs=True)
        writer.start("pendu")
        for i in range(65_000):
            channel = writer.register_channel(f"/{i}", "json", 0)
        writer.add_message(channel, SECOND, b"{}", SECOND)
        writer.finish()
    sentences = refused(path, tmp_path)
    assert "unexpectedly many channels" in sentences[0]


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.replace(b'"theta":2.0', b'"theta":NaN'),
        lambda data: data.replace(b'"theta":2.0', b'"theta":null'),
        lambda data: data.replace(b'"theta":2.0', b'"theta":1e999'),
        lambda data: data.replace(b'"theta":2.0', b'"theta":"2.0"'),
        lambda data: b"{",
        lambda data: b"[" * 3_000,
        lambda data: b"\x1b[2J",
        lambda data: data + random.Random(1).randbytes(100_000),
    ],
    ids=["nan", "null", "infinite", "text", "cut", "deep", "escape", "long"],
)
def test_invalid_numbers_are_refused(tmp_path, change):
    forger = Forger(tmp_path / "x.mcap")
    forger.event(start())
    forger.sample(two_runs()[1].value, change=change)
    path = forger.done()
    with pytest.raises(RecordingError):
        verify(path)
    with pytest.raises(RecordingError):
        recover(path, tmp_path / "out" / "saved.mcap")
    with Recording.open(path) as recording:  # the player goes on
        assert list(recording.entries()) == []
        assert recording.damaged
    assert not list((tmp_path / "out").iterdir())


def test_runs_without_valid_samples_do_not_keep_the_player_from_opening(tmp_path):
    forger = Forger(tmp_path / "x.mcap")
    for run in (1, 2):
        forger.event(start(run))
        forger.sample(two_runs()[1].value, change=lambda data: b"{")
    with Recording.open(forger.done()) as recording:
        assert [(run.number, run.steps) for run in recording.runs] == [(1, 0), (2, 0)]
        assert recording.at(0.0) is None
        assert recording.damaged


@pytest.mark.parametrize("records", [1, 70, 1000])
def test_oversized_metadata_are_skipped(tmp_path, records):
    forger = Forger(tmp_path / "x.mcap")
    forger.event(start())
    forger.writer.flush()
    for i in range(records):
        forger.writer.add_metadata("pendu.recording", {f"{i}": "x" * 100_000})
    path = forger.done()
    for check in (False, True):
        with Recording.open(path, check) as recording:
            assert recording.metadata == {}
            assert recording.damaged


@pytest.mark.parametrize("times", [(5, 4), (0, 1), (1, 1 << 63), ((1 << 64) - 1,) * 2])
def test_an_impossible_clock_is_refused(tmp_path, times):
    forger = Forger(tmp_path / "x.mcap")
    forger.event(start(), times[0] * SECOND if times[0] < 9 else times[0])
    forger.writer.flush()
    forger.sample(two_runs()[1].value, times[1] * SECOND if times[1] < 9 else times[1])
    sentences = refused(forger.done(), tmp_path)
    assert "clock" in sentences[0]


def test_incomplete_samples_are_refused(tmp_path):
    for leave_out in range(4):
        forger = Forger(tmp_path / "x.mcap")
        forger.event(start())
        for place, (channel, data) in enumerate(zip(forger.methods, encode_readings(two_runs()[1].value), strict=True)):
            if place != leave_out:
                forger.writer.add_message(channel, SECOND, data, SECOND)
        with pytest.raises(RecordingError, match="a sample is incomplete"):
            verify(forger.done())


def test_of_too_many_events_the_first_are_shown(tmp_path, monkeypatch):
    monkeypatch.setattr("recordings.recording.EVENT_LIMIT", 1_000)
    forger = Forger(tmp_path / "x.mcap")
    forger.event(start())
    for step in range(1_000):
        forger.event(Event("mark", 1, step, step / 7))
    with Recording.open(forger.done()) as recording:
        assert len(recording.events) == 1_000
        assert not recording.complete
        assert recording.reason == "only its first 1000 events are shown"


def test_a_recording_with_many_changes_and_many_steps_back_opens_completely(tmp_path):
    assert EVENT_LIMIT > 2 * 28_307  # events of 310 changes of h, after which somebody stepped back 110 times
    path = tmp_path / "a.mcap"
    changes = [Event("set_h", 1, step, step / 10, h=0.1) for step in range(200)]
    with Recorder(path) as recorder:
        for run in range(1, 120):  # each going on from the past of the one before
            for event in (start(run), *(change._replace(run=run) for change in changes)):
                recorder.event(event, run / 10)
            recorder.sample(two_runs()[1].value._replace(run=run), run / 10)
    with Recording.open(path) as recording:
        assert recording.complete
        assert len(recording.events) == 119 * 201 + 1  # the stop


def test_three_weeks_of_recording_are_within_the_limit_of_chunks_and_take_little_memory():
    assert CHUNK_LIMIT * FLUSH_EVERY > 20 * 86_400
    chunks = Chunks()
    for second in range(10_000):
        chunks.add(second, SECOND + second, SECOND + second, eventful=False)
    columns = (chunks.offsets, chunks.starts, chunks.ends, chunks.eventful)
    a_chunk = sum(map(sys.getsizeof, columns)) / len(chunks)
    assert a_chunk * CHUNK_LIMIT < 60e6  # bytes, twice where a summary is compared with what is in the file


def test_a_recording_of_too_many_chunks_is_refused_in_a_sentence(tmp_path, monkeypatch):
    path = record(tmp_path / "a.mcap", two_runs())
    with path.open("rb") as stream:
        found = len(list(Scan(stream)))
    monkeypatch.setattr("recordings.summary.CHUNK_LIMIT", found)
    assert verify(path).complete
    monkeypatch.setattr("recordings.summary.CHUNK_LIMIT", found - 1)
    assert refused(path, tmp_path) == [f"{path}: it has unexpectedly many chunks."] * 4


def test_texts_of_untrusted_files_are_printable_everywhere(tmp_path):
    evil = "\x1b]0;owned\x07[red]\u202e../../etc/passwd\n"
    forger = Forger(tmp_path / "x.mcap", {"format": "1", "sin": evil})
    forger.writer.add_metadata("pendu.recording", {evil: evil})
    data = json.loads(encode_event(start()))
    forger.event(json.dumps(data | {"scene": evil, "watch": evil}).encode())
    forger.sample(two_runs()[1].value)
    with Recording.open(forger.done()) as recording:
        (run,) = recording.runs
        texts = [run.scene.name, run.scene.watch, *recording.metadata, *recording.metadata.values()]
    assert len(texts) == 4
    assert all(text.isprintable() for text in texts)


@pytest.mark.parametrize("check", [False, True])
def test_a_file_without_message_indexes_plays(tmp_path, check):
    forger = Forger(tmp_path / "x.mcap", index_types=IndexType.ALL & ~IndexType.MESSAGE)
    forger.event(start())
    forger.writer.flush()
    forger.sample(two_runs()[1].value)
    with Recording.open(forger.done(), check) as recording:
        assert recording.complete
        assert [run.number for run in recording.runs] == [1]


def test_a_false_summary_is_found_by_a_check_and_does_not_mislead_the_player(tmp_path):
    path = record(tmp_path / "x.mcap", two_runs())
    data = path.read_bytes()
    footer = data[-37:-8]
    begin = struct.unpack_from("<Q", footer, 9)[0]
    summary = bytearray(data[begin:-37])
    at = 0
    while summary[at] != 8:  # the first chunk's index
        at += 9 + struct.unpack_from("<Q", summary, at + 1)[0]
    second = at + 9 + struct.unpack_from("<Q", summary, at + 1)[0]
    summary[at + 9 + 16 : at + 9 + 24], summary[second + 9 + 16 : second + 9 + 24] = (
        summary[second + 9 + 16 : second + 9 + 24],
        summary[at + 9 + 16 : at + 9 + 24],
    )  # exchange where the first two chunks are
    body = bytes(summary) + footer[:-4]
    path.write_bytes(data[:begin] + body + struct.pack("<I", zlib.crc32(body)) + data[-8:])
    with Recording.open(path) as recording:
        assert recording.damaged
        assert [run.number for run in recording.runs] == [2]  # the other's start is not where the summary says
    with Recording.open(path, check=True) as recording:
        assert recording.damaged
        assert recording.reason == "its summary contradicts what is in it"
    assert not verify(path).identical


@given(st.binary(max_size=400))
def test_any_bytes_raise_only_our_error(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("any")
    path = folder / "x.mcap"
    path.write_bytes(framing.MAGIC + data)
    for attempt in (lambda path: Recording.open(path).close(), verify, lambda path: recover(path, folder / "out.mcap")):
        with pytest.raises(RecordingError):
            attempt(path)


@given(
    opcode=st.sampled_from([1, 3, 4, 7, 12, 15]),
    content=st.binary(max_size=60),
    cut=st.integers(0, 20),
)
def test_any_record_raises_only_our_error(tmp_path_factory, opcode, content, cut):
    folder = tmp_path_factory.mktemp("any")
    path = record(folder / "x.mcap", two_runs()[:4])
    whole = path.read_bytes()
    forged = struct.pack("<BQ", opcode, len(content)) + content
    path.write_bytes((whole[:45] + forged + whole[45:])[: len(whole) - cut])
    for attempt in (
        lambda path: Recording.open(path).close(),
        verify,
        lambda path: recover(path, folder / "out.mcap", overwrite=True),
    ):
        with suppress(RecordingError):
            attempt(path)


@pytest.mark.parametrize("name", FILES)
def test_a_hostile_file_is_quick_and_small(tmp_path, name):
    """A part of what tests/bench/hostile.py has; this thread's processor time, because others may use the machine."""
    path = tmp_path / "hostile.mcap"
    FILES[name](path, 0.002)  # a chunk that repeats more would be refused at sight

    def last_run():
        with Recording.open(path, check=True) as recording:
            return recording.runs[-1]

    def compare_with_itself():
        with Recording.open(path) as one, Recording.open(path) as other:
            compare(one, other)

    attempts = (
        last_run,
        compare_with_itself,
        lambda: verify(path, max_steps=1000),
        lambda: recover(path, tmp_path / "out" / "saved.mcap"),
    )
    for attempt in attempts:
        began = time.thread_time()
        tracemalloc.start()
        with suppress(RecordingError):
            attempt()
        assert time.thread_time() - began < 10  # s; a hang takes minutes, and the bench has the limits
        assert tracemalloc.get_traced_memory()[1] < 50e6
        tracemalloc.stop()
