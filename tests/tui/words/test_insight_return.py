"""The insight when time has run back to the start."""

import re

import pytest

from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tui.playback.live import Live
from tui.words.insight import insight, return_text


def misses(text: str) -> dict[str, float]:
    return {letter: float(number) for letter, number in re.findall(r"\b([a-z]) ([\d.e+-]+\d)", text.partition("by")[2])}


def there_and_back(scene_name: str, steps: int) -> Live:
    live = Live(SCENES[scene_name])
    for h in (live.stepping.h, -live.stepping.h):
        if h != live.stepping.h:
            live.set_stepping(Stepping(h))
        for _ in range(steps):
            live.step(1)
    return live


@pytest.mark.parametrize("scene", ["drift", "large-swing", "gentle"])
def test_ten_seconds_there_and_back_show_which_methods_are_reversible(scene):
    live = there_and_back(scene, round(10 / SCENES[scene].h))
    text = insight(live)
    assert text.startswith("Back at t = 0")
    assert len(text) <= 79  # with the blank before it, what the narrowest full layout has room for
    missed = misses(text)
    assert missed["v"] < 1e-12  # reversible but for rounding, 1e-16 a step
    assert 1e-9 < missed["r"] < 1e-2  # h⁵
    assert missed["s"] > 1e-3  # not reversible, whatever the books say
    assert missed["e"] > 1e-2


def test_the_distances_are_shown_for_a_while_only():
    live = there_and_back("drift", 40)
    assert "Back" in insight(live)
    live.step(round(9 / live.stepping.h * -1))
    assert "Back" not in insight(live)


def test_nothing_is_shown_before_time_is_back():
    live = there_and_back("drift", 40)
    live.step(-1)
    assert "Back" not in insight(live)


def test_a_failed_method_has_no_distance():
    sample = there_and_back("drift", 10).sample
    euler, *others = sample.readings
    sample = sample._replace(readings=(euler._replace(diverged_at=0.5), *others))
    assert "by e failed, s 0." in return_text(SCENES["drift"], sample)
