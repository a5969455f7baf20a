"""In a replay keys and the bar go to any moment, and a key that changes the run continues it live."""

import asyncio
import itertools
from pathlib import Path

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.screens.launch import start_recording
from pendu_tui.tui.screens.lines import SeekBar, StatusLine
from pendu_tui.tui.views.lab import EventList
from tests.tui.harness import eventful, lab, player, recorded


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return eventful(tmp_path / "eventful.mcap")


async def test_seeking_stepping_events_speed_direction_and_space_at_the_end(path):
    async with player(path) as theatre:
        replay = theatre.source
        assert " REPLAY " in theatre.text(StatusLine)
        bar = theatre.stage.query_one(SeekBar)
        assert "of 12.00 s" in bar.render_line(0).text
        moves = (("right right", 2), ("left", 1), ("end", 12), ("home", 0))
        for keys, position in (*moves, ("pagedown pagedown", 2.4), ("pageup", 1.2)):
            await theatre.press(*keys.split())
            assert replay.playhead.position == pytest.approx(position)
        await theatre.press("full_stop", "full_stop", "comma")
        assert replay.sample.step == 25
        assert "paused" in theatre.text(StatusLine)

        await theatre.press("home", "space", "right_square_bracket")
        assert replay.playhead.position == pytest.approx(2)
        await theatre.press("right_square_bracket", "right_square_bracket", "left_square_bracket")
        assert replay.playhead.position == pytest.approx(4)
        await theatre.press("space", "b", "greater_than_sign")
        assert replay.playhead.speed == -2
        assert "-2×" in theatre.text(StatusLine)
        await theatre.run(1)
        assert replay.playhead.position == pytest.approx(2)
        await theatre.press("b", "less_than_sign", "end")
        await theatre.run(0.5)
        assert replay.playhead.paused
        await theatre.press("space")
        await theatre.run(1)
        assert replay.playhead.position == pytest.approx(1)


