"""A view that cannot compute says so in its pane, can be tried again, and the lab goes on."""

import os

import pytest

from pendu_tui.recordings.system import kill
from pendu_tui.tui.views import background
from tests.tui.command_line import own_method, pendu
from tests.tui.harness import key_of, lab, player, until

VIEW = "accuracy"


def os_pid():
    while True:
        yield os.getpid()


@pytest.mark.other_process
async def test_a_view_whose_process_is_killed_says_so_and_computes_when_it_is_shown_again(
    monkeypatch,
):
    real = background.computed

    async def killed_once(function, *arguments):
        monkeypatch.setattr("pendu_tui.tui.views.background.computed", real)
        async for process in real(os_pid):
            kill(process, 9)
        yield  # never reached, but it makes this a generator

    monkeypatch.setattr("pendu_tui.tui.views.background.computed", killed_once)
    async with lab() as theatre:
        await theatre.press(key_of(VIEW))
        pane = theatre.stage.query_one(f"#{VIEW}").pane
        await until(theatre.pilot, lambda: pane.failure)
        await theatre.run(1)
        assert "was ended. Open this view again" in pane.text
        assert theatre.source.sample.t > 0.9
        await theatre.press("f2", key_of(VIEW))
        await until(theatre.pilot, lambda: pane.is_computing)
        assert not pane.failure


@pytest.mark.other_process
@pytest.mark.parametrize("keys", [(key_of("stability"),), ("f3", "x")])
async def test_in_a_replay_of_somebodys_own_method_a_view_names_the_file_that_it_needs(
    keys, tmp_path
):
    path = tmp_path / "k.mcap"
    option = ("--method", own_method(tmp_path), "--methods", "mine")
    assert pendu("run", "--time", 8, *option, "--record", path).code == 0
    async with player(path) as theatre:
        await theatre.press(*keys)
        pane = theatre.stage.query_one(f"#{theatre.stage.view}").pane
        await until(theatre.pilot, lambda: pane.failure)
        await theatre.run(1)
        assert "--method FILE.py:mine" in pane.text
        assert theatre.app.is_running
