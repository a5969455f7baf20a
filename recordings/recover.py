"""Recover: write what is intact of a damaged or unfinished recording as a whole one, and count what was lost.

Chunks are kept or dropped as they are; no number is repaired, guessed or changed.
"""

import struct
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode

from engine.run.lockstep import Sample
from recordings.contents import layout_of
from recordings.errors import DiskError, RecordingError, named, printable, writing
from recordings.events import Event
from recordings.fields import without_extremes
from recordings.format import CLOCK_OFFSET, FORMAT_VERSION, encode_readings
from recordings.framing import Message
from recordings.library import PART, alone_with, free_path, open_file, part_of
from recordings.recorder import Recorder
from recordings.scan import Gap, Intact, Scan, ShowProgress
from recordings.verify import Rerun


@dataclass(frozen=True, slots=True)
class Recovery:
    """The result of a recovery.  What a cut-off end held is counted only as far as the file shows it."""

    file: Path
    out: Path
    damaged: bool  # more was wrong than that it was not finished
    reason: str | None  # what was wrong, a clause; None if nothing was
    samples_kept: int
    samples_lost: int
    chunks_lost: int
    seconds_lost: float  # of the recording clock
    runs_lost: int  # whose start was lost, and with it the means to replay them
    runs_broken: tuple[int, ...]  # that lost a change of h: they play, but do not verify


@dataclass(frozen=True, slots=True)
class Rescue:
    """The result of a rescue of a recording that a killed lab left unfinished."""

    saved: Path | None  # the recording made of it; None if nothing could be saved
    kept: Path | None  # where the leftover is now; None if all of it is in `saved`, or it was empty
    recovery: Recovery | None
    reason: str | None  # why nothing could be saved, a sentence


def rescue(leftover: Path, progress: ShowProgress | None = None) -> Rescue:
    """Make a recording of a leftover.

    The leftover is removed once all of it is in the recording, or if it was empty; otherwise it is renamed, so
    that it is not found again.  Raises OSError if the disk fails.
    """
    with alone_with(leftover):
        if leftover.stat().st_size == 0:
            leftover.unlink()
            return Rescue(None, None, None, f"{printable(str(leftover))}: the file is empty.")
        name = leftover.with_name(leftover.name.removesuffix(PART))
        try:
            recovery = recover(leftover, free_path(name), progress)
        except RecordingError as error:
            return Rescue(None, _put_aside(leftover, ".unreadable"), None, str(error))
        if recovery.damaged:
            return Rescue(recovery.out, _put_aside(leftover, ".damaged"), recovery, None)
        leftover.unlink()
        saved = recovery.out if name.exists() else recovery.out.rename(name)
        return Rescue(saved, None, recovery, None)


def _put_aside(path: Path, suffix: str) -> Path:
    return path.rename(free_path(path.with_name(path.name + suffix)))


def recover(path: Path, out: Path, progress: ShowProgress | None = None, overwrite: bool = False) -> Recovery:
    """Write what is intact of `path` to `out`, which appears only when it is whole.

    Raises RecordingError if nothing can be saved, DiskError if `out` cannot be written.
    """
    if out.exists() and path.exists() and out.samefile(path):
        raise DiskError("is the recording to recover; choose another name", out)
    if not (part_of(out).exists() and path.exists() and part_of(out).samefile(path)):
        return _recover(path, out, progress, overwrite)
    if out.exists() and not overwrite:
        raise DiskError("a file of this name exists already; choose another name", out)
    recovery = _recover(path, free_path(out), progress)  # the .part of `out` is the file that is read
    with writing(out):
        return replace(recovery, out=recovery.out.replace(out))


def _recover(path: Path, out: Path, progress: ShowProgress | None, overwrite: bool = False) -> Recovery:
    with named(path), open_file(path) as stream:
        scan = Scan(stream, progress)
        salvage = _Salvage(scan, out, overwrite)
        try:
            for piece in scan:
                if isinstance(piece, Gap):
                    salvage.pass_over(piece, stream)
                else:
                    salvage.keep(piece)
            if salvage.kept == 0:
                raise scan.nothing("saved")
            return salvage.finished(path)
        except BaseException:
            salvage.give_up()
            raise


