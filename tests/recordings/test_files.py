"""The library: where recordings are, and what files are called."""

import errno
import os
import re
import select
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import pyte
import pytest
from mcap.writer import Writer

from pendu_tui.recordings import files, system
from pendu_tui.recordings.files import DiskError, RecordingError, listing, new_path
from pendu_tui.recordings.recorder import Recorder
from tests.recordings.examples import record, start, two_runs
from tests.tui.command_line import IS_WINDOWS, link

pytestmark = pytest.mark.timeout(20)


@pytest.fixture(autouse=True)
def library(tmp_path, monkeypatch):
    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path / "library"))
    return tmp_path / "library"


def test_the_library_is_set_by_the_environment_or_in_the_users_data(library, monkeypatch):
    assert files.folder() == library
    monkeypatch.setenv("PENDU_RECORDINGS", " ")
    assert files.folder().parts[-2:] == ("pendu-tui", "recordings")
    monkeypatch.setenv("PENDU_RECORDINGS", "~/runs")
    assert files.folder() == Path.home() / "runs"
    no_folders = ["s3://bucket/runs", __file__]
    if not IS_WINDOWS:  # where any name stands for a folder
        no_folders.append("~nosuchuser/runs")
    for no_folder in no_folders:
        monkeypatch.setenv("PENDU_RECORDINGS", no_folder)
        with pytest.raises(DiskError, match=f"^{re.escape(no_folder)}: PENDU"):
            files.folder()


def test_a_new_recording_has_a_free_name_with_the_time(library, monkeypatch):
    written, noon = time.strftime, (2026, 11, 20, 12, 30, 5, 4, 324, 0)
    monkeypatch.setattr(time, "strftime", lambda form: written(form, noon))
    library.mkdir()
    for name, taken in (("", ".mcap.part"), ("-2", ".mcap"), ("-3", ".mcap")):
        free = library / f"2026-11-20T12-30-05{name}.mcap"
        assert new_path() == free
        free.with_suffix(taken).touch()
    assert new_path(library.parent) == library.parent / "2026-11-20T12-30-05.mcap"


def test_the_list_is_newest_first_without_files_of_others_or_those_being_made(library, monkeypatch):
    unlockable = Mock(side_effect=OSError)  # as on some file systems
    monkeypatch.setattr("pendu_tui.recordings.recorder.lock", unlockable)
    assert listing() == []
    library.mkdir()
    killed = record(library / "killed.mcap", two_runs()).rename(library / "killed.mcap.part")
    old = [record(library / f"{name}.mcap", two_runs()) for name in "zyxw"]
    for each in old:
        os.utime(each, (1, 1))
    (library / "notes.txt").write_bytes(killed.read_bytes())
    (library / "folder.mcap").mkdir()
    (library / "empty.mcap.part").touch()
    if hasattr(os, "mkfifo"):
        os.mkfifo(library / "pipe.mcap")  # to open it would wait for a writer
    for name, profile in (
        ("robot.mcap", "ros2"),
        ("robot.mcap.part", "ros2"),  # a browser's download is called so, too
        ("clock.mcap", "pendulum"),
    ):
        with (library / name).open("wb") as stream:
            Writer(stream).start(profile, "pendu")
    monkeypatch.setattr("pendu_tui.recordings.recorder.lock", system.lock)
    with Recorder(library / "running.mcap") as recorder:
        recorder.add(start(), 0.0)
        recorder.flush()
        assert [item.path for item in listing()] == [killed, *old]
        assert listing()[0].bytes == killed.stat().st_size
        assert [item.path for item in listing(being_made=True)] == [recorder.part]
    monkeypatch.setattr(files, "lock", unlockable)
    assert [item.path for item in listing()] == [recorder.path, *old]


def test_a_file_can_be_written_in_a_folder_under_a_free_name(tmp_path, monkeypatch):
    taken = record(tmp_path / "a.mcap", two_runs())
    link(tmp_path / "link", tmp_path / "nowhere")
    for path, why, *force in (
        (taken, "--force"),
        (tmp_path / "link", "--force"),
        (taken, "name$", None),
        (tmp_path, "name$", True),
        (tmp_path / "no" / "a.mcap", "does not exist", True),
        (files.Path("-"), "not a file name", True),
    ):
        with pytest.raises(DiskError, match=why) as refused:
            files.check_target(path, *force)
        assert refused.value.filename == str(path)
    files.check_target(taken, force=True)
    files.check_target(tmp_path / "free.mcap", force=None)
    files.check_target(files.Path(os.devnull))
    monkeypatch.setattr(os, "access", lambda _, mode: mode != os.W_OK | os.X_OK)
    with pytest.raises(DiskError, match="is not writable"):
        files.check_target(tmp_path / "free.mcap")


@pytest.mark.parametrize("name", ["con.mcap", "LPT1.csv", "nul .svg", "19:44.csv"])
def test_a_name_that_no_file_of_windows_has_is_refused_there(tmp_path, monkeypatch, name):
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(DiskError, match="not a file name"):
        files.check_target(tmp_path / name)
    files.check_target(tmp_path / "console.mcap")
    assert not system.is_reserved("NUL")


