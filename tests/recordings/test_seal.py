"""Seals: a recording vouches for all of itself, numbers or not."""

import hashlib
import json
from dataclasses import replace

import pytest
import zstandard
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import Writer

from engine.run.lockstep import Lockstep
from recordings.events import Event
from recordings.format import EVENTS, SEALS, decode_seal, encode_event
from recordings.framing import RECORD
from recordings.library import GOLDEN
from recordings.recorder import Recorder
from recordings.recording import Recording
from recordings.recover import recover
from recordings.verify import verify
from tests.recordings.examples import SCENE, record, start, tiny, two_runs
from tests.tui.command_line import pendu


@pytest.fixture
def path(tmp_path):
    return record(tmp_path / "whole.mcap", two_runs())


def kept(topic, fields, message):
    """No change."""
    return [message]


def rewritten(path, change=kept, metadata=dict):
    """The recording with some messages changed, left out or doubled, by somebody who makes every checksum right."""
    out = path.with_name("rewritten.mcap")
    with path.open("rb") as stream, out.open("wb") as file:
        writer, topics = Writer(file, chunk_size=1 << 62, enable_data_crcs=True), {}
        writer.start("pendu", "forger")
        for item in StreamReader(stream, emit_chunks=True).records:
            if isinstance(item, Metadata):
                writer.add_metadata(item.name, metadata(item.metadata))
            if not isinstance(item, Chunk):
                continue
            for each in breakup_chunk(item):
                if isinstance(each, Schema):
                    writer.register_schema(each.name, each.encoding, each.data)
                elif isinstance(each, Channel) and each.id in topics:
                    writer._Writer__chunk_builder.add_channel(each)  # declared again
                elif isinstance(each, Channel):
                    writer.register_channel(each.topic, each.message_encoding, each.schema_id, each.metadata)
                    topics[each.id] = each.topic
                elif isinstance(each, Message):
                    for new in change(topics[each.channel_id], json.loads(each.data), each):
                        writer.add_message(
                            new.channel_id, new.log_time, new.data, publish_time=new.publish_time, sequence=new.sequence
                        )
            writer.flush()
        writer.finish()
    return out


def without_a_sample(topic, fields, message):
    return [] if topic != EVENTS and (fields.get("run"), fields.get("step")) == (1, 16) else [message]


def cut_after_the_first_sample(topic, fields, message):
    return [message] if topic in (EVENTS, SEALS) or (fields["run"], fields["step"]) == (1, 0) else []


def without(kind):
    return lambda topic, fields, message: [] if fields.get("kind") == kind else [message]


def with_another(event):
    def change(topic, fields, message):
        invented = replace(message, data=encode_event(event))
        return [message, invented] if fields.get("kind") == "set_h" and fields["run"] == 1 else [message]

    return change


def with_slower_clock(topic, fields, message):
    return [replace(message, log_time=10**9 + 2 * (message.log_time - 10**9))]


def with_another_wall_clock(topic, fields, message):
    return [replace(message, publish_time=message.publish_time + 1)]


def without_extremes(topic, fields, message):
    left = {name: value for name, value in fields.items() if name not in ("energy_error_low", "energy_error_high")}
    return [replace(message, data=json.dumps(left).encode())] if left != fields else [message]


def twice(topic, fields, message):
    return [message, replace(message, channel_id=message.channel_id)] if fields.get("kind") == "pause" else [message]


CHANGES = {
    "a sample left out": without_a_sample,
    "all after the first sample left out": cut_after_the_first_sample,
    "no speed": without("speed"),
    "no mark": without("mark"),
    "no pause": without("pause"),
    "no stop": without("stop"),
    "an invented pause": with_another(Event("pause", 1, 9, 0.9)),
    "an invented mark": with_another(Event("mark", 1, 9, 0.9, text="I was here")),
    "another clock": with_slower_clock,
    "another wall clock": with_another_wall_clock,
    "extremes left out": without_extremes,
    "a message twice": twice,
}


def test_the_digest_does_not_depend_on_the_compression(path):
    verification = verify(rewritten(path))
    assert verification.complete
    assert verification.sealed
    assert verification.sha256 == verify(path).sha256


@pytest.mark.parametrize("what", CHANGES)
def test_a_change_that_alters_no_number_breaks_the_digest(path, what):
    changed = rewritten(path, CHANGES[what])
    verification = verify(changed)
    assert verification.identical
    assert verification.sealed is False
    assert not verification.complete
    assert "its digest does not match" in verification.reason
    with Recording.open(changed, check=True) as recording:
        assert recording.sealed is False
        assert recording.damaged
    outcome = pendu("verify", changed)
    assert outcome.code == 1
    assert "altered" in outcome.out
    assert "its numbers are identical" in outcome.out
    assert pendu("verify", changed, "--json").json["files"][0]["digest_matches"] is False
    assert "does not match" in pendu("info", changed).out


