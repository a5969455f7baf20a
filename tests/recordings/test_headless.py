"""Headless runs: which samples they take, and how long they last."""

from dataclasses import replace

import pytest

from pendu_tui.recordings.headless import simulate, steps_for
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover
from tests.recordings.examples import SCENE


@pytest.mark.parametrize(
    ("h", "time", "every", "steps"),
    [
        (0.1, 2.0, 6, [0, 6, 12, 18, 20]),
        (0.1, 0.3, None, [0, 1, 2, 3]),
        (0.004, 0.1, None, [0, 8, 16, 24, 25]),  # 1/30 s are 8.3 steps
    ],
)
def test_samples_have_their_cadence_and_include_the_first_and_the_last(h, time, every, steps):
    scene = replace(SCENE, h=h)
    assert [sample.step for sample in simulate(scene, time, sample_every=every)] == steps
    assert steps_for(scene, time) == steps[-1]


def test_a_long_headless_run_has_few_chunks(tmp_path):
    path, copy = tmp_path / "a.mcap", tmp_path / "copy.mcap"
    with Recorder(path, wall=None) as recorder:
        samples = sum(1 for _ in simulate(SCENE, 300.0, recorder, sample_every=2))
    recover(path, copy)
    for each in (path, copy):
        with Recording.open(each) as recording:
            assert recording.samples == samples == 1501
    assert path.read_bytes().count(b"\x04\x00\x00\x00zstd") < 50  # in chunks and their index