async def test_the_lab_has_the_same_bar_and_the_same_keys_on_it():
    async with lab() as theatre:
        await theatre.run(4)
        end = theatre.source.sample
        bar = theatre.stage.query_one(SeekBar)
        await theatre.press("left")
        assert theatre.source.sample.t == pytest.approx(3.0, abs=0.06)
        await theatre.press("home")
        assert theatre.source.sample.step == 0
        await theatre.pilot.click(SeekBar, offset=(1 + bar._columns // 2, 0))
        assert theatre.source.sample.t == pytest.approx(2.0, abs=4 / bar._columns + 0.06)
        await theatre.run(1)
        assert theatre.source.sample.t == pytest.approx(3.0, abs=0.2)
        await theatre.press("end")
        assert theatre.source.sample == end


async def test_a_click_on_an_event_goes_there(path):
    async with player(path, (120, 45)) as theatre:
        await theatre.press("end")
        await theatre.pilot.pause(0.1)
        listed = theatre.stage.query_one(EventList)
        row = next(at for at, line in enumerate(listed.text.splitlines()) if "mark 1" in line)
        await theatre.pilot.click(listed, offset=(8, row + 1))
        await theatre.pilot.pause()
        marked = next(event for event in theatre.source.recording.events if event[1].kind == "mark")
        assert theatre.source.playhead.position == pytest.approx(marked[0], abs=1 / 30)
        assert (theatre.source.sample.run, theatre.source.sample.step) == (1, marked[1].step)
        assert theatre.source.playhead.paused


async def test_a_click_and_a_drag_on_the_bar_go_there(path):
    async with player(path) as theatre:
        replay, bar = theatre.source, theatre.stage.query_one(SeekBar)
        half = 1 + bar._columns // 2
        cell = replay.length / bar._columns
        await theatre.pilot.mouse_down(SeekBar, offset=(half, 0))
        await theatre.pilot.pause()
        assert replay.playhead.position == pytest.approx(6, abs=cell)
        await theatre.pilot.hover("Stage", offset=(1 + bar._columns // 4, 3))  # far off the bar
        await theatre.pilot.pause()
        assert replay.playhead.position == pytest.approx(3, abs=cell)
        await theatre.pilot.hover("KeyLine", offset=(119, 0))
        await theatre.pilot.pause()
        assert replay.playhead.position == pytest.approx(12)
        await theatre.pilot.mouse_up("KeyLine", offset=(119, 0))
        await theatre.pilot.hover(SeekBar, offset=(half, 0))
        await theatre.pilot.pause()
        assert replay.playhead.position == pytest.approx(12)


async def test_the_lab_that_goes_on_knows_what_the_replay_knew_even_right_after_a_jump(tmp_path):
    async with player(recorded(tmp_path / "drift.mcap", 20.0), (120, 45)) as theatre:
        # a frame has time for some samples only
        theatre.source._clock = itertools.count(0.0, 0.003).__next__
        theatre.stage.action_part(1)
        await theatre.pilot.click("KeyLine", offset=(theatre.text("KeyLine").index("Live"), 0))
        async with asyncio.timeout(20):
            while theatre.source.kind == "REPLAY":
                await theatre.pilot.pause(0.01)
        verdicts = [judgement.verdict for judgement in theatre.source.judgements]
        assert verdicts == ["grows", "bounded", "bounded", "loses"]
        assert "over the top" in theatre.text(EventList)


async def test_where_the_lab_could_not_record_the_replay_stays(path):
    def refuse(live):
        raise UserError("/nowhere is not writable: choose another folder.")

    async with player(path) as theatre:
        theatre.stage.record = refuse
        await theatre.press("right", "f")
        await theatre.pilot.pause(0.1)
        assert theatre.source.kind == "REPLAY"
        assert any("/nowhere" in notice.message for notice in theatre.app._notifications)
        await theatre.press("right")
        assert theatre.source.playhead.position == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("keys", "changed"),
    [
        ("f", lambda live: (live.sample.step, live.stepping.h) == (20, 0.05)),
        ("plus", lambda live: live.stepping.h == 0.1),
        ("n", lambda live: live.stepping.equal_cost),
        ("r", lambda live: live.sample.step == 0),
        ("p", lambda live: live.scene == SCENES["gentle"]),
        ("i enter", lambda live: (live.sample.step, live.scene.h) == (0, 0.05)),
        ("T", lambda live: live.scene.name == "who gains"),
        ("f3 right enter", lambda live: live.scene.theta != 1.0),
    ],
)
async def test_a_key_that_changes_the_run_goes_on_live_from_there_and_u_leads_back(
    path, keys, changed
):
    before = path.read_bytes()
    async with player(path) as theatre:
        theatre.stage.record = lambda live: start_recording(live, path.with_name("new.mcap"))
        await theatre.press("right")
        replay, here = theatre.source, theatre.source.sample
        for key in keys.split():
            await theatre.press(key)
            await theatre.pilot.pause()
        assert theatre.source.kind == "LIVE"
        assert changed(theatre.source)
        assert any("new.mcap" in notice.message for notice in theatre.app._notifications)
        await theatre.press("u")
        assert theatre.source is replay
        assert theatre.source.sample == here
        await theatre.press("right", "full_stop")
        assert theatre.source.sample.step > here.step
    assert path.read_bytes() == before
    assert verify(path.with_name("new.mcap")).identical


async def test_after_a_lesson_begun_in_a_replay_undo_never_leads_into_the_run_that_was_left(path):
    async with player(path) as theatre:
        replay = theatre.source
        for key in ("T", "plus", "escape", "u", "u", "u"):
            await theatre.press(key)
            await theatre.pilot.pause()
        assert theatre.source is replay
        here = replay.sample.step
        await theatre.press("full_stop")
        assert replay.sample.step > here  # it is still open
