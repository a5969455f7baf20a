"""Check the environment (terminal, encoding, colours, recordings, versions) and suggest fixes."""

import argparse
import os
import platform
import shutil
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryFile

from tui.cli.errors import Exit, UserError
from tui.cli.output import write_json
from tui.cli.report import print_table
from tui.terminal.options import SMALLEST, colours, is_utf8
from tui.words.numbers import file_size

EXAMPLES = """\
examples:
  pendu-tui doctor
  pendu-tui doctor --json | jq '.findings[] | select(.advice != "")'
"""

PACKAGES = ("pendu-tui", "textual", "rich", "plotext", "numpy", "mcap")
ROOMY = 1_000_000_000  # bytes free: a day of recordings


@dataclass(frozen=True, slots=True)
class Check:
    """One property of the environment.  No advice: it is fine."""

    what: str
    found: str
    advice: str = ""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="one JSON object")


def run(options: argparse.Namespace) -> int:
    checks = list(_checks())
    if options.json:
        write_json("doctor", {"findings": [asdict(check) for check in checks]})
    else:
        print_table("lll", ("", "found", "advice"), ((c.what, c.found, c.advice or "fine") for c in checks))
    return Exit.FINE


def _checks() -> Iterator[Check]:
    from recordings import library

    yield lab()
    columns, rows = shutil.get_terminal_size()
    yield size(columns, rows) if sys.stdout.isatty() else Check("size", "unknown: the output is a file or a pipe")
    yield encoding(sys.stdout.encoding)
    yield colour(os.environ)
    yield mouse(os.environ)
    yield folder(library.folder())
    with suppress(OSError):  # which the check of the folder shows
        yield unfinished(len(library.leftovers()))
    yield sine(library.resolve("drift"))
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
    advice = "" if columns >= 120 and rows >= 40 else "120x40 or larger shows all panes"
    if columns < SMALLEST[0] or rows < SMALLEST[1]:
        limit = f"{SMALLEST[0]}x{SMALLEST[1]}"
        advice = f"too small: the lab needs {limit}, better 80x24"
    return Check("size", f"{columns}x{rows}", advice)


def encoding(name: str) -> Check:
    return Check("encoding", name, "" if is_utf8(name) else "braille needs UTF-8: set LANG=C.UTF-8, or PYTHONUTF8=1")


def colour(environment: Mapping[str, str]) -> Check:
    term, many = environment.get("TERM", ""), colours(environment)
    found, advice = str(many), "if your terminal supports true colour, set COLORTERM=truecolor"
    if environment.get("NO_COLOR"):
        found, advice = "NO_COLOR", "off, as requested; methods keep their digits and letters"
    elif not many:
        found, advice = "none", "set TERM correctly, e.g. xterm-256color"
    elif many > 256:
        found, advice = "16 million", ""
    return Check("colours", f"TERM={term}, {found}", advice)


def mouse(environment: Mapping[str, str]) -> Check:
    """Whether a mouse can be expected: only the terminal's name gives a hint."""
    if environment.get("TERM", "") in ("", "dumb", "linux", "vt100", "vt220"):
        return Check("mouse", "probably not supported", "every mouse action has a key")
    return Check("mouse", "enabled if the terminal supports it; --no-mouse disables it")


def folder(path: Path) -> Check:
    """Whether recordings can be kept: tried in the folder or its nearest parent, since permissions are not enough."""
    try:
        there = next(each for each in (path, *path.parents) if each.exists() or each.is_symlink())
        with TemporaryFile(dir=there):
            free = shutil.disk_usage(there).free
    except OSError as error:
        advice = f"cannot be written ({error.strerror}): set PENDU_RECORDINGS to a writable folder"
        return Check("recordings", str(path), advice)
    advice = "disk space is low: pendu-tui recordings prune --keep 20 frees some" if free < ROOMY else ""
    return Check("recordings", f"{path}, {file_size(free)} free", advice)


def unfinished(count: int) -> Check:
    advice = "recovered at the next start of the lab; listed by pendu-tui recordings" if count else ""
    return Check("unfinished", str(count or "none"), advice)


def sine(golden: Path) -> Check:
    """Whether this machine's sin() gives the same bits as the one of the bundled recordings."""
    from recordings.recording import Recording
    from recordings.summary import fingerprint

    with Recording.open(golden) as recording:
        same = recording.functions["sin"] == fingerprint("sin")
    advice = "" if same else "different libm: recordings made elsewhere verify within a tolerance only"
    return Check("sin", fingerprint("sin"), advice)


def numba() -> Check:
    try:
        return Check("numba", version("numba"))
    except PackageNotFoundError:
        return Check("numba", "not installed", "speeds up long runs: pip install '.[fast]' in the clone")
