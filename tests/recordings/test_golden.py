"""The bundled recordings: every later version of the methods is compared with them."""

import csv
from pathlib import Path

import pytest

from pendu_tui.recordings.files import GOLDEN, golden_names
from pendu_tui.recordings.format import values_of
from pendu_tui.recordings.recording import Recording
from tests.recordings.examples import samples_of
from tests.recordings.make_golden import make
from tests.tui.command_line import pendu

COLUMNS = "clock_s,run,step,t_s,method,theta_rad,omega_rad_per_s,energy_per_s2,energy_error"
ROOM = 64_000  # bytes; they are in every installation


@pytest.mark.parametrize("name", golden_names())
def test_making_a_golden_recording_again_gives_the_same(name, tmp_path):
    again, other = tmp_path / "again.mcap", tmp_path / "and again.mcap"
    make(name, again)
    make(name, other)
    assert again.read_bytes() == other.read_bytes()
    golden = GOLDEN / f"{name}.mcap"
    assert golden.stat().st_size < ROOM
    with Recording.open(golden) as was, Recording.open(again) as made:
        if not was.runs[0].arithmetic.other_functions():  # bytes depend on zstd's version, too
            assert list(was.entries()) == list(made.entries())


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


@pytest.mark.parametrize(
    ("name", "more"),
    [("swapped-cast", "diverged_at_s"), ("stiff-slow", "vx_per_s")],
)
def test_the_csv_has_a_row_for_each_sample_and_method_and_every_number(name, more):
    with Recording.open(GOLDEN / f"{name}.mcap") as recording:
        expected = [
            [clock, sample.run, sample.step, sample.t, method.key, *values_of(reading).values()]
            for clock, sample in samples_of(recording)
            for method, reading in zip(
                recording.run_of(sample.run).scene.cast, sample.readings, strict=True
            )
        ]
    head, *lines = pendu("export", name).out.splitlines()
    assert head.startswith(COLUMNS)
    assert more in head.split(",")
    rows = list(csv.reader(lines))
    assert rows == [[str(value).replace("None", "NaN") for value in row] for row in expected]
