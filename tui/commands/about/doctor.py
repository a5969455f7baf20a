"""Check the environment (terminal, encoding, colours, recordings, versions) and suggest fixes."""

import argparse
import os
import platform
import shutil
import sys
from collections.abc import Iterator, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryFile
from typing import NamedTuple

from tui.cli.errors import Exit, UserError
from tui.cli.install import install_advice
from tui.cli.report import Column, Report, add_report_options, publish
from tui.terminal.options import SMALLEST, colours, is_utf8
from tui.words.numbers import file_size

EXAMPLES = """\
examples:
  pendu-tui doctor
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
"""

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")
ROOMY = 1_000_000_000  # bytes free: a day of recordings


class Check(NamedTuple):
    """One property of the environment.  No advice: it is fine."""

    what: str
    found: str
    advice: str = ""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    checks = [check._asdict() for check in _checks()]
    columns = (
        Column("", "what"),
        Column("found", "found"),
        Column("advice", lambda check: check["advice"] or "fine"),
    )
    publish(
        Report(name="doctor", columns=columns, rows=checks, fields={"findings": checks}), options
    )
    return Exit.FINE


def _checks() -> Iterator[Check]:
    from recordings import library

    yield lab()
    columns, rows = shutil.get_terminal_size()
    yield (
        size(columns, rows)
        if sys.stdout.isatty()
        else Check("size", "unknown: the output is a file or a pipe")
    )
    yield encoding(sys.stdout.encoding)
    yield colour(os.environ)
    yield folder(library.folder())
    yield Check("python", f"{platform.python_version()}, {platform.system()} {platform.machine()}")
    yield Check("versions", ", ".join(f"{package} {version(package)}" for package in PACKAGES))
    yield numba()


def lab() -> Check:
    from tui.terminal.check import check_terminal

    try:
        check_terminal()
    except UserError as error:
        return Check("lab", "cannot start here", str(error))
    return Check("lab", "starts here")


def size(columns: int, rows: int) -> Check:
    advice = ""
    if columns < SMALLEST[0] or rows < SMALLEST[1]:
        advice = f"too small: the lab needs {SMALLEST[0]}x{SMALLEST[1]}, better 80x24"
    elif columns < 120 or rows < 40:
        advice = "120x40 or larger shows all panes"
    return Check("size", f"{columns}x{rows}", advice)


def encoding(name: str) -> Check:
    return Check(
        "encoding",
        name,
        "" if is_utf8(name) else "braille needs UTF-8: set LANG=C.UTF-8, or PYTHONUTF8=1",
    )


def colour(environment: Mapping[str, str]) -> Check:
    number = colours(environment)
    found = str(number)
    advice = "if your terminal supports true colour, set COLORTERM=truecolor"
    if environment.get("NO_COLOR"):
        found = "NO_COLOR"
        advice = "off, as requested; methods keep their digits and letters"
    elif not number:
        found = "none"
        advice = "set TERM correctly, e.g. xterm-256color"
    elif number > 256:
        found = "16 million"
        advice = ""
    return Check("colours", f"TERM={environment.get('TERM', '')}, {found}", advice)


def folder(path: Path) -> Check:
    """Try to make a file in the folder or its nearest parent: permissions alone do not tell."""
    try:
        there = next(each for each in (path, *path.parents) if each.exists() or each.is_symlink())
        with TemporaryFile(dir=there):
            free = shutil.disk_usage(there).free
    except OSError as error:
        advice = f"cannot be written ({error.strerror}): set PENDU_RECORDINGS to a writable folder"
        return Check("recordings", str(path), advice)
    advice = (
        "disk space is low: pendu-tui recordings prune --keep 20 frees some" if free < ROOMY else ""
    )
    return Check("recordings", f"{path}, {file_size(free)} free", advice)


def numba() -> Check:
    try:
        return Check("numba", version("numba"))
    except PackageNotFoundError:
        return Check(
            "numba", "not installed", f"speeds up long runs: {install_advice('numba', 'fast')}"
        )
