"""`pendu-tui live` before there is a screen, and without one."""

import gc
import os
import re
import signal
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.files import DiskError, NameTakenError, listing
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.cli import watchdog
from pendu_tui.tui.commands import lab
from pendu_tui.tui.commands.lab import lesson_of
from pendu_tui.tui.commands.options import parser_of
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.options import TerminalOptions
from pendu_tui.tui.views.view import Pane
from tests.tui.command_line import PENDU, pendu


def test_a_library_or_a_file_that_cannot_be_made_is_one_sentence_and_exit_5(tmp_path, monkeypatch):
    path = tmp_path / "mine.mcap"
    path.write_bytes(b"precious")
    taken = ("already exists", "choose another name")
    assert pendu("live", "--plain", "--record", path).refused(5, *taken)
    assert path.read_bytes() == b"precious"
    monkeypatch.setattr(lab, "check_terminal", lambda: None)
    monkeypatch.setattr(lab, "show", None)
    assert pendu("live", "--record", path).refused(5, *taken)  # before the screen
    monkeypatch.setenv("PENDU_RECORDINGS", str(path / "library"))
    assert pendu("live", "--plain").refused(5, str(path))

    def refuse(path, force):
        raise DiskError("choose another folder", str(path))

    monkeypatch.setenv("PENDU_RECORDINGS", str(tmp_path))
    monkeypatch.setattr(lab.files, "check_target", refuse)
    advice = "with PENDU_RECORDINGS, or use --no-record"
    assert pendu("live", "--plain").refused(5, f"choose another folder, {advice}")
    assert advice not in pendu("live", "--plain", "--record", path).err


def test_labs_that_begin_at_once_record_under_names_of_their_own(tmp_path, monkeypatch):
    path = tmp_path / "new" / "library" / "now.mcap"
    monkeypatch.setattr("pendu_tui.recordings.files.new_path", lambda _: path)
    labs = [Live(DEFAULT_SCENE) for _ in range(2)]
    for each in labs:
        lab.start_recording(each)
    with pytest.raises(NameTakenError):
        lab.start_recording(Live(DEFAULT_SCENE), path)
    for each in labs:
        each.close()
    assert sorted(each.name for each in path.parent.iterdir()) == ["now-2.mcap", "now.mcap"]


def test_a_picture_is_as_it_is_asked_for_and_has_the_name_of_its_scene(here, monkeypatch):
    async def still(*asked):
        return str(asked)

    monkeypatch.setattr(lab, "still", still)
    monkeypatch.setenv("COLORFGBG", "0;15")  # which is light
    picture = ("snapshot", "spin", "--time", 3, "--size", "60x16", "--pixels", "half")
    assert pendu(*picture).code == 0
    asked = (SCENES["spin"], 3.0, (60, 16), TerminalOptions("dark", "half"))
    assert Path("spin.svg").read_text(encoding="utf-8") == str(asked)
    assert pendu(*picture).refused(5, "--force")
    assert pendu(*picture, "-o", "b.svg").err == "pendu-tui: wrote b.svg\n"
    Path("mine.toml").write_text('name = "../mine"\n', encoding="utf-8")
    assert pendu("snapshot", "mine.toml").err == "pendu-tui: wrote mine.svg\n"


async def test_a_picture_shows_its_time_when_all_panes_are_done(monkeypatch):
    asked = []
    done = property(lambda pane: asked.append(pane) or len(asked) not in {*range(10), 13})
    monkeypatch.setattr(Pane, "settled", done)
    monkeypatch.setattr("pendu_tui.tui.playback.live.FRAME_BUDGET", 1e-9)  # it has all the time
    look = TerminalOptions("dark", "ascii")
    still = await lab.still(DEFAULT_SCENE, 1.0, (60, 16), look, keys="e")
    assert ">1.00" in still
    assert "|dE/E0|" not in still  # but the next quantity
    assert not re.search("[\u2801-\u28ff]", still)
    assert len(asked) > 13


@pytest.fixture
def asking(tmp_path):
    path = tmp_path / "asking.toml"
    shot = "speed = 0.5\n[shot]\nmoment = 1\nquestion = 'Why?'\nanswers = ['So.', 'No.']\n"
    path.write_text(shot, encoding="utf-8")
    return path


