"""What a command writes is there whole or not at all, and nothing is overwritten but by force."""

import os
import signal
import time
from pathlib import Path

import pytest

from tests.tui.command_line import pendu
from tui.cli.files import whole_file

WRITERS = {
    "export": ("export", "drift", "-o"),
    "accuracy": ("accuracy", "--time", 1, "--h-values", "0.2:0.1:2", "-o"),
    "stability": ("stability", "--steps", 5, "--z-values", "0.1,0.2", "--theta-values", "1", "-o"),
}
each_writer = pytest.mark.parametrize("command", WRITERS.values(), ids=WRITERS)


def test_a_file_appears_when_it_is_whole(tmp_path):
    file = tmp_path / "data"
    with whole_file(file) as meanwhile:
        meanwhile.write_text("half")
        assert not file.exists()
    assert file.read_text() == "half"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_after_an_error_the_older_file_is_unchanged(tmp_path, error):
    file = tmp_path / "data"
    file.write_text("older")

    def fail():
        with whole_file(file, force=True) as meanwhile:
            meanwhile.write_text("half")
            raise error

    with pytest.raises(error):
        fail()
    assert file.read_text() == "older"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_to_end_leaves_nothing_half_written(tmp_path, number):
    before = signal.getsignal(number)

    def end_it():
        with whole_file(tmp_path / "data") as meanwhile:
            meanwhile.write_text("half")
            os.kill(os.getpid(), number)
            time.sleep(1)

    with pytest.raises(KeyboardInterrupt):
        end_it()
    assert list(tmp_path.iterdir()) == []
    assert signal.getsignal(number) is before


def test_force_does_not_replace_a_folder(tmp_path):
    with pytest.raises(OSError, match="already exists"), whole_file(tmp_path, force=True):
        raise AssertionError


def test_a_device_is_written_to_and_not_replaced():
    with whole_file(Path("/dev/null")) as meanwhile:
        assert str(meanwhile) == "/dev/null"


@each_writer
def test_every_command_overwrites_only_with_force(tmp_path, command):
    file = tmp_path / "file.csv"
    file.write_text("older")
    assert pendu(*command, file).refused(5, str(file), "already exists", "--force")
    assert file.read_text() == "older"
    assert pendu(*command, file, "--force").code == 0
    assert file.read_bytes() != b"older"
    assert list(tmp_path.iterdir()) == [file]


def test_a_missing_folder_is_refused_before_anything_is_computed(tmp_path, monkeypatch):
    monkeypatch.setattr("tui.commands.files.export.write_csv", None)
    refusal = pendu(*WRITERS["export"], tmp_path / "no" / "file.csv")
    assert refusal.refused(5, "no folder", "create the folder")


def test_a_file_that_appears_meanwhile_is_left_alone(tmp_path):
    file = tmp_path / "data"

    def write():
        with whole_file(file) as meanwhile:
            meanwhile.write_text("ours")
            file.write_text("precious")

    with pytest.raises(OSError, match="appeared meanwhile"):
        write()
    assert file.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [file]


def test_two_commands_may_write_the_same_name_at_once(tmp_path):
    file = tmp_path / "data"
    (tmp_path / "data.part").write_text("a user's own")
    with whole_file(file, force=True) as one, whole_file(file, force=True) as other:
        one.write_text("1")
        other.write_text("2")
    assert file.read_text() == "1"
    assert (tmp_path / "data.part").read_text() == "a user's own"
