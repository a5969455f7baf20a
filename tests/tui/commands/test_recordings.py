"""`pendu-tui recordings` and `export`."""

import csv
import os
from dataclasses import replace

import pytest

from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.verification import verify
from tests.recordings.examples import SCENE, record, start, two_runs
from tests.tui.command_line import pendu


@pytest.fixture
def library(here):
    """Three recordings of known age: c is the newest."""
    for age, name in enumerate("cba"):
        path = record(here / f"{name}.mcap", two_runs())
        os.utime(path, (1e9 - age, 1e9 - age))
    return here


@pytest.fixture
def whole(tmp_path):
    return record(tmp_path / "sitting.mcap", two_runs())


def test_show_says_what_is_damaged(whole):
    data = bytearray(whole.read_bytes())
    data[20] ^= 1
    whole.write_bytes(data)
    damaged = f"{whole}: damaged: its checksum is wrong\n"
    assert pendu("recordings", "show", whole).out.startswith(damaged)


@pytest.mark.parametrize(("most", "more"), [(1, 1), (2, 0)])
def test_show_tabulates_so_many_runs_at_most(most, more, whole, monkeypatch):
    monkeypatch.setattr("pendu_tui.tui.commands.recordings.MAX_RUNS", most)
    out = pendu("recordings", "show", whole).out
    assert out.count("\n  1  test ") + out.count("\n  2  test ") == most
    assert (f"\nand {more} more runs; --json" in out) == bool(more)


def test_recover_makes_a_whole_recording_of_a_cut_one_and_says_what_is_lost(
    whole, here, monkeypatch
):
    out = here / "saved.mcap"
    recover = ("recordings", "recover", whole, "-o", out)
    whole.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    answer = pendu(*recover, "--json").json
    assert 0 < answer["samples_kept"] == verify(out).samples < 10
    saved = out.read_bytes()
    assert pendu(*recover).refused(5, "exists", "--force")
    assert out.read_bytes() == saved
    assert f"{answer['samples_kept']} samples saved; 0 " in pendu(*recover, "--force").out
    itself = ("recordings", "recover", "saved", "-o", "saved.mcap", "--force")
    assert pendu(*itself).refused(2, "another name")
    lost = {"samples_kept": 1, "entries_lost": 3, "runs_lost": 1, "reason": None, "out": "new"}
    monkeypatch.setattr("pendu_tui.tui.commands.recordings.recover", lambda *_: lost)
    told = "new: 1 sample saved; 3 samples and events, and 1 run lost: it was complete."
    assert pendu(*itself[:-2], "new").out == f"{told}\n"
    assert out.read_bytes() == saved


def test_the_library_is_listed_newest_first(library):
    rows = pendu("recordings", "--json").json["recordings"]
    assert [row["file"] for row in rows] == [str(library / f"{name}.mcap") for name in "cba"]
    assert rows[0]["seconds"] == 4.0
    with Recorder(library / "now.mcap") as recorder:
        recorder.add(start(), 0.0)
        recorder.flush()
        out = pendu("recordings").out
    assert "recording now: now.mcap" in out
    assert out.index("c.mcap") < out.index("b.mcap") < out.index("a.mcap")


def test_a_recording_that_cannot_be_read_is_listed_with_what_is_wrong(library):
    cut = library / "a.mcap"
    cut.write_bytes(cut.read_bytes()[:40])  # now it is the newest
    rows = pendu("recordings", "--json").json["recordings"]
    assert [row["seconds"] for row in rows] == [None, 4.0, 4.0]
    why = f"{cut}: its end is missing or damaged."
    assert [row["reason"] for row in rows] == [why, None, None]
    assert "its end is missing" in pendu("recordings").out


def test_an_empty_library_is_no_error(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "nothing"))
    assert pendu("recordings").out == f"0 recordings in {tmp_path / 'nothing'}\n"
    assert not (tmp_path / "nothing").exists()


@pytest.mark.parametrize(("names", "listed"), [("km", "k, m"), ("kmn", "k, 2 more")])
def test_of_many_scenes_the_first_is_named(names, listed, library):
    with Recorder(library / "tour.mcap") as recorder:
        for run, name in enumerate(names, 1):
            recorder.add(start(run, replace(SCENE, name=name)), float(run))
            recorder.add(two_runs()[1].value._replace(run=run), float(run))
    assert f"B  {listed}" in pendu("recordings").out


def test_export_to_stdout_is_the_file(tmp_path):
    pendu("export", "drift", "-o", tmp_path / "a.CSV")
    assert pendu("export", "drift").out == (tmp_path / "a.CSV").read_text()
    assert pendu("export", "drift", "-o", tmp_path / "a.CSV").refused(5, "exists", "--force")
    assert pendu("export", "drift", "-o", os.devnull).code == 0
    assert pendu("export", "drift", "-o", tmp_path / "a.parquet").refused(2, "a.csv")
    assert pendu("export", "drift", "-o", tmp_path / "no" / "a.csv").refused(5, "does not exist")


def test_export_has_a_column_for_each_variable_of_each_model(here):
    with Recorder(here / "two.mcap") as recorder:
        for run, name in enumerate(("drift", "stiff-slow"), 1):
            recorder.add(start(run, SCENES[name]), float(run))
            recorder.add(Lockstep(SCENES[name]).sample()._replace(run=run), float(run))
    first, *_, last = csv.DictReader(pendu("export", "two").out.splitlines())
    assert (first["spring_energy"], last["spring_energy"]) == ("NaN", "1.0")


def test_after_a_failure_export_writes_nan_and_not_the_last_finite_numbers(tmp_path):
    run = ("--theta", "3", "--omega", "0.7", "--h", "0.7", "--time", "7")
    methods = ("--methods", "implicit_m,verlet")
    pendu("run", *run, *methods, "--record", tmp_path / "a.mcap")
    rows = list(csv.DictReader(pendu("export", tmp_path / "a.mcap").out.splitlines()))
    failed = [row for row in rows if row["method"] == "implicit_midpoint"][1:]
    assert failed
    numbers = {
        (row["omega_rad_per_s"], row["energy_error"], row["diverged_at_s"]) for row in failed
    }
    assert numbers == {("NaN", "NaN", "0.7")}
    assert "NaN" not in {
        row["energy_error"] for row in rows if row["method"] != "implicit_midpoint"
    }
