"""The run in words, held against the run."""

import re

import pytest

from engine.methods import METHODS
from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tests.tui.stage import lab
from tui.playback.live import Live
from tui.words.describe import description, method_sentence

EXPLICIT, SYMPLECTIC, VERLET, RK4 = range(4)


def after(name: str, seconds: float, **changes: float) -> Live:
    live = Live(SCENES[name].altered(**changes), clock=lambda: 0.0)
    for frame in range(round(seconds * 30) + 1):
        live.tick(frame / 30)
    return live


def test_the_default_scene_after_twenty_seconds():
    live = after("drift", 20)
    assert description(live) == [
        "The lab runs at 1 times real time, at 20.00 s of run 1, scene drift.",
        "The pendulum is 1 m long and started at 57.3 degrees with 0 radians per second; it swings, once in 2.1 s.",
        "The step size is 0.05 s, z = 0.157.",
        "Explicit Euler went over the top at 7.15 s with 5.1 times the start's energy.",
        "Symplectic Euler stays within a band: its energy is off by 0.079 at most.",
        "Velocity Verlet stays within a band: its energy is off by 0.0057 at most.",
        "RK4 loses 2.9e-06 per second: at this h it leaves Verlet's band in about 32 min.",
        "Nothing is recorded.",
    ]


def test_every_method_has_a_sentence_at_any_time_of_any_scene():
    for scene in SCENES.values():
        live = Live(scene, clock=lambda: 0.0)
        for _ in range(6):
            for index, method in enumerate(METHODS):
                sentence = method_sentence(live, index)
                assert re.fullmatch(r"[A-Z].*\.", sentence)
                assert method.label.split()[-1] in sentence
            live.step(200)


def test_before_a_verdict_the_error_is_told():
    live = after("drift", 3)
    error = live.sample.readings[RK4].energy_error
    assert method_sentence(live, RK4) == f"RK4 is off by {error:+.2g} of its energy; it is too early for a verdict."


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda live: live.pause(True), "is paused"),
        (lambda live: live.set_speed(0.5), "runs at 0.5 times real time"),
        (lambda live: live.set_stepping(Stepping(-0.05)), "time runs backwards"),
        (lambda live: live.set_stepping(Stepping(0.2, equal_cost=True)), "at equal cost"),
        (lambda live: live.start(SCENES["spin"]), "it turns over and over, once in 0.98 s"),
    ],
)
def test_what_was_changed_is_told(change, words):
    live = after("drift", 1)
    assert words not in " ".join(description(live))
    change(live)
    assert words in " ".join(description(live))


async def test_d_describes_the_screen_and_closes_again():
    async with lab() as theatre:
        await theatre.run(20)
        await theatre.press("d")
        text = theatre.app.screen.text
        assert text.startswith("\n".join(description(theatre.source)))
        assert "On screen" in text
        assert "dE/E0" in text.splitlines()[-1]
        await theatre.press("d")
        assert theatre.app.screen is theatre.stage
