"""The command that is copied gives the same run, to the bit."""

import shlex
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.run.stepping import Stepping
from engine.scenes import LIMITS, SCENES, Scene
from recordings.library import GOLDEN
from recordings.live_recorder import LiveRecorder
from recordings.recording import Recording
from tui.cli.dispatch import command_of
from tui.cli.scene import scene_of
from tui.playback.live import Live
from tui.playback.marks import Marks
from tui.playback.replay import Replay
from tui.words.command_line import command, reproduces


def options_of(text: str):
    """What the command line makes of a command."""
    program, name, *arguments = shlex.split(text)
    assert program == "pendu-tui"
    return command_of(name)[0].parse_args(arguments)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_listed_scene_is_given_by_name(scene):
    text = command(Live(scene))
    assert text == f"pendu-tui live --scene {scene.name}"
    assert scene_of(options_of(text)) == scene


@given(
    theta=st.floats(*LIMITS["theta"]),
    omega=st.floats(-1e3, 1e3),
    length=st.floats(0.01, 100),
    h=st.floats(1e-3, 0.1),
)
def test_other_scenes_are_reproduced_to_the_last_bit(theta, omega, length, h):
    scene = Scene(theta=theta, omega=omega, length=length, h=h)
    again = scene_of(options_of(command(Live(scene))))
    assert (again.theta, again.omega, again.length, again.gravity, again.h) == (theta, omega, length, scene.gravity, h)


def test_the_speed_is_kept():
    assert options_of(command(Live(SCENES["spin"], speed=0.25))).speed == 0.25


def test_after_a_change_of_step_size_the_command_points_into_the_recording(tmp_path):
    live = Live(SCENES["drift"], clock=lambda: 0.0)
    live.record(LiveRecorder(tmp_path / "my run.mcap"))
    for frame in range(61):
        live.tick(frame / 30)
    live.set_stepping(Stepping(0.1))
    options = options_of(command(live))
    live.close()
    assert Path(options.file) == tmp_path / "my run.mcap"
    assert options.start_at == pytest.approx(2.0)
    assert options.paused


def test_the_command_of_a_replay_starts_where_it_stands():
    path = GOLDEN / "drift.mcap"
    replay = Replay(Recording.open(path), Marks(path))
    replay.seek(1.5)
    options = options_of(command(replay))
    assert (Path(options.file), options.start_at, options.paused) == (path, 1.5, True)
    replay.close()


def test_a_changed_step_that_no_file_holds_is_not_reproduced(tmp_path):
    live = Live(SCENES["drift"])
    assert reproduces(live)
    live.set_stepping(Stepping(0.1))
    assert not reproduces(live)
    live.record(LiveRecorder(tmp_path / "run.mcap"))
    assert reproduces(live)
    live.close()
