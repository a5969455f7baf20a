"""Damage recordings at random, and check what every reader makes of them."""

import csv
import os
import random
from collections import Counter
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from pendu_tui.recordings.events import Event
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.format import without_extremes
from pendu_tui.recordings.reader import read_contents
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from pendu_tui.tui.playback.replay import Replay
from tests.recordings.examples import record, samples_of, tiny, two_runs
from tests.tui.command_line import pendu


class Damaged:
    """Damaged copies of a recording, compared with the original."""

    def __init__(self, whole: Path, folder: Path, cut: int = 0) -> None:
        """Take the original without its last `cut` bytes, as if its lab had been killed."""
        data = whole.read_bytes()
        self.data = data[: len(data) - cut]
        self.path = folder / "damaged.mcap"
        self.out = folder / "out.mcap"
        self.path.write_bytes(self.data)
        with Recording.open(self.path) as recording:
            self.entries = list(recording.entries())
            self.samples = [value for _, value in samples_of(recording)]
            self.runs = [run.scene for run in recording.runs]
        self.chunks = self._offsets()

    def _offsets(self) -> list[int]:
        """Return where intact chunks begin."""
        with self.path.open("rb") as stream:
            return [place.offset for place in read_contents(stream, check=True).places]

    def cut(self, length: int) -> None:
        """Check that a file of this length reads as far as it goes."""
        self.path.write_bytes(self.data[:length])
        with suppress(RecordingError):
            result = verify(self.path)
            assert (result.complete, result.identical) == (False, True)
        with suppress(RecordingError), Recording.open(self.path) as recording:
            entries = list(recording.entries())
            assert entries == self.entries[: len(entries)]

    def flip(self, chance: random.Random) -> None:
        """Change a bit of the file."""
        data = bytearray(self.data)
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        self.path.write_bytes(data)

    def is_harmless(self) -> bool:
        """Return whether all that is read is what was recorded."""
        with suppress(RecordingError), Recording.open(self.path) as recording:
            scenes = [run.scene for run in recording.runs]
            return list(recording.entries()) == self.entries and scenes == self.runs
        return False

    def is_noticed_by_verify(self) -> bool:
        result = verify(self.path)
        assert result.identical or result.reason
        return not result.complete or not result.identical

    def is_noticed_by_show(self) -> bool:
        with Recording.open(self.path, check=True) as recording:
            return bool(recording.reason)

    def is_noticed_by_export(self) -> bool:
        """Check every number that is written, too."""
        answer = pendu("export", self.path)
        numbers = {
            (sample.step, reading.theta, reading.energy_error)
            for sample in self.samples
            for reading in sample.readings
        }
        for row in csv.DictReader(answer.out.splitlines()):
            exported = int(row["step"]), float(row["theta_rad"]), float(row["energy_error"])
            assert exported in numbers
        return bool(answer.err)

    def is_noticed_by_replay(self) -> bool:
        """Check every sample that is shown, too."""
        with Recording.open(self.path) as recording:
            if recording.at(0.0) is None:
                return True
            replay = Replay(recording, clock=lambda: 0.0)
            for tenth in range(11):
                replay.seek(recording.length * tenth / 10)
                assert replay.sample in self.samples
            return bool(recording.reason)

    def hole(self, chance: random.Random) -> int:
        """Overwrite up to 5000 bytes, check that intact chunks are read, and count lost ones."""
        begin = chance.randrange(len(self.data))
        end = begin + chance.randrange(1, 5_000)
        noise = chance.randbytes(min(end, len(self.data)) - begin)
        self.path.write_bytes(self.data[:begin] + noise + self.data[end:])
        ends = [*self.chunks[1:], len(self.data)]
        intact = {a for a, b in zip(self.chunks, ends, strict=True) if b <= begin or a >= end}
        read = self._offsets()
        assert intact <= set(read)
        self._check_recovered()
        return len(self.chunks) - len(read)

    def _check_recovered(self) -> None:
        """Check that recover saves only what was recorded."""
        try:
            recover(self.path, self.out, overwrite=True)
        except RecordingError:
            return
        with Recording.open(self.out, check=True) as recording:
            assert recording.complete
            for clock, value in recording.entries():
                if isinstance(value, Event):
                    assert (clock, value) in self.entries or value.kind == "stop"
                else:
                    assert value in self.samples or value in map(without_extremes, self.samples)


READERS = {
    "verify": Damaged.is_noticed_by_verify,
    "show": Damaged.is_noticed_by_show,
    "export": Damaged.is_noticed_by_export,
    "replay": Damaged.is_noticed_by_replay,
}


def campaign(cuts: int = 1, flips: int = 100, others: int = 30, holes: int = 30) -> dict[str, int]:
    """Cut recordings at every `cuts`-th byte, flip bits and punch holes; return the counts.

    `flips` of the bits are flipped for verify, `others` for each other reader.
    """
    done = Counter(unnoticed=0)
    chance = random.Random(1)
    with TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        folder = Path(name)
        small = tiny(folder / "tiny.mcap")
        large = record(folder / "two.mcap", two_runs())
        for file in (small, large):
            damaged = Damaged(file, folder)
            for length in range(chance.randrange(cuts), len(damaged.data), cuts):
                damaged.cut(length)
                done["cuts"] += 1
        whole = Damaged(large, folder)
        cut = Damaged(large, folder, cut=1_500)
        for reader, is_noticed in READERS.items():
            for number in range(flips if reader == "verify" else others):
                damaged = cut if number % 2 else whole
                damaged.flip(chance)
                noticed = True
                with suppress(RecordingError):
                    noticed = is_noticed(damaged)
                harmless = damaged.is_harmless()
                done["flips"] += 1
                done["harmless"] += harmless
                done["unnoticed"] += not (noticed or harmless)
        for _ in range(holes):
            done["chunks_lost"] += whole.hole(chance)
            done["holes"] += 1
    return dict(done)
