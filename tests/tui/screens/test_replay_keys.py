"""In a replay keys and the bar go to any moment, and a key that changes the run continues it live."""

import asyncio
import itertools
import re
from pathlib import Path

import pytest

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.recordings.events import remember
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.commands.lab import start_recording
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lines import SeekBar, StatusLine
from pendu_tui.tui.views.lab import EventList
from tests.own_methods import VERLET, load
from tests.tui.harness import eventful, player, recorded


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return eventful(tmp_path / "eventful.mcap")


async def test_events_speed_direction_and_space_at_the_end(path):
    async with player(path, (120, 45)) as theatre:
        replay = theatre.source
        assert " REPLAY " in theatre.text(StatusLine)
        await theatre.press("space", "m", "right_square_bracket")  # no mark in a file
        assert replay.playhead.position == pytest.approx(2)
        await theatre.press("right_square_bracket", "right_square_bracket", "left_square_bracket")
        assert replay.playhead.position == pytest.approx(4)
        await theatre.press("space", "b", "greater_than_sign")
        assert "-2×" in theatre.text(StatusLine)
        await theatre.run(1)
        assert replay.playhead.position == pytest.approx(2)
        await theatre.press("b", "less_than_sign", "end")
        await theatre.run(0.5)
        assert replay.playhead.paused
        await theatre.press("space")
        await theatre.run(1)
        assert replay.playhead.position == pytest.approx(1)


async def test_an_incomplete_recording_is_said_to_be_one(path):
    path.write_bytes(path.read_bytes()[:-40])
    async with player(path, (60, 16)) as theatre:
        assert "incomplete (its end is missing" in theatre.notices[0]
        assert theatre.text(SeekBar).endswith("───   0.00 s of 12.00 s  run 1/3")  # has 24 columns


async def test_a_click_and_a_drag_on_the_bar_go_there(path):
    async with player(path) as theatre:
        pilot, playhead = theatre.pilot, theatre.playhead
        columns = theatre.pane(SeekBar)._columns
        half = 1 + columns // 2
        for act, widget, column, position in (
            (pilot.mouse_down, "SeekBar", half, 6),
            (pilot.hover, "Stage", columns // 4, 3),  # far off the bar
            (pilot.hover, "KeyLine", 119, 12),
            (pilot.mouse_up, "KeyLine", 119, 12),
            (pilot.hover, "SeekBar", half, 12),
        ):
            await act(widget, offset=(column, 0))
            await pilot.pause()
            assert playhead.position == pytest.approx(position, abs=0.6 * 12 / columns)


async def test_the_lab_that_goes_on_knows_what_the_replay_knew_even_right_after_a_jump(tmp_path):
    async with player(recorded(tmp_path / "drift.mcap", 20.0), (120, 45)) as theatre:
        # a frame has time for some samples only
        theatre.source._clock = itertools.count(0.0, 0.003).__next__
        theatre.stage.action_part(1)
        await theatre.click("KeyLine", theatre.text("KeyLine").index("Live"), 0)
        async with asyncio.timeout(20):
            while theatre.source.kind == "REPLAY":
                await theatre.pilot.pause(0.01)
        verdicts = [judgement.verdict for judgement in theatre.source.judgements]
        assert verdicts == ["grows", "bounded", "bounded", "loses"]
        assert "over the top" in theatre.text(EventList)
        assert "not recorded" in theatre.notices[-1]
        for key, is_there in (("m", True), ("u", False)):
            await theatre.press(key)
            assert ("mark" in theatre.text(EventList)) == is_there
            assert ("Live" in theatre.text("KeyLine")) != is_there


async def test_where_the_lab_could_not_record_the_replay_stays_and_ctrl_c_closes_what_it_records(
    path, monkeypatch
):
    ended = []
    monkeypatch.setattr("os._exit", ended.append)
    monkeypatch.setattr("pendu_tui.tui.screens.app.is_gone", lambda: True)

    def refuse(live):
        raise UserError("/nowhere is not writable: choose another folder.")

    async with player(path) as theatre:
        theatre.stage.record = refuse
        await theatre.press("right", "f")
        await theatre.pilot.pause(0.1)
        assert theatre.source.kind == "REPLAY"
        assert any("/nowhere" in each for each in theatre.notices)
        theatre.stage.record = lambda live: start_recording(live, path.with_name("new.mcap"))
        await theatre.press("f", "ctrl+c")
        assert path.with_name("new.mcap").exists()  # it has this name when it is closed
        assert [*ended, theatre.app.return_value] == [130, 130]


@pytest.mark.parametrize(
    ("keys", "changed"),
    [
        ("f", lambda live: (live.sample.step, live.stepping.h) == (20, 0.05)),
        ("plus", lambda live: live.stepping.h == 0.1),
        ("r", lambda live: live.sample.step == 0),
        ("p", lambda live: live.scene == SCENES["gentle"]),
        ("f3 right enter", lambda live: live.scene.theta != 1.0),
        (
            "b T plus escape",
            lambda live: (live.scene.name, live.playhead.speed) == ("who gains", 1.0),
        ),
    ],
)
async def test_a_key_that_changes_the_run_goes_on_live_from_there_and_u_leads_back(
    path, keys, changed
):
    before = path.read_bytes()
    async with player(path) as theatre:
        theatre.stage.record = lambda live: start_recording(live, path.with_name("new.mcap"))
        await theatre.press("right")
        replay, here = theatre.source, theatre.sample
        said = []
        for key in keys.split():
            await theatre.press(key)
            said += theatre.notices
        assert " LIVE " in theatre.text(StatusLine)
        assert changed(theatre.source)
        told = f"Live from 1.00 s on, recorded as {path.with_name('new.mcap')};"
        assert any(each.startswith(told) for each in said)
        await theatre.press("u")
        assert (theatre.source, theatre.sample) == (replay, here)
        assert theatre.notices[-1].startswith("Back")
        assert replay.playhead.paused
        assert path.with_name("new.mcap").exists()
        await theatre.press("u", "right", "full_stop")
        assert theatre.sample.step > here.step  # it is still open
    assert path.read_bytes() == before
    assert verify(path.with_name("new.mcap")).identical


OWN = VERLET.replace(
    "    while", "    assert threading.current_thread() is threading.main_thread()\n    while"
)


@pytest.mark.parametrize(("step", "told"), [(100_000, []), (100_001, ["100001 steps"])])
async def test_a_users_method_goes_on_where_it_can_be_stopped_and_a_wait_for_many_steps_is_told(
    tmp_path, monkeypatch, step, told
):
    own = load(f"import threading\n{OWN}")
    remember([own])
    path = recorded(tmp_path / "own.mcap", 2.0, scene=DEFAULT_SCENE.with_cast((own,)))
    said = []
    monkeypatch.setattr(PenduApp, "notify", lambda _, message, **__: said.append(message))
    async with player(path) as theatre:
        await theatre.press("right")
        history = theatre.source.history
        history.sample = history.sample._replace(step=step)
        await theatre.press("f")
        assert theatre.source.kind == "LIVE"
        assert re.findall(r"\d+ steps", "".join(said)) == told
