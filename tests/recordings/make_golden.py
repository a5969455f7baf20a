"""Make the bundled recordings again from their inputs: python -m tests.recordings.make_golden.

The same bytes each time.  Run it only when the recorded fields are meant to change: later versions
of the methods are measured against these files.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.recordings.events import Event, noticed
from pendu_tui.recordings.files import GOLDEN, golden_names
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording


def make(name: str, path: Path):
    with Recording.open(GOLDEN / f"{name}.mcap") as golden, Recorder(path) as recorder:
        for clock, value in golden.entries():
            if isinstance(value, Event) and value.scene is not None:
                lockstep = Lockstep(value.scene, value.run, judged=True)
                noted = 0  # milestones
                recorder.add(value._replace(arithmetic=None), clock)
            elif isinstance(value, Sample):
                lockstep.advance(value.step - lockstep.step)
                recorder.add(lockstep.sample(), clock)
                for milestone in lockstep.milestones[noted:]:
                    recorder.add(noticed(value.run, milestone), clock)
                noted = len(lockstep.milestones)
            elif value.kind == "set_h":
                recorder.add(value._replace(t=lockstep.t), clock)
                lockstep.set_stepping(Stepping(value.h, cast=lockstep.scene.cast))


if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        for name in golden_names():
            path = Path(folder) / f"{name}.mcap"
            make(name, path)
            (GOLDEN / path.name).write_bytes(path.read_bytes())