def test_a_name_is_given_once_also_without_links(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "link", lambda *_: (_ for _ in ()).throw(OSError(errno.EPERM, "no")))
    for content in ("first", "second"):
        (tmp_path / "a.part").write_text(content)
        with suppress(FileExistsError):
            system.rename(tmp_path / "a.part", tmp_path / "a")
        assert (tmp_path / "a.part").exists() == (content == "second")
        assert (tmp_path / "a").read_text() == "first"


def test_an_error_of_the_disk_or_in_a_file_names_the_file_first(tmp_path):
    for error, why in ((OSError(errno.ENOSPC, "No space"), "No space"), (OSError("odd"), "odd")):
        with pytest.raises(DiskError) as failed, files.writing(tmp_path):
            raise error
        assert str(failed.value) == f"{tmp_path}: {why}"
        assert failed.value.errno == (error.errno or 0)
    for text in ("it is odd", "it is odd."):
        with (
            pytest.raises(RecordingError, match=rf"^{re.escape(str(tmp_path))}: it is odd\.$"),
            files.named(tmp_path),
        ):
            raise RecordingError(text)


@pytest.mark.skipif(IS_WINDOWS, reason="has no such signals")
@pytest.mark.parametrize("platform", ["linux", "win32"])
def test_processes_are_ended_stopped_and_put_last(monkeypatch, platform):
    monkeypatch.setattr(sys, "platform", platform)
    calls = []
    for module, name in ((os, "kill"), (os, "nice"), (signal, "signal")):
        monkeypatch.setattr(module, name, lambda *each: calls.append(each))
    system.kill(7, 3)
    system.give_way()
    system.stop()
    system.stop_as_usual()
    assert system.ENDING == [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
    linux = [(7, signal.SIGKILL), (10,), (os.getpid(), signal.SIGSTOP)]
    linux += [(each, signal.SIG_DFL) for each in (signal.SIGTSTP, signal.SIGCONT)]
    assert calls == {"linux": linux, "win32": [(7, 3)]}[platform]
    for state, is_stopped in (("7 (T) S 1", False), ("7 (a) S) T 1", platform == "linux")):
        monkeypatch.setattr(Path, "read_text", lambda _, state=state: state)
        assert system.is_stopped(7) == is_stopped


def test_windows_locks_a_byte_behind_all_data_and_renames_without_links(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(os, "link", None)
    locked = []

    def locking(number, mode, size):
        locked.append((os.lseek(number, 0, os.SEEK_CUR), mode, size))

    windows = SimpleNamespace(LK_LOCK="lock", LK_NBLCK="probe", locking=locking)
    monkeypatch.setattr(system, "msvcrt", windows, raising=False)
    with (tmp_path / "a").open("wb") as file:
        file.write(b"data")
        file.flush()
        system.lock(file)
        system.lock(file, probe=True)
        assert os.lseek(file.fileno(), 0, os.SEEK_CUR) == 4
    assert locked == [(0x7FFFFFFF, "lock", 1), (0x7FFFFFFF, "probe", 1)]
    system.rename(tmp_path / "a", tmp_path / "b")
    assert (tmp_path / "b").read_bytes() == b"data"


def test_windows_has_a_shell_of_its_own_and_a_console_with_all_colours(monkeypatch):
    for platform, command in (("linux", "exec 'a b' c"), ("win32", '"a b" c')):
        monkeypatch.setattr(sys, "platform", platform)
        assert system.shell_command(["a b", "c"]) == command
    for name, usual in (("TERM", "xterm-256color"), ("COLORTERM", "truecolor")):
        monkeypatch.delenv(name, raising=False)
        assert system.environment()[name] == usual
        monkeypatch.setenv(name, "other")
        assert system.environment()[name] == "other"


@pytest.mark.skipif(IS_WINDOWS, reason="has other terminals")
def test_a_terminal_is_read_key_by_key_and_given_back_to_the_shell(monkeypatch):
    import termios

    keyboard, screen = os.openpty()
    stderr = os.dup(2)
    os.dup2(screen, 2)
    try:
        settings = system.terminal_state()
        with system.key_by_key(2) as is_possible:
            assert is_possible
            assert not termios.tcgetattr(2)[3] & (termios.ECHO | termios.ICANON)
        system.restore_terminal(settings)  # the shell has it still
        termios.tcsetattr(2, termios.TCSANOW, [*settings[:3], 0, *settings[4:]])
        system.restore_terminal(settings)
        assert termios.tcgetattr(2) == settings
        with monkeypatch.context() as windows:
            windows.setattr(sys, "platform", "win32")
            system.restore_terminal(system.terminal_state())
        os.write(2, b"shell$")
        sent = b""
        while not sent.endswith(b"shell$"):
            assert select.select([keyboard], [], [], 5.0)[0]
            sent += os.read(keyboard, 500)
        assert sent.count(b"\x1b[<u") == 2  # once on each system
        screen = pyte.Screen(9, 9)
        usual = set(screen.mode)
        pyte.ByteStream(screen).feed(b"\x1b[?7;25l\x1b[?1000;1003;1004;1006;1049;2004h" + sent)
        assert screen.mode == usual
        assert not system.is_gone()
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        assert system.is_gone()
        assert system.terminal_state() is None
    finally:
        os.dup2(stderr, 2)
