"""Every key of the lab does what the help says."""

import asyncio
import gc
from collections import Counter
from itertools import pairwise

import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.format import without_extremes
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.dialogs import COLUMN_WIDTH, bindings_of, help_text, key_lines
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import InsightLine, StatusLine
from pendu_tui.tui.views.error_table import ErrorTable
from pendu_tui.tui.views.lab import TimeChart
from pendu_tui.tui.views.phase import SectionPane
from pendu_tui.tui.views.stage import Stage
from pendu_tui.tui.views.view import Held, Pane
from tests.tui.harness import lab, on_stage


async def test_time_that_runs_backwards_pauses_at_0_and_keeps_what_each_method_misses_its_start_by():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("b")
        theatre.frames(40)
        assert theatre.sample.t == pytest.approx(0, abs=1e-9)
        assert theatre.playhead.paused
        (mark,) = [event for event in theatre.source.events if event.kind == "mark"]
        assert mark.text == "Back at the start"
        await theatre.press("space")
        theatre.frames(20)
        assert theatre.sample.t < -0.3


async def test_a_frame_draws_what_is_due_or_nothing_if_the_terminal_is_behind(monkeypatch):
    gc.disable()
    gc.unfreeze()
    async with lab(DEFAULT_SCENE.altered(h=0.01)) as theatre:
        stage = theatre.stage
        assert gc.isenabled()
        assert gc.get_freeze_count()
        theatre.now = 0.1
        async with asyncio.timeout(10):  # frames come by themselves
            while not theatre.sample.step:
                await theatre.pilot.pause(0.01)
        stage.frame_timer.pause()
        drawn = Counter()
        monkeypatch.setattr(Pane, "draw", lambda pane: drawn.update([type(pane)]))

        def frames(number=60):
            drawn.clear()
            theatre.frames(number)
            return drawn[Stage], drawn[StatusLine], drawn[InsightLine]

        frames(-stage._beat % 60 // 2)  # until all text has had its turn
        assert frames() == (60, 10, 4)
        theatre.source.pause(True)
        assert frames() == (10, 10, 4)  # what is computed meanwhile
        monkeypatch.setattr("pendu_tui.tui.screens.lab.is_writing", lambda app: True)
        drawn.clear()
        stage.action_pause()
        assert not drawn
        before = theatre.sample.t
        assert frames() == (0, 0, 0)
        assert theatre.sample.t > before + 1.9


async def test_settings_are_undone_one_after_the_other_and_a_scene_has_its_own_speed():
    *_, last = SCENES.values()
    async with lab() as theatre:
        await theatre.run(1)

        def settings():
            source = theatre.source
            return source.stepping.h, source.playhead.speed, source.scene, theatre.stage.shown

        before = [settings()]
        for keys in ("+", ">", "p", ("P", *last.name[:4], "enter"), "p", ("y", "escape")):
            await theatre.press(*keys)
            before.append(settings())
        assert before[3][2] == SCENES["gentle"]
        assert before[4][1:3] == (last.speed, last)
        assert before[5][2] == SCENES["drift"]  # the first comes after the last
        for earlier in reversed(before[:-1]):
            await theatre.press("u")
            assert settings() == earlier
        assert theatre.sample.step == 20
        await theatre.press("u")  # nothing is left


async def test_a_run_that_was_replaced_is_brought_back_where_it_was_and_verifies(tmp_path):
    path = tmp_path / "run.mcap"

    def make(clock):
        screen = LabScreen(Live(SCENES["drift"], clock=lambda: 0.0), clock)
        screen.record = lambda live: live.record(LiveRecorder(path))
        return screen

    async with on_stage(make, (120, 40)) as theatre:
        await theatre.run(2)
        await theatre.press("plus")
        await theatre.run(2)
        before, milestones = theatre.sample, theatre.source.milestones
        for key in ("p", "r"):
            await theatre.press(key)
            await theatre.run(1)
        await theatre.press("u", "u")
        there = theatre.sample
        assert without_extremes(there._replace(run=before.run)) == without_extremes(before)
        assert (theatre.scene.name, theatre.source.stepping.h) == ("drift", 0.1)
        assert theatre.source.milestones == milestones
        await theatre.run(4)
        assert theatre.sample.t == pytest.approx(before.t + 4, abs=0.11)
        assert there.run == 5  # drift, the next, that again, that again, drift again
        theatre.source.close()
    assert verify(path).identical


async def test_a_click_on_a_row_or_a_chart_and_going_to_events():
    async with lab() as theatre:
        await theatre.run(12)
        for row, places in ((3, [2]), (1, [0, 1, 2, 3])):
            await theatre.click(ErrorTable, 5, row)
            assert theatre.stage.shown.places(USUAL_CAST) == places
            assert len(theatre.notices) == (places == [2])  # it is alone
            theatre.app.clear_notifications()
        await theatre.click(TimeChart, 20, 5)
        assert theatre.stage.shown.quantity == "theta_error"

        first, over, *_ = [milestone.step for milestone in theatre.source.milestones]
        theatre.stage.action_go_to(1, first)
        assert (theatre.sample.step, theatre.playhead.paused) == (first, True)
        for key, step in (("]", over), ("[", first), ("[", 0)):
            await theatre.press(key)
            assert theatre.sample.step == step
        await theatre.press("r")
        theatre.stage.action_go_to(1, first)
        await theatre.pilot.pause()
        assert "run 1;" in theatre.notices[-1]
        await theatre.press("f3")
        pane = theatre.pane("#phase PhasePane")
        pane.failure = "It failed."
        await theatre.press("f2", "f3")
        assert not pane.failure


async def test_the_lab_stands_still_and_says_so_below_a_dialog_and_while_the_pendulum_is_held():
    async with lab() as theatre:

        async def runs(state: str) -> bool:
            await theatre.pilot.pause()
            step = theatre.sample.step
            theatre.frames(6)  # a fifth of a second, after which the line is drawn
            assert state in theatre.text(StatusLine)
            return theatre.sample.step > step

        for opening, paused in (("question_mark", False), ("ctrl+p", False), ("i", True)):
            theatre.source.pause(paused)
            await theatre.press(opening)
            assert not await runs("paused")
            await theatre.press("escape")
            assert await runs("paused" if paused else "running") == (not paused)
        theatre.source.pause(False)
        theatre.stage.post_message(Held(1.0))
        assert not await runs("held")
        assert theatre.text(ErrorTable).count(" +1.00000      +0.00000 ") == 4
        theatre.stage.show_now()
        assert "Let go or throw" in theatre.text(InsightLine)
        theatre.stage.post_message(Held(None))
        assert await runs("running")
        for gap, played in ((0.99, 0.99), (1.01, 0.0)):  # as after ctrl+z
            before = theatre.playhead.position
            theatre.frames(seconds=gap)
            assert theatre.playhead.position - before == pytest.approx(played)
        theatre.now += 0.02
        theatre.stage.action_pause()
        assert theatre.playhead.position - before == pytest.approx(0.02)


async def test_thirty_changes_can_be_undone_and_a_step_takes_the_line_of_its_scene_away():
    scene = SCENES["euler-caught"]
    async with lab(scene) as theatre:
        stage = theatre.stage
        await theatre.press("+")
        assert stage.shown.line is None
        await theatre.press("u")
        assert stage.shown.line == scene.shot.line is not None
        assert await stage.start(DEFAULT_SCENE)
        assert stage.shown.line is None
        await theatre.press("n")
        absurd = scene.altered(h=100.0).with_cast(USUAL_CAST)
        assert not await stage.start(absurd)  # RK4 would take 400 s
        assert stage.shown.line is None
        for _ in range(40):
            stage.action_switch("exact")
            stage.action_window()
        seen = [stage.shown]
        for _ in range(31):
            stage.action_undo()
            seen.append(stage.shown)
        changes = [one != other for one, other in pairwise(seen)]
        assert changes == [*[True] * 30, False]


async def test_pictures_and_scenes_are_saved_among_the_recordings_or_say_why_not(
    tmp_path, monkeypatch
):
    folder = tmp_path / "to" / "make"
    monkeypatch.setenv("PENDU_RECORDINGS", str(folder))
    async with lab(size=(80, 24)) as theatre:
        await theatre.press("s", "S", "S")
        picture, another, scene = sorted(folder.iterdir())
        assert ">scene</text>" in picture.read_text(encoding="utf-8")
        monkeypatch.setattr(PenduApp, "is_web", True)
        await theatre.press("s", "S")  # a visitor's do nothing
        assert sorted(folder.iterdir()) == [picture, another, scene]
        monkeypatch.setattr(PenduApp, "is_web", False)
        monkeypatch.setenv("PENDU_RECORDINGS", str(picture / "below"))
        for key, what in (("s", "Screenshot"), ("S", "Scene")):
            await theatre.press(key)
            (said,) = theatre.notices
            assert said.startswith(f"{what} not saved: ")


@pytest.mark.parametrize("owner", [LabScreen, SectionPane])
def test_every_listed_key_fits_a_column_of_the_help_and_has_one_meaning(owner, snapshot):
    listed = bindings_of(owner)
    assert all(len(line) < COLUMN_WIDTH for line in key_lines(listed))
    wide, narrow = (help_text([owner], SCENES["spin"], width) for width in (80, 79))
    assert wide.count("\n") < narrow.count("\n")
    first, *others = narrow.split("\n\n")
    lines = [f"{line}\n" for line in first.splitlines() if "ctrl+z" not in line]
    lines += [f"{each.key}: {each.description}\n" for each in listed if each.show]
    snapshot(f"keys-{owner.__name__}.txt", "".join(lines))
    titles = [each.partition("\n")[0] for each in others]
    methods = [f"{each.letter}  {each.label}" for each in USUAL_CAST]
    assert titles == ["Scene spin", "What is on the screen", *methods]
    keys = [key for binding in listed for key in binding.key.split(",")]
    assert len(keys) == len(set(keys))


async def test_the_last_line_has_what_one_needs_now_each_a_button():
    async with lab(size=(82, 40)) as theatre:
        row = theatre.text("KeyLine")
        end = len(row.rstrip()) + 1
        await theatre.click("KeyLine", row.index("Pause") + 1, 0)
        for column, h in ((row.index("-"), 0.02), (row.index("Step"), 0.01), (end, 0.01)):
            await theatre.click("KeyLine", column, 0)
            assert theatre.source.stepping.h == h
        assert theatre.playhead.paused
