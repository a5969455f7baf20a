"""The lab in a browser, for a class without terminals: each tab gets a lab of its own."""

import argparse
import ipaddress
import os
from pathlib import Path

from tui.cli.errors import Exit, UserError
from tui.cli.install import install_advice
from tui.cli.options import add_file, count
from tui.cli.output import warn
from tui.cli.scene import add_scene_options, scene_of
from tui.terminal.options import add_picture_options, terminal_options_of

EXAMPLES = """\
examples:
  pendu-tui serve
  pendu-tui serve --port 8080 --scene crossover
  pendu-tui serve --at-most 30 --record recorded/

From another computer: ssh -L 8000:127.0.0.1:8000 HOST, then open http://127.0.0.1:8000 there.
Ctrl+C ends it.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--port", metavar="N", type=port, default=8000, help="where to listen (%(default)s; 0: any)"
    )
    parser.add_argument(
        "--host",
        metavar="ADDRESS",
        default="127.0.0.1",
        help="this computer's address (%(default)s)",
    )
    parser.add_argument(
        "--at-most", metavar="N", type=count, default=20, help="labs at once (%(default)s)"
    )
    add_file(parser, "--record", metavar="FOLDER", type=Path, help="record every lab into FOLDER")
    add_scene_options(parser)
    add_picture_options(parser, "dark", "braille")


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)

    try:
        from tui.commands.lab.web.server import serve
    except ImportError as error:
        raise UserError(
            f"serve needs {error.name}: {install_advice('textual-serve', 'web')}."
        ) from None
    folder = None if options.record is None else recording_folder(options.record)
    settings = (scene, terminal_options_of(options, {}, "utf-8"), folder)

    def listening(address: str) -> None:
        if not is_local(options.host):
            warn(
                f"everybody who can reach {options.host} can use this computer's processor in up to"
                f" {options.at_most} labs, without a password or encryption."
            )
        print(
            f"{address} shows the lab, {options.at_most} at once at most; Ctrl+C ends it.",
            flush=True,
        )

    try:
        serve(settings, options.host, options.port, options.at_most, listening)
    except (OSError, UnicodeError) as error:
        number = getattr(error, "errno", 0) or 0
        why = os.strerror(number) if number > 0 else error
        where = f"{options.host} port {options.port}"
        raise UserError(
            f"cannot listen on {where}: {why}; choose another --port or --host."
        ) from None
    return Exit.FINE


def port(text: str) -> int:
    """A port, 0 to 65535."""
    if not (text.isdecimal() and text.isascii() and len(text) <= 5 and int(text) <= 65535):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a port; use 1024 to 65535, or 0 for any that is free"
        )
    return int(text)


def is_local(host: str) -> bool:
    """Whether only this computer can reach the address."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def recording_folder(folder: Path) -> Path:
    """Return the folder, made if it is missing.

    Raises UserError or OSError if it cannot be written to.
    """
    folder.mkdir(exist_ok=True)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise UserError(f"{folder} is not writable: choose another folder for --record.", Exit.DISK)
    return folder.absolute()
