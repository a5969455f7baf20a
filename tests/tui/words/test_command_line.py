"""The command that is copied gives the same run, to the bit."""

import shlex
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import LIMITS, SCENES
from pendu_tui.recordings.library import GOLDEN
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.cli.dispatch import command_of
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.commands.live import lab_of
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.words.command_line import command, reproduces
from tests.tui.command_line import own_method

DRIFT = SCENES["drift"]


def options_of(text: str):
    """What the command line makes of a command."""
    program, name, *arguments = shlex.split(text)
    assert program == "pendu-tui"
    return command_of(name)[0].parse_args(arguments)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_listed_scene_is_given_by_name(scene):
    text = command(Live(scene, scene.speed))
    assert text == f"pendu-tui live --scene {scene.name}"
    assert scene_of(options_of(text)) == scene


NUMBERS = {
    "theta": st.floats(*LIMITS["theta"]),
    "omega": st.floats(-1e3, 1e3),
    "length": st.floats(0.5, 100),
    "h": st.floats(1e-3, 0.1),
}


@settings(max_examples=50)
@given(
    scene=st.sampled_from(list(SCENES.values())),
    changes=st.fixed_dictionaries({}, optional=NUMBERS),
    equal_cost=st.booleans(),
    speed=st.floats(0.1, 9),
    parameter=st.floats(1, 30),
    data=st.data(),
)
def test_any_start_is_reproduced_to_the_last_bit(
    scene, changes, equal_cost, speed, parameter, data
):
    known = [method for method in METHODS if scene.model in method.models]
    cast = data.draw(st.lists(st.sampled_from(known), min_size=1, max_size=6, unique=True))
    changes |= dict.fromkeys(scene.parameters, parameter)
    scene = scene.altered(**changes).with_cast(tuple(cast))
    before = Live(scene, float(f"{speed:g}"))
    if equal_cost:
        before.set_stepping(before.stepping.toggled())
    options = options_of(command(before))
    after = lab_of(scene_of(options), options)
    assert replace(after.scene, name=scene.name, watch=scene.watch) == scene
    assert (after.stepping, after.playhead.speed) == (before.stepping, before.playhead.speed)
    assert reproduces(before)


def test_a_step_changed_before_the_first_one_is_part_of_the_start_but_time_that_runs_back_is_not():
    live = Live(DRIFT)
    live.set_stepping(Stepping(0.1))
    assert options_of(command(live)).h == 0.1
    live.set_stepping(Stepping(-0.1))
    assert not reproduces(live)


def test_a_method_of_ones_own_is_loaded_again_from_its_file(tmp_path):
    given = f"pendu-tui live --method '{own_method(tmp_path)}' --methods mine,rk4"
    scene = scene_of(options_of(given))
    assert scene_of(options_of(command(Live(scene)))) == scene


def test_after_a_change_of_step_size_the_command_points_into_the_recording_if_there_is_one(
    tmp_path,
):
    live = Live(DRIFT, clock=lambda: 0.0)
    assert reproduces(live)
    for frame in range(61):
        live.tick(frame / 30)
    live.set_stepping(Stepping(0.1))
    assert not reproduces(live)
    assert command(live) == "pendu-tui live --scene drift"
    live.record(LiveRecorder(tmp_path / "my run.mcap"))
    assert reproduces(live)
    options = options_of(command(live))
    live.close()
    assert (Path(options.file), options.paused) == (tmp_path / "my run.mcap", True)
    assert options.start_at == pytest.approx(2.0)


def test_the_command_of_a_replay_starts_where_it_stands():
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        replay = Replay(recording)
        replay.seek(1.5)
        options = options_of(command(replay))
        assert (Path(options.file), options.start_at) == (recording.path, 1.5)
        assert options.paused
