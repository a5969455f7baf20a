"""Check the terminal, its colours, the recordings folder and versions, and suggest fixes."""

import argparse
import os
import platform
import shutil
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from tempfile import TemporaryFile

from pendu_tui.recordings import files
from pendu_tui.recordings.system import environment
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.commands.report import Column, Report, publish
from pendu_tui.tui.terminal.options import SMALLEST, check_terminal, colours, is_utf8
from pendu_tui.tui.words.numbers import file_size

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")


def run(options: argparse.Namespace) -> int:
    names = ("what", "found", "advice")
    rows = [dict(zip(names, finding, strict=True)) for finding in _findings()]
    advice = Column("advice", lambda row: row["advice"] or "fine")
    columns = (Column("", "what"), Column("found", "found"), advice)
    publish(Report(name="doctor", columns=columns, rows=rows, fields={"findings": rows}), options)
    return Exit.FINE


def _findings() -> Iterator[tuple[str, str, str]]:
    """Yield what was checked, what was found, and advice, which is empty if that is fine."""
    try:
        check_terminal()
        yield "lab", "starts here", ""
    except UserError as error:
        yield "lab", "cannot start here", str(error)
    if sys.stdout.isatty():
        size = shutil.get_terminal_size()
        advice = ""
        if size.columns < SMALLEST[0] or size.lines < SMALLEST[1]:
            advice = f"the lab needs {SMALLEST[0]}x{SMALLEST[1]}; 120x40 shows all panes"
        yield "size", f"{size.columns}x{size.lines}", advice
    if platform.system() == "Windows":
        console = ("older", "use Windows Terminal, or --pixels half where dots are missing")
        if "WT_SESSION" in os.environ:
            console = ("Windows Terminal", "")
        yield "console", *console
    encoding = sys.stdout.encoding
    advice = ""
    if not is_utf8(encoding):
        advice = "braille needs UTF-8: set LANG=C.UTF-8, or PYTHONUTF8=1"
    yield "encoding", encoding, advice
    known = environment()
    advice = "if it has true colour, set COLORTERM=truecolor; if it has no colour, set TERM"
    if known.get("NO_COLOR") or colours(known) > 256:
        advice = ""
    yield "colours", f"{colours(known)}, TERM={known.get('TERM', '')}", advice
    yield "recordings", *recordings()
    yield "python", f"{platform.python_version()}, {platform.system()} {platform.machine()}", ""
    yield "versions", ", ".join(f"{package} {version(package)}" for package in PACKAGES), ""
    try:
        yield "numba", version("numba"), ""
    except PackageNotFoundError:
        yield "numba", "not installed", "it speeds up long runs: install pendu-tui[fast]"


def recordings() -> tuple[str, str]:
    """Check the folder, or its nearest parent, by creating a file: permissions may mislead."""
    advice = "set PENDU_RECORDINGS to a writable folder"
    path = None
    try:
        path = nearest = files.folder()
        while not (nearest.exists() or nearest.is_symlink()):
            nearest = nearest.parent
        with TemporaryFile(dir=nearest):
            return f"{path}, {file_size(shutil.disk_usage(nearest).free)} free", ""
    except OSError as error:  # also of a PENDU_RECORDINGS that names no folder
        return str(path or error.filename), f"{error.strerror}: {advice}"