class _Salvage:
    """The copy, as far as it has come."""

    def __init__(self, scan: Scan, out: Path, overwrite: bool) -> None:
        self._scan, self._out, self._overwrite = scan, out, overwrite
        self._recorder: Recorder | None = None
        self._publish_time = 0
        self._rerun: Rerun | None = None  # of the run being kept, without methods: it only knows the time of a step
        self._broken = False  # something was lost since the last sample kept
        self._next_sequence = 0
        self._clock = self._end = 0.0  # s; of the last sample kept, and of the last thing known of
        self.kept = self._lost = self._chunks_lost = 0
        self._seconds_lost = 0.0
        self._runs_lost: set[int] = set()
        self._runs_broken: set[int] = set()

    def pass_over(self, gap: Gap, stream: BinaryIO) -> None:
        """Note what the header of a lost chunk still shows."""
        self._broken = True
        stream.seek(gap.offset)
        header = stream.read(25)  # opcode, length, start, end
        if header[:1] == bytes([Opcode.CHUNK]):
            self._chunks_lost += 1
            if len(header) == 25:
                start, end = ((time - CLOCK_OFFSET) / 1e9 for time in struct.unpack("<QQ", header[9:]))
                if 0 <= start - self._clock < 1 and 0 <= end - start < 1:
                    self._end = end

    def keep(self, piece: Intact) -> None:
        """Copy what a chunk holds of runs whose start is known."""
        layout = piece.layout
        if self._recorder is None:
            facts = self._scan.metadata | layout.functions | {"format": str(FORMAT_VERSION), "recovered": "yes"}
            self._recorder = Recorder(self._out, lambda: self._publish_time, self._overwrite, facts)
        for parts, (clock, value) in self._scan.entries(piece):
            self._publish_time = parts[0].publish_time
            if isinstance(value, Event) and value.kind == "start":
                if self._rerun is not None and value.run <= self._rerun.run:
                    raise RecordingError("its runs are not in order")
                assert value.scene is not None
                self._rerun = Rerun(value._replace(scene=replace(value.scene, cast=())))
            if self._rerun is None or value.run != self._rerun.run:
                self._runs_lost.add(value.run)
                self._broken = True
            elif isinstance(value, Event):
                self._rerun.follow(value)
                self._recorder.event(value, clock)
            else:
                (computed,) = self._rerun.reach(value.step)
                if computed.t != value.t:
                    self._runs_broken.add(value.run)
                self._recorder.sample(value, clock, self._encoded(value, clock, parts))
                self.kept += 1
                self._clock = clock
            self._end = max(self._end, clock)

    def _encoded(self, sample: Sample, clock: float, parts: list[Message]) -> list[bytes]:
        """The messages of a sample, which after a gap knows no extremes.  Count what the gap has cost."""
        sequence, encoded = parts[0].sequence, [part.data for part in parts]
        missing = max(0, sequence - self._next_sequence)
        if self._broken or missing:
            self._lost += missing
            self._seconds_lost += clock - self._clock
            encoded = encode_readings(without_extremes(sample))
        self._broken, self._next_sequence = False, sequence + 1
        return encoded

    def finished(self, path: Path) -> Recovery:
        assert self._recorder is not None
        self._recorder.close()
        summary = self._scan.summary
        if summary and summary.statistics:  # which counts all that was there
            seal, layout = self._scan.seal, layout_of(summary.channels.values())
            there = layout.samples(summary.statistics.channel_message_counts)
            self._lost = max(self._lost, (seal.samples if seal and seal.end else there) - self.kept)
            self._chunks_lost = len(summary.chunks) - len(self._scan.chunks)
            self._end = (summary.statistics.message_end_time - CLOCK_OFFSET) / 1e9
        return Recovery(
            file=path,
            out=self._out,
            damaged=self._scan.damaged or self._scan.sealed is False,
            reason=self._scan.reason,
            samples_kept=self.kept,
            samples_lost=self._lost,
            chunks_lost=self._chunks_lost,
            seconds_lost=self._seconds_lost + (self._end - self._clock if self._broken else 0.0),
            runs_lost=len(self._runs_lost),
            runs_broken=tuple(sorted(self._runs_broken)),
        )

    def give_up(self) -> None:
        if self._recorder is not None:
            self._recorder.abandon()
            self._recorder.part.unlink(missing_ok=True)
