"""Equal cost in the lab: RK4 takes a step four times as long, and that is recorded like any change."""

from pathlib import Path

import pytest

from engine.scenes import Scene
from recordings.recording import Recording
from recordings.verify import verify
from tests.tui.harness import recorded
from tui.playback.live import Live
from tui.screens.live import LiveScreen


class Driver(LiveScreen):
    """The lab's actions without a screen."""

    def show_now(self) -> None:
        pass


def toggle(live: Live) -> None:
    Driver(live).action_equal_cost()


def test_each_method_has_its_own_step_and_all_meet(tmp_path: Path):
    steps = []
    recorded(
        tmp_path / "a.mcap",
        toggle,
        lambda live: steps.append((live.stepping.h, live.stepping.own, live.stepping.smallest)),
    )
    assert steps == [(0.2, (0.05, 0.05, 0.05, 0.2), 0.05)]


def test_the_same_key_goes_back_to_the_same_step_for_all(tmp_path: Path):
    steps = []
    recorded(tmp_path / "a.mcap", toggle, 0.5, toggle, lambda live: steps.append(live.stepping.own))
    assert steps == [(0.05,) * 4]


def test_a_restart_stays_at_equal_cost(tmp_path: Path):
    steps = []
    recorded(
        tmp_path / "a.mcap", toggle, 0.5, Live.restart, lambda live: steps.append((live.scene.h, live.stepping.own))
    )
    assert steps == [(0.05, (0.05, 0.05, 0.05, 0.2))]


@pytest.mark.parametrize(
    "acts", [(1.0, toggle, 2.0, toggle, 1.0), (toggle, 1.0, lambda live: live.step(-2), toggle, 1.0)]
)
def test_a_sitting_at_equal_cost_verifies_to_the_bit(tmp_path: Path, acts):
    def resume(live: Live) -> None:
        live.pause(False)

    path = recorded(tmp_path / "a.mcap", *acts, resume, 1.0)
    verification = verify(path)
    assert verification.complete
    assert verification.identical
    with Recording.open(path) as recording:
        assert [event.equal_cost for _, event in recording.events if event.kind == "set_h"][:1] == [True]


@pytest.mark.parametrize(("h", "acts"), [(0.05, "n"), (1e-9, "n--r"), (100.0, "n"), (60.0, "nr")])
def test_a_step_that_is_absurd_for_one_of_the_methods_is_refused_before_anything_changes(h: float, acts: str):
    lab = Driver(Live(Scene(h=h)))
    refusals: list[str] = []
    lab.notify = lambda message, **_: refusals.append(message)
    actions = {
        "n": lab.action_equal_cost,
        "-": lambda: lab.action_larger_h(-1),
        "r": lab.action_restart,
    }
    for act in acts:
        actions[act]()
    runs = lab.live.sample.run
    lab.start(Scene(h=100.0))
    assert lab.live.sample.run == runs + (not lab.live.stepping.equal_cost)
    assert bool(refusals) == (lab.live.stepping.equal_cost or h == 100.0)
