"""The bundled recordings: every later version of the methods is compared with them."""

from pathlib import Path

import pytest

from engine.methods import USUAL_CAST
from engine.run.lockstep import Sample
from recordings.events import Event
from recordings.fields import COLUMNS, reading_fields, values_of, without_extremes
from recordings.format import topic
from recordings.library import GOLDEN, golden_names
from recordings.recording import Recording
from recordings.summary import other_functions
from recordings.verify import verify
from tests.recordings.examples import two_runs
from tests.recordings.make_golden import FORMAT_1, RECORDINGS, make
from tests.tui.command_line import pendu

ROOM = 64_000  # bytes; they are in every installation


@pytest.mark.parametrize("name", golden_names())
def test_a_golden_recording_verifies(name):
    verification = verify(GOLDEN / f"{name}.mcap")
    assert verification.complete
    assert verification.identical
    assert verification.first_difference is None
    assert verification.sealed == (None if name in FORMAT_1 else True)
    assert verification.samples > 30


@pytest.mark.parametrize("name", golden_names())
def test_making_a_golden_recording_again_gives_the_same(name, tmp_path):
    make(name, tmp_path / "again.mcap")
    make(name, tmp_path / "and again.mcap")
    again = (tmp_path / "again.mcap").read_bytes()
    assert (tmp_path / "and again.mcap").read_bytes() == again
    with Recording.open(GOLDEN / f"{name}.mcap") as golden, Recording.open(tmp_path / "again.mcap") as made:
        if not other_functions(golden.functions):  # bytes depend on zstd's version, too, entries do not
            new = {"noticed"} if golden.version == 1 else set()  # format 1 does not record what the lab noticed
            kept = [entry for entry in made.entries() if getattr(entry.value, "kind", "sample") not in new]
            assert list(golden.entries()) == kept


def test_the_golden_recordings_are_those_we_make_and_small():
    assert set(golden_names()) == set(RECORDINGS)
    assert {"drift", "changes-of-h", "reversed-time", "near-separatrix", "spin"} <= set(RECORDINGS)
    assert all(path.stat().st_size < ROOM for path in GOLDEN.iterdir())


def test_a_recording_of_format_1_stays_readable():
    path = Path(__file__).with_name("format-1.mcap")  # of two_runs(), made when the format was new
    with Recording.open(path, check=True) as recording:
        assert recording.complete
        assert recording.version == 1
        entries = list(recording.entries())
    kinds = {value.kind for _, value in entries if isinstance(value, Event)}
    assert kinds == {"start", "set_h", "mark", "pause", "resume", "speed", "stop"}
    for (clock, value), (then, was) in zip(two_runs(), entries[:-1], strict=True):  # the last one is the stop
        assert clock == then
        if isinstance(value, Event):
            assert value == was
        elif not other_functions(recording.functions):
            assert without_extremes(value) == without_extremes(was)
    assert verify(path).identical


def test_a_recording_holds_runs_with_different_methods_and_says_what_the_lab_noticed():
    with Recording.open(GOLDEN / "swapped-cast.mcap") as recording:
        casts = [[method.letter for method in run.scene.cast] for run in recording.runs]
        samples = [value for _, value in recording.entries() if isinstance(value, Sample)]
    assert casts == [["e", "s"], ["v", "r"], ["r", "v", "e", "s"]]
    assert {(sample.run, len(sample.readings)) for sample in samples} == {(1, 2), (2, 2), (3, 4)}
    ends = [[sample for sample in samples if sample.run == run][-1].readings for run in (1, 2, 3)]
    assert (ends[2][2:], ends[2][:2]) == (ends[0], ends[1][::-1])  # the cast's order changes no number
    with Recording.open(GOLDEN / "verdicts.mcap") as recording:
        said = [f"{each.method.letter} {each.kind} {each.verdict}" for _, each in recording.events.milestones(1)]
    assert said[0] == "e over the top too early"
    assert said[1:] == ["e verdict grows", "r verdict loses", "s verdict bounded", "v verdict bounded"]


def last_readings(name):
    with Recording.open(GOLDEN / f"{name}.mcap") as recording:
        sample = recording.sample(recording.at(recording.length)).value
        (run,) = recording.runs
        return run.scene, dict(zip(recording.methods, sample.readings, strict=True))


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
    assert end["explicit_euler"].energy_error == pytest.approx((1 + scene.z**2) ** 60 - 1)  # a factor each of 60 steps
    assert scene.model == "linear"
    scene, end = last_readings("spin")
    assert all(reading.theta > 20 for reading in end.values())
    with Recording.open(GOLDEN / "changes-of-h.mcap") as recording:
        assert [(clock, event.h) for clock, event in recording.events if event.kind == "set_h"] == [
            (pytest.approx(3.0), 0.1),  # sums of steps
            (pytest.approx(6.0), 0.025),
            (pytest.approx(9.0), 0.05),
        ]


@pytest.mark.parametrize("name", ["drift", "stiff-slow", "damped", "swapped-cast"])
def test_a_layout_shows_the_topics_of_a_recording(name):
    layout = pendu("export", name, "--format", "foxglove").json
    panels = layout["configById"]

    def shown(node):
        return [node] if isinstance(node, str) else [*shown(node["first"]), *shown(node["second"])]

    assert sorted(shown(layout["layout"])) == sorted(panels)
    with Recording.open(GOLDEN / f"{name}.mcap") as recording:
        keys = recording.keys
        fields = {f"{topic(method, model)}.{field.name}" for model, method in keys for field in reading_fields(model)}
        errors = [f"{topic(method, model)}.energy_error" for model, method in keys]
    assert [path["value"] for path in panels["Plot!energyerror"]["paths"]] == errors
    plots = [panel for key, panel in panels.items() if key.startswith("Plot!")]
    paths = [path for panel in plots for path in [*panel["paths"], *filter(None, [panel.get("xAxisPath")])]]
    assert {path["value"] for path in paths} <= fields
    planes = [panel["xAxisPath"]["value"].rpartition(".")[2] for panel in plots if panel["xAxisVal"] == "custom"]
    assert planes == ["x" if name == "stiff-slow" else "theta"] * len(errors)
    assert ("Plot!springenergy" in panels) == (name == "stiff-slow")
    assert panels["RawMessages!events"]["topicPath"] == "/pendu/events"


def test_the_shipped_layout_is_that_of_the_usual_methods(request):
    path, text = (
        GOLDEN.parent / "viewers" / "foxglove_layout.json",
        pendu("export", "drift", "--format", "foxglove").out,
    )
    if request.config.getoption("--snapshot-update"):
        path.write_text(text, encoding="utf-8")
    assert path.read_text(encoding="utf-8") == text


def test_the_csv_has_a_row_for_each_sample_and_method_and_every_number(tmp_path):
    path = tmp_path / "drift.csv"
    assert pendu("export", "drift", "-o", path).code == 0
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        samples = [entry for entry in recording.entries() if isinstance(entry.value, Sample)]
    head, *rows = (line.split(",") for line in path.read_text().splitlines())
    assert tuple(head) == COLUMNS
    assert len(rows) == 4 * len(samples)
    expected = (
        (*entry, method.key, reading)
        for entry in samples
        for method, reading in zip(USUAL_CAST, entry.value.readings, strict=True)
    )
    for row, (clock, sample, key, reading) in zip(rows, expected, strict=True):
        assert (float(row[0]), int(row[1]), int(row[2]), float(row[3])) == (clock, sample.run, sample.step, sample.t)
        assert row[4] == key
        assert row[5:] == ["" if value is None else repr(value) for value in values_of(reading)[: len(row) - 5]]