@pytest.mark.parametrize("name", ["theta.hex", "pendu-tui", "sin"])
def test_changed_metadata_are_noticed(path, name):
    verification = verify(rewritten(path, metadata=lambda facts: facts | {name: "0"}))
    assert verification.identical
    assert verification.sealed is False


def test_a_recording_without_its_last_chunks_is_not_complete_however_right_its_checksums(path):
    last = None
    with path.open("rb") as stream:
        for item in StreamReader(stream).records:
            last = item.log_time if isinstance(item, Message) else last
    verification = verify(rewritten(path, lambda topic, fields, message: [message] if message.log_time < last else []))
    assert verification.sealed is False
    assert "its end is not the recorder's" in verification.reason


def test_both_numbers_and_digest_are_named_if_both_are_wrong(path):
    def change(topic, fields, message):
        wrong = fields | {"theta": 1.0} if fields.get("step") == 6 and topic == "/pendu/rk4" else fields
        return [replace(message, data=json.dumps(wrong).encode())] if wrong != fields else [message]

    changed = rewritten(path, change)
    assert verify(changed).sealed is False
    assert verify(changed).first_difference.field == "theta"
    outcome = pendu("verify", changed)
    assert "its numbers are different" in outcome.out
    assert "first in theta" in outcome.out


def test_anybody_can_compute_the_digest_of_a_recording(path):
    digest, seals = hashlib.sha256(), []
    with path.open("rb") as stream:
        for item in StreamReader(stream, emit_chunks=True).records:
            if isinstance(item, Metadata):
                data = path.read_bytes()
                begin = data.index(b"\x0f\x00\x00\x00pendu.recording") - RECORD.size
                opcode, length = RECORD.unpack_from(data, begin)
                assert opcode == Opcode.METADATA
                digest.update(data[begin : begin + RECORD.size + length])
            if isinstance(item, Chunk):
                content = zstandard.decompress(item.data)
                *_, last = (each for each in breakup_chunk(item) if isinstance(each, Message))
                before = len(content) - len(last.data) - RECORD.size - 22
                digest.update(content[:before])
                seals.append(decode_seal(last.data))
                assert seals[-1].sha256 == digest.hexdigest()
                digest.update(content[before:])
    assert [seal.end for seal in seals] == [*[False] * (len(seals) - 1), True]
    assert (seals[-1].samples, seals[-1].events) == (10, 10)
    assert pendu("info", path, "--json").json["sha256"] == seals[-1].sha256 == verify(path).sha256
    assert seals[-1].sha256 in pendu("info", path).out


def test_an_unfinished_recording_is_covered_up_to_its_last_chunk(tmp_path):
    lockstep = Lockstep(SCENE)
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.event(start(), 0.0)
        for step in range(30):
            recorder.sample(lockstep.sample(), step / 10)
            lockstep.advance(1)
        part = tmp_path / "copy.mcap.part"
        part.write_bytes(recorder.part.read_bytes())
    verification = verify(part)
    assert not verification.complete
    assert verification.reason == "the recording was not finished"
    assert verification.sealed
    assert verification.sha256
    assert pendu("verify", part).code == 0
    assert "up to its last intact chunk" in pendu("info", part).out


def test_a_damaged_recording_is_covered_up_to_the_damage(path):
    with path.open("rb") as stream:
        seals = [
            decode_seal(item.data)
            for item in StreamReader(stream).records
            if isinstance(item, Message) and b"sha256" in item.data
        ]
    data = bytearray(path.read_bytes())
    data[data.rindex(b"\x04\x00\x00\x00zstd", 0, len(data) * 3 // 4) + 60] ^= 1
    path.write_bytes(data)
    verification = verify(path)
    assert not verification.identical
    assert verification.sealed
    assert verification.sha256 in [seal.sha256 for seal in seals[:-1]]


def test_format_1_has_no_digest_and_that_is_said():
    verification = verify(GOLDEN / "drift.mcap")
    assert verification.complete
    assert verification.sealed is None
    assert verification.sha256 is None
    outcome = pendu("verify", "drift")
    assert outcome.code == 0
    assert "it has no digest" in outcome.out
    assert "format 1 had none" in pendu("info", "drift").out


@pytest.mark.parametrize("version", [1, 2])
def test_a_recovered_recording_states_a_digest_of_its_own(tmp_path, path, version):
    whole = GOLDEN / "drift.mcap" if version == 1 else path
    recover(whole, tmp_path / "out.mcap")
    verification = verify(tmp_path / "out.mcap")
    assert verification.complete
    assert verification.sealed
    assert verification.sha256 not in (None, verify(whole).sha256)
    with Recording.open(tmp_path / "out.mcap") as recording:
        assert recording.version == 2
        assert recording.samples == verification.samples


def test_a_recording_that_goes_on_after_its_end_is_altered(tmp_path):
    path = tiny(tmp_path / "a.mcap")

    def twice(topic, fields, message):
        again = replace(message, log_time=message.log_time + 1)
        return [message, again] if topic == SEALS and fields["end"] else [message]

    assert verify(rewritten(path, twice)).sealed is False
