"""LiveRecorder: records the lab, and goes on in a new file when the disk fails."""

import time
from contextlib import suppress
from pathlib import Path

from engine.run.lockstep import Sample
from recordings.errors import DiskError, NameTakenError, writing
from recordings.events import Event
from recordings.library import free_path
from recordings.recorder import Recorder, WallClock

RETRY_EVERY = 5.0  # s of the recording clock


class LiveRecorder:
    """A recorder that survives a failing disk.

    Opening the first file may raise DiskError; nothing after that does.  With `or_next`, a name
    that is taken becomes the next free one.  `failed` is a sentence on why nothing is being
    recorded now, or None. Every file begins with the start of its run, its changes of h and what
    was noticed of it, so each replays and verifies by itself.
    """

    def __init__(self, path: Path, wall: WallClock = time.time_ns, or_next: bool = False) -> None:
        self.failed: str | None = None
        self.files: list[Path] = []  # that hold something and are no longer written to
        self._closed = False
        self._path = path
        self._wall = wall
        self._run: list[Event] = []  # of the run: its start, its changes of h and what was noticed
        self._zero = 0.0  # s of the lab's clock, where the file begins
        self._failed_at = 0.0  # s of the lab's clock
        self._recorder = self._opened() if or_next else Recorder(path, wall)

    @property
    def path(self) -> Path:
        """The file that is being written, or was last."""
        return self._recorder.path

    @property
    def bytes(self) -> int:
        return self._recorder.bytes

    @property
    def seconds(self) -> float:
        return self._recorder.seconds

    def event(self, event: Event, clock: float) -> None:
        if event.kind == "start":
            self._run = []
        self._write(event, clock)
        if event.kind in ("start", "set_h", "noticed"):
            self._run.append(event)

    def sample(self, sample: Sample, clock: float) -> None:
        self._write(sample, clock)

    def close(self) -> None:
        """Finish the file; `failed` is set if that was impossible."""
        self._closed = True
        if self.failed is None:
            try:
                with suppress(NameTakenError):  # it has another name then
                    self._recorder.close()
                self._keep(self._recorder.path)
            except DiskError as error:
                self._fail(error, self._failed_at)

    def _write(self, value: Sample | Event, clock: float) -> None:
        if self._closed or (self.failed and clock < self._failed_at + RETRY_EVERY):
            return
        try:
            if self.failed:
                self._reopen(clock)
            if isinstance(value, Event):
                self._recorder.event(value, clock - self._zero)
            else:
                self._recorder.sample(value, clock - self._zero)
        except DiskError as error:
            self._fail(error, clock)

    def _fail(self, error: DiskError, clock: float) -> None:
        self.failed = str(error)
        self._failed_at = clock
        self._recorder.abandon()
        self._keep(self._recorder.part)

    def _keep(self, path: Path) -> None:
        if path.exists() and path not in self.files:
            self.files.append(path)

    def _opened(self) -> Recorder:
        while True:
            with suppress(NameTakenError):  # since it was found to be free
                return Recorder(free_path(self._path), self._wall)

    def _reopen(self, clock: float) -> None:
        with writing(self._path):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._recorder = self._opened()
        self._zero = clock
        for event in self._run:
            self._recorder.event(event, 0.0)
        self.failed = None
