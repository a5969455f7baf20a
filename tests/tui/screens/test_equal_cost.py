"""Equal cost in the lab: RK4 takes a step four times as long, and that is recorded like any change."""

from pathlib import Path

import pytest

from engine.scenes import Scene
from recordings.recording import Recording
from recordings.verification import verify
from tests.tui.harness import recorded
from tui.playback.live import Live
from tui.screens.live import LiveScreen


class Driver(LiveScreen):
    """The lab's actions without a screen."""

    def show_now(self) -> None:
        pass


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


@pytest.mark.parametrize(
    "acts",
    [(1.0, toggle, 2.0, toggle, 1.0), (toggle, 1.0, lambda live: live.step(-2), toggle, 1.0)],
)
def test_a_sitting_at_equal_cost_verifies_to_the_bit(tmp_path: Path, acts):
    def resume(live: Live) -> None:
        live.pause(False)

    path = recorded(tmp_path / "a.mcap", *acts, resume, 1.0)
    verification = verify(path)
    assert verification.complete
    assert verification.identical
    with Recording.open(path) as recording:
        changes = [event for _, event in recording.events if event.kind == "set_h"]
        assert changes[0].equal_cost


@pytest.mark.parametrize(("h", "acts"), [(0.05, "n"), (1e-9, "n--r"), (100.0, "n"), (60.0, "nr")])
def test_a_step_that_is_absurd_for_one_of_the_methods_is_refused_before_anything_changes(
    h: float, acts: str
):
    lab = Driver(Live(Scene(h=h)))
    refusals: list[str] = []
    lab.notify = lambda message, **_: refusals.append(message)
    actions = {
        "n": lab.action_equal_cost,
        "-": lambda: lab.action_next_h(-1),
        "r": lab.action_restart,
    }
    for act in acts:
        actions[act]()
    runs = lab.live.sample.run
    lab.start(Scene(h=100.0))
    assert lab.live.sample.run == runs + (not lab.live.stepping.equal_cost)
    assert bool(refusals) == (lab.live.stepping.equal_cost or h == 100.0)
