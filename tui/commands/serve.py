"""Show the lab in a browser, for a class without terminals; each tab gets its own lab."""

import argparse
import os
from pathlib import Path

from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.options import add_file, count
from pendu_tui.tui.cli.report import warn
from pendu_tui.tui.cli.scene import add_scene_options, scene_of
from pendu_tui.tui.terminal.options import add_picture_options, terminal_options_of

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
    port = "port to listen on (%(default)s; 0: any free one)"
    add("--port", metavar="N", type=int, default=8000, help=port)
    host = "address to listen on (%(default)s)"
    add("--host", metavar="ADDRESS", default="127.0.0.1", help=host)
    add("--at-most", metavar="N", type=count, default=20, help="limit of open labs (%(default)s)")
    add_file(parser, "--record", metavar="FOLDER", type=Path, help="record each lab in FOLDER")
    add_scene_options(parser)
    add_picture_options(parser, "dark", "braille")


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    check_fits(scene.cast)
    try:
        from pendu_tui.tui.commands.web.server import serve
    except ImportError:
        raise UserError("serve needs an extra: pip install 'pendu-tui[web]'.") from None
    folder: Path | None = options.record
    if folder is not None:
        folder.mkdir(exist_ok=True)
        folder = folder.absolute()
        if not os.access(folder, os.W_OK | os.X_OK):
            why = f"{folder} is not writable: choose another folder for --record."
            raise UserError(why, Exit.DISK)

    def listening(address: str) -> None:
        if options.host not in THIS_COMPUTER:
            warn(
                f"anyone who can reach {options.host} can open labs on this computer, without a "
                "password or encryption."
            )
        print(f"{address} serves up to {options.at_most} labs; Ctrl+C ends it.", flush=True)

    settings = (scene, terminal_options_of(options, {}, "utf-8"), folder)
    try:
        serve(settings, options.host, options.port, options.at_most, listening)
    except (OSError, OverflowError, UnicodeError) as error:
        why = getattr(error, "strerror", None) or str(error)
        where = f"{options.host} port {options.port}"
        advice = "choose another --port or --host"
        raise UserError(f"cannot listen on {where}: {why}; {advice}.") from None
    return Exit.FINE
