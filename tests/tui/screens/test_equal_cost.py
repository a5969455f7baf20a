"""Equal cost in the lab: RK4 takes a step four times as long, and that is recorded like any change."""

from functools import partial
from pathlib import Path

import pytest

from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.live import LiveScreen
from tests.tui.harness import recorded


class Driver(LiveScreen):
    """The lab's actions without a screen."""

    def show_now(self) -> None:
        pass


EQUAL = LiveScreen.action_equal_cost
RESTART = LiveScreen.action_restart
SMALLER = partial(LiveScreen.action_next_h, direction=-1)


def toggle(live: Live) -> None:
    Driver(live).action_equal_cost()


def test_the_key_toggles_equal_cost_which_a_restart_keeps():
    live = Live(Scene(h=0.05))
    toggle(live)
    assert live.stepping.own == (0.05, 0.05, 0.05, 0.2)
    live.step(5)
    live.restart()
    assert (live.scene.h, live.stepping.own) == (0.05, (0.05, 0.05, 0.05, 0.2))
    toggle(live)
    assert live.stepping.own == (0.05,) * 4


def test_a_sitting_at_equal_cost_verifies_to_the_bit(tmp_path: Path):
    acts = (toggle, 1.0, lambda live: live.step(-2), toggle, lambda live: live.pause(False), 1.0)
    path = recorded(tmp_path / "a.mcap", *acts)
    verification = verify(path)
    assert verification.complete
    assert verification.identical
    with Recording.open(path) as recording:
        changes = [event for _, event in recording.events if event.kind == "set_h"]
        assert changes[0].equal_cost


@pytest.mark.parametrize(
    ("h", "acts"), [(0.05, [EQUAL]), (1e-9, [EQUAL, SMALLER, RESTART]), (60.0, [EQUAL, RESTART])]
)
def test_a_step_that_is_absurd_for_a_method_is_refused_before_anything_changes(h, acts):
    lab = Driver(Live(Scene(h=h)))
    refusals: list[str] = []
    lab.notify = lambda message, **_: refusals.append(message)
    for act in acts:
        act(lab)
    runs = lab.live.sample.run
    lab.start(Scene(h=100.0))
    assert lab.live.sample.run == runs + (not lab.live.stepping.equal_cost)
    assert bool(refusals) == lab.live.stepping.equal_cost
