"""Show the lab in a browser, for a class without terminals; each tab gets its own lab.

This is textual-serve with limits and access checks.
"""

import argparse
import asyncio
import ipaddress
import logging
import pickle
import signal
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import urlsplit

from pendu_tui.recordings.files import check_target, new_path
from pendu_tui.recordings.system import ENDING, shell_command
from pendu_tui.tui.cli.errors import Exit, UserError, warn
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.terminal.options import terminal_options_of

try:
    from aiohttp import web
    from textual_serve.server import Server
    from yarl import URL
except ImportError:
    Server = object  # `run` refuses

THIS_COMPUTER = ("127.0.0.1", "::1", "localhost")
# Pages load nothing from elsewhere, such as textual-serve's fonts.
POLICY = "default-src 'self' 'unsafe-inline' data: ws: wss:; frame-ancestors 'none'"


def run(options: argparse.Namespace) -> int:
    if Server is object:
        raise UserError("serve needs an extra: install pendu-tui[web].")
    scene = scene_of(options)
    folder: Path | None = options.record
    if folder is not None:
        folder.mkdir(exist_ok=True)
        folder = folder.absolute()
        check_target(new_path(folder))
    settings = (scene, terminal_options_of(options, {}, "utf-8"), folder)
    try:
        with TemporaryDirectory(prefix="pendu-") as private:  # mode 700
            file = Path(private, "settings")
            file.write_bytes(pickle.dumps(settings))
            asyncio.run(LabServer(file, options).run())
    except (OSError, OverflowError, UnicodeError) as error:
        where = f"{options.host} port {options.port}"
        why = str(getattr(error, "strerror", None) or error).removesuffix(".")
        raise UserError(f"cannot listen on {where}: {why}; use another --port or --host.") from None
    return Exit.INTERRUPTED


class LabServer(Server):  # type: ignore[misc]
    """Serves a limited number of labs, to its own pages only."""

    def __init__(self, settings: Path, options: argparse.Namespace) -> None:
        lab = [sys.executable, "-P", "-m", "pendu_tui.tui.commands.served", str(settings)]
        super().__init__(shell_command(lab), options.host, options.port, title="pendu-tui")
        self._max_labs = options.at_most
        self._labs = 0

    async def run(self) -> None:
        """Serve until a signal.  Raises OSError."""
        logging.disable()  # any client can cause harmless errors
        loop = asyncio.get_running_loop()
        stop = asyncio.Event()
        for number in ENDING:
            signal.signal(number, lambda *_: loop.call_soon_threadsafe(stop.set))
        app = await self._make_app()
        app.middlewares.append(web.middleware(partial(self.check)))
        app.on_response_prepare.append(add_policy)
        runner = web.AppRunner(app, shutdown_timeout=1.0)  # s
        try:
            await runner.setup()
            await web.TCPSite(runner, self.host, self.port).start()
            host, port, *_ = runner.addresses[0]
            if self.host not in THIS_COMPUTER:
                warn(
                    f"anyone who can reach {self.host} can open labs on this computer, without a "
                    "password or encryption."
                )
            address = URL.build(scheme="http", host=host, port=port)
            print(f"{address} serves up to {self._max_labs} labs; Ctrl+C ends it.", flush=True)
            await stop.wait()
        finally:
            await runner.cleanup()

    async def on_startup(self, app: Any) -> None:
        """Print nothing."""

    async def check(self, request: Any, handler: Any) -> Any:
        """Refuse other names of this host, foreign pages, and labs above the limit."""
        pages = f"http://{request.host}", f"https://{request.host}"
        if not is_ours(request.host, self.host):
            raise web.HTTPMisdirectedRequest(text="Wrong address.\n")
        if request.headers.get("Origin", pages[0]) not in pages:
            raise web.HTTPForbidden(text="Wrong page.\n")
        if self._labs >= self._max_labs and request.path in ("/", "/ws"):
            raise web.HTTPServiceUnavailable(text="All labs are in use; reload later.\n")
        self.public_url = pages[0]
        return await handler(request)

    async def _process_messages(self, websocket: Any, app_service: Any) -> None:
        """End the lab when its tab closes, even while it is writing."""
        lab = app_service._process
        try:
            await super()._process_messages(websocket, app_service)
        finally:
            with suppress(ProcessLookupError):
                lab.terminate()
            await lab.wait()

    async def handle_websocket(self, request: Any) -> Any:
        self._labs += 1
        try:
            return await super().handle_websocket(request)
        finally:
            self._labs -= 1


def is_ours(authority: str, host: str) -> bool:
    """Return whether host:port is an address, localhost or `host`, which nobody can rebind."""
    try:
        name = urlsplit(f"//{authority}").hostname or ""
        return name in ("localhost", host) or bool(ipaddress.ip_address(name))
    except ValueError:
        return False


async def add_policy(request: Any, response: Any) -> None:
    response.headers["Content-Security-Policy"] = POLICY
