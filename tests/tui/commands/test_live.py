"""`pendu-tui live` before there is a screen."""

import signal

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.recordings.files import DiskError, listing
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.commands import lab
from pendu_tui.tui.commands.lab import lesson_of
from pendu_tui.tui.playback.live import Live
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PtyLab


@pytest.mark.slow
def test_labs_that_are_opened_in_the_same_second_record_each_for_itself(tmp_path):
    library = {"PENDU_RECORDINGS": str(tmp_path)}
    with PtyLab(**library) as one, PtyLab(**library) as other:
        while not all(b"REC " in session.output for session in (one, other)):
            one.read(0.1)
            other.read(0.1)
        for session in (one, other):
            session.type("q")
            assert session.end() == 0
    assert len(listing(tmp_path)) == 2
    assert all(verify(item.path).complete for item in listing(tmp_path))


def test_a_library_or_a_file_that_cannot_be_made_is_one_sentence_and_exit_5(tmp_path, monkeypatch):
    path = tmp_path / "mine.mcap"
    path.write_bytes(b"precious")
    taken = ("already exists", "choose another name")
    assert pendu("live", "--plain", "--record", path).refused(5, *taken)
    assert path.read_bytes() == b"precious"
    monkeypatch.setenv("PENDU_RECORDINGS", str(path / "library"))
    assert pendu("live", "--plain").refused(5, str(path))


def test_a_picture_has_the_name_of_its_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert pendu("snapshot", "--scene", "spin", "--time", 0, "--size", "60x16").code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["spin.svg"]


def test_options_of_a_lab_and_of_a_replay_reach_them(monkeypatch):
    screens = []
    monkeypatch.setattr("pendu_tui.tui.commands.lab.check_terminal", lambda: None)
    monkeypatch.setattr(
        "pendu_tui.tui.commands.lab.show",
        lambda screen, options: screens.append(screen) or 0,
    )
    looping = ("--loop", "--paused", "--start-at", 3, "--speed", 2, "--no-record")
    replay = ("replay", "drift", *looping)
    for command in (
        replay,
        ("replay", "drift"),
        ("live", "--equal-cost", "--no-record", "--speed", 3),
        ("live",),
    ):
        assert pendu(*command).code == 0
    assert ["record" in vars(screen) for screen in screens] == [False, True, False, True]
    sources = [screen.source for screen in screens]
    given, usual, equal, live = sources
    assert (given.looping, given.playhead.paused, given.playhead.position) == (True, True, 3.0)
    assert (given.playhead.speed, usual.playhead.speed) == (2.0, 1.0)
    assert (usual.looping, usual.playhead.paused, usual.playhead.position) == (False, False, 0.0)
    assert (equal.stepping.equal_cost, live.stepping.equal_cost) == (True, False)
    assert (equal.playhead.speed, live.playhead.speed) == (3.0, 1.0)
    behind = ("--start-at", usual.length + 0.02)
    assert pendu("replay", "drift", *behind).refused(2, f"0 to {usual.length:.2f} s")
    for source in sources:
        source.close()


def test_a_file_of_one_scene_is_a_lesson_if_it_asks_something(tmp_path):
    plain = tmp_path / "plain.toml"
    plain.write_text("theta = 1\n", encoding="utf-8")
    asking = tmp_path / "asking.toml"
    shot = "[shot]\nmoment = 1\nquestion = 'Why?'\nanswers = ['So.', 'No.']\n"
    asking.write_text(shot, encoding="utf-8")
    assert lesson_of(plain) is None
    assert lesson_of(asking).page.shot.question == "Why?"


def test_after_a_disk_failure_the_goodbye_names_the_unfinished_file(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(lab, "tell", lambda *_, **__: signal.raise_signal(signal.SIGTERM))
    live = Live(DEFAULT_SCENE)
    live.record(LiveRecorder(tmp_path / "lab.mcap"))
    live.recorder._fail(DiskError("no space is left", "disk"))
    live.recorder.abandon()
    assert lab.print_sentences(live) == 5
    printed = capsys.readouterr()
    part = tmp_path / "lab.mcap.part"
    assert printed.out == f"saved {part}\nreplay it with: pendu-tui replay {part}\n"
    assert "the recording stopped" in printed.err
