"""`serve`, by way of the websocket that a browser would open."""

import asyncio
import os
import signal
import subprocess
import sys
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import pyte
import pytest

from engine.scenes import SCENES
from recordings.verification import verify
from tests.tui.command_line import pendu
from tests.tui.pty_lab import PENDU
from tui.terminal.options import TerminalOptions

aiohttp = pytest.importorskip("aiohttp", reason="the extra web is not installed")
pytest.importorskip("textual_serve", reason="the extra web is not installed")

PATIENCE = 50.0  # s, on a busy machine
CTRL_P, CTRL_Z, ESCAPE, ENTER = "\x10", "\x1a", "\x1b", "\r"


class Tab:
    """A terminal behind a websocket, as in a browser's tab."""

    def __init__(self, socket, size=(100, 30)) -> None:
        self.socket = socket
        self.screen = pyte.Screen(*size)
        self._stream = pyte.ByteStream(self.screen)

    @property
    def text(self) -> str:
        return "\n".join(line.rstrip() for line in self.screen.display)

    async def until(self, right) -> str:
        """Read until the screen is right."""
        async with asyncio.timeout(PATIENCE):
            while not right(self.text):
                message = await self.socket.receive()
                assert message.type == aiohttp.WSMsgType.BINARY, message
                self._stream.feed(message.data)
        return self.text

    async def shows(self, *words: str) -> str:
        return await self.until(lambda text: all(word in text for word in words))

    async def press(self, keys: str) -> None:
        await self.socket.send_json(["stdin", keys])

    async def closed(self) -> bool:
        """Wait until the server closes it."""
        async with asyncio.timeout(PATIENCE):
            async for _ in self.socket:
                pass
        return self.socket.closed


class Server:
    """A running server."""

    def __init__(self, process: subprocess.Popen[str], address: str) -> None:
        self.process, self.address = process, address

    @asynccontextmanager
    async def tab(self, size=(100, 30)):
        columns, rows = size
        async with aiohttp.ClientSession() as session:
            url = f"{self.address}/ws?width={columns}&height={rows}"
            async with session.ws_connect(url, max_msg_size=0) as socket:
                yield Tab(socket, size)

    @property
    def labs(self) -> list[int]:
        """The processes that it has started."""
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        return [int(child) for child in children]

    async def until_labs(self, count: int) -> None:
        async with asyncio.timeout(PATIENCE):
            while len(self.labs) != count:
                await asyncio.sleep(0.05)


@contextmanager
def serving(*arguments: str, **environment: str):
    process = subprocess.Popen(
        [*PENDU, "serve", "--port", "0", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **environment},
    )
    try:
        line = process.stdout.readline()
        assert line.startswith("http://"), process.stderr.read()
        yield Server(process, line.split()[0])
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """An empty folder."""
    return tmp_path_factory.mktemp("library")


@pytest.fixture(scope="module")
def server(library):
    """A server whose library is empty.  Each test waits until its labs have ended."""
    with serving(PENDU_RECORDINGS=str(library)) as running:
        yield running


@pytest.fixture(autouse=True)
async def no_labs_left(request):
    yield
    if "server" in request.fixturenames:
        await request.getfixturevalue("server").until_labs(0)


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.rglob("*") if path.is_file())


async def test_a_tab_shows_the_lab_in_its_size_and_takes_keys(server):
    async with server.tab() as tab:
        await tab.shows("LIVE", "scene drift", "not recorded", "RK4")
        await tab.press("p")
        await tab.until(lambda text: "scene drift" not in text)
        await tab.press(" ")
        await tab.shows("paused")


async def test_a_tab_that_is_resized_gets_a_lab_that_fits(server):
    async with server.tab() as tab:
        await tab.shows("LIVE", "RK4")
        tab.screen.resize(45, 140)
        tab.screen.erase_in_display(2)
        await tab.socket.send_json(["resize", {"width": 140, "height": 45}])
        await tab.until(lambda text: max(map(len, text.splitlines())) == 140 and "Phase space" in text)


