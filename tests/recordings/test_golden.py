"""The bundled recordings: every later version of the methods is compared with them."""

from pathlib import Path

import pytest
from mcap.reader import make_reader

from pendu_tui.recordings.files import GOLDEN, golden_names
from pendu_tui.recordings.recording import Recording
from tests.recordings.make_golden import make


def messages(path):
    with path.open("rb") as file:
        return [(each.log_time, each.data) for *_, each in make_reader(file).iter_messages()]


@pytest.mark.parametrize("name", golden_names())
def test_making_a_golden_recording_again_gives_the_same(name, tmp_path):
    again, other = tmp_path / "again.mcap", tmp_path / "and again.mcap"
    make(name, again)
    make(name, other)
    assert again.read_bytes() == other.read_bytes()
    golden = GOLDEN / f"{name}.mcap"
    assert golden.stat().st_size < 80_000  # bytes, in every installation
    with Recording.open(golden) as was:
        if not was.runs[0].arithmetic.other_functions():  # bytes depend on zstd's version, too
            assert messages(golden) == messages(again)


@pytest.mark.parametrize(
    "path", [GOLDEN / "verdicts.mcap", Path(__file__).parent / "older" / "eight-verdicts.mcap"]
)
def test_a_recording_holds_what_the_lab_noticed_also_one_made_with_eight_verdicts(path):
    with Recording.open(path) as recording:
        (run,) = recording.runs
    assert run.inputs == 0  # milestones are none
    over_the_top, *others = run.milestones
    assert (over_the_top.method.letter, over_the_top.kind) == ("e", "over the top")
    verdicts = [("e", "grows"), ("r", "loses"), ("s", "bounded"), ("v", "bounded")]
    assert [(other.method.letter, other.verdict) for other in others] == verdicts
