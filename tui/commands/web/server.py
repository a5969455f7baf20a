"""textual-serve with limits and access checks."""

import asyncio
import ipaddress
import logging
import pickle
import re
import signal
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web
from textual_serve.server import Server
from yarl import URL

from pendu_tui.recordings.system import ENDING, shell_command

CONNECTIONS_PER_LAB = 10  # browsers open six
FONT_SERVER = re.compile(r"<link[^>]*fonts\.googleapis[^>]*>")
POLICY = "default-src 'self' 'unsafe-inline' data: ws: wss:; frame-ancestors 'none'"


class LabServer(Server):  # type: ignore[misc]
    """Serves a limited number of labs, to its own pages only."""

    def __init__(self, settings_file: str, max_labs: int, host: str) -> None:
        served = [sys.executable, "-P", "-m", "pendu_tui.tui.commands.web.served", settings_file]
        super().__init__(shell_command(served), host, title="pendu-tui")
        self._max_labs = max_labs
        self._labs = 0

    async def run(self, port: int, listening: Callable[[str], None]) -> None:
        """Serve until a signal, and call `listening` with the address.  Raises OSError."""
        logging.disable()  # any client can cause harmless errors
        loop = asyncio.get_running_loop()
        stop = asyncio.Event()
        for number in ENDING:
            signal.signal(number, lambda *_: loop.call_soon_threadsafe(stop.set))
        app = await self._make_app()
        app.middlewares.append(self.check)
        app.on_response_prepare.append(add_policy)
        runner = web.AppRunner(app, keepalive_timeout=3.0, shutdown_timeout=1.0)  # s
        await runner.setup()

        def connect() -> Any:
            connection = runner.server()
            if len(runner.server.connections) >= CONNECTIONS_PER_LAB * self._max_labs:
                loop.call_later(0, connection.force_close)
            return connection

        try:
            listener = await loop.create_server(connect, self.host, port)
            address, port = listener.sockets[0].getsockname()[:2]
            listening(str(URL.build(scheme="http", host=address, port=port)))
            await stop.wait()
            listener.close()
        finally:
            await runner.cleanup()

    async def on_startup(self, app: web.Application) -> None:
        """Print nothing."""

    @web.middleware  # type: ignore[untyped-decorator]
    async def check(self, request: web.Request, handler: Any) -> Any:
        """Refuse other names of this host, foreign pages, and labs above the limit."""
        pages = f"http://{request.host}", f"https://{request.host}"
        if not is_ours(request.host, self.host):
            raise web.HTTPMisdirectedRequest(text="Wrong address.\n")
        if request.headers.get("Origin", pages[0]) not in pages:
            raise web.HTTPForbidden(text="Wrong page.\n")
        if self._labs >= self._max_labs and request.path in ("/", "/ws"):
            raise web.HTTPServiceUnavailable(text="All labs are in use; reload later.\n")
        self.public_url = f"{request.scheme}://{request.host}"
        response = await handler(request)
        if isinstance(response, web.Response) and response.content_type == "text/html":
            response.text = FONT_SERVER.sub("", response.text or "")
        return response

    async def _process_messages(self, websocket: web.WebSocketResponse, app_service: Any) -> None:
        """End the lab when its tab closes, even while it is writing."""
        lab = app_service._process
        try:
            await super()._process_messages(websocket, app_service)
        finally:
            with suppress(ProcessLookupError):
                lab.terminate()
            await lab.wait()

    async def handle_websocket(self, request: web.Request) -> web.WebSocketResponse:
        self._labs += 1
        try:
            return await super().handle_websocket(request)
        finally:
            self._labs -= 1


def serve(
    settings: object, host: str, port: int, max_labs: int, listening: Callable[[str], None]
) -> None:
    with tempfile.TemporaryDirectory(prefix="pendu-") as folder:  # mode 700
        file = Path(folder, "settings")
        file.write_bytes(pickle.dumps(settings))
        asyncio.run(LabServer(str(file), max_labs, host).run(port, listening))


def is_ours(authority: str, host: str) -> bool:
    """Return whether host:port is an address, localhost or `host`, which nobody can rebind."""
    try:
        name = urlsplit(f"//{authority}").hostname or ""
        return name in ("localhost", host) or bool(ipaddress.ip_address(name))
    except ValueError:
        return False


async def add_policy(request: web.Request, response: web.StreamResponse) -> None:
    response.headers["Content-Security-Policy"] = POLICY
