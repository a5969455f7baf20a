"""`pendu-tui serve`: which requests it answers, the lab of a tab, and the tabs of a real server."""

import argparse
import asyncio
import logging
import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import AsyncMock, Mock

import aiohttp
import pyte
import pytest
from aiohttp import web

from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.commands import serve, served
from pendu_tui.tui.terminal.options import TerminalOptions
from tests.tui.command_line import IS_WINDOWS, PENDU, own_method, pendu

OURS = "127.0.0.1:8000"


def server_at(host: str) -> serve.LabServer:
    options = argparse.Namespace(host=host, port=0, at_most=2)
    return serve.LabServer(Path("settings"), options)


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
    server = server_at("127.0.0.1")
    server._labs = labs
    headers = {"Origin": origin} if origin else {}
    request = SimpleNamespace(path=path, host=host, headers=headers)

    async def handler(request):
        return "a page"

    if refusal is None:
        assert await server.check(request, handler) == "a page"
        return
    with pytest.raises(getattr(web, refusal)):
        await server.check(request, handler)


@pytest.mark.parametrize(("host", "warning"), [("127.0.0.1", ""), ("0.0.0.0", "0.0.0.0 can open")])
async def test_its_pages_are_where_it_says_and_load_nothing_from_elsewhere(
    host, warning, monkeypatch
):
    handlers = {}
    warned = []
    monkeypatch.setattr(logging.root.manager, "disable", 0)
    monkeypatch.setattr(serve, "warn", warned.append)
    monkeypatch.setattr(serve, "print", printed := Mock(), raising=False)
    monkeypatch.setattr(serve.signal, "signal", handlers.__setitem__)
    server = server_at(host)
    lab = f"{sys.executable} -P -m pendu_tui.tui.commands.served settings"
    assert server.command.endswith(lab)
    running = asyncio.create_task(server.run())
    async with asyncio.timeout(50):
        while not (printed.called or running.done()):
            await asyncio.sleep(0.01)
    (told,), more = printed.call_args
    address, _, limits = told.partition(" ")
    assert (address[:-5], limits) == (f"http://{host}:", "serves up to 2 labs; Ctrl+C ends it.")
    assert more == {"flush": True}
    assert warning in "".join(warned)
    assert len(warned) == bool(warning)
    texts = []
    for name in (address[7:], "elsewhere.example"):
        async with aiohttp.request("GET", address, headers={"Host": name}) as page:
            texts.append(await page.text())
            policy = page.headers["Content-Security-Policy"]
            assert ("http" in policy, "frame-ancestors 'none'" in policy) == (False, True)
    assert texts[1] == "Wrong address.\n"
    assert ">pendu-tui<" in texts[0]
    assert f'"ws{address[4:]}/ws"' in texts[0]
    assert logging.root.manager.disable
    assert [*handlers] == serve.ENDING
    handlers[signal.SIGTERM]()
    await asyncio.wait_for(running, 50)
    with pytest.raises(aiohttp.ClientError):
        async with aiohttp.request("GET", address):
            pass


async def test_the_lab_of_a_tab_that_closes_ends_and_is_free_again(monkeypatch):
    server = server_at("127.0.0.1")
    labs = []

    async def cut(*_):
        labs.append(server._labs)
        raise ConnectionResetError

    monkeypatch.setattr(serve.Server, "handle_websocket", cut)
    monkeypatch.setattr(serve.Server, "_process_messages", cut)
    lab = SimpleNamespace(terminate=Mock(side_effect=ProcessLookupError), wait=AsyncMock())
    service = SimpleNamespace(_process=lab)
    for call in (server.handle_websocket(None), server._process_messages(None, service)):
        with pytest.raises(ConnectionResetError):
            await call
    assert labs == [1, 0]
    assert (lab.terminate.call_count, lab.wait.await_count) == (1, 1)


