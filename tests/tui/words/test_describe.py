"""The run in words, held against the run."""

import re

import pytest

from engine.run.stepping import Stepping
from engine.scenes import SCENES
from recordings.library import GOLDEN
from recordings.recording import Recording
from tests.tui.harness import after, lab
from tui.playback.ghost import Ghost
from tui.playback.live import Live
from tui.words.describe import description, method_sentence

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def test_the_default_scene_after_twenty_seconds():
    live = after(SCENES["drift"], 20)
    assert description(live) == [
        'The lab runs in real time and is at 20.00 s of run 1 of the scene "drift".',
        "The pendulum is 1 m long and started at 57.3° 0 rad/s; one swing takes 2.1 s.",
        "The step size is 0.05 s, z = 0.157.",
        "Explicit Euler went over the top at 7.15 s with 5.1 times its initial energy.",
        "Symplectic Euler stays bounded: its largest energy error is 0.079.",
        "Velocity Verlet stays bounded: its largest energy error is 0.0057.",
        "RK4 loses 0.00030 % of E0 per s; its error will pass Verlet's in 31 min.",
        "Not recording.",
    ]


def test_every_method_has_a_sentence_at_any_time_of_any_scene():
    for scene in SCENES.values():
        live = Live(scene, clock=lambda: 0.0)
        for _ in range(3):
            for index, method in enumerate(scene.cast):
                sentence = method_sentence(live, index)
                assert re.fullmatch(r"[A-Zr].*\.", sentence)
                assert method.label.split()[-1] in sentence
            live.step(200)


def test_before_a_verdict_a_method_s_sentence_gives_its_error():
    live = after(SCENES["drift"], 3)
    error = live.sample.readings[RK4].energy_error
    assert (
        method_sentence(live, RK4)
        == f"RK4 has an energy error of {error:+.2g}; too early: 1 of 5 swings."
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda live: live.pause(True), "is paused"),
        (lambda live: live.set_speed(0.5), "runs at 0.5 times real time"),
        (lambda live: live.set_stepping(Stepping(-0.05)), "time runs backwards"),
        (lambda live: live.set_stepping(Stepping(0.2, equal_cost=True)), "at equal cost"),
        (lambda live: live.start(SCENES["spin"]), "one turn takes 0.98 s"),
    ],
)
def test_the_description_follows_changes(change, words):
    live = after(SCENES["drift"], 1)
    assert words not in " ".join(description(live))
    change(live)
    assert words in " ".join(description(live))


async def test_d_opens_the_description_and_closes_it():
    async with lab() as theatre:
        await theatre.run(20)
        await theatre.press("d")
        text = theatre.app.screen.text
        assert "\n".join(description(theatre.source)[1:]) in text
        assert "On screen" in text
        assert "dE/E0" in text.splitlines()[-1]
        await theatre.press("d")
        assert theatre.app.screen is theatre.stage


def test_a_recording_under_the_lab_is_said():
    live = after(SCENES["drift"], 1)
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        live.laid_under = Ghost.recorded(recording)
    assert "Under it, dim: drift, h 0.05 s." in description(live)
