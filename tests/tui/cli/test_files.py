"""What a command writes is there whole or not at all, and nothing is overwritten but by force."""

import asyncio
import ctypes
import errno
import gc
import os
import signal
import sys
import time
from functools import partial
from pathlib import Path
from signal import SIGINT, SIGTERM

import pytest

from pendu_tui.recordings.files import GOLDEN, RecordingError
from pendu_tui.recordings.system import ENDING
from pendu_tui.tui.cli.dispatch import main
from pendu_tui.tui.cli.errors import explained
from pendu_tui.tui.cli.files import stop_requests, text_file, whole_file
from pendu_tui.tui.cli.options import resolve
from tests.tui.command_line import link, needs_signals, pendu

EXPORT = ("export", "drift", "-o")


def write(file: Path, after, force: bool = False) -> None:
    with whole_file(file, force) as meanwhile:
        meanwhile.write_text("half")
        assert meanwhile.parent.match(f"{file.parent}/.pendu-*")
        assert not file.exists() or file.read_text() == "older"
        after()


def fail() -> None:
    raise OSError("full")


def ask_to_end(number: int) -> None:
    signal.raise_signal(number)
    time.sleep(1)


async def busy(number: int) -> None:
    ask_to_end(number)
    raise AssertionError("the signal waits")


@pytest.mark.parametrize(
    ("after", "error"),
    [
        (fail, OSError),
        *((partial(ask_to_end, each), KeyboardInterrupt) for each in ENDING),
        (lambda: asyncio.run(busy(SIGINT)), KeyboardInterrupt),
    ],
)
def test_after_an_error_or_a_signal_the_older_file_is_unchanged(tmp_path, after, error):
    before = signal.getsignal(SIGTERM)
    file = tmp_path / "data"
    file.write_text("older")
    with pytest.raises(error) as raised:
        write(file, after, force=True)
    assert error is not OSError or str(raised.value) == f"{file}: full"
    assert file.read_text() == "older"
    assert list(tmp_path.iterdir()) == [file]
    assert signal.getsignal(SIGTERM) is before is not signal.default_int_handler


@needs_signals
def test_a_second_signal_interrupts_and_one_that_is_ignored_stays_so_as_under_nohup():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    with stop_requests() as stopped:
        signal.raise_signal(signal.SIGHUP)
        assert not stopped()
        signal.raise_signal(SIGTERM)
        assert stopped()
        with pytest.raises(KeyboardInterrupt):
            ask_to_end(SIGTERM)
    signal.signal(signal.SIGHUP, before)


def test_an_interrupt_that_a_callback_swallows_comes_again(monkeypatch):
    others = []
    monkeypatch.setattr(sys, "unraisablehook", lambda other: others.append(other.exc_type))
    monkeypatch.setattr(sys, "argv", ["pendu-tui", "scenes"])
    monkeypatch.setattr(os, "_exit", id)  # called where pytest's timer is a thread
    assert main() == 0
    assert gc.isenabled()  # again, after the imports
    ctypes.CFUNCTYPE(None)(lambda: 1 / 0)()
    assert others == [ZeroDivisionError]

    def wait():
        ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(SIGINT))()  # swallows it
        for _ in range(100):  # a sleep is not cut short
            time.sleep(0.05)

    with pytest.raises(KeyboardInterrupt):
        wait()


@pytest.mark.parametrize(
    ("number", "advice"),
    [
        (errno.ENOENT, "choose a folder that exists"),
        (errno.ENOSPC, "free some space or write elsewhere"),
        (errno.EACCES, "choose a writable location"),
        (errno.EROFS, "choose a writable location"),
    ],
)
def test_an_error_of_a_file_comes_with_advice(number, advice):
    assert str(explained(OSError("full"))) == "output: full."
    found = explained(OSError(number, "why", "x.csv"))
    assert (found.code, str(found)) == (5, f"x.csv: why; {advice}.")
    assert explained(MemoryError()).code == 3


def test_a_recording_is_a_file_or_a_bundled_one_or_the_latest_or_another_of_the_library(
    here, monkeypatch
):
    library = here / "library"
    monkeypatch.setenv("PENDU_RECORDINGS", str(library))
    for folder in ("library", "drift"):  # which hides no file
        Path(folder).mkdir()
    for name, suggestion in (("latest", "file, or one of changes"), ("drfit", r"mean drift\?$")):
        with pytest.raises(RecordingError, match=suggestion):
            resolve(name)
    for name, changed_at in (("drift", 2), ("old", 1)):
        (library / f"{name}.mcap").write_bytes((GOLDEN / "drift.mcap").read_bytes())
        os.utime(library / f"{name}.mcap", (changed_at,) * 2)
    choice = r"'\\x1b\[2J': choose a file, or one of latest, ch"
    for name, suggestion in (("\x1b[2J", choice), ("odl.mcap", r"mean old\.mcap\?$")):
        with pytest.raises(RecordingError, match=suggestion):
            resolve(name)
    assert resolve(__file__) == Path(__file__)
    assert resolve("drift") == GOLDEN / "drift.mcap"
    assert resolve("latest") == library / "drift.mcap"
    assert resolve("old") == resolve("old.mcap") == library / "old.mcap"


@pytest.mark.parametrize("command", [EXPORT, ("run", "--time", 1, "-o")])
def test_every_command_overwrites_only_with_force(tmp_path, command):
    file = tmp_path / "file.csv"
    file.write_text("older")
    assert pendu(*command, file).refused(5, str(file), "already exists", "--force")
    assert file.read_text() == "older"
    done = pendu(*command, file, "--force")
    assert (done.code, done.err) == (0, f"pendu-tui: wrote {file}\n")
    assert file.read_bytes() != b"older"
    assert list(tmp_path.iterdir()) == [file]


def test_a_file_that_appears_meanwhile_is_left_alone(tmp_path):
    file = tmp_path / "data"
    with pytest.raises(OSError, match="has just appeared"):
        write(file, lambda: file.write_text("precious"))
    assert file.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [file]


def test_a_text_has_the_same_bytes_on_every_system(tmp_path):
    with text_file(tmp_path / "data") as out:
        out.write("θ\n")
    assert (tmp_path / "data").read_bytes() == "θ\n".encode()


@pytest.mark.parametrize(
    "command",
    [
        "recordings recover one.mcap -o one.mcap --force",
        "recordings recover one.mcap -o link.mcap --force",
        "recordings recover one.mcap -o hard.mcap --force",
        "run --time 1 --scene one.toml --record one.toml --force",
        "run one.toml --time 1 --record one.toml --force",
        "run --time 1 --method one.py:mine --record one.py --force",
    ],
)
def test_no_output_replaces_an_input_even_with_force(here, command):
    for name in ("one.toml", "one.py", "one.csv"):
        Path(name).write_text("theta = 1.0\n", encoding="utf-8")
    Path("one.mcap").write_bytes((GOLDEN / "drift.mcap").read_bytes()[:-500])
    Path("hard.mcap").hardlink_to("one.mcap")
    if "link.mcap" in command:
        link(Path("link.mcap"), "one.mcap")
    before = {path.name: path.read_bytes() for path in here.iterdir()}
    assert pendu(*command.split()).refused(2, "is an input of this command")
    assert {path.name: path.read_bytes() for path in here.iterdir()} == before


def test_a_loop_of_links_is_an_ordinary_error(tmp_path):
    loop = tmp_path / "loop"
    link(loop, loop)
    assert pendu("judge", loop).refused(3, "loop")
