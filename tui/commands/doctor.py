"""Check the terminal, its colours, the recordings folder and versions, and suggest fixes."""

import argparse
import platform
import shutil
import sys
from collections.abc import Iterator, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryFile

from pendu_tui.recordings.system import environment
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.report import Column, Report, add_report_options, publish
from pendu_tui.tui.terminal.options import SMALLEST, colours, is_utf8
from pendu_tui.tui.words.numbers import file_size

EXAMPLES = """\
examples:
  pendu-tui doctor
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
"""

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")


def add_options(parser: argparse.ArgumentParser) -> None:
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    names = ("what", "found", "advice")
    rows = [dict(zip(names, finding, strict=True)) for finding in _findings()]
    advice = Column("advice", lambda row: row["advice"] or "fine")
    columns = (Column("", "what"), Column("found", "found"), advice)
    publish(Report(name="doctor", columns=columns, rows=rows, fields={"findings": rows}), options)
    return Exit.FINE


def _findings() -> Iterator[tuple[str, str, str]]:
    """Yield what was checked, what was found, and advice, which is empty if that is fine."""
    from pendu_tui.recordings import library

    yield "lab", *_lab()
    if sys.stdout.isatty():
        yield "size", *size(*shutil.get_terminal_size())
    else:
        yield "size", "unknown: the output is a file or a pipe", ""
    encoding = sys.stdout.encoding
    advice = "braille needs UTF-8: set LANG=C.UTF-8, or PYTHONUTF8=1"
    yield "encoding", encoding, "" if is_utf8(encoding) else advice
    yield "colours", *colour(environment())
    yield "recordings", *folder(library.folder())
    yield "python", f"{platform.python_version()}, {platform.system()} {platform.machine()}", ""
    yield "versions", ", ".join(f"{package} {version(package)}" for package in PACKAGES), ""
    try:
        yield "numba", version("numba"), ""
    except PackageNotFoundError:
        yield "numba", "not installed", "speeds up long runs: pip install 'pendu-tui[fast]'"


def _lab() -> tuple[str, str]:
    from pendu_tui.tui.terminal.check import check_terminal

    try:
        check_terminal()
    except UserError as error:
        return "cannot start here", str(error)
    return "starts here", ""


def size(columns: int, rows: int) -> tuple[str, str]:
    advice = ""
    if columns < SMALLEST[0] or rows < SMALLEST[1]:
        advice = f"too small: the lab needs {SMALLEST[0]}x{SMALLEST[1]}, better 80x24"
    elif columns < 120 or rows < 40:
        advice = "120x40 or larger shows all panes"
    return f"{columns}x{rows}", advice


def colour(environment: Mapping[str, str]) -> tuple[str, str]:
    count = colours(environment)
    text = str(count)
    advice = "if your terminal supports true colour, set COLORTERM=truecolor"
    if environment.get("NO_COLOR"):
        text = "NO_COLOR"
        advice = "off, as requested; methods keep their digits and letters"
    elif not count:
        text = "none"
        advice = "set TERM correctly, e.g. xterm-256color"
    elif count > 256:
        text = "16 million"
        advice = ""
    return f"TERM={environment.get('TERM', '')}, {text}", advice


def folder(path: Path) -> tuple[str, str]:
    """Check the folder, or its nearest parent, by creating a file: permissions may mislead."""
    nearest = path
    try:
        while not (nearest.exists() or nearest.is_symlink()):
            nearest = nearest.parent
        with TemporaryFile(dir=nearest):
            return f"{path}, {file_size(shutil.disk_usage(nearest).free)} free", ""
    except OSError as error:
        why = f"cannot be written ({error.strerror})"
        return str(path), f"{why}: set PENDU_RECORDINGS to a writable folder"
