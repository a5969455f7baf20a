"""Which requests `pendu-tui serve` answers."""

import argparse
import pickle
from pathlib import Path
from types import SimpleNamespace

import pytest
from aiohttp import web

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.commands import serve, served
from pendu_tui.tui.terminal.options import TerminalOptions
from tests.tui.command_line import pendu

OURS = "127.0.0.1:8000"


@pytest.mark.parametrize(
    ("path", "labs", "host", "origin", "refusal"),
    [
        ("/", 1, OURS, None, None),
        ("/ws", 1, "localhost:1", "http://localhost:1", None),
        ("/", 2, OURS, None, "HTTPServiceUnavailable"),
        ("/ws", 2, OURS, None, "HTTPServiceUnavailable"),
        ("/static/js/textual.js", 2, OURS, None, None),  # of the last lab
        ("/", 0, "rebound.example", None, "HTTPMisdirectedRequest"),
        ("/", 0, "[::1", None, "HTTPMisdirectedRequest"),
        ("/", 0, "[::1]:80", None, None),
        ("/", 0, OURS, "http://elsewhere.example", "HTTPForbidden"),
        ("/", 0, OURS, f"https://{OURS}", None),
    ],
)
async def test_a_lab_is_for_pages_of_this_computer_while_one_is_free(
    path, labs, host, origin, refusal
):
    options = argparse.Namespace(host="127.0.0.1", port=8000, at_most=2)
    server = serve.LabServer(Path("settings"), options)
    server._labs = labs
    headers = {"Origin": origin} if origin else {}
    request = SimpleNamespace(path=path, host=host, headers=headers, scheme="http")

    async def handler(request):
        return "a page"

    if refusal is None:
        assert await server.check(request, handler) == "a page"
        return
    with pytest.raises(getattr(web, refusal)):
        await server.check(request, handler)


def test_each_tab_is_told_the_scene_its_look_and_a_folder_that_is_made(tmp_path, monkeypatch):
    told = []

    class Server:
        def __init__(self, settings, options):
            told.append(pickle.loads(settings.read_bytes()))

        async def run(self):
            if len(told) > 2:
                raise OverflowError("no such port.")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(serve, "LabServer", Server)
    line = ("serve", "spin", "--theme", "light", "--record", "folder", "--port", 0)
    assert [pendu(*line).code for _ in range(2)] == [130, 130]
    assert told[0] == (SCENES["spin"], TerminalOptions("light"), tmp_path / "folder")
    assert pendu(*line).refused(2, "cannot listen on 127.0.0.1 port 0: no such port; use")


def test_of_a_flood_of_sizes_a_tab_gets_the_last_and_that_of_a_terminal_at_most(monkeypatch):
    told, waiting = [], []
    monkeypatch.setattr(served.WebDriver, "on_meta", lambda self, *packet: told.append(packet))
    driver = object.__new__(served.BoundedDriver)
    driver._loop = SimpleNamespace(
        call_soon_threadsafe=lambda soon, *arguments: soon(*arguments),
        call_later=lambda seconds, resize: waiting.append(resize),
    )
    for width in (80, 90, 1e9):
        driver.on_meta("resize", {"width": width, "height": -3})
    driver.on_meta("focus", {})
    for resize in waiting:
        resize()
    assert told == [("focus", {}), ("resize", {"width": 400, "height": 1})]