def test_what_cannot_be_served_is_one_sentence(tmp_path, monkeypatch):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        said = pendu("serve", "--port", port)
    assert said.refused(2, f"cannot listen on 127.0.0.1 port {port}: ", "--port")
    assert "[Errno" not in said.err
    assert pendu("serve", "--record", tmp_path / "no" / "folder").refused(5, "No such file")
    with monkeypatch.context() as patch:
        patch.setattr(os, "access", lambda *_: False)
        patch.setattr(serve, "LabServer", None)
        assert pendu("serve", "--record", tmp_path, "--port", port).refused(5, "not writable")
    monkeypatch.setitem(sys.modules, "textual_serve.server", None)
    monkeypatch.delitem(sys.modules, "pendu_tui.tui.commands.serve", raising=False)
    assert pendu("serve").refused(2, "install", "serve needs")


def test_each_tab_is_told_the_scene_its_look_and_a_folder_that_is_made(here, monkeypatch):
    told = []

    class Server:
        def __init__(self, settings, options):
            assert IS_WINDOWS or settings.parent.stat().st_mode & 0o777 == 0o700
            told.append((*pickle.loads(settings.read_bytes()), settings))

        async def run(self):
            if len(told) > 2:
                raise OverflowError("no such port.")

    monkeypatch.setattr(serve, "LabServer", Server)
    own = ("--methods", "rk4", "--method", own_method(here))
    line = ("serve", "spin", *own, "--theme", "light", "--record", "folder", "--port", 0)
    assert [pendu(*line).code for _ in range(2)] == [130, 130]
    scene, look, folder, settings = told[0]
    assert [method.key for method in scene.cast] == ["rk4", "mine"]
    assert (scene.name, look, folder) == ("spin", TerminalOptions("light"), here / "folder")
    assert not settings.exists()
    assert pendu(*line).refused(2, "cannot listen on 127.0.0.1 port 0: no such port; use")


def test_of_a_flood_of_sizes_a_tab_gets_the_last_and_that_of_a_terminal_at_most(monkeypatch):
    told, waiting = [], []
    monkeypatch.setattr(served.WebDriver, "on_meta", lambda self, *packet: told.append(packet))
    driver = object.__new__(served.BoundedDriver)
    driver._loop = SimpleNamespace(
        call_soon_threadsafe=lambda soon, *arguments: soon(*arguments),
        call_later=lambda *later: waiting.append(later),
    )
    for width in (80, 90, 1e9):
        driver.on_meta("resize", {"width": width, "height": -3})
    driver.on_meta("focus", {})
    ((seconds, resize),) = waiting
    assert seconds == 0.2
    resize()
    assert told == [("focus", {}), ("resize", {"width": 400, "height": 1})]
    driver.on_meta("resize", {"width": 80, "height": 24})
    assert len(waiting) == 2


def test_a_recording_is_finished_before_the_server_ends_its_lab(monkeypatch):
    told = []
    monkeypatch.setattr(served.WebDriver, "stop_application_mode", lambda _: told.append("end"))
    driver = object.__new__(served.BoundedDriver)
    driver._app = SimpleNamespace(finish=lambda: told.append("finish"))
    driver.stop_application_mode()
    assert told == ["finish", "end"]


def test_the_lab_of_a_tab_has_the_size_that_is_asked_for_and_may_record(tmp_path, monkeypatch):
    file = tmp_path / "settings"
    folder = tmp_path / "folder"
    look = TerminalOptions("light")
    monkeypatch.setattr(sys, "argv", ["served", str(file)])
    monkeypatch.setenv("PENDU_RECORDINGS", str(folder))

    class App:
        def __init__(self, screen, terminal):
            assert (screen.source.scene, terminal) == (SCENES["spin"], look)
            self.screen = screen

        def run(self):
            assert self.driver_class is served.BoundedDriver
            assert (os.environ["COLUMNS"], os.environ["ROWS"]) == ("400", "24")
            if self.screen.record:
                self.screen.record(self.screen.source)

    monkeypatch.setattr(served, "PenduApp", App)
    for recorded in (folder, None):
        monkeypatch.setenv("COLUMNS", "1000")
        monkeypatch.setenv("ROWS", "24")
        file.write_bytes(pickle.dumps((SCENES["spin"], look, recorded)))
        served.main()
    assert [path.suffix for path in folder.iterdir()] == [".mcap"]  # and no .part