async def test_a_closed_tab_ends_its_process_and_only_its(server):
    async with server.tab() as first:
        async with server.tab() as second:
            await asyncio.gather(first.shows("LIVE"), second.shows("LIVE"))
            await server.until_labs(2)
        await server.until_labs(1)
        await first.press("p")
        await first.until(lambda text: "scene drift" not in text)
    await server.until_labs(0)


async def test_a_lab_that_is_quit_closes_its_tab(server):
    async with server.tab() as tab:
        await tab.shows("LIVE")
        await tab.press("q")
        assert await tab.closed()
    await server.until_labs(0)


async def test_a_lab_that_dies_closes_its_tab(server):
    async with server.tab() as tab:
        await tab.shows("LIVE")
        os.kill(server.labs[0], signal.SIGKILL)
        assert await tab.closed()


async def test_labs_beyond_the_limit_are_refused_until_one_is_closed():
    with serving("--at-most", "1") as server:
        async with aiohttp.ClientSession() as session:
            async with server.tab() as tab:
                await tab.shows("LIVE")
                async with session.get(server.address) as page:
                    assert (page.status, "1 labs are open" in await page.text()) == (503, True)
                with pytest.raises(aiohttp.WSServerHandshakeError, match="503"):
                    await session.ws_connect(f"{server.address}/ws")
            await server.until_labs(0)
            async with session.get(server.address) as page:
                assert page.status == 200


async def test_nothing_in_it_writes_or_reads_a_file_by_name(server, library):
    async with server.tab() as tab:
        await tab.shows("LIVE")
        await tab.press("s" + CTRL_Z)
        await tab.press("?")
        help_text = await tab.shows("╭─ Help")
        await tab.press(ESCAPE)
        await tab.until(lambda text: "╭─ Help" not in text)  # a key right after Esc would be Alt with that key
        for word in ("screenshot", "replay", "suspend"):
            await tab.press(CTRL_P)
            await tab.shows("Search")
            await tab.press(word)
            await tab.shows("No matches found")
            await tab.press(ESCAPE)
            await tab.until(lambda text: "Search" not in text and "No matches" not in text)
        await tab.press("p")
        await tab.until(lambda text: "scene drift" not in text)  # it was not stopped
    assert not any(word in help_text for word in ("screenshot", "ctrl+z"))
    assert files(library) == []


async def test_recording_is_off_unless_asked_for_and_then_in_its_folder(tmp_path):
    folder = tmp_path / "recorded"
    with serving("--record", str(folder), "--scene", "spin", PENDU_RECORDINGS=str(tmp_path / "library")) as server:
        async with server.tab() as one, server.tab() as other:
            await asyncio.gather(one.shows("scene spin", "RK4"), other.shows("scene spin", "RK4"))
            await asyncio.sleep(1)
        await server.until_labs(0)
    assert len(files(tmp_path)) == len(files(folder)) == 2
    for name in files(folder):
        result = verify(folder / name)
        assert result.complete
        assert result.identical


class Heard:
    """What of a browser's words reaches the lab, or goes back to the browser."""

    def __init__(self) -> None:
        self.words: list[object] = []

    async def hear(self, *words: object) -> None:
        self.words.extend(words)

    send_bytes = set_terminal_size = focus = blur = send_json = hear


@pytest.mark.parametrize(
    ("said", "heard"),
    [
        ('["stdin", "p"]', [b"p"]),
        ('["stdin", "\\ud800"]', [b"?"]),
        ('["resize", {"width": 80, "height": 24}]', [80, 24]),
        ('["resize", {"width": 1000000000, "height": -5}]', [400, 1]),
        ('["resize", {"width": "x", "height": 1e999}]', [80, 24]),
        ('["ping", "1"]', [["pong", "1"]]),
        ('["focus"]', []),
    ],
)
async def test_the_messages_of_a_terminal_are_passed_on_with_sane_sizes(said, heard):
    from tui.commands.lab.web.server import passed_on

    ears = Heard()
    assert await passed_on(said, ears, ears)
    assert ears.words == heard


