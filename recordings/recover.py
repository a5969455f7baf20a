"""Recover: what is intact of a damaged or unfinished recording, as a whole one, and what was lost.

Chunks are kept or dropped as they are; no number is repaired, guessed or changed.
"""

import struct
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode

from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from engine.scenes import SceneError
from recordings.errors import DiskError, RecordingError, named
from recordings.events import Event
from recordings.format import CLOCK_OFFSET, encode_readings, without_extremes
from recordings.framing import Message
from recordings.layout import Layout, layout_of
from recordings.lock import open_file
from recordings.names import free_path, part_of
from recordings.recorder import Recorder, trouble
from recordings.scan import Gap, Progress, Walk


@dataclass(frozen=True, slots=True)
class Recovery:
    """What came of it.  What a cut-off end held is counted only as far as the file tells."""

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


def recover(path: Path, out: Path, progress: Progress | None = None, overwrite: bool = False) -> Recovery:
    """Write what is intact of `path` to `out`, which appears only when it is whole.

    Raises RecordingError if nothing can be saved, DiskError if `out` cannot be written.
    """
    if out.exists() and path.exists() and out.samefile(path):
        raise DiskError("is the recording that is to be recovered; choose another name", out)
    if not (part_of(out).exists() and path.exists() and part_of(out).samefile(path)):
        return _recover(path, out, progress, overwrite)
    if out.exists() and not overwrite:
        raise DiskError("a file of this name exists already; choose another name", out)
    recovery = _recover(path, free_path(out), progress)  # what is left has the name under which `out` would be made
    try:
        return replace(recovery, out=recovery.out.replace(out))
    except OSError as error:
        raise trouble(error, out) from error


def _recover(path: Path, out: Path, progress: Progress | None, overwrite: bool = False) -> Recovery:
    with named(path), open_file(path) as stream:
        walk = Walk(stream, progress)
        salvage = _Salvage(walk, out, overwrite)
        try:
            for piece in walk:
                if isinstance(piece, Gap):
                    salvage.pass_over(piece, stream)
                else:
                    salvage.keep(piece.layout, piece.chunk.messages)
            if salvage.kept == 0:
                raise walk.nothing("saved")
        except BaseException:
            salvage.give_up()
            raise
        return salvage.finished(path)


class _Salvage:
    """The copy, as far as it has come."""

    def __init__(self, walk: Walk, out: Path, overwrite: bool) -> None:
        self._walk, self._out, self._overwrite = walk, out, overwrite
        self._recorder: Recorder | None = None
        self._publish_time = 0
        self._timekeeper: Lockstep | None = None  # of the run being kept; without methods, it only tells the time
        self._step = -1  # of the last sample kept in this run
        self._broken = False  # something was lost since the last sample kept
        self._next_sequence = 0
        self._clock = self._end = 0.0  # s; of the last sample kept, and of the last thing known of
        self.kept = self._lost = self._chunks_lost = 0
        self._seconds_lost = 0.0
        self._runs_lost: set[int] = set()
        self._runs_broken: set[int] = set()

    def pass_over(self, gap: Gap, stream: BinaryIO) -> None:
        """Note what the header of a lost chunk still tells."""
        self._broken = True
        stream.seek(gap.offset)
        header = stream.read(25)  # opcode, length, start, end
        if header[:1] == bytes([Opcode.CHUNK]):
            self._chunks_lost += 1
            if len(header) == 25:
                start, end = ((time - CLOCK_OFFSET) / 1e9 for time in struct.unpack("<QQ", header[9:]))
                if 0 <= start - self._clock < 1 and 0 <= end - start < 1:
                    self._end = end

    def keep(self, layout: Layout, messages: list[Message]) -> None:
        """Copy what a chunk holds of runs whose start is known."""
        if self._recorder is None:
            facts = self._walk.metadata | {"format": str(layout.version), "sin": layout.sin, "recovered": "yes"}
            self._recorder = Recorder(self._out, lambda: self._publish_time, self._overwrite, facts)
        for parts, (clock, value) in layout.entries(messages):
            self._publish_time = parts[0].publish_time
            if isinstance(value, Event) and value.kind == "start":
                self._begin(value)
            if self._timekeeper is None or value.run != self._timekeeper.run:
                self._runs_lost.add(value.run)
                self._broken = True
            elif isinstance(value, Event):
                self._keep_event(value, clock)
            else:
                self._keep_sample(value, clock, parts)
            self._end = max(self._end, clock)

    def _begin(self, start: Event) -> None:
        if self._timekeeper is not None and start.run <= self._timekeeper.run:
            raise RecordingError("its runs are not in order")
        assert start.scene is not None
        self._timekeeper, self._step = Lockstep(start.scene, start.run, ()), -1

    def _keep_event(self, event: Event, clock: float) -> None:
        assert self._recorder is not None
        assert self._timekeeper is not None
        if event.kind == "set_h" and event.h is not None:
            self._timekeeper.advance(event.step - self._timekeeper.step)
            try:
                self._timekeeper.set_stepping(Stepping(event.h))
            except SceneError as error:
                raise RecordingError(f"run {event.run} cannot have been recorded: {error}") from error
        self._recorder.event(event, clock)

    def _keep_sample(self, sample: Sample, clock: float, parts: list[Message]) -> None:
        assert self._recorder is not None
        assert self._timekeeper is not None
        if sample.step <= self._step:
            raise RecordingError(f"the steps of run {sample.run} are not in order")
        sequence, encoded = parts[0].sequence, [part.data for part in parts]
        missing = max(0, sequence - self._next_sequence)
        if self._broken or missing:
            self._lost += missing
            self._seconds_lost += clock - self._clock
            encoded = encode_readings(without_extremes(sample))
        self._timekeeper.advance(sample.step - self._timekeeper.step)
        if self._timekeeper.t != sample.t:
            self._runs_broken.add(sample.run)
        self._recorder.sample(sample, clock, encoded)
        self.kept += 1
        self._broken, self._step, self._clock, self._next_sequence = False, sample.step, clock, sequence + 1

    def finished(self, path: Path) -> Recovery:
        """Finish the copy."""
        assert self._recorder is not None
        self._recorder.close()
        summary = self._walk.summary
        if summary and summary.statistics:  # which tells of all that was there
            layout = layout_of(summary.channels.values())
            self._lost = layout.samples(summary.statistics.channel_message_counts) - self.kept
            self._chunks_lost = len(summary.chunks) - len(self._walk.chunks)
            self._end = (summary.statistics.message_end_time - CLOCK_OFFSET) / 1e9
        return Recovery(
            file=path,
            out=self._out,
            damaged=self._walk.damaged,
            reason=self._walk.reason,
            samples_kept=self.kept,
            samples_lost=self._lost,
            chunks_lost=self._chunks_lost,
            seconds_lost=self._seconds_lost + (self._end - self._clock if self._broken else 0.0),
            runs_lost=len(self._runs_lost),
            runs_broken=tuple(sorted(self._runs_broken)),
        )

    def give_up(self) -> None:
        """Leave nothing behind."""
        if self._recorder is not None:
            self._recorder.abandon()
            self._recorder.part.unlink(missing_ok=True)
