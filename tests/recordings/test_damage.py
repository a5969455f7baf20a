"""A recording cut or changed anywhere: nothing altered passes, nothing intact is lost."""

import os
import random
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from engine.run.lockstep import Sample
from recordings.errors import RecordingError
from recordings.events import Event
from recordings.fields import without_extremes
from recordings.recording import Recording
from recordings.recover import recover
from recordings.scan import Scan
from recordings.verify import verify
from tests.recordings.examples import record, tiny, two_runs

STRIDE = 12  # bytes, in four parts: every third byte, so at least one of each number in a record
PARTS = range(0, STRIDE, 3)


@pytest.fixture(autouse=True)
def no_fsync(monkeypatch):
    """What is written in a sweep need not outlive a power cut."""
    monkeypatch.setattr(os, "fsync", lambda _: None)


class Damaged:
    """A damaged copy of a recording, and what is known of the original."""

    def __init__(self, whole, tmp_path):
        self.data = whole.read_bytes()
        with Recording.open(whole) as recording:
            self.entries = list(recording.entries())
        with whole.open("rb") as stream:
            self.chunks = [piece.offset for piece in Scan(stream)]
        self.path, self.out = tmp_path / "damaged.mcap", tmp_path / "out.mcap"
        self.recovered = set()

    def write(self, data):
        self.path.write_bytes(data)

    def check_verify_and_info(self):
        """Nothing that was altered or lost passes, and every refusal is a sentence.  Returns the verification."""
        try:
            with Recording.open(self.path, check=True) as recording:
                assert not recording.complete
                assert recording.reason
                assert all(entry in self.entries for entry in recording.entries())
            verification = verify(self.path)
        except RecordingError as error:
            sentence = str(error)
        else:
            assert not verification.complete
            assert verification.reason
            return verification
        assert sentence.startswith(str(self.path))
        assert sentence.isprintable()
        return None

    def has(self, entry):
        """Whether the original has it, extremes aside.  A stop is added where the last one is lost."""
        clock, value = entry
        if isinstance(value, Event):
            return entry in self.entries or value.kind == "stop"
        samples = (was for time, was in self.entries if time == clock and isinstance(was, Sample))
        return any(value in (was, without_extremes(was)) for was in samples)

    def check_recover(self):
        """What is saved is what was there, and verifies.  Returns the recovery."""
        recovery = None
        with suppress(RecordingError):
            recovery = recover(self.path, self.out, overwrite=True)
            if (saved := self.out.read_bytes()) not in self.recovered:  # most damages have the same few outcomes
                self.recovered.add(saved)
                with Recording.open(self.out, check=True) as recording:
                    assert recording.complete
                    assert all(self.has(entry) for entry in recording.entries())
                verification = verify(self.out)
                assert verification.complete
                assert verification.identical or recovery.runs_broken
        return recovery


@pytest.fixture
def damaged():
    memory = "/dev/shm" if Path("/dev/shm").is_dir() else None  # tens of thousands of files need no disk
    with TemporaryDirectory(dir=memory) as folder:
        yield Damaged(tiny(Path(folder) / "whole.mcap"), Path(folder))


@pytest.mark.parametrize("part", PARTS)
def test_a_recording_cut_anywhere_verifies_but_is_never_called_complete(damaged, part):
    for length in range(part, len(damaged.data), STRIDE):
        damaged.write(damaged.data[:length])
        verification = damaged.check_verify_and_info()
        assert verification is None or verification.identical


@pytest.mark.parametrize("part", PARTS)
def test_no_recording_with_a_changed_byte_is_called_complete(damaged, part):
    chance = random.Random(part)
    for at in range(part, len(damaged.data), STRIDE):
        damaged.write(changed(damaged.data, at, chance))
        damaged.check_verify_and_info()


@pytest.mark.parametrize("part", PARTS)
def test_recover_saves_every_whole_chunk_before_any_cut(damaged, part):
    ends = [*damaged.chunks[1:], len(damaged.data)]
    for length in range(part, len(damaged.data), STRIDE):
        damaged.write(damaged.data[:length])
        recovery = damaged.check_recover()
        samples = (0, 1, 3, 3)[sum(end <= length for end in ends)]
        assert (recovery.samples_kept if recovery else 0) >= samples


@pytest.mark.parametrize("part", PARTS)
def test_recover_saves_every_chunk_but_the_changed_one(damaged, part):
    chance = random.Random(part)
    first, second, last = damaged.chunks
    for at in range(part, len(damaged.data), STRIDE):
        damaged.write(changed(damaged.data, at, chance))
        recovery = damaged.check_recover()
        if at < first or at >= last:
            assert recovery.samples_kept == 3
        elif at >= second:
            assert recovery.samples_kept in (1, 3)  # 3: it was in the index behind the chunk
            assert recovery.samples_kept + recovery.samples_lost == 3
            assert recovery.seconds_lost == (1.0 if recovery.samples_lost else 0.0)
        elif recovery is not None:  # the first chunk holds the start, without which nothing can be replayed
            assert recovery.samples_kept == 3


def test_damage_in_many_places_never_yields_a_number_that_was_not_recorded(tmp_path):
    damaged = Damaged(record(tmp_path / "whole.mcap", two_runs()), tmp_path)
    chance = random.Random(1)
    lost = 0
    for _ in range(150):
        data = damaged.data
        for _ in range(chance.randrange(1, 4)):
            at = chance.randrange(len(data))
            if chance.random() < 0.3:
                data = data[:at] + data[at + chance.randrange(1, 300) :]
            else:
                data = changed(data, at, chance)
        damaged.write(data)
        damaged.check_verify_and_info()
        recovery = damaged.check_recover()
        lost += recovery.samples_lost if recovery else 0
    assert lost > 0  # or nothing was tested


def changed(data, at, chance):
    """`data` with the byte there changed."""
    return data[:at] + bytes([data[at] ^ chance.randrange(1, 256)]) + data[at + 1 :]
