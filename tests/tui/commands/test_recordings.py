import csv
import io
import os

import pytest
from mcap.writer import Writer

from recordings.recorder import Recorder
from recordings.recording import Recording
from recordings.verification import verify
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import pendu


@pytest.fixture
def library(tmp_path, monkeypatch):
    """Three recordings of known age: c is the newest."""
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    for age, name in enumerate("cba"):
        path = record(tmp_path / f"{name}.mcap", two_runs())
        os.utime(path, (1e9 - age, 1e9 - age))
    return tmp_path


def test_a_recording_in_progress_is_listed_as_such(library):
    with Recorder(library / "now.mcap"):
        assert f"recording now: {library / 'now.mcap'}" in pendu("recordings").out
    assert "recording now" not in pendu("recordings").out


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_show_shows_what_a_recording_contains(tmp_path):
    path = record(tmp_path / "sitting.mcap", two_runs())
    answer = pendu("recordings", "show", path, "--json").json
    assert answer["schema"] == "pendu.recordings-show/1"
    assert (answer["complete"], answer["damaged"], answer["reason"]) == (True, False, None)
    assert (answer["samples"], answer["bytes"]) == (10, path.stat().st_size)
    first, second = answer["runs"]
    assert (first["scene"]["theta"], first["scene"]["h"], first["steps"]) == (2.0, 0.1, 16)
    assert first["inputs"] == 5  # set_h, speed, pause, mark, resume
    assert (second["steps"], second["seconds"]) == (16, 1.25)
    out = pendu("recordings", "show", path).out
    assert "complete" in out
    assert "explicit_euler, symplectic_euler, velocity_verlet, rk4" in out


def test_show_shows_what_is_wrong_with_a_recording(tmp_path):
    path = record(tmp_path / "sitting.mcap", two_runs())
    path.write_bytes(path.read_bytes()[:-40])
    answer = pendu("recordings", "show", path, "--json").json
    assert (answer["complete"], answer["damaged"]) == (False, False)
    assert answer["reason"] in pendu("recordings", "show", path).out


def test_recover_makes_a_whole_recording_of_a_cut_one_and_says_what_is_lost(tmp_path):
    path, out = record(tmp_path / "sitting.mcap", two_runs()), tmp_path / "saved.mcap"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    answer = pendu("recordings", "recover", path, "-o", out, "--json").json
    assert answer["schema"] == "pendu.recordings-recover/1"
    assert {"samples_kept", "entries_lost"} <= answer.keys()
    assert 0 < answer["samples_kept"] == verify(out).samples < 10
    assert verify(out).complete
    told = pendu("recordings", "recover", path, "-o", out, "--force").out
    assert f"{answer['samples_kept']} samples saved" in told


def test_recover_overwrites_nothing_unless_by_force(tmp_path):
    path, out = record(tmp_path / "sitting.mcap", two_runs()), tmp_path / "saved.mcap"
    out.write_bytes(b"precious")
    assert pendu("recordings", "recover", path, "-o", out).refused(5, "exists", "--force")
    assert out.read_bytes() == b"precious"


def test_recover_accepts_the_same_names_as_replay(tmp_path):
    told = pendu("recordings", "recover", "drift", "-o", tmp_path / "saved.mcap").out
    assert "samples saved" in told
    assert pendu("recordings", "recover", "drfit", "-o", tmp_path / "other.mcap").refused(
        3, "did you mean drift?"
    )


def test_export_to_stdout_is_the_file(tmp_path):
    pendu("export", "spin", "-o", tmp_path / "spin.csv")
    assert pendu("export", "spin").out == (tmp_path / "spin.csv").read_text()


def test_the_library_is_listed_newest_first(library):
    answer = pendu("recordings", "--json").json
    assert answer["schema"] == "pendu.recordings/1"
    assert [told["file"] for told in answer["recordings"]] == [
        str(library / f"{name}.mcap") for name in "cba"
    ]
    assert (answer["recordings"][0]["seconds"], answer["recordings"][0]["scenes"]) == (
        4.0,
        ["test"],
    )
    out = pendu("recordings").out
    assert out.index("c.mcap") < out.index("b.mcap") < out.index("a.mcap")


def test_a_damaged_recording_in_the_library_is_listed_with_what_is_wrong(library):
    (library / "a.mcap").write_bytes(b"")
    assert "the file is empty" in pendu("recordings").out
    assert pendu("recordings", "--json").json["recordings"][0]["reason"]  # it is the newest now


def test_an_empty_library_is_no_error(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "nothing"))
    assert "No recordings in" in pendu("recordings").out
    assert pendu("recordings", "prune", "--keep", 1, "--yes").code == 0
    assert not (tmp_path / "nothing").exists()


def test_prune_keeps_the_newest(library):
    assert pendu("recordings", "prune", "--keep", 2, "--yes").out.startswith("deleted 1 recording")
    assert names(library) == ["b.mcap", "c.mcap"]


def test_prune_deletes_nothing_without_a_yes(library):
    outcome = pendu("recordings", "prune", "--keep", 1)
    assert outcome.refused(2, "--yes")
    assert len(names(library)) == 3


@pytest.mark.parametrize(("answer", "left"), [("y\n", 1), ("\n", 3), ("no\n", 3), ("", 3)])
def test_prune_asks_on_a_terminal(library, monkeypatch, answer, left):
    class Keyboard(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr("sys.stdin", Keyboard(answer))
    outcome = pendu("recordings", "prune", "--keep", 1)
    assert "Delete these 2 recordings?" in outcome.err
    assert "a.mcap" in outcome.err
    assert len(names(library)) == left


def test_prune_touches_no_file_in_use(library):
    with Recording.open(library / "a.mcap"):
        outcome = pendu("recordings", "prune", "--keep", 1, "--yes")
    assert names(library) == ["a.mcap", "c.mcap"]
    assert "1 more could not be deleted" in outcome.out


@pytest.mark.parametrize(
    "arguments",
    [
        ("prune",),
        ("--keep", "1"),
        ("prune", "--keep", "0"),
    ],
)
def test_prune_without_a_measure_deletes_nothing(library, arguments):
    assert pendu("recordings", *arguments, "--yes").refused(2)
    assert len(names(library)) == 3


@pytest.mark.parametrize("name", ["info", "recover"])
def test_the_old_names_name_the_new_ones(name):
    assert pendu(name, "drift").refused(2, "use: pendu-tui recordings ")


def test_a_recording_of_an_older_format_is_listed_and_not_read(library):
    path = library / "a.mcap"
    data = path.read_bytes()
    with path.open("wb") as stream:
        writer = Writer(stream, enable_data_crcs=True)
        writer.start()
        schema = writer.register_schema("pendu.Event", "jsonschema", b"{}")
        writer.register_channel("/pendu/events", "json", schema, {"format": "2"})
        writer.finish()
    assert data != path.read_bytes()
    assert pendu("verify", path).refused(3, "it was made by 0.1; this version reads format 3")
    (row,) = [
        row for row in pendu("recordings", "--json").json["recordings"] if row["file"] == str(path)
    ]
    assert "format 3" in row["reason"]


def test_export_to_parquet_has_the_same_rows(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    assert pendu("export", "drift", "--format", "parquet", "-o", tmp_path / "a.parquet").code == 0
    pendu("export", "drift", "-o", tmp_path / "a.csv")
    rows = list(csv.DictReader((tmp_path / "a.csv").open(newline="")))
    table = parquet.read_table(tmp_path / "a.parquet").to_pylist()
    assert [row["theta_rad"] for row in table] == [float(row["theta_rad"]) for row in rows]
