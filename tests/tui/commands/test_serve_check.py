"""Which requests `pendu-tui serve` answers."""

import argparse
from pathlib import Path
from types import SimpleNamespace

import pytest
from aiohttp import web

from pendu_tui.tui.commands import serve

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
