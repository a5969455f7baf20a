"""Equal cost in the lab: RK4 takes a step four times as long, and that is recorded like any change."""

from pathlib import Path

import pytest

from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.playback.live import Live
from tests.tui.harness import lab, recorded


def toggle(live: Live) -> None:
    live.change(live.stepping.toggled())


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


@pytest.mark.parametrize(("h", "keys"), [(0.05, "n"), (1e-9, "n-r"), (60.0, "nr")])
async def test_a_step_that_is_absurd_for_a_method_is_refused_before_anything_changes(h, keys):
    async with lab(Scene(h=h)) as theatre:
        await theatre.press(*keys)
        runs = theatre.source.sample.run
        await theatre.stage.start(Scene(h=100.0))
        await theatre.pilot.pause()
        equal_cost = theatre.source.stepping.equal_cost
        assert theatre.source.sample.run == runs + (not equal_cost)
        refused = [each for each in theatre.app._notifications if "not a usable" in each.message]
        assert bool(refused) == equal_cost
