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


real = background.computed


async def killed():
    async for process in real(os_pid):
        kill(process, 9)


async def faulty():
    raise ZeroDivisionError("why")


@pytest.mark.other_process
@pytest.mark.parametrize(
    ("fails", "words", "keys"),
    [
        (killed, "was stopped.", ("f2", key_of(VIEW))),
        (faulty, "This view cannot be computed: ZeroDivisionError: why.", ("asterisk",)),
    ],
)
async def test_a_view_whose_process_fails_says_so_and_computes_when_asked_again(
    fails, words, keys, monkeypatch
):
    asked = []

    async def once(function, *arguments):
        asked.append(function)
        if len(asked) == 1:
            await fails()
        for nothing in ():
            yield nothing

    monkeypatch.setattr("pendu_tui.tui.views.background.computed", once)
    async with lab() as theatre:
        await theatre.press(key_of(VIEW))
        pane = theatre.pane(f"#{VIEW}").panes[0]
        await until(theatre.pilot, lambda: pane.failure and len(asked) == 2)  # also for its own h
        await theatre.run(1)
        assert f"{words} Open this view again to retry." in pane.text
        assert theatre.sample.t > 0.9
        await theatre.press(*keys)
        await until(theatre.pilot, lambda: len(asked) == 4)
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
        pane = theatre.pane(f"#{theatre.stage.view}").panes[0]
        await until(theatre.pilot, lambda: pane.failure)
        await theatre.run(1)
        assert "--method FILE.py:mine" in pane.text
        assert theatre.app.is_running
