"""`export --format cast`: a film of the replay, played here on a terminal in memory."""

import json
import os
import signal
import subprocess
import time

import pyte
import pytest

from recordings.library import GOLDEN
from tests.recordings.examples import record, two_runs
from tests.tui.command_line import pendu
from tests.tui.harness import player, recorded
from tests.tui.pty_lab import PENDU
from tui.terminal.screenshot import text_of
from tui.words.numbers import file_size


class Film:
    """A cast, and the terminal that it plays on."""

    def __init__(self, text: str) -> None:
        head, *events = (json.loads(line) for line in text.splitlines())
        self.head, self.events = head, events
        self.screen = pyte.Screen(head["width"], head["height"])
        self._stream, self._played = pyte.Stream(self.screen), 0

    def at(self, seconds: float) -> list[str]:
        """What is on the terminal at a time."""
        while self._played < len(self.events) and self.events[self._played][0] <= seconds + 1e-9:
            self._stream.feed(self.events[self._played][2])
            self._played += 1
        return [line.rstrip() for line in self.screen.display]


def cast(*arguments: object) -> Film:
    outcome = pendu("export", *arguments, "--format", "cast")
    assert (outcome.code, outcome.err) == (0, "")
    return Film(outcome.out)


@pytest.fixture
def short(tmp_path):
    return recorded(tmp_path / "short.mcap", 1.0)


@pytest.fixture(params=[(80, 24), (120, 40)], ids=str)
def sized(request, short):
    """A film, and its size."""
    return cast(short, "--size", "{}x{}".format(*request.param)), request.param


async def test_it_shows_what_the_replay_shows(sized, short):
    film, size = sized
    assert (film.head["version"], film.head["width"], film.head["height"]) == (2, *size)
    async with player(short, size) as theatre:
        for frame in range(1, 11):
            theatre.now = frame / 10
            theatre.source.tick(theatre.now)
            if frame not in (4, 9):
                continue
            theatre.stage.show_now()
            await theatre.pilot.pause()
            await theatre.settled()
            await theatre.pilot.pause()
            assert film.at(theatre.now) == text_of(theatre.app.export_screenshot()).splitlines()


def test_the_same_recording_gives_the_same_bytes(short, tmp_path):
    for name in "ab":
        assert pendu("export", short, "--format", "cast", "-o", tmp_path / name).code == 0
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_frames_follow_each_other_at_the_rate_asked_for(short):
    times = [t for t, kind, _ in cast(short, "--fps", "5").events if kind == "o"]
    assert times == pytest.approx([frame / 5 for frame in range(len(times))])
    assert times[-1] == pytest.approx(1.2, abs=0.2)


@pytest.mark.parametrize("speed", ["0.5", "2", "7"])
def test_speed_stretches_time(speed):
    film = cast("drift", "--speed", speed, "--fps", "1", "--size", "60x16")
    assert film.events[-1][0] == pytest.approx(15 / float(speed), abs=1)
    assert f"t {float(speed):.2f} s" in film.at(1.0)[0]
    assert "paused" in film.at(100)[0]
    assert "t 15.00 s" in film.at(100)[0]


def test_it_is_small_because_only_changes_are_in_it():
    film = cast("drift", "--fps", "5")
    first, *rest = (len(sent) for _, _, sent in film.events)
    assert sum(rest) / len(rest) < first / 3


def test_the_cursor_is_hidden_while_it_plays_and_back_at_its_end(short):
    film = cast(short)
    film.at(0)
    assert film.screen.cursor.hidden
    film.at(100)
    assert not film.screen.cursor.hidden


def test_display_options_are_those_of_the_lab(short):
    plain, ascii_only = cast(short, "--fps", "1"), cast(short, "--fps", "1", "--pixels", "ascii")
    assert not "".join(plain.at(0)).isascii()
    assert "".join(ascii_only.at(0)).isascii()


def test_what_makes_no_sense_is_one_sentence(tmp_path):
    assert pendu("export", "drift", "--size", "80x24").refused(2, "--size", "--format cast")
    assert pendu("export", "drift", "--format", "cast", "--size", "80").refused(2, "120x40")
    assert pendu("export", "drift", "--format", "cast", "--speed", "1e-4").refused(2, "frames", "--speed")
    assert pendu("export", "nothing", "--format", "cast").refused(3, "nothing")


def test_of_a_damaged_recording_what_is_intact_is_shown(tmp_path):
    path = record(tmp_path / "cut.mcap", two_runs())
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 3 // 5])
    outcome = pendu("export", path, "--format", "cast", "--fps", "1")
    assert outcome.code == 0
    assert "the rest is exported" in outcome.err
    assert any("REPLAY" in line for line in Film(outcome.out).at(100))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_it_leaves_nothing_behind(tmp_path, number):
    film = ["export", str(GOLDEN / "drift.mcap"), "--format", "cast", "--speed", "0.01", "-o", str(tmp_path / "x.cast")]
    process = subprocess.Popen([*PENDU, *film], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    part = tmp_path / "x.cast.part"
    until = time.monotonic() + 30
    while time.monotonic() < until and not (part.exists() and part.stat().st_size):
        time.sleep(0.05)
    os.kill(process.pid, number)
    assert process.communicate(timeout=30)[1].endswith("pendu-tui: interrupted.\n")
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", ["csv", "cast", "foxglove"])
def test_what_was_written_is_told_on_stderr_and_nothing_on_stdout(short, tmp_path, form):
    outcome = pendu(
        "export",
        short,
        "--format",
        form,
        "--fps" if form == "cast" else "-o",
        *(["1", "-o"] * (form == "cast")),
        out := tmp_path / "x",
    )
    size = file_size(out.stat().st_size)
    what = "a layout for" if form == "foxglove" else "1 s of"
    assert (outcome.out, outcome.err) == ("", f"pendu-tui: wrote {what} short.mcap, {size}: {out}\n")