PATIENCE = 50.0  # s, on a busy machine
CTRL_Z = "\x1a"
needs_proc = pytest.mark.skipif(not Path("/proc").is_dir(), reason="counts labs in /proc")


class Tab:
    def __init__(self, socket, size) -> None:
        self.socket = socket
        self.screen = pyte.Screen(*size)
        self._stream = pyte.ByteStream(self.screen)

    @property
    def text(self) -> str:
        return "\n".join(line.rstrip() for line in self.screen.display)

    async def until(self, right) -> None:
        async with asyncio.timeout(PATIENCE):
            while not right(self.text):
                message = await self.socket.receive()
                assert message.type == aiohttp.WSMsgType.BINARY, message
                self._stream.feed(message.data)

    async def shows(self, *words: str) -> None:
        await self.until(lambda text: all(word in text for word in words))

    async def press(self, keys: str) -> None:
        await self.socket.send_json(["stdin", keys])

    async def closed(self) -> bool:
        async with asyncio.timeout(PATIENCE):
            async for _ in self.socket:
                pass
        return self.socket.closed


class Server:
    def __init__(self, process, address) -> None:
        self.process = process
        self.address = address

    @asynccontextmanager
    async def tab(self, size=(100, 30)):
        url = "{}/ws?width={}&height={}".format(self.address, *size)
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(url, max_msg_size=0) as socket,
        ):
            yield Tab(socket, size)

    @property
    def labs(self) -> list[str]:
        pid = self.process.pid
        return Path(f"/proc/{pid}/task/{pid}/children").read_text().split()

    async def status(self) -> int:
        async with aiohttp.request("GET", self.address) as page:
            return page.status

    async def until_labs(self, count: int) -> None:
        async with asyncio.timeout(PATIENCE):
            while len(self.labs) != count:
                await asyncio.sleep(0.05)


@contextmanager
def serving(*arguments: str, **environment: str):
    command = [*PENDU, "serve", "--port", "0", *arguments]
    env = {**os.environ, **environment}
    pipe = subprocess.PIPE
    process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, env=env)
    late = threading.Timer(PATIENCE, process.kill)
    late.start()
    try:
        line = process.stdout.readline()
        late.cancel()
        assert line.startswith("http://"), process.stderr.read()
        yield Server(process, line.split()[0])
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)


@needs_proc
async def test_so_many_tabs_take_keys_and_record_even_if_cut_off_under_a_flood_of_them(
    tmp_path,
):
    folder = tmp_path / "recorded"
    options = ("--record", str(folder), "--scene", "spin", "--at-most", "2")
    with serving(*options, PENDU_RECORDINGS=str(tmp_path / "library")) as server:
        async with server.tab((120, 40)) as one, server.tab() as other:
            await asyncio.gather(*(tab.shows("scene spin", "REC ") for tab in (one, other)))
            assert await server.status() == 503
            await other.press("s" + CTRL_Z)
            await other.press("p")
            await other.until(lambda text: "scene spin" not in text)  # it was not stopped
            await other.press("q")
            assert await other.closed()
            await server.until_labs(1)
            for _ in range(300):
                await one.press("v+-bpr .,")
            one.socket._response.connection.transport.abort()
        await server.until_labs(0)
        assert await server.status() == 200
    results = map(verify, folder.iterdir())
    assert [(each.complete, each.identical) for each in results] == [(True, True)] * 2
    assert list(tmp_path.iterdir()) == [folder]


@needs_proc
@pytest.mark.slow
@pytest.mark.parametrize("name", ["SIGINT", "SIGKILL"])
async def test_a_signal_ends_the_server_and_its_labs(name):
    number = getattr(signal, name)
    with serving() as server:
        async with server.tab() as tab:
            await tab.shows("LIVE")
            (lab,) = server.labs
            server.process.send_signal(number)
            code = await asyncio.to_thread(server.process.wait, PATIENCE)
            assert code == (-number if name == "SIGKILL" else 130)
            status = Path(f"/proc/{lab}/status")
            async with asyncio.timeout(PATIENCE):
                while status.exists() and "State:\tZ" not in status.read_text():
                    await asyncio.sleep(0.1)
