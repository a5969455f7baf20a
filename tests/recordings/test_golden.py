"""The bundled recordings: every later version of the methods is compared with them."""

import pytest

from engine.methods import USUAL_CAST
from engine.run.lockstep import Sample
from recordings.fields import values_of
from recordings.library import GOLDEN, golden_names
from recordings.recording import Recording
from tests.recordings.make_golden import RECORDINGS, make
from tests.tui.command_line import pendu
from tui.commands.export import columns_of

ROOM = 64_000  # bytes; they are in every installation


@pytest.mark.parametrize("name", golden_names())
def test_making_a_golden_recording_again_gives_the_same(name, tmp_path):
    make(name, tmp_path / "again.mcap")
    make(name, tmp_path / "and again.mcap")
    again = (tmp_path / "again.mcap").read_bytes()
    assert (tmp_path / "and again.mcap").read_bytes() == again
    with (
        Recording.open(GOLDEN / f"{name}.mcap") as golden,
        Recording.open(tmp_path / "again.mcap") as made,
    ):
        if not golden.runs[0].arithmetic.other_functions():  # bytes depend on zstd's version, too
            assert list(golden.entries()) == list(made.entries())


def test_the_golden_recordings_are_those_we_make_and_small():
    assert set(golden_names()) == set(RECORDINGS)
    assert {"drift", "changes-of-h", "reversed-time", "near-separatrix", "spin"} <= set(RECORDINGS)
    assert all(path.stat().st_size < ROOM for path in GOLDEN.iterdir())


def test_a_recording_holds_runs_with_different_methods_and_says_what_the_lab_noticed():
    with Recording.open(GOLDEN / "swapped-cast.mcap") as recording:
        casts = [[method.letter for method in run.scene.cast] for run in recording.runs]
        samples = [value for _, value in recording.entries() if isinstance(value, Sample)]
    assert casts == [["e", "s"], ["v", "r"], ["r", "v", "e", "s"]]
    assert {(sample.run, len(sample.readings)) for sample in samples} == {(1, 2), (2, 2), (3, 4)}
    ends = [[sample for sample in samples if sample.run == run][-1].readings for run in (1, 2, 3)]
    assert (ends[2][2:], ends[2][:2]) == (
        ends[0],
        ends[1][::-1],
    )  # the cast's order changes no number
    with Recording.open(GOLDEN / "verdicts.mcap") as recording:
        said = [
            f"{each.method.letter} {each.kind} {each.verdict}"
            for each in recording.runs[0].milestones
        ]
    assert said[0] == "e over the top too early"
    assert said[1:] == [
        "e verdict grows",
        "r verdict loses",
        "s verdict bounded",
        "v verdict bounded",
    ]


def last_readings(name):
    with Recording.open(GOLDEN / f"{name}.mcap") as recording:
        sample = recording.sample(recording.at(recording.length)).value
        (run,) = recording.runs
        return run.scene, dict(zip(recording.methods_of(1), sample.readings, strict=True))


def test_each_golden_recording_shows_what_its_text_says():
    scene, end = last_readings("drift")
    assert end["explicit_euler"].theta < -7  # over the top
    assert end["velocity_verlet"].max_energy_error < 0.01
    scene, end = last_readings("reversed-time")
    assert abs(end["velocity_verlet"].theta - scene.theta) < 1e-13  # round-off of 200 steps
    assert 1e-6 < abs(end["rk4"].theta - scene.theta) < 1e-3
    assert abs(end["symplectic_euler"].theta - scene.theta) > 0.01
    assert abs(end["explicit_euler"].theta - scene.theta) > 1
    scene, end = last_readings("linear")
    assert end["explicit_euler"].energy_error == pytest.approx(
        (1 + scene.z**2) ** 60 - 1
    )  # a factor each of 60 steps
    assert scene.model == "linear"
    scene, end = last_readings("spin")
    assert all(reading.theta > 20 for reading in end.values())
    with Recording.open(GOLDEN / "changes-of-h.mcap") as recording:
        assert [(clock, event.h) for clock, event in recording.events if event.kind == "set_h"] == [
            (pytest.approx(3.0), 0.1),  # sums of steps
            (pytest.approx(6.0), 0.025),
            (pytest.approx(9.0), 0.05),
        ]


def test_the_csv_has_a_row_for_each_sample_and_method_and_every_number(tmp_path):
    path = tmp_path / "drift.csv"
    assert pendu("export", "drift", "-o", path).code == 0
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        samples = [entry for entry in recording.entries() if isinstance(entry.value, Sample)]
    head, *rows = (line.split(",") for line in path.read_text().splitlines())
    assert tuple(head) == columns_of(["pendulum"])
    assert len(rows) == 4 * len(samples)
    expected = (
        (*entry, method.key, reading)
        for entry in samples
        for method, reading in zip(USUAL_CAST, entry.value.readings, strict=True)
    )
    for row, (clock, sample, key, reading) in zip(rows, expected, strict=True):
        assert (float(row[0]), int(row[1]), int(row[2]), float(row[3])) == (
            clock,
            sample.run,
            sample.step,
            sample.t,
        )
        assert row[4] == key
        assert row[5:] == [
            "NaN" if value is None else repr(value) for value in values_of(reading)[: len(row) - 5]
        ]
