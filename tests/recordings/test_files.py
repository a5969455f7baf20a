"""The library: where recordings are, and which one a name means."""

import os
import time

import pytest
from mcap.writer import Writer

from pendu_tui.recordings import files
from pendu_tui.recordings.files import (
    GOLDEN,
    DiskError,
    RecordingError,
    listing,
    new_path,
)
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.tui.cli.options import resolve
from tests.recordings.examples import start, tiny
from tests.tui.command_line import IS_WINDOWS


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    return tmp_path / "library"


def fill(folder, **ages):
    """Recordings of these names, so many seconds old."""
    folder.mkdir(exist_ok=True)
    for name, age in ages.items():
        path = tiny(folder / f"{name}.mcap")
        os.utime(path, (1_700_000_000 - age,) * 2)
    return [folder / f"{name}.mcap" for name in ages]


def test_the_library_is_set_by_the_environment_or_in_the_users_data(folder, monkeypatch):
    assert files.folder() == folder
    for nothing in ("", " "):
        monkeypatch.setenv("PENDU_RECORDINGS", nothing)
        assert files.folder().parts[-2:] == ("pendu-tui", "recordings")
    no_folders = ["s3://bucket/runs"]
    if not IS_WINDOWS:  # where any name stands for a folder
        no_folders.append("~nosuchuser/runs")
    for no_folder in no_folders:
        monkeypatch.setenv("PENDU_RECORDINGS", no_folder)
        with pytest.raises(DiskError, match="names no folder"):
            files.folder()


def test_a_new_recording_has_a_free_name_with_the_time(folder, monkeypatch):
    monkeypatch.setattr(time, "strftime", lambda _: "2026-11-20T12-00-00")
    folder.mkdir()
    for name, taken in (("", ".mcap.part"), ("-2", ".mcap"), ("-3", ".mcap")):
        free = folder / f"2026-11-20T12-00-00{name}.mcap"
        assert new_path() == free
        free.with_suffix(taken).touch()


def test_the_list_is_newest_first_and_empty_without_a_folder(folder):
    assert listing() == []
    old, new = fill(folder, old=100, new=1)
    (folder / "notes.txt").touch()
    (folder / "folder.mcap").mkdir()
    assert [item.path for item in listing()] == [new, old]
    assert listing()[0].bytes == new.stat().st_size


def test_a_name_is_a_file_or_the_latest_or_one_of_the_library_or_a_bundled_one(
    folder, tmp_path, monkeypatch
):
    old, new = fill(folder, old=100, new=1)
    elsewhere = tiny(tmp_path / "elsewhere.mcap")
    assert resolve(str(elsewhere)) == elsewhere
    assert resolve("latest") == new
    assert resolve("old") == resolve("old.mcap") == old
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drift").mkdir()  # a folder hides no file
    assert resolve("drift") == GOLDEN / "drift.mcap"


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("latest", "no recordings in .*library yet"),
        ("drfit", "did you mean drift?"),
        ("/no/such.mcap", "choose a file, or one of latest, changes-of-h, damped, drift"),
        ("../../etc/passwd.mcap", "choose a file"),
        ("\x1b[2J", r"there is no recording '\\x1b"),
    ],
)
def test_an_unknown_name_is_refused_with_a_suggestion(name, why):
    with pytest.raises(RecordingError, match=why) as caught:
        resolve(name)
    assert str(caught.value).isprintable()


def test_a_recording_in_progress_is_not_listed_among_the_unfinished(folder):
    folder.mkdir()
    killed = tiny(folder / "killed.mcap").rename(folder / "killed.mcap.part")
    with Recorder(folder / "running.mcap") as recorder:
        recorder.event(start(), 0.0)
        recorder.flush()
        assert [item.path for item in listing()] == [killed]
        assert [item.path for item in listing(being_made=True)] == [recorder.part]


def test_files_of_other_programs_are_not_listed(folder):
    folder.mkdir()
    for name in ("robot.mcap", "robot.mcap.part"):  # a browser's download is called so, too
        with (folder / name).open("wb") as stream:
            Writer(stream).start("ros2")
    (folder / "empty.mcap.part").touch()
    assert listing() == []
