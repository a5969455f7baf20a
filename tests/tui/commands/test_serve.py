import asyncio
import os
import signal
import subprocess
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import aiohttp
import pyte
import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.command_line import PENDU

if not Path("/proc").is_dir():
    pytest.skip("needs /proc, to count the labs", allow_module_level=True)

PATIENCE = 50.0  # s, on a busy machine
CTRL_Z = "\x1a"


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
    try:
        line = process.stdout.readline()
        assert line.startswith("http://"), process.stderr.read()
        yield Server(process, line.split()[0])
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE)


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
