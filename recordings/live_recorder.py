"""LiveRecorder: records the lab, which goes on if its disk fails."""

from collections.abc import Callable

from engine.run.lockstep import Sample
from recordings.errors import DiskError, NameTakenError
from recordings.events import Event
from recordings.recorder import Recorder


class LiveRecorder(Recorder):
    """A recorder that raises nothing once it is there, and takes nothing once it is closed.

    `failed` is a sentence on why the recording ended before the lab did, or None.
    """

    failed: str | None = None

    def event(self, event: Event, clock: float) -> None:
        self._try(lambda: super(LiveRecorder, self).event(event, clock))

    def sample(self, sample: Sample, clock: float) -> None:
        self._try(lambda: super(LiveRecorder, self).sample(sample, clock))

    def close(self) -> None:
        self._try(super().close)

    def _try(self, write: Callable[[], None]) -> None:
        if self.failed is None and not self._file.closed:
            try:
                write()
            except NameTakenError:
                pass  # at the end: it has another name then
            except DiskError as error:
                self.failed = str(error)
                self.abandon()