def test_options_of_a_lab_and_of_a_replay_reach_them(asking, monkeypatch):
    screens = []
    methods = []
    watched = []
    library = asking.with_name("library")
    saved = asking.with_name("saved.toml")
    saved.write_text("[shot]\nequal_cost = true")
    monkeypatch.setenv("PENDU_RECORDINGS", str(library))
    monkeypatch.setattr(lab, "own_methods", lambda options: options.method)
    monkeypatch.setattr(lab, "remember", methods.append)
    monkeypatch.setattr(watchdog, "watch_calls_in_c", lambda: watched.append("by a process"))
    monkeypatch.setattr(lab, "check_terminal", lambda: None)
    monkeypatch.setattr(lab, "show", lambda screen, options: screens.append(screen) or 0)
    looping = ("--loop", "--paused", "--start-at", 3, "--speed", 2, "--no-record")
    replay = ("replay", "drift", *looping)
    gc.enable()
    for command in (
        replay,
        ("replay", "drift", "--method", "mine.py"),
        ("live", asking, "--equal-cost", "--no-record", "--speed", 3),
        ("live", saved, "--no-record"),
        ("live", "--scene", asking, "--record", "new.mcap"),
    ):
        assert pendu(*command).code == 0
    assert not gc.isenabled()  # which would delay the first paint
    gc.enable()
    assert ["record" in vars(screen) for screen in screens] == [False, True, False, False, True]
    assert screens[-1].record.keywords == {"file": Path("new.mcap")}
    assert [screen.guide is None for screen in screens] == [True, True, False, True, False]
    assert methods == [[], ["mine.py"]]
    assert watched == ["by a process"]
    sources = [screen.source for screen in screens]
    given, usual, equal, as_saved, live = sources
    assert (given.looping, given.playhead.paused, given.playhead.position) == (True, True, 3.0)
    assert (given.playhead.speed, usual.playhead.speed) == (2.0, 1.0)
    assert (usual.looping, usual.playhead.paused, usual.playhead.position) == (False, False, 0.0)
    assert equal.stepping.equal_cost
    assert as_saved.stepping.equal_cost
    assert not live.stepping.equal_cost
    assert (equal.playhead.speed, live.playhead.speed) == (3.0, 0.5)
    assert not library.exists()  # a replay is not recorded
    for outside in (-0.01, usual.length + 0.02):
        refused = pendu("replay", "drift", "--start-at", outside)
        assert refused.refused(2, f"0 to {usual.length:.2f} s")
    for source in sources:
        source.close()


def test_sentences_are_told_of_a_lesson_and_recorded_unless_that_is_not_wanted(here, monkeypatch):
    told = []

    def tell(source, say, _, lesson):
        assert say.keywords == {"flush": True}
        told.append((source.recorder is not None, lesson is not None))

    monkeypatch.setattr(lab, "tell", tell)
    for command in ("live", "live --no-record", "tour --no-record"):
        assert pendu(*command.split(), "--plain").code == 0
    assert told == [(True, False), (False, False), (False, True)]
    assert len(listing()) == 1


class App(SimpleNamespace):
    def run(self, mouse: bool):
        self.mouse = mouse
        return self.result

    def finish(self):
        self.finished = True


def test_the_app_has_the_colours_of_the_terminal_and_its_end_is_that_of_the_command(monkeypatch):
    def shown(result=None, code: int | None = None, theme="auto", mouse=(), **environment: str):
        nonlocal app
        options = parser_of("live").parse_args(["--theme", theme, *mouse])
        monkeypatch.setattr(lab, "environment", lambda: {"TERM": "xterm-256color"} | environment)
        app = App(result=result, return_code=code)
        return lab.show(LabScreen(Live(DEFAULT_SCENE)), options)

    def made(screen: LabScreen, terminal: TerminalOptions) -> App:
        app.theme = terminal.theme
        return app

    app = App()
    monkeypatch.setattr(lab, "PenduApp", made)
    for asked, found, theme in (
        ({}, "light", "light"),
        ({}, None, "dark"),
        ({"theme": "dark"}, "light", "dark"),
        ({"COLORFGBG": "15;0"}, "light", "dark"),
        ({"NO_COLOR": "1"}, "light", "ansi"),
    ):
        monkeypatch.setattr(lab, "background", lambda found=found: found)
        assert shown(**asked) == 0
        assert (app.theme, app.finished) == (theme, True)
    assert app.mouse
    assert (shown(130, mouse=["--no-mouse"]), app.mouse, shown(code=1)) == (130, False, 1)
    in_a_worker = RuntimeError()
    in_a_worker.error = ZeroDivisionError()
    for error in (ZeroDivisionError(), in_a_worker):
        with pytest.raises(ZeroDivisionError):
            shown(error)


def test_a_file_of_several_scenes_is_a_lesson_and_one_of_one_if_it_asks_something(asking, tmp_path):
    plain = tmp_path / "plain.toml"
    plain.write_text("theta = 1\n", encoding="utf-8")
    assert lesson_of(plain) is None
    several = tmp_path / "several.toml"
    several.write_text("[[scene]]\nname = 'one'\n[[scene]]\nname = 'two'\n", encoding="utf-8")
    assert [page.name for page in lesson_of(several).pages] == ["one", "two"]
    lesson = lesson_of(asking)
    assert (lesson.name, lesson.page.shot.question) == ("Page", "Why?")


def test_the_goodbye_names_the_recording_and_after_a_disk_failure_the_unfinished_file(
    tmp_path, capsys, monkeypatch
):
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
    path = tmp_path / "whole.mcap"
    live.recorder = None
    live.record(LiveRecorder(path))
    assert lab.print_sentences(live) == 130
    assert f"saved {path}\n" in capsys.readouterr().out
    assert verify(path).complete


@pytest.mark.slow
def test_when_nobody_reads_any_more_the_recording_is_whole(tmp_path):
    env = {**os.environ, "PENDU_RECORDINGS": str(tmp_path)}
    line = [*PENDU, "live", "--plain", "--speed", "20"]
    with subprocess.Popen(line, env=env, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().startswith("The lab runs at 20×")
        process.stdout.close()
        process.wait(timeout=30)
    assert process.returncode == 141
    (path,) = tmp_path.iterdir()
    report = verify(path)
    assert (report.identical, report.complete) == (True, True)
