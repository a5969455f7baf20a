"""The lab in a browser, for a class without terminals: each tab gets a lab of its own."""

import argparse
import os
from pathlib import Path

from tui.cli.errors import Exit, UserError
from tui.cli.install import install_advice
from tui.cli.options import add_file, count
from tui.cli.report import warn
from tui.cli.scene import add_scene_options, scene_of
from tui.terminal.options import add_picture_options, terminal_options_of

EXAMPLES = """\
examples:
  pendu-tui serve --port 8080 --scene crossover
  pendu-tui serve --at-most 30 --record recorded/

From another computer: ssh -L 8000:127.0.0.1:8000 HOST, then open http://127.0.0.1:8000 there.
Ctrl+C ends it.
"""

THIS_COMPUTER = ("127.0.0.1", "::1", "localhost")


def add_options(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    port = "where to listen (%(default)s; 0: any)"
    add("--port", metavar="N", type=int, default=8000, help=port)
    host = "this computer's address (%(default)s)"
    add("--host", metavar="ADDRESS", default="127.0.0.1", help=host)
    add("--at-most", metavar="N", type=count, default=20, help="labs at once (%(default)s)")
    add_file(parser, "--record", metavar="FOLDER", type=Path, help="record every lab into FOLDER")
    add_scene_options(parser)
    add_picture_options(parser, "dark", "braille")


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    try:
        from tui.commands.web.server import serve
    except ImportError as error:
        advice = install_advice("textual-serve", "web")
        raise UserError(f"serve needs {error.name}: {advice}.") from None
    folder: Path | None = options.record
    if folder is not None:
        folder.mkdir(exist_ok=True)
        folder = folder.absolute()
        if not os.access(folder, os.W_OK | os.X_OK):
            why = f"{folder} is not writable: choose another folder for --record."
            raise UserError(why, Exit.DISK)

    def listening(address: str) -> None:
        at_most = options.at_most
        if options.host not in THIS_COMPUTER:
            warn(
                f"everybody who can reach {options.host} can use this computer's processor in up to"
                f" {at_most} labs, without a password or encryption."
            )
        print(f"{address} shows the lab, {at_most} at once at most; Ctrl+C ends it.", flush=True)

    settings = (scene, terminal_options_of(options, {}, "utf-8"), folder)
    try:
        serve(settings, options.host, options.port, options.at_most, listening)
    except (OSError, OverflowError, UnicodeError) as error:
        why = getattr(error, "strerror", None) or str(error)
        where = f"{options.host} port {options.port}"
        raise UserError(
            f"cannot listen on {where}: {why}; choose another --port or --host."
        ) from None
    return Exit.FINE