@pytest.mark.parametrize(
    "said",
    ["no json", "[]", '["stdin", 1]', '["resize", {"width": 1}]', '["run", "ls"]', '{"a": 1}', "3", "[" * 10_000],
)
async def test_any_other_message_is_refused(said):
    from tui.commands.lab.web.server import passed_on

    ears = Heard()
    assert not await passed_on(said, ears, ears)
    assert ears.words == []


async def test_a_message_that_is_not_a_terminals_closes_the_tab(server):
    async with server.tab() as tab:
        await tab.shows("LIVE")
        await tab.socket.send_str("no json")
        assert await tab.closed()


async def test_a_page_of_another_server_gets_no_lab(server):
    async with aiohttp.ClientSession() as session:
        with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
            await session.ws_connect(f"{server.address}/ws", origin="http://elsewhere.example")
        async with session.ws_connect(f"{server.address}/ws", origin=server.address) as socket:
            await Tab(socket, (80, 24)).shows("LIVE")


async def test_the_page_loads_nothing_from_other_hosts(server):
    async with aiohttp.ClientSession() as session:
        async with session.get(server.address) as page:
            text = await page.text()
        assert f"ws://{server.address.removeprefix('http://')}/ws" in text
        assert "https:" not in text
        for name in ("js/textual.js", "css/xterm.css", "fonts/RobotoMono-VariableFont_wght.ttf"):
            assert f"/static/{name}" in text
            async with session.get(f"{server.address}/static/{name}") as part:
                assert part.status == 200
        async with session.get(f"{server.address}/static/../server.py") as outside:
            assert outside.status == 404


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
async def test_a_signal_ends_the_server_and_its_labs(number):
    with serving() as server:
        async with server.tab() as tab:
            await tab.shows("LIVE")
            (lab,) = server.labs
            server.process.send_signal(number)
            assert await tab.closed()
            assert await asyncio.to_thread(server.process.wait, PATIENCE) == 0
    assert not Path(f"/proc/{lab}").exists()


async def test_a_lab_ends_when_its_server_was_killed():
    with serving() as server:
        async with server.tab() as tab:
            await tab.shows("LIVE")
            await tab.press(" ")
            await tab.shows("paused")
            (lab,) = server.labs
            server.process.kill()
            async with asyncio.timeout(PATIENCE):
                while Path(f"/proc/{lab}").exists() and "State:\tZ" not in Path(f"/proc/{lab}/status").read_text():
                    await asyncio.sleep(0.1)


def test_only_another_address_says_what_is_exposed():
    with serving("--host", "0.0.0.0") as server:
        server.process.terminate()
        _, said = server.process.communicate(timeout=PATIENCE)
    assert said.count("\n") == 1
    assert "without a password" in said
    with serving() as server:
        assert server.address.startswith("http://127.0.0.1:")
        server.process.terminate()
        assert server.process.communicate(timeout=PATIENCE)[1] == ""


def test_what_cannot_be_served_is_one_sentence(server, tmp_path, monkeypatch):
    taken = server.address.rpartition(":")[2]
    assert pendu("serve", "--port", taken).refused(2, "cannot listen", taken, "--port")
    assert pendu("serve", "--host", "no.such.host.invalid").refused(2, "cannot listen", "--host")
    assert pendu("serve", "--port", "70000").refused(2, "70000")
    assert pendu("serve", "--at-most", "0").refused(2, "count")
    (tmp_path / "file").touch()
    assert pendu("serve", "--record", tmp_path / "file").refused(5, "is a file")
    assert pendu("serve", "--record", tmp_path / "no" / "folder").refused(5, "create the folder")
    monkeypatch.setitem(sys.modules, "textual_serve", None)
    monkeypatch.delitem(sys.modules, "tui.commands.lab.web.server", raising=False)
    assert pendu("serve").refused(2, "pip install textual-serve")


def test_settings_survive_the_way_to_the_lab():
    from tui.commands.lab.web.server import Settings

    for folder in (None, Path("/somewhere/ours")):
        settings = Settings(SCENES["spin"].altered(theta=1 / 3), TerminalOptions(theme="light"), folder)
        assert Settings.from_text(settings.as_text()) == settings
