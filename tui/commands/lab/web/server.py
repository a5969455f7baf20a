"""The server: a page, and for each tab a websocket and a process with a lab.  Closing one ends the other."""

import asyncio
import json
import pickle
import shlex
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import textual_serve
from aiohttp import WSMsgType, web
from textual_serve.app_service import AppService
from textual_serve.download_manager import DownloadManager

from engine.scenes import Scene
from tui.commands.lab.web.page import full_text, lab_page
from tui.terminal.options import LARGEST, TerminalOptions

STATIC = Path(textual_serve.__file__).parent / "static"
PROGRAM = "import sys; from tui.commands.lab.web.served import main; main(sys.argv[1])"
PATIENCE = 5.0  # s that a lab has to finish its recording
HEARTBEAT = 10.0  # s; a browser that does not answer within half of it is gone
LONGEST = 1 << 16  # bytes of a message from a browser
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@dataclass(frozen=True, slots=True)
class Settings:
    """What each lab that is served is like."""

    scene: Scene
    terminal: TerminalOptions
    folder: Path | None  # of recordings

    def as_text(self) -> str:
        """For a process of ours, and for nobody else: it may hold code."""
        return pickle.dumps(self).hex()

    @classmethod
    def from_text(cls, text: str) -> "Settings":
        settings: Settings = pickle.loads(bytes.fromhex(text))
        return settings


class Server:
    """Serves labs to at most so many tabs at once."""

    def __init__(self, settings: Settings, most: int) -> None:
        command = [sys.executable, "-P", "-c", PROGRAM, settings.as_text()]
        self._command = f"exec {shlex.join(command)}"  # no shell stays between
        self._most = most
        self._open: set[web.WebSocketResponse] = set()
        self._count = 0

    async def run(self, host: str, port: int, listening: Callable[[str], None]) -> None:
        """Serve until a signal asks for an end; `listening` gets the address.  Raises OSError if it cannot listen."""
        app = web.Application()
        app.add_routes([web.get("/", self._page), web.get("/ws", self._lab), web.static("/static", STATIC)])
        app.on_shutdown.append(self._close_all)
        runner = web.AppRunner(app, access_log=None, shutdown_timeout=PATIENCE)
        await runner.setup()
        stop = asyncio.Event()
        for number in SIGNALS:
            asyncio.get_running_loop().add_signal_handler(number, stop.set)
        try:
            await web.TCPSite(runner, host, port).start()
            bound = runner.addresses[0]
            listening(f"http://{f'[{bound[0]}]' if ':' in bound[0] else bound[0]}:{bound[1]}")
            await stop.wait()
        finally:
            await runner.cleanup()

    async def _close_all(self, _: web.Application) -> None:
        await asyncio.gather(*(socket.close() for socket in self._open))

    async def _page(self, request: web.Request) -> web.Response:
        if self._count >= self._most:
            return web.Response(status=503, text=full_text(self._most))
        scheme = "wss" if request.scheme == "https" else "ws"
        return web.Response(text=lab_page(f"{scheme}://{request.host}"), content_type="text/html")

    async def _lab(self, request: web.Request) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != request.host:
            return web.Response(status=403, text="This page belongs to another server.\n")
        if self._count >= self._most:
            return web.Response(status=503, text=full_text(self._most))
        self._count += 1
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT, max_msg_size=LONGEST)
        try:
            await socket.prepare(request)
            self._open.add(socket)
            await self._show(socket, _size(request.query.get("width"), request.query.get("height")))
        finally:
            self._open.discard(socket)
            self._count -= 1
        return socket

    async def _show(self, socket: web.WebSocketResponse, size: tuple[int, int]) -> None:
        lab = AppService(
            self._command,
            write_bytes=socket.send_bytes,
            write_str=socket.send_str,
            close=socket.close,
            download_manager=DownloadManager(),
        )
        await lab.start(*size)
        watch = asyncio.create_task(_close_after(lab, socket))
        try:
            async for message in socket:
                if message.type != WSMsgType.TEXT or not await passed_on(message.data, socket, lab):
                    break
        finally:
            watch.cancel()
            await asyncio.shield(_ended(lab))


async def _close_after(lab: AppService, socket: web.WebSocketResponse) -> None:
    """Close the websocket when the lab has ended, in whatever way."""
    if lab._task is not None:
        await asyncio.wait([lab._task])
    await socket.close()


async def passed_on(text: str, socket: web.WebSocketResponse, lab: AppService) -> bool:
    """Do what the browser says; whether it is one of the few things that a terminal can say."""
    try:
        kind, *values = json.loads(text)
    except (ValueError, TypeError, RecursionError):
        return False
    match kind, values:
        case "stdin", [str(keys)]:
            await lab.send_bytes(keys.encode(errors="replace"))
        case "resize", [{"width": width, "height": height}]:
            await lab.set_terminal_size(*_size(width, height))
        case "ping", [str(sent)]:
            await socket.send_json(["pong", sent])
        case (("focus" | "blur"), _):
            await (lab.focus() if kind == "focus" else lab.blur())
        case _:
            return False
    return True


def _size(width: Any, height: Any) -> tuple[int, int]:
    """Columns and rows within reason, whatever the browser says."""
    try:
        return min(max(int(width), 1), LARGEST[0]), min(max(int(height), 1), LARGEST[1])
    except (ValueError, TypeError, OverflowError):
        return 80, 24


async def _ended(lab: AppService) -> None:
    """End a lab's process: by asking, else by force."""
    process = lab._process
    with suppress(TimeoutError, ConnectionError):
        await asyncio.wait_for(lab.stop(), PATIENCE)
    if process is not None:
        try:
            await asyncio.wait_for(process.communicate(), PATIENCE)  # it may still have something to write
        except TimeoutError:
            process.kill()
            await process.wait()
