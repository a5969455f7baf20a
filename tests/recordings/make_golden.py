"""Make the bundled recordings again from their inputs: python -m tests.recordings.make_golden.

The same bytes each time.  Run it only when the recorded fields are meant to change: later versions
of the methods are measured against these files.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.files import GOLDEN, golden_names
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from tests.recordings.examples import samples_of, with_changes


class Later:
    """A recorder for a run that follows others."""

    def __init__(self, recorder: Recorder, run: int):
        self._recorder, self._run, self._begin = recorder, run, recorder.seconds

    def add(self, value: Sample | Event, clock: float):
        self._recorder.add(value._replace(run=self._run), self._begin + clock)


def make(name: str, path: Path):
    with Recording.open(GOLDEN / f"{name}.mcap") as golden, Recorder(path) as recorder:
        for run in golden.runs:
            steps = [value.step for _, value in samples_of(golden) if value.run == run.number]
            changes = [(event.step, event.h) for _, event in run.events if event.kind == "set_h"]
            later = Later(recorder, run.number)
            list(with_changes(run.scene, run.end - run.begin, later, changes, steps[1]))


if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        for name in golden_names():
            path = Path(folder) / f"{name}.mcap"
            make(name, path)
            (GOLDEN / path.name).write_bytes(path.read_bytes())
