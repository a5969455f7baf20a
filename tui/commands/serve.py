"""Show the lab in a browser, for a class without terminals; each tab gets its own lab."""

import argparse
import os
from pathlib import Path

from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.errors import Exit, UserError, warn
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.terminal.options import terminal_options_of

THIS_COMPUTER = ("127.0.0.1", "::1", "localhost")


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
